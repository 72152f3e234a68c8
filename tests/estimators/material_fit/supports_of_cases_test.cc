// Load cases of which each has supports of its own, in iterative-fe and auto.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <string>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

const IsotropicElasticity kTruthOfCases = {3e3, 0.3};

Estimate RunNamed(const std::string& name, const Scene& scene) {
  return MakeEstimator(name)->Run(scene, {});
}

// Held on the side that is opposite to that of SceneOfKind, and moved there.
Scene SceneHeldAtTheFarSide(const KindOfSection& kind, int cells = 3) {
  Scene scene = testing::SceneOfKind(kind, cells);
  const int last = scene.mesh.Dimension() - 1;
  const double far = scene.mesh.nodes.row(last).maxCoeff();
  scene.supports.held.setConstant(false);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(last, node) > 0.9 * far) {
      scene.supports.held.col(node).setConstant(true);
      scene.supports.displacement.col(node).setConstant(0.01);
    }
  }
  BodyForce weight;
  weight.force_density =
      Eigen::VectorXd::LinSpaced(scene.mesh.Dimension(), 100, 300);
  for (LoadCase& load_case : scene.load_cases) {
    load_case.loads = {weight};
  }
  return scene;
}

Scene Together(const Scene& first, const Scene& second) {
  Scene both = first;
  for (LoadCase load_case : second.load_cases) {
    load_case.supports = second.supports;
    both.load_cases.push_back(load_case);
  }
  return both;
}

class SupportsOfCases : public ::testing::TestWithParam<KindOfSection> {
 protected:
  SupportsOfCases() {
    testing::MeasureByTextbook(kTruthOfCases, near_);
    testing::MeasureByTextbook(kTruthOfCases, far_);
  }

  Scene near_ = testing::SceneOfKind(GetParam());
  Scene far_ = SceneHeldAtTheFarSide(GetParam());
};

TEST_P(SupportsOfCases, LeaveExactDataExact) {
  const Scene scene = Together(near_, far_);
  for (const std::string name : {"iterative-fe", "auto"}) {
    const Estimate estimate = RunNamed(name, scene);
    ASSERT_EQ(estimate.status, Status::kOk) << name << estimate.message;
    EXPECT_NEAR(
        estimate.elasticity.youngs_modulus / kTruthOfCases.youngs_modulus, 1,
        1e-8);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, kTruthOfCases.poisson_ratio,
                1e-8);
  }
}

// The supports of one load case moved as measured.
TEST_P(SupportsOfCases, LeaveExactDataExactWhereSomeWereMeasured) {
  far_.supports.displacement.setZero();
  far_.supports.unknown = far_.supports.held;
  const Estimate estimate = RunNamed("iterative-fe", Together(near_, far_));
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kTruthOfCases.youngs_modulus,
              1, 1e-8);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kTruthOfCases.poisson_ratio,
              1e-8);
}

// What load cases tell of the parameters adds up, whatever holds them.
TEST_P(SupportsOfCases, AddTheirInformation) {
  far_.supports.displacement.setZero();
  far_.supports.unknown = far_.supports.held;
  for (Scene* const scene : {&near_, &far_}) {
    for (LoadCase& load_case : scene->load_cases) {
      load_case.noise_sd = 1e-4;
    }
  }
  // One displaced by a known amount, so that this one too is a material fit.
  Scene near = near_;
  near.load_cases[0].supports = near.supports;
  const Eigen::Matrix2d expected =
      (RunNamed("iterative-fe", near).covariance.inverse() +
       RunNamed("iterative-fe", far_).covariance.inverse())
          .inverse();
  const Eigen::Matrix2d both =
      RunNamed("iterative-fe", Together(near_, far_)).covariance;
  EXPECT_LT((both - expected).norm(), 0.02 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(AllLong, SupportsOfCases,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

// The specimen is finer than the mesh.
TEST(SupportsOfCasesOfElementsLong, HoldWhatElementsMiss) {
  for (const KindOfSection& kind : testing::AllKindsOfSections()) {
    if (kind.model == SectionModel::kSolid) {
      continue;
    }
    const int cells = TopologyOf(kind.kind).order == 2 ? 4 : 10;
    Scene far = SceneHeldAtTheFarSide(kind, cells);
    Scene near = testing::SceneOfKind(kind, cells);
    near.load_cases[0].loads = far.load_cases[0].loads;
    // At small strains.
    constexpr IsotropicElasticity kStiff = {1e3 * kTruthOfCases.youngs_modulus,
                                            kTruthOfCases.poisson_ratio};
    testing::MeasureInCutWorld(kStiff, near);
    testing::MeasureInCutWorld(kStiff, far);
    Scene scene = Together(near, far);
    std::mt19937_64 generator(1);
    for (LoadCase& load_case : scene.load_cases) {
      const double noise_sd =
          1e-3 * load_case.displacement.norm() /
          std::sqrt(static_cast<double>(load_case.displacement.size()));
      load_case.displacement +=
          DrawNoiseAt(load_case.displacement, noise_sd, 0, generator);
    }
    const Estimate estimate = RunNamed("iterative-fe", scene);
    ASSERT_EQ(estimate.status, Status::kOk)
        << testing::NameOf(kind) << estimate.message;
    EXPECT_LT(
        std::abs(estimate.elasticity.youngs_modulus - kStiff.youngs_modulus),
        3 * *estimate.YoungsModulusStandardError())
        << testing::NameOf(kind);
    EXPECT_LT(
        std::abs(estimate.elasticity.poisson_ratio - kStiff.poisson_ratio),
        3 * *estimate.PoissonRatioStandardError())
        << testing::NameOf(kind);
  }
}

TEST(SupportsOfCasesOfEstimators, AreRefusedByThoseThatShareThem) {
  const KindOfSection kind = {ElementKind::kTet4, SectionModel::kSolid};
  Scene near = testing::SceneOfKind(kind);
  testing::MeasureByTextbook(kTruthOfCases, near);
  Scene far = SceneHeldAtTheFarSide(kind);
  testing::MeasureByTextbook(kTruthOfCases, far);
  for (const std::string name :
       {"closed-form", "bounded", "virtual-fields", "reduced-fe"}) {
    EXPECT_THROWS_WITH(RunNamed(name, Together(near, far)),
                       "same in all load cases; use --estimator=iterative-fe");
  }
}

}  // namespace
}  // namespace elastimate
