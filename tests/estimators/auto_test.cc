#include "elastimate/estimators/auto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::MeasureInFinerWorld;
using testing::SmallScene;
using testing::UnderBodyForce;

// Returns a scene measured on quadratic elements, which linear ones cannot
// follow.  The load is the same for both.
Scene FinerWorld(const std::string& shape, const IsotropicElasticity& truth) {
  Scene scene = UnderBodyForce(SmallScene(shape));
  MeasureInFinerWorld(truth, scene);
  return scene;
}

void ExpectBooksToBalance(const Estimate& estimate) {
  Work work;
  for (const Rung& rung : estimate.rungs) {
    work = work + rung.work;
    EXPECT_NE(rung.decision, "");
    EXPECT_EQ(rung.decision.find("passed over") == 0, !rung.status);
  }
  EXPECT_EQ(estimate.work.element_passes, work.element_passes);
  EXPECT_EQ(estimate.work.factorizations, work.factorizations);
  EXPECT_EQ(estimate.work.solves, work.solves);
}

TEST(Auto, StopsAtTheClosedFormWithoutNoise) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.rungs.size(), 1);
  EXPECT_EQ(estimate.rungs[0].estimator, "closed-form");
  EXPECT_EQ(estimate.work.factorizations, 0);
  EXPECT_EQ(estimate.element_order, 1);
  ExpectBooksToBalance(estimate);
}

// The balance of forces does not notice the error of the mesh, so auto begins
// with a fit of displacements.
TEST(Auto, BeginsWithAFitWhereDisplacementsWereMeasured) {
  for (const std::string shape : {"cuboid", "organ"}) {
    SCOPED_TRACE(shape);
    const Estimate estimate = Auto().Run(FinerWorld(shape, {5e4, 0.3}), {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    ASSERT_EQ(estimate.rungs.size(), 1U);
    EXPECT_EQ(estimate.rungs[0].estimator, "reduced-fe");
    EXPECT_EQ(estimate.element_order, 2);
    EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus - 5e4),
              3 * *estimate.YoungsModulusStandardError());
    EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - 0.3),
              3 * *estimate.PoissonRatioStandardError());
    ExpectBooksToBalance(estimate);
  }
}

TEST(Auto, ClimbsWhereNoiseAsksForIt) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.05, 1, scene);
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.rungs.size(), 3);
  EXPECT_EQ(estimate.rungs[2].estimator, "reduced-fe");
  EXPECT_NE(estimate.rungs[2].decision.find("statistical limit"),
            std::string::npos);
  EXPECT_EQ(estimate.element_order, 1);
  EXPECT_FALSE(estimate.discretization_error.has_value());
  // A notice says that the displacements were taken as those of small strains.
  ASSERT_EQ(estimate.findings.size(), 1);
  EXPECT_EQ(estimate.findings[0].severity, Severity::kNotice);
  const Estimate fit = ReducedFe().Run(scene, {});
  EXPECT_EQ(estimate.elasticity.youngs_modulus, fit.elasticity.youngs_modulus);
  EXPECT_EQ(estimate.estimator, "auto");
  ExpectBooksToBalance(estimate);
}

TEST(Auto, PassesOverWhatCannotServe) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.01, 1, scene);
  EstimatorOptions options;
  options.loss = Loss::kHuber;
  const Estimate robust = Auto().Run(scene, options);
  ASSERT_EQ(robust.status, Status::kOk) << robust.message;
  ASSERT_EQ(robust.rungs.size(), 3);
  EXPECT_FALSE(robust.rungs[0].status.has_value());
  EXPECT_FALSE(robust.rungs[1].status.has_value());
  EXPECT_EQ(robust.rungs[2].estimator, "reduced-fe");
  ExpectBooksToBalance(robust);

  Scene loose = scene;
  loose.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(Auto().Run(loose, options), "without strain");
}

}  // namespace
}  // namespace elastimate
