#include "elastimate/estimators/reduced_model/reduced_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

constexpr Bounds kWholeRange = {-0.99, 0.499};

// Holds a noisy scene of two load cases and displaced supports, of which each
// third component is not observed, and a model that is accurate over the range
// of nu.
struct Fixture {
  Fixture() : scene(NoisyScene()), model(scene), observed(scene) {
    for (const double pole : {0.3, 0.49, -0.9}) {
      EXPECT_TRUE(model.SetPole(pole));
      for (int i = 0; i < 12; ++i) {
        EXPECT_TRUE(model.Enlarge());
      }
    }
  }

  static Scene NoisyScene() {
    Scene scene = SmallScene("organ");
    scene.load_cases.push_back(scene.load_cases[0]);
    std::get<NodalForces>(scene.load_cases[1].loads[0]).force.row(2).array() *=
        -0.3;
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      scene.supports.displacement(0, node) = 1e-5 * scene.mesh.nodes(1, node);
    }
    Measure({5e4, 0.35}, scene);
    AddNoise(0.05, 7, scene);
    for (LoadCase& load_case : scene.load_cases) {
      load_case.observed =
          ComponentMask::Constant(3, scene.mesh.NumNodes(), true);
      for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
        load_case.observed(node % 3, node) = false;
      }
    }
    return scene;
  }

  Scene scene;
  ReducedModel model;
  ObservedDisplacements observed;
};

// Returns the sum of squares by the full model, with the best t within the
// bounds.
ReducedFit::Point FullFit(const Scene& scene,
                          const ObservedDisplacements& observed, double nu,
                          const Bounds& youngs_modulus) {
  const double range = (1 + nu) * (1 - 2 * nu);
  Equilibrium model(scene, SolverKind::kCholesky);
  EXPECT_TRUE(model.Solve(
      model.Forces().Parameters().Moduli(Eigen::Vector2d(range, nu))));
  const Eigen::VectorXd w =
      observed.Restrict(model.Displacement() - model.SupportResponse());
  const Eigen::VectorXd rest =
      observed.Measured() - observed.Restrict(model.SupportResponse());
  double t = w.dot(rest) / w.squaredNorm();
  t = std::max(t, range / youngs_modulus.upper.value_or(
                              std::numeric_limits<double>::infinity()));
  t = std::min(t, range / youngs_modulus.lower.value_or(0));
  return {nu, t, (rest - t * w).squaredNorm()};
}

// Returns the best of FullFit over nu, by ever finer grids.
ReducedFit::Point BruteForce(const Fixture& fixture,
                             const Bounds& poisson_ratio,
                             const Bounds& youngs_modulus) {
  double lower = *poisson_ratio.lower;
  double upper = *poisson_ratio.upper;
  ReducedFit::Point best{0, 0, std::numeric_limits<double>::infinity()};
  for (int round = 0; round < 5; ++round) {
    const double step = (upper - lower) / 24;
    for (int i = 0; i <= 24; ++i) {
      const ReducedFit::Point point = FullFit(fixture.scene, fixture.observed,
                                              lower + i * step, youngs_modulus);
      if (point.square_sum < best.square_sum) {
        best = point;
      }
    }
    lower = std::max(best.poisson_ratio - step, *poisson_ratio.lower);
    upper = std::min(best.poisson_ratio + step, *poisson_ratio.upper);
  }
  return best;
}

void ExpectSame(const ReducedFit::Point& actual,
                const ReducedFit::Point& expected) {
  EXPECT_NEAR(actual.square_sum / expected.square_sum, 1, 1e-6);
  EXPECT_NEAR(actual.poisson_ratio, expected.poisson_ratio, 1e-4);
  EXPECT_NEAR(actual.compliance_scale / expected.compliance_scale, 1, 1e-3);
}

TEST(ReducedFit, FindsTheGlobalMinimumOfTheSumOfSquares) {
  const Fixture fixture;
  for (const Bounds& youngs_modulus :
       {Bounds{}, Bounds{{}, 4e4}, Bounds{7e4, {}}}) {
    for (const Bounds& poisson_ratio :
         {kWholeRange, Bounds{0.4, 0.49}, Bounds{-0.9, 0.2}}) {
      SCOPED_TRACE(std::to_string(*poisson_ratio.lower));
      ExpectSame(ReducedFit(fixture.model, fixture.observed, poisson_ratio,
                            youngs_modulus)
                     .Fit(fixture.observed.Measured()),
                 BruteForce(fixture, poisson_ratio, youngs_modulus));
    }
  }
}

TEST(ReducedFit, HasNoSlopeAtItsMinimum) {
  const Fixture fixture;
  const ObservedDisplacements& observed = fixture.observed;
  const ReducedFit::Point point =
      ReducedFit(fixture.model, observed, kWholeRange, {})
          .Fit(observed.Measured());
  const ReducedSolution solution = SolveReduced(
      fixture.model,
      IsotropicElasticity::FromComplianceScale(
          point.compliance_scale, point.poisson_ratio, SectionModel::kSolid));
  const Eigen::VectorXd residual =
      observed.Restrict(solution.displacement) - observed.Measured();
  EXPECT_NEAR(residual.squaredNorm() / point.square_sum, 1, 1e-9);
  for (const Eigen::MatrixXd& derivative :
       {solution.by_log_youngs_modulus, solution.by_poisson_ratio}) {
    const Eigen::VectorXd rows = observed.Restrict(derivative);
    EXPECT_LT(std::abs(rows.dot(residual)),
              1e-9 * rows.norm() * residual.norm());
  }
}

TEST(ReducedFit, SolvesAsTheFullModelDoes) {
  const Fixture fixture;
  const IsotropicElasticity elasticity = {4e4, 0.4};
  const ReducedSolution solution = SolveReduced(fixture.model, elasticity);
  Equilibrium model(fixture.scene, SolverKind::kCholesky);
  const MaterialParameters& chart = model.Forces().Parameters();
  ASSERT_TRUE(model.Solve(chart.Moduli(elasticity.Parameters())));
  const auto& observed = fixture.observed;
  const auto expect_alike = [&](const Eigen::MatrixXd& reduced,
                                const Eigen::MatrixXd& full, double tolerance) {
    const Eigen::VectorXd rows = observed.Restrict(full);
    EXPECT_LT((observed.Restrict(reduced) - rows).norm(),
              tolerance * rows.norm());
  };
  expect_alike(solution.displacement, model.Displacement(), 1e-6);
  const Eigen::MatrixXd sensitivities =
      model.Sensitivities(chart.ModuliJacobian(elasticity.Parameters()));
  expect_alike(solution.by_log_youngs_modulus,
               elasticity.youngs_modulus *
                   sensitivities(Eigen::all, Eigen::seq(0, Eigen::last, 2)),
               1e-6);
  expect_alike(solution.by_poisson_ratio,
               sensitivities(Eigen::all, Eigen::seq(1, Eigen::last, 2)), 1e-5);
}

// The full model explains these displacements at a nu where the reduced model,
// which has a single vector, is poor.  The best fit of the reduced model is
// elsewhere and leaves a large residual.  The lower bounds must not exclude the
// truth.
TEST(ReducedFitStatistics, LowerBoundsHoldWhereTheModelIsPoor) {
  for (const std::string& shape : testing::ShapeNames()) {
    for (const double nu : {-0.8, 0.1, 0.45, 0.499, 0.4997}) {
      for (const Bounds& youngs_modulus :
           {Bounds{}, Bounds{4e4, 6e4}, Bounds{7e4, {}}}) {
        Scene scene = testing::ShapeScene(shape, "torsion");
        Measure({5e4, nu}, scene);
        AddNoise(1e-3, 1, scene);
        const ObservedDisplacements observed(scene);
        ReducedModel model(scene);
        ASSERT_TRUE(model.SetPole(0.3));
        const double norm =
            model.ComplianceNormAtPole(observed.BoundingWeights());
        for (int vectors = 0; vectors < 16; vectors += 5) {
          SCOPED_TRACE(shape + ", nu " + std::to_string(nu) + ", vectors " +
                       std::to_string(vectors));
          const ReducedFit fit(model, observed, {nu, nu}, youngs_modulus);
          const double error =
              norm /
              std::sqrt(SmallestEnergyRatio(nu, 0.3, SectionModel::kSolid)) *
              model.ErrorBound(0, nu);
          const auto brackets =
              fit.BracketResiduals(observed.Measured(), {{error, 0}});
          ASSERT_EQ(brackets.size(), 1U);
          const double exact = std::sqrt(
              FullFit(scene, observed, nu, youngs_modulus).square_sum);
          EXPECT_LE(brackets[0].least, exact * (1 + 1e-6) + 1e-9);
          for (int i = 0; i < 5; ++i) {
            model.Enlarge();
          }
        }
      }
    }
  }
}

TEST(ReducedFit, KeepsAKnownPoissonRatio) {
  const Fixture fixture;
  ExpectSame(ReducedFit(fixture.model, fixture.observed, {0.2, 0.2}, {})
                 .Fit(fixture.observed.Measured()),
             FullFit(fixture.scene, fixture.observed, 0.2, {}));
}

}  // namespace
}  // namespace elastimate
