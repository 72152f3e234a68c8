// Tests of what every law has to satisfy, in every section that it takes.

#include "elastimate/core/laws/law.h"

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/law_check.h"
#include "elastimate/core/materials/laws.h"
#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

struct LawInSection {
  const Law* law;
  SectionModel model;
};

// Returns the laws of small strains; tests/core/large_strain tests the others.
std::vector<LawInSection> AllLawsInSections() {
  std::vector<LawInSection> all;
  for (const Law* const law : Laws()) {
    for (const SectionModel model : kAllSectionModels) {
      if (law->Takes(model) && law->ForLargeStrains() == nullptr) {
        all.push_back({law, model});
      }
    }
  }
  return all;
}

// The numbers have derivatives by the entries of H, of which there are up to
// nine.
using GradientJet = ceres::Jet<double, 9>;

// W_k = 1/2 H : C_k H, where the columns of C_k are stresses of unit gradients.
std::vector<GradientJet> QuadraticEnergies(const Law& law, SectionModel model,
                                           const Eigen::MatrixXd& gradient) {
  std::vector<GradientJet> energies(law.NumModuli());
  for (int i = 0; i < gradient.size(); ++i) {
    Eigen::MatrixXd unit =
        Eigen::MatrixXd::Zero(gradient.rows(), gradient.cols());
    unit(i) = 1;
    const Eigen::MatrixXd columns = law.Stresses(unit, model);
    for (int j = 0; j < gradient.size(); ++j) {
      for (std::size_t k = 0; k < energies.size(); ++k) {
        energies[k] += 0.5 * columns(j, Eigen::Index(k)) *
                       GradientJet(gradient(j), j) *
                       GradientJet(gradient(i), i);
      }
    }
  }
  return energies;
}

// Returns how far a law of small strains is from QuadraticEnergies: the largest
// deviation of its energies, of its stresses from the automatic derivatives,
// and of what its tangent makes of H for these moduli, each relative to its
// size.
double DeviationFromQuadraticEnergies(const Law& law, SectionModel model,
                                      const Eigen::MatrixXd& gradient,
                                      const Eigen::VectorXd& moduli) {
  const std::vector<GradientJet> automatic =
      QuadraticEnergies(law, model, gradient);
  Eigen::VectorXd energies(law.NumModuli());
  Eigen::MatrixXd stresses(gradient.size(), law.NumModuli());
  for (Eigen::Index k = 0; k < energies.size(); ++k) {
    energies(k) = automatic[k].a;
    stresses.col(k) = automatic[k].v.head(gradient.size());
  }
  const auto deviation = [](const Eigen::MatrixXd& actual,
                            const Eigen::MatrixXd& expected) {
    return (actual - expected).norm() / expected.norm();
  };
  return std::max(
      {deviation(law.Energies(gradient, model), energies),
       deviation(law.Stresses(gradient, model), stresses),
       deviation(law.Tangent(moduli, gradient, model) * gradient.reshaped(),
                 stresses * moduli)});
}

class LawConformance : public ::testing::TestWithParam<LawInSection> {
 protected:
  const Law& law_ = *GetParam().law;
  SectionModel model_ = GetParam().model;
  Eigen::Index dimension_ = model_ == SectionModel::kSolid ? 3 : 2;
  Eigen::MatrixXd gradient_ = 0.1 * RandomMatrix(dimension_, dimension_, 1);

  // Returns parameters near the typical ones.
  Eigen::VectorXd Parameters() const {
    Eigen::VectorXd parameters(law_.Parameters().size());
    double factor = 0.8;
    for (Eigen::Index i = 0; i < parameters.size(); ++i) {
      parameters(i) = law_.Parameters()[i].typical * factor;
      factor += 0.05;
    }
    return parameters;
  }
  Eigen::VectorXd Moduli() const { return law_.Moduli(Parameters(), model_); }
};

TEST_P(LawConformance, PassesTheCheck) {
  EXPECT_THAT(CheckLaw(law_), ::testing::IsEmpty());
}

TEST_P(LawConformance, StressAndTangentAreAutomaticDerivativesOfTheEnergy) {
  EXPECT_LT(DeviationFromQuadraticEnergies(law_, model_, gradient_, Moduli()),
            1e-12);
}

INSTANTIATE_TEST_SUITE_P(Laws, LawConformance,
                         ::testing::ValuesIn(AllLawsInSections()),
                         [](const auto& info) {
                           std::string name(info.param.law->Name());
                           name +=
                               "_" +
                               std::string(SectionModelName(info.param.model));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// This law has shear stresses that are wrong by these factors, which the
// comparison with automatic derivatives has to notice.
class WrongShear : public IsotropicLaw {
 public:
  WrongShear(double factor, double factor_of_transpose)
      : factor_(factor), factor_of_transpose_(factor_of_transpose) {}

  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override {
    Eigen::MatrixXd stresses = IsotropicLaw::Stresses(gradient, model);
    stresses.row(1) *= factor_;
    stresses.row(gradient.rows()) *= factor_of_transpose_;
    return stresses;
  }

 private:
  double factor_;
  double factor_of_transpose_;
};

TEST(WrongShear, IsFarFromItsQuadraticEnergies) {
  for (const SectionModel model : kAllSectionModels) {
    const int dimension = model == SectionModel::kSolid ? 3 : 2;
    const auto deviation = [&](double factor, double factor_of_transpose) {
      return DeviationFromQuadraticEnergies(
          WrongShear(factor, factor_of_transpose), model,
          RandomMatrix(dimension, dimension, 1), Eigen::Vector2d(1, 0.3));
    };
    EXPECT_LT(deviation(1, 1), 1e-12);
    EXPECT_GT(deviation(2, 2), 0.01);
    // This tangent is not symmetric, though the energy may be right.
    EXPECT_GT(deviation(1.1, 0.9), 0.01);
  }
}

TEST(Laws, AreFoundByTheirNames) {
  for (const Law* const law : Laws()) {
    for (const SectionModel model : kAllSectionModels) {
      if (law->Takes(model)) {
        EXPECT_EQ(FindLaw(law->Name(), model), law);
      }
    }
    // Among laws of the same name, the first has all parameters of the others.
    std::set<std::string_view> names;
    for (const LawParameter& parameter : FindLaw(law->Name())->Parameters()) {
      names.insert(parameter.name);
    }
    for (const LawParameter& parameter : law->Parameters()) {
      EXPECT_EQ(names.count(parameter.name), 1) << parameter.name;
    }
  }
  EXPECT_EQ(FindLaw("anisotropic", SectionModel::kPlaneStress), nullptr);
  EXPECT_EQ(FindLaw("rubber"), nullptr);
}

}  // namespace
}  // namespace elastimate
