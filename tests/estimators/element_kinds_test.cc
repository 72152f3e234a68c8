// Tests of every estimator on every element kind and section.

#include "tests/element_kinds.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/reduced_model/krylov_bound.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::AllKindsOfSections;
using testing::KindOfSection;
using testing::MeasureByTextbook;
using testing::NameOf;
using testing::SceneOfKind;

constexpr double kYoungsModulus = 5000;
constexpr double kPoissonRatio = 0.3;

Scene MeasuredScene(const KindOfSection& parameter) {
  Scene scene = SceneOfKind(parameter);
  MeasureByTextbook({kYoungsModulus, kPoissonRatio}, scene);
  return scene;
}

class OnEachKind : public ::testing::TestWithParam<KindOfSection> {
 protected:
  OnEachKind() : scene_(MeasuredScene(GetParam())) {}

  // Each estimator finds the truth.
  static void ExpectExact(const Scene& scene, const EstimatorOptions& options,
                          double youngs_modulus) {
    for (const std::string_view name : EstimatorNames()) {
      SCOPED_TRACE(name);
      const Estimate estimate = MakeEstimator(name)->Run(scene, options);
      EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
      EXPECT_NEAR(estimate.elasticity.youngs_modulus / youngs_modulus, 1, 1e-7);
      EXPECT_NEAR(estimate.elasticity.poisson_ratio, kPoissonRatio, 1e-7);
    }
  }

  Scene scene_;
};

// The displacements are those of textbook elements, which share no code with
// the library.
TEST_P(OnEachKind, EstimatorsAreExactWithoutNoise) {
  ExpectExact(scene_, {}, kYoungsModulus);
}

TEST_P(OnEachKind, EstimatorsTakeAKnownPoissonRatio) {
  EstimatorOptions options;
  options.known_poisson_ratio = kPoissonRatio;
  ExpectExact(scene_, options, kYoungsModulus);
}

// At the same displacements, twice the force means twice the modulus.  At twice
// the thickness it means the same modulus.
TEST_P(OnEachKind, EstimatesScaleWithForceAndThickness) {
  std::vector<Load>& loads = scene_.load_cases[0].loads;
  loads = {NodalForces{2 * AssembleLoads(scene_.mesh, loads)}};
  ExpectExact(scene_, {}, 2 * kYoungsModulus);
  if (scene_.mesh.Dimension() == 2) {
    scene_.mesh.section.thickness *= 2;
    ExpectExact(scene_, {}, kYoungsModulus);
  }
}

INSTANTIATE_TEST_SUITE_P(All, OnEachKind,
                         ::testing::ValuesIn(AllKindsOfSections()),
                         testing::KindTestName);

// Certificates of the reduced model rest on this ratio.  It is tested for a
// general strain, for a change of volume and for a shear.
TEST(SmallestEnergyRatio, HoldsForEverySection) {
  for (const KindOfSection& parameter : AllKindsOfSections()) {
    SCOPED_TRACE(NameOf(parameter));
    const Mesh mesh = testing::MeshOfKind(parameter);
    const Eigen::Index dimension = mesh.Dimension();
    Eigen::MatrixXd x(mesh.NumDofs(), 3);
    x.col(0) = Eigen::VectorXd::LinSpaced(mesh.NumDofs(), 0, 500).array().sin();
    x.col(1) = mesh.nodes.reshaped();
    Eigen::MatrixXd shear = Eigen::MatrixXd::Zero(dimension, dimension);
    shear(0, 1) = 1;
    x.col(2) = (shear * mesh.nodes).reshaped();
    const StiffnessProducts products = MultiplyStiffnessBasis(mesh, x);
    const auto energy = [&](Eigen::Index k, double nu) {
      return x.col(k).dot(products.h.col(k) + nu * products.j.col(k));
    };
    for (const double pole : {-0.9, 0.3, 0.499}) {
      for (const double nu : {-0.99, -0.5, 0.0, 0.3, 0.49, 0.4999}) {
        const double ratio = SmallestEnergyRatio(nu, pole, mesh.section.model);
        double least = std::numeric_limits<double>::infinity();
        for (Eigen::Index k = 0; k < 3; ++k) {
          least = std::min(least, energy(k, nu) / energy(k, pole));
        }
        // The ratio is also the largest number that holds.
        EXPECT_NEAR(least / ratio, 1, 1e-9) << pole << " " << nu;
      }
    }
  }
}

class FitsOfEachKind : public ::testing::TestWithParam<KindOfSection> {};

// The two fits share nothing but the elements, and must agree.
TEST_P(FitsOfEachKind, AgreeUnderNoise) {
  Scene scene = MeasuredScene(GetParam());
  AddNoise(0.02, 7, scene);
  const Estimate reduced = MakeEstimator("reduced-fe")->Run(scene, {});
  const Estimate iterative = MakeEstimator("iterative-fe")->Run(scene, {});
  ASSERT_EQ(reduced.status, Status::kOk) << reduced.message;
  ASSERT_EQ(iterative.status, Status::kOk) << iterative.message;
  const double tolerance = 0.02 * *reduced.PoissonRatioStandardError();
  EXPECT_NEAR(reduced.elasticity.poisson_ratio,
              iterative.elasticity.poisson_ratio, tolerance);
  EXPECT_NEAR(reduced.elasticity.youngs_modulus,
              iterative.elasticity.youngs_modulus,
              0.02 * *reduced.YoungsModulusStandardError());
  EXPECT_NEAR(*reduced.displacement_residual / *iterative.displacement_residual,
              1, 1e-3);
}

// Errors are near the bound of Cramer and Rao, and error bars are right for
// every kind.
class KindStatistics : public ::testing::TestWithParam<KindOfSection> {};

TEST_P(KindStatistics, ReachTheCramerRaoBound) {
  constexpr int kSeeds = 60;
  const Scene exact = MeasuredScene(GetParam());
  Scene noisy = exact;
  const double noise_sd = AddNoise(0.01, 1, noisy);
  const Eigen::Matrix2d bound =
      CramerRaoBound(exact, Eigen::Vector2d(kYoungsModulus, kPoissonRatio),
                     Eigen::VectorXd::Constant(1, noise_sd));
  const ReducedFe reduced_fe;
  PreparedEstimator prepared = reduced_fe.Prepare(exact, {});
  double chi_squared = 0;
  int num_covered = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    noisy = exact;
    AddNoise(0.01, std::uint64_t(seed), noisy);
    const Estimate estimate = prepared.Run({noisy.load_cases[0].displacement});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    const Eigen::Vector2d error(
        estimate.elasticity.youngs_modulus - kYoungsModulus,
        estimate.elasticity.poisson_ratio - kPoissonRatio);
    chi_squared += error.dot(bound.inverse() * error);
    num_covered +=
        std::abs(error(1)) <= 1.96 * *estimate.PoissonRatioStandardError();
  }
  // chi^2 of 2 degrees of freedom has mean 2 and variance 4: four standard
  // errors of the mean.  Of 60 intervals of 95 % about 57 +- 1.7 cover.
  EXPECT_NEAR(chi_squared / kSeeds, 2, 4 * 2 / std::sqrt(double(kSeeds)));
  EXPECT_NEAR(num_covered, 0.95 * kSeeds, 4 * 1.7);
}

INSTANTIATE_TEST_SUITE_P(All, FitsOfEachKind,
                         ::testing::ValuesIn(AllKindsOfSections()),
                         testing::KindTestName);

INSTANTIATE_TEST_SUITE_P(
    Planar, KindStatistics,
    ::testing::Values(
        KindOfSection{ElementKind::kHex8, SectionModel::kSolid},
        KindOfSection{ElementKind::kQuad4, SectionModel::kPlaneStress},
        KindOfSection{ElementKind::kTri6, SectionModel::kPlaneStrain}),
    testing::KindTestName);

}  // namespace
}  // namespace elastimate
