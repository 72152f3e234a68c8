#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/estimators/material_fit/iterative_fe.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

// Both maximum likelihood fits find the global minimum, on shapes that neither
// was built on.  An error of both at the same scene would show against the
// truth: its residual is the noise, which no minimum may exceed.

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::ShapeNames;
using testing::ShapeScene;

constexpr double kTrueYoungsModulus = 5e3;

// The residual of an estimate at which the truth leaves `of_truth`.
void ExpectGlobal(const Estimate& estimate, double of_truth) {
  EXPECT_NE(estimate.status, Status::kIterationLimit) << estimate.message;
  EXPECT_NE(estimate.status, Status::kNumericalFailure) << estimate.message;
  ASSERT_TRUE(estimate.displacement_residual.has_value());
  EXPECT_LE(*estimate.displacement_residual, of_truth * (1 + 1e-6) + 1e-6);
}

struct MeasuredShape {
  Scene scene;
  /// ||noise|| / ||measurement||.
  double residual_of_truth;
};

MeasuredShape MeasureShape(const std::string& shape, const std::string& load,
                           double nu, double noise, std::uint64_t seed) {
  MeasuredShape measured = {ShapeScene(shape, load), 0};
  Scene& scene = measured.scene;
  Measure({kTrueYoungsModulus, nu}, scene);
  if (noise > 0) {
    const Eigen::MatrixXd exact = scene.load_cases[0].displacement;
    AddNoise(noise, seed, scene);
    const Eigen::MatrixXd& noisy = scene.load_cases[0].displacement;
    measured.residual_of_truth = (noisy - exact).norm() / noisy.norm();
  }
  return measured;
}

// The estimate of reduced-fe.
Estimate ExpectSameMinimum(const MeasuredShape& measured,
                           const EstimatorOptions& options) {
  const Estimate reduced = ReducedFe().Run(measured.scene, options);
  const Estimate iterative = IterativeFe().Run(measured.scene, options);
  ExpectGlobal(reduced, measured.residual_of_truth);
  ExpectGlobal(iterative, measured.residual_of_truth);
  EXPECT_NEAR(*reduced.displacement_residual, *iterative.displacement_residual,
              1e-3 * *iterative.displacement_residual + 1e-6);
  return reduced;
}

// Each shape meets each nu, with loads and noises in turn.
TEST(GlobalMinimumStatistics, OfManyShapes) {
  const std::vector<std::string> loads = testing::ShapeLoads();
  const double noises[] = {0, 1e-3, 1e-2, 5e-2};
  std::size_t count = 0;
  for (const std::string& shape : ShapeNames()) {
    for (const double nu : {-0.6, 0.0, 0.3, 0.45, 0.49, 0.4985, 0.4995}) {
      const std::string& load = loads[count % loads.size()];
      const double noise = noises[count % std::size(noises)];
      ++count;
      SCOPED_TRACE(shape + ", " + load + ", nu " + std::to_string(nu) +
                   ", noise " + std::to_string(noise));
      ExpectSameMinimum(MeasureShape(shape, load, nu, noise, count), {});
    }
  }
}

// The narrow minimum next to 1/2 is easily passed over.
TEST(GlobalMinimumStatistics, OfATwistedDumbbellNextToOneHalf) {
  for (const double nu : {0.499, 0.4994, 0.4997}) {
    for (int seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::to_string(nu) + ", seed " + std::to_string(seed));
      const MeasuredShape measured =
          MeasureShape("dumbbell", "torsion", nu, 1e-2, seed);
      const Estimate estimate = ReducedFe().Run(measured.scene, {});
      ExpectGlobal(estimate, measured.residual_of_truth);
      EXPECT_NEAR(estimate.elasticity.youngs_modulus / kTrueYoungsModulus, 1,
                  0.1);
    }
  }
}

// In torsion only the mesh tells something of Poisson's ratio, in a dip next to
// 1/2 that is narrower than the errors.
TEST(GlobalMinimumStatistics, ADipOfTheMeshIsNoKnowledge) {
  Scene scene = ShapeScene("dumbbell", "torsion");
  testing::MeasureInCutWorld({5e4, 0}, scene);  // At small strains.
  AddNoise(0.1, 7, scene);
  const Estimate estimate = ReducedFe().Run(scene, {});
  const std::optional<double> error = estimate.PoissonRatioStandardError();
  EXPECT_GT(estimate.elasticity.poisson_ratio, 0.49);
  ASSERT_TRUE(error.has_value());
  EXPECT_GT(3 * *error, estimate.elasticity.poisson_ratio);
  EXPECT_LT(*error, 0.5);
  const ErrorBudget& budget = estimate.error_budget;
  double sum = 0;
  for (const ParameterErrors& part :
       {budget.noise, budget.model, budget.outliers, budget.discretization,
        budget.curvature, budget.kinematics}) {
    sum += part.size() > 0 ? part(1) * part(1) : 0;
  }
  EXPECT_NEAR(std::sqrt(sum), *error, 1e-6 * *error);
}

// A crest lies between the start at 0.45 and the minimum.
TEST(GlobalMinimumStatistics, BehindACrest) {
  for (const std::string shape : {"ring", "dumbbell", "spring"}) {
    for (const double nu : {0.48, 0.49, 0.495}) {
      SCOPED_TRACE(shape + ", nu " + std::to_string(nu));
      ExpectSameMinimum(MeasureShape(shape, "tension", nu, 2e-2, 1), {});
    }
  }
}

void ExpectNotTrappedByABound(const std::string& shape) {
  struct Case {
    double nu;
    Bounds bounds;
  };
  const Case cases[] = {
      {0.47, {0.45, {}}},  {0.49, {0.45, {}}},  {0.49, {0.47, {}}},
      {0.499, {0.45, {}}}, {0.499, {0.48, {}}}, {0.46, {0.45, 0.4995}},
      {-0.97, {{}, -0.8}}, {-0.9, {{}, -0.8}},  {-0.9, {-0.99, -0.7}},
      {0.1, {{}, 0.2}},    {-0.3, {{}, 0.2}},   {-0.98, {-0.999, {}}}};
  for (const Case& test : cases) {
    SCOPED_TRACE(shape + ", nu " + std::to_string(test.nu));
    EstimatorOptions options;
    options.poisson_ratio = test.bounds;
    const MeasuredShape measured =
        MeasureShape(shape, "bending", test.nu, 1e-2, 1);
    const Estimate estimate = ExpectSameMinimum(measured, options);
    if (estimate.IsUsable()) {
      EXPECT_NEAR(estimate.elasticity.youngs_modulus / kTrueYoungsModulus, 1,
                  0.2);
    }
  }
}

// Bounds that hold the truth may not become the answer.
TEST(GlobalMinimum, IsNotTrappedByABound) {
  ExpectNotTrappedByABound("bracket");
}

TEST(GlobalMinimumStatistics, IsNotTrappedByABoundOfAnotherShape) {
  ExpectNotTrappedByABound("tree");
}

TEST(GlobalMinimum, IsFoundBeyondTheUsualRange) {
  for (const double noise : {1e-4, 3e-2}) {
    for (const double nu : {-0.72, -0.75, -0.8, -0.85, -0.9, -0.96, -0.99}) {
      SCOPED_TRACE("noise " + std::to_string(noise) + ", nu " +
                   std::to_string(nu));
      const MeasuredShape measured =
          MeasureShape("bracket", "swelling", nu, noise, 1);
      const Estimate estimate = ReducedFe().Run(measured.scene, {});
      ExpectGlobal(estimate, measured.residual_of_truth);
      EXPECT_NEAR(estimate.elasticity.poisson_ratio, nu, 0.02);
    }
  }
}

// With 3 % of the components observed.
TEST(GlobalMinimumStatistics, OfFewObservations) {
  for (const std::string& shape : ShapeNames()) {
    for (const double nu : {0.2, 0.497}) {
      SCOPED_TRACE(shape + ", nu " + std::to_string(nu));
      Scene scene = MeasureShape(shape, "bending", nu, 0, 0).scene;
      AddNoise(1e-2, 3, scene);
      ComponentMask& observed = scene.load_cases[0].observed;
      observed = ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
      for (Eigen::Index i = 0; i < observed.size(); i += 31) {
        observed.reshaped()(i) = true;
      }
      const Estimate reduced = ReducedFe().Run(scene, {});
      const Estimate iterative = IterativeFe().Run(scene, {});
      ASSERT_TRUE(reduced.displacement_residual.has_value());
      EXPECT_NEAR(*reduced.displacement_residual,
                  *iterative.displacement_residual,
                  1e-3 * *iterative.displacement_residual);
    }
  }
}

}  // namespace
}  // namespace elastimate
