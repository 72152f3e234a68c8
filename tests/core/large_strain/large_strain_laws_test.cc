// Tests of what every law of large strains has to satisfy.  The energies of the
// textbook stand here once more, for numbers of any kind: derivatives come from
// ceres::Jet, and digits near rest from long double.

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>
#include <vector>

#include "elastimate/core/large_strain/charts.h"
#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/laws/law_parameters.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/law_check.h"
#include "elastimate/core/materials/laws.h"
#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

template <class T>
using Square = Eigen::Matrix<T, 3, 3>;

constexpr SectionModel kAnySection = SectionModel::kSolid;

// Returns U = C^(1/2) by the iteration of Denman and Beavers.
template <class T>
Square<T> StretchOf(const Square<T>& c) {
  Square<T> y = c;
  Square<T> z = Square<T>::Identity();
  for (int step = 0; step < 12; ++step) {
    const Square<T> next = (y + z.inverse()) * T(0.5);
    z = ((z + y.inverse()) * T(0.5)).eval();
    y = next;
  }
  return y;
}

// Returns the law of small strains that the law of that name has in Green's
// strain, or null.
const Law* LawInGreenStrain(const std::string& name) {
  const std::string prefix = "st_venant_kirchhoff_";
  return name.rfind(prefix, 0) == 0
             ? FindLaw(name.substr(prefix.size()), kAnySection)
             : nullptr;
}

// Returns E : C_k : E / 2, with the C_k of a law of small strains.
template <class T>
std::vector<T> QuadraticEnergies(const Law& law, const Square<T>& e) {
  std::vector<T> energies;
  for (int k = 0; k < law.NumModuli(); ++k) {
    const Eigen::MatrixXd c =
        law.Tangent(Eigen::VectorXd::Unit(law.NumModuli(), k),
                    Eigen::Matrix3d::Zero(), kAnySection);
    T sum(0);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        if (c(i, j) != 0) {
          sum += e(i) * e(j) * T(c(i, j) / 2);
        }
      }
    }
    energies.push_back(sum);
  }
  return energies;
}

// The energies W_k of the law of that name at F.
template <class T>
std::vector<T> TextbookEnergies(const std::string& law, const Square<T>& f) {
  using std::exp;
  using std::log;
  const Square<T> c = f.transpose() * f;
  if (const Law* const law_of_strain = LawInGreenStrain(law)) {
    return QuadraticEnergies<T>(*law_of_strain,
                                (c - Square<T>::Identity()) * T(0.5));
  }
  const T j = f.determinant();
  const T i1 = c.trace();
  const T i2 = (i1 * i1 - (c * c).trace()) * T(0.5);
  if (law == "corotated") {
    const Square<T> v = StretchOf(c) - Square<T>::Identity();
    return {v.squaredNorm(), v.trace() * v.trace() * T(0.5)};
  }
  if (law == "st_venant_kirchhoff") {
    const Square<T> e = (c - Square<T>::Identity()) * T(0.5);
    return {e.squaredNorm(), e.trace() * e.trace() * T(0.5)};
  }
  if (law == "neo_hookean") {
    return {(i1 - T(3)) * T(0.5) - log(j), log(j) * log(j) * T(0.5)};
  }
  const T a = i1 * exp(log(j) * T(-2.0L / 3)) - T(3);
  const T volume = (j - T(1)) * (j - T(1)) * T(0.5);
  if (law == "mooney_rivlin") {
    return {a, i2 * exp(log(j) * T(-4.0L / 3)) - T(3), volume};
  }
  if (law == "yeoh") {
    return {a, a * a, a * a * a, volume};
  }
  ADD_FAILURE() << "the test knows no energy of " << law;
  return {};
}

std::vector<const LargeStrainLaw*> AllLargeStrainLaws() {
  std::vector<const LargeStrainLaw*> all;
  for (const Law* const law : Laws()) {
    if (law->ForLargeStrains() != nullptr) {
      all.push_back(law->ForLargeStrains());
    }
  }
  return all;
}

// Numbers with derivatives by the nine entries of F.
using Long = long double;
using Jet = ceres::Jet<Long, 9>;
using LongVector = Eigen::Matrix<Long, 9, 1>;

// Returns the textbook W_k with their derivatives at F = I + H.
std::vector<Jet> EnergiesAt(const std::string& law, const LongVector& h) {
  Square<Jet> f;
  for (int i = 0; i < 9; ++i) {
    f(i) = Jet(h(i) + (i % 4 == 0 ? 1 : 0), i);
  }
  return TextbookEnergies(law, f);
}

class LargeStrainLaws : public ::testing::TestWithParam<const LargeStrainLaw*> {
 protected:
  const LargeStrainLaw& law_ = *GetParam();
  std::string name_ = std::string(law_.Name());

  Eigen::VectorXd Parameters() const {
    Eigen::VectorXd parameters(law_.Parameters().size());
    for (Eigen::Index i = 0; i < parameters.size(); ++i) {
      parameters(i) = law_.Parameters()[i].typical * (1 + 0.1 * double(i));
    }
    return parameters;
  }
  Eigen::VectorXd Moduli() const {
    return law_.Moduli(Parameters(), kAnySection);
  }

  // Returns a rotation times stretches by up to 40 %.
  static Eigen::Matrix3d LargeGradient(int seed) {
    const Eigen::Vector3d axis = RandomMatrix(3, 1, seed);
    Eigen::Matrix3d stretch = 0.2 * RandomMatrix(3, 3, seed + 100);
    stretch = (stretch + stretch.transpose()).eval();
    stretch.diagonal().array() += 1;
    return Eigen::AngleAxisd(2 * axis.norm(), axis.normalized()) * stretch -
           Eigen::Matrix3d::Identity();
  }
};

TEST_P(LargeStrainLaws, PassTheCheck) {
  EXPECT_THAT(CheckLaw(law_), ::testing::IsEmpty());
}

TEST_P(LargeStrainLaws, HaveTheDerivativesOfTheTextbookEnergies) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Eigen::Matrix3d gradient = LargeGradient(seed);
    const LongVector h = gradient.reshaped().cast<Long>();
    const std::vector<Jet> expected = EnergiesAt(name_, h);
    ASSERT_EQ(int(expected.size()), law_.NumModuli());
    const Eigen::MatrixXd stresses = law_.Stresses(gradient, kAnySection);
    const Eigen::VectorXd energies = law_.Energies(gradient, kAnySection);
    std::vector<Eigen::MatrixXd> slopes(law_.NumModuli(),
                                        Eigen::MatrixXd(9, 9));
    for (int i = 0; i < 9; ++i) {
      // Differences of long double have an error of the square of the step.
      const LongVector step = 1e-7L * LongVector::Unit(i);
      const std::vector<Jet> above = EnergiesAt(name_, h + step);
      const std::vector<Jet> below = EnergiesAt(name_, h - step);
      for (std::size_t k = 0; k < slopes.size(); ++k) {
        slopes[k].col(i) = ((above[k].v - below[k].v) / 2e-7L).cast<double>();
      }
    }
    for (int k = 0; k < law_.NumModuli(); ++k) {
      EXPECT_NEAR(energies(k), double(expected[k].a), 1e-13);
      EXPECT_LT((stresses.col(k) - expected[k].v.cast<double>()).norm(),
                1e-12 * (1 + stresses.col(k).norm()));
      const Eigen::MatrixXd tangent = law_.Tangent(
          Eigen::VectorXd::Unit(law_.NumModuli(), k), gradient, kAnySection);
      EXPECT_LT((tangent - slopes[k]).norm(), 1e-10 * (1 + slopes[k].norm()))
          << k;
    }
  }
}

TEST_P(LargeStrainLaws, AreObjective) {
  const Eigen::Matrix3d h = LargeGradient(1);
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d turn(
      Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, -2, 0.5).normalized()));
  const Eigen::MatrixXd stresses = law_.Stresses(h, kAnySection);
  const Eigen::MatrixXd turned =
      law_.Stresses(turn * (identity + h) - identity, kAnySection);
  const Eigen::MatrixXd stretched_after =
      law_.Stresses((identity + h) * turn - identity, kAnySection);
  const Eigen::VectorXd energies = law_.Energies(h, kAnySection);
  EXPECT_TRUE(law_.Energies(turn * (identity + h) - identity, kAnySection)
                  .isApprox(energies, 1e-12));
  if (law_.NumAxes() == 0) {
    EXPECT_TRUE(law_.Energies((identity + h) * turn - identity, kAnySection)
                    .isApprox(energies, 1e-12));
  }
  for (int k = 0; k < law_.NumModuli(); ++k) {
    const Eigen::Matrix3d stress = stresses.col(k).reshaped(3, 3);
    EXPECT_TRUE(turned.col(k).reshaped(3, 3).isApprox(turn * stress, 1e-12));
    // Without axes they are isotropic as well.
    if (law_.NumAxes() == 0) {
      EXPECT_TRUE(
          stretched_after.col(k).reshaped(3, 3).isApprox(stress * turn, 1e-12));
    }
    const Eigen::Matrix3d kirchhoff = stress * (identity + h).transpose();
    EXPECT_TRUE(kirchhoff.isApprox(kirchhoff.transpose(), 1e-12));
  }
}

TEST_P(LargeStrainLaws, HaveNoStressInAnyRigidRotation) {
  for (const double angle : {0.5, 1.5, 3.0}) {
    const Eigen::Matrix3d h =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(2, 1, 2) / 3)
            .toRotationMatrix() -
        Eigen::Matrix3d::Identity();
    EXPECT_LT(law_.Stresses(h, kAnySection).norm(), 1e-14);
  }
}

TEST_P(LargeStrainLaws, AreTheLawOfSmallStrainsNearRest) {
  const Eigen::VectorXd moduli = Moduli();
  const Eigen::MatrixXd tangent =
      law_.Tangent(moduli, Eigen::Matrix3d::Zero(), kAnySection);
  if (const Law* const law_of_strain = LawInGreenStrain(name_)) {
    EXPECT_TRUE(tangent.isApprox(
        law_of_strain->Tangent(moduli, Eigen::Matrix3d::Zero(), kAnySection),
        1e-13));
    EXPECT_TRUE(
        moduli.isApprox(law_of_strain->Moduli(Parameters(), kAnySection)));
    return;
  }
  // mu and lambda are what shear and volume feel.
  const double mu = tangent(1, 1);
  const double lambda = tangent(0, 4);
  const Eigen::Vector2d parameters(mu * (3 * lambda + 2 * mu) / (lambda + mu),
                                   lambda / (2 * (lambda + mu)));
  const IsotropicLaw isotropic;
  const Eigen::MatrixXd expected =
      isotropic.Tangent(isotropic.Moduli(parameters, kAnySection),
                        Eigen::Matrix3d::Zero(), kAnySection);
  EXPECT_TRUE(tangent.isApprox(expected, 1e-13));
  if (law_.Parameters()[0].name == "youngs_modulus") {
    EXPECT_TRUE(
        parameters.isApprox(law_.ParametersOf(moduli, kAnySection), 1e-13));
  } else {
    const bool has_c01 = law_.Parameters()[1].name == "c01";
    EXPECT_NEAR(mu, 2 * (moduli(0) + (has_c01 ? moduli(1) : 0)), 1e-13);
    EXPECT_NEAR(lambda + 2 * mu / 3, moduli(moduli.size() - 1), 1e-13);
  }
}

TEST_P(LargeStrainLaws, KeepTheirDigitsNearRest) {
  for (const double size : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const Eigen::Matrix3d h = size * RandomMatrix(3, 3, 7);
    const Eigen::MatrixXd stresses = law_.Stresses(h, kAnySection);
    // The textbook loses digits too, but has 19 of them.
    const std::vector<Jet> expected =
        EnergiesAt(name_, h.reshaped().cast<Long>());
    for (int k = 0; k < law_.NumModuli(); ++k) {
      const double norm = double(expected[k].v.norm());
      // The stress of the powers of A in Yeoh's law is of third and fifth
      // order; long double does not have its digits there.
      if (norm < 1e-2 * size) {
        continue;
      }
      EXPECT_LT(double((stresses.col(k).cast<Long>() - expected[k].v).norm()),
                (1e-15 + 1e-18 / size * 20) * norm)
          << size << " " << k;
    }
  }
}

TEST_P(LargeStrainLaws, GiveTheSameAtManyPointsAsAtOne) {
  PointMatrices gradients = {};
  constexpr int kCount = 61;
  for (int p = 0; p < kCount; ++p) {
    const Eigen::Matrix3d h = LargeGradient(p);
    for (int i = 0; i < 9; ++i) {
      gradients.row[i][p] = h(i);
    }
  }
  std::vector<PointMatrices> columns(law_.NumModuli());
  PointTangents tangents;
  PointMatrices sum;
  law_.StressesAtPoints(gradients, GradientEntries::kAll, kCount,
                        columns.data());
  law_.TangentsAtPoints(Moduli(), gradients, GradientEntries::kAll, kCount,
                        tangents, &sum);
  for (int p = 0; p < kCount; ++p) {
    const Eigen::Matrix3d h = LargeGradient(p);
    const Eigen::MatrixXd stresses = law_.Stresses(h, kAnySection);
    const Eigen::MatrixXd tangent = law_.Tangent(Moduli(), h, kAnySection);
    for (int i = 0; i < 9; ++i) {
      for (int k = 0; k < law_.NumModuli(); ++k) {
        EXPECT_NEAR(columns[k].row[i][p], stresses(i, k), 1e-12);
      }
      EXPECT_NEAR(sum.row[i][p], stresses.row(i).dot(Moduli()), 1e-11);
      EXPECT_NEAR(tangents.row[TangentRow(i, 2)][p], tangent(2, i), 1e-11);
    }
  }
}

TEST_P(LargeStrainLaws, HaveInThePlaneAndAcrossItWhatTheSolidHas) {
  PointMatrices gradients = {};
  constexpr int kCount = 61;
  for (int p = 0; p < kCount; ++p) {
    const Eigen::Matrix3d h = LargeGradient(p);
    for (const int place : kPlacesOfPlane) {
      gradients.row[place][p] = 0.3 * h(place);
    }
  }
  struct Found {
    std::vector<PointMatrices> columns;
    PointTangents tangents;
    PointMatrices stress;
  };
  const auto find = [&](GradientEntries entries) {
    Found found;
    found.columns.resize(law_.NumModuli());
    law_.StressesAtPoints(gradients, entries, kCount, found.columns.data());
    law_.TangentsAtPoints(Moduli(), gradients, entries, kCount, found.tangents,
                          &found.stress);
    return found;
  };
  const Found of_solid = find(GradientEntries::kAll);
  const auto expect_same = [&](GradientEntries entries,
                               const std::vector<int>& places) {
    const Found found = find(entries);
    for (const int a : places) {
      for (int p = 0; p < kCount; ++p) {
        EXPECT_NEAR(found.stress.row[a][p], of_solid.stress.row[a][p], 1e-11);
        for (int k = 0; k < law_.NumModuli(); ++k) {
          EXPECT_NEAR(found.columns[k].row[a][p], of_solid.columns[k].row[a][p],
                      1e-12);
        }
        for (const int b : places) {
          EXPECT_NEAR(found.tangents.row[TangentRow(a, b)][p],
                      of_solid.tangents.row[TangentRow(a, b)][p], 1e-11);
        }
      }
    }
  };
  expect_same(GradientEntries::kOfPlane,
              {kPlacesOfPlane.begin(), kPlacesOfPlane.end()});
  expect_same(GradientEntries::kAcross, {kCrossPlace});
}

INSTANTIATE_TEST_SUITE_P(Laws, LargeStrainLaws,
                         ::testing::ValuesIn(AllLargeStrainLaws()),
                         [](const auto& info) {
                           return std::string(info.param->Name());
                         });

// Its energy is H : H / 2, which a rotation changes.
class NotObjective : public OwnModuliLaw<LargeStrainLaw> {
 public:
  std::string_view Name() const override { return "not_objective"; }
  std::string_view Description() const override { return "for this test"; }
  const std::vector<LawParameter>& Parameters() const override {
    static const std::vector<LawParameter> parameters = {Modulus("c", "c", 1)};
    return parameters;
  }
  Eigen::VectorXd Energies(const Eigen::MatrixXd& gradient,
                           SectionModel /*model*/) const override {
    return Eigen::VectorXd::Constant(1, gradient.squaredNorm() / 2);
  }
  void StressesAtPoints(const PointMatrices& gradients,
                        GradientEntries /*entries*/, int /*count*/,
                        PointMatrices* columns) const override {
    columns[0] = gradients;
  }
  void TangentsAtPoints(const Eigen::VectorXd& moduli,
                        const PointMatrices& /*gradients*/,
                        GradientEntries /*entries*/, int /*count*/,
                        PointTangents& tangents,
                        PointMatrices* /*stresses*/) const override {
    tangents = {};
    for (int i = 0; i < 9; ++i) {
      tangents.row[TangentRow(i, i)][0] = moduli(0);
    }
  }
};

TEST(CheckLawOfLargeStrains, FindsThatALawIsNotObjective) {
  EXPECT_THAT(CheckLaw(NotObjective()),
              ::testing::Contains(::testing::HasSubstr(
                  "the stress of a turned deformation is not the turned "
                  "stress")));
}

// Values that another code computed.
TEST(LargeStrainLawsAtOnePoint, HavePublishedValues) {
  Eigen::Matrix3d h;
  h << 0.1, 0.2, 0, 0, -0.1, 0.1, 0.05, 0, 0.05;
  Eigen::Matrix3d d;
  d << 0.3, -0.1, 0.2, 0, 0.4, -0.2, 0.1, 0.1, -0.3;
  const auto expect = [&](const char* name, std::vector<double> work,
                          std::vector<double> curvature) {
    const Law& law = *FindLaw(name);
    const Eigen::VectorXd stresses =
        law.Stresses(h, kAnySection).transpose() * d.reshaped();
    for (std::size_t k = 0; k < work.size(); ++k) {
      EXPECT_NEAR(stresses(Eigen::Index(k)), work[k], 1e-9) << name;
      const Eigen::VectorXd along =
          law.Tangent(Eigen::VectorXd::Unit(law.NumModuli(), Eigen::Index(k)),
                      h, kAnySection) *
          d.reshaped();
      EXPECT_NEAR(along.dot(d.reshaped()), curvature[k], 1e-9) << name;
    }
  };
  expect("corotated", {-0.0558776459, 0.0233623425},
         {0.7716563289, 0.1394535798});
  expect("st_venant_kirchhoff", {-0.010675, 0.02975}, {0.762575, 0.154975});
  expect("neo_hookean", {-0.0713407016, 0.0163307881},
         {0.7998835370, 0.1553103181});
  expect("mooney_rivlin", {-0.1856907485, -0.2758511752, 0.0173340},
         {1.4670518407, 1.6644886088, 0.17557});
}

}  // namespace
}  // namespace elastimate
