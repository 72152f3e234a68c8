#include "elastimate/core/materials/law_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/laws.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

enum class Mistake {
  kNone,
  kEnergy,
  kTangent,
  kNotLinear,
  kStressAtRest,
  kNotSymmetric,
  kIndefinite,
  kResistsRotations,
  kJacobian,
  kChart,
  kUnit,
  kShape,
  kNotFinite,
  kBlocks,
  kBlocksIndefinite,
  kName,
  kTypical,
  kNoSection,
};

// This is the isotropic law with one mistake.
class MistakenLaw : public IsotropicLaw {
 public:
  explicit MistakenLaw(Mistake mistake, std::string_view name = "mistaken")
      : mistake_(mistake), name_(name) {
    parameters_ = IsotropicLaw::Parameters();
    if (mistake == Mistake::kTypical) {
      parameters_[1].typical = 0.7;
    }
    if (mistake == Mistake::kBlocks) {
      entries_ = {{0, 0, 1}};
    } else if (mistake == Mistake::kBlocksIndefinite) {
      entries_ = {{0, 0, 1}, {0, 1, 10}};
    }
  }

  std::string_view Name() const override {
    return mistake_ == Mistake::kName ? "" : name_;
  }
  const std::vector<LawParameter>& Parameters() const override {
    return parameters_;
  }
  const std::vector<BlockEntry>& BlockEntries() const override {
    return entries_;
  }
  bool Takes(SectionModel model) const override {
    return mistake_ != Mistake::kNoSection && model == SectionModel::kSolid;
  }
  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override {
    Eigen::VectorXd energies = IsotropicLaw::Energies(gradient, model);
    if (mistake_ == Mistake::kEnergy) {
      energies(1) *= 1.0001;
    }
    return energies;
  }
  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override {
    Eigen::MatrixXd stresses = IsotropicLaw::Stresses(gradient, model);
    if (mistake_ == Mistake::kNotLinear) {
      stresses *= 1 + gradient.squaredNorm();
    } else if (mistake_ == Mistake::kStressAtRest) {
      stresses(0) += 1e-3;
    } else if (mistake_ == Mistake::kNotFinite) {
      stresses(2) = std::numeric_limits<double>::quiet_NaN();
    }
    return stresses;
  }
  Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& gradient,
                          SectionModel model) const override {
    Eigen::MatrixXd tangent = IsotropicLaw::Tangent(moduli, gradient, model);
    if (mistake_ == Mistake::kTangent) {
      tangent *= 1.0001;
    } else if (mistake_ == Mistake::kNotSymmetric) {
      tangent(0, 8) *= 1.0001;
    } else if (mistake_ == Mistake::kIndefinite) {
      tangent -= Eigen::MatrixXd::Ones(9, 9) * tangent(0);
    } else if (mistake_ == Mistake::kResistsRotations) {
      tangent(1, 1) *= 1.0001;
    }
    return tangent;
  }
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters,
                         SectionModel model) const override {
    Eigen::VectorXd moduli = IsotropicLaw::Moduli(parameters, model);
    if (mistake_ == Mistake::kUnit) {
      moduli(0) += 0.1;
    }
    return mistake_ == Mistake::kShape ? Eigen::VectorXd(moduli.head(1))
                                       : moduli;
  }
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters,
                                 SectionModel model) const override {
    Eigen::MatrixXd jacobian = IsotropicLaw::ModuliJacobian(parameters, model);
    if (mistake_ == Mistake::kJacobian) {
      jacobian(0, 1) *= 1.0001;
    }
    return jacobian;
  }
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli,
                               SectionModel model) const override {
    Eigen::VectorXd parameters = IsotropicLaw::ParametersOf(moduli, model);
    if (mistake_ == Mistake::kChart) {
      parameters(1) += 1e-6;
    }
    return parameters;
  }

 private:
  Mistake mistake_;
  std::string_view name_;
  std::vector<LawParameter> parameters_;
  std::vector<BlockEntry> entries_;
};

TEST(CheckLaw, FindsNothingInARightLaw) {
  EXPECT_THAT(CheckLaw(MistakenLaw(Mistake::kNone)), IsEmpty());
}

struct MistakeAndSentence {
  Mistake mistake;
  const char* sentence;
};

TEST(CheckLaw, SaysWhatIsWrong) {
  for (const auto& [mistake, sentence] : std::vector<MistakeAndSentence>{
           {Mistake::kEnergy,
            "in 3d: column 1 of Stresses is not the derivative of entry 1 of "
            "Energies"},
           {Mistake::kTangent, "Tangent is not the derivative of the stress"},
           {Mistake::kNotLinear, "make the stress linear in the gradient"},
           {Mistake::kStressAtRest, "is not zero where the gradient is zero"},
           {Mistake::kNotSymmetric, "Tangent is not symmetric"},
           {Mistake::kIndefinite, "the stiffness is not positive definite"},
           {Mistake::kResistsRotations, "Tangent resists rotations"},
           {Mistake::kJacobian, "ModuliJacobian is not the derivative"},
           {Mistake::kChart, "ParametersOf(Moduli(p)) is not p"},
           {Mistake::kUnit, "in another unit of pressure"},
           {Mistake::kShape, "Moduli returns 1 x 1 numbers; it must return 2"},
           {Mistake::kNotFinite, "Stresses returns numbers that are not fin"},
           {Mistake::kBlocks, "BlockEntries has 1 entries; it must have one"},
           {Mistake::kBlocksIndefinite, "BlockEntries is not positive definit"},
           {Mistake::kName, "has no name"},
           {Mistake::kTypical, "a typical value of 'poisson_ratio', 0.7"},
           {Mistake::kNoSection, "takes no section"}}) {
    EXPECT_THAT(CheckLaw(MistakenLaw(mistake)),
                ::testing::Contains(HasSubstr(sentence)));
  }
}

// A mistake from which no other follows is told in one sentence.
TEST(CheckLaw, SaysEachThingOnce) {
  for (const Mistake mistake :
       {Mistake::kEnergy, Mistake::kJacobian, Mistake::kChart}) {
    EXPECT_EQ(CheckLaw(MistakenLaw(mistake)).size(), 1U);
  }
}

TEST(RegisterLaw, RefusesWhatCannotBeUsed) {
  EXPECT_THROWS_WITH(RegisterLaw(nullptr), "null pointer");
  EXPECT_THROWS_WITH(
      RegisterLaw(std::make_shared<MistakenLaw>(Mistake::kChart)),
      "ParametersOf.Moduli.p.. is not p");
  EXPECT_THROWS_WITH(RegisterLaw(std::make_shared<MistakenLaw>(
                         Mistake::kNone, IsotropicLaw::kName)),
                     "there is a law 'isotropic' already");
  EXPECT_EQ(FindLaw("mistaken"), nullptr);
}

TEST(RegisterLaw, LetsMaterialsNameTheLaw) {
  RegisterLaw(std::make_shared<MistakenLaw>(Mistake::kNone, "registered"));
  ASSERT_NE(FindLaw("registered", SectionModel::kSolid), nullptr);
  EXPECT_EQ(FindLaw("registered", SectionModel::kPlaneStress), nullptr);
  EXPECT_THAT(LawNames(SectionModel::kSolid), HasSubstr("registered"));
  EXPECT_THAT(LawNames(SectionModel::kPlaneStress),
              ::testing::Not(HasSubstr("registered")));
  // The registered law is the isotropic one, but takes the pass over the
  // elements that serves any law.
  Scene expected = testing::SmallScene("cuboid");
  Measure({2e4, 0.3}, expected);
  Scene scene = testing::SmallScene("cuboid");
  Material material;
  material.law = "registered";
  scene.materials = {material};
  MeasureMaterials(Eigen::Vector2d(2e4, 0.3), scene);
  EXPECT_TRUE(scene.load_cases[0].displacement.isApprox(
      expected.load_cases[0].displacement, 1e-10));
}

}  // namespace
}  // namespace elastimate
