#include "elastimate/estimators/statistics/correlated_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

// A grid of 15 x 15 points of spacing 1, all of which are measured.
Scene Grid() {
  constexpr int kPoints = 15;
  Scene scene;
  scene.mesh.kind = ElementKind::kQuad4;
  scene.mesh.section = {SectionModel::kPlaneStress, 1};
  scene.mesh.nodes.resize(2, Eigen::Index{kPoints} * kPoints);
  scene.mesh.elements.resize(4, Eigen::Index{kPoints - 1} * (kPoints - 1));
  const auto node = [&](int i, int j) { return i * kPoints + j; };
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      scene.mesh.nodes.col(node(i, j)) << i, j;
      if (i + 1 < kPoints && j + 1 < kPoints) {
        scene.mesh.elements.col(i * (kPoints - 1) + j) << node(i, j),
            node(i + 1, j), node(i + 1, j + 1), node(i, j + 1);
      }
    }
  }
  scene.supports.held =
      ComponentMask::Constant(2, scene.mesh.NumNodes(), false);
  scene.supports.displacement.setZero(2, scene.mesh.NumNodes());
  scene.load_cases.resize(1);
  scene.load_cases[0].displacement.setConstant(2, scene.mesh.NumNodes(), 1);
  return scene;
}

// By rows of the grid's nodes, two components each.
Eigen::VectorXd IndependentNoise(Eigen::Index size, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size,
                                      [&](auto) { return normal(generator); });
}

// A cosine of period 14 along x, in both components.
Eigen::VectorXd AlongX(const Scene& scene) {
  Eigen::VectorXd field(2 * scene.mesh.NumNodes());
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    field.segment(2 * node, 2)
        .setConstant(std::cos(2 * M_PI * scene.mesh.nodes(0, node) / 14));
  }
  return field;
}

TEST(Autocorrelation, OfIndependentNoiseIsMostlyNone) {
  const Scene scene = Grid();
  const ObservedDisplacements observed(scene);
  int num_found = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Autocorrelation correlation = CorrelateResiduals(
        scene, observed, IndependentNoise(observed.Size(), seed));
    num_found += correlation.values.size() > 0 ? 1 : 0;
  }
  // Three standard deviations on one side: .27 of 200, so that 4 are a chance
  // of one in 5000.
  EXPECT_LE(num_found, 3);
}

TEST(Autocorrelation, OfAFieldReachesAsFarAsIt) {
  const Scene scene = Grid();
  const ObservedDisplacements observed(scene);
  const Autocorrelation correlation =
      CorrelateResiduals(scene, observed, AlongX(scene));
  EXPECT_NEAR(correlation.step, 1.5, 1e-12);
  EXPECT_GT(correlation.values(0), 0.8);
  // A cosine of period 14 is no longer alike at a quarter of it.
  EXPECT_GT(correlation.Length(), 2);
  EXPECT_LT(correlation.Length(), 6);
}

// Half of the variance is that of independent noise, which halves the integral
// of rho, but not the length over which the other half is alike.
TEST(Autocorrelation, IndependentNoiseDoesNotShortenTheLengthOfAlike) {
  const Scene scene = Grid();
  const ObservedDisplacements observed(scene);
  const Eigen::VectorXd field = AlongX(scene);
  const double alone = CorrelateResiduals(scene, observed, field).Length();
  const double deviation =
      std::sqrt(field.squaredNorm() / static_cast<double>(field.size()));
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Autocorrelation correlation = CorrelateResiduals(
        scene, observed,
        field + deviation * IndependentNoise(field.size(), seed));
    EXPECT_NEAR(correlation.share, 0.5, 0.15);
    EXPECT_LT(correlation.Length(), 0.7 * alone);
    EXPECT_GT(correlation.LengthOfAlike(), 0.8 * alone);
  }
}

TEST(Autocorrelation, OfSmoothedNoiseReachesAsFarAsIt) {
  constexpr double kLength = 1.5;
  const Scene scene = Grid();
  const ObservedDisplacements observed(scene);
  double mean = 0;
  constexpr int kFields = 50;
  for (int seed = 1; seed <= kFields; ++seed) {
    std::mt19937_64 generator{std::uint64_t(seed)};
    const Eigen::VectorXd noise =
        DrawNoiseAt(scene.mesh.nodes, 1, kLength, generator).reshaped();
    mean +=
        CorrelateResiduals(scene, observed, noise).LengthOfAlike() / kFields;
  }
  // The integral of exp(-d^2 / 2 X^2), and what 225 points leave open.
  const double integral = kLength * std::sqrt(M_PI / 2);
  EXPECT_GT(mean, integral);
  EXPECT_LT(mean, 1.5 * integral);
}

TEST(Autocorrelation, AddsTheSumOverAllPairs) {
  const Scene scene = Grid();
  const ObservedDisplacements observed(scene);
  Autocorrelation correlation;
  correlation.step = 1.5;
  correlation.values = Eigen::Vector2d(0.6, 0.2);
  const Eigen::MatrixXd sensitivities =
      Eigen::MatrixXd::Random(observed.Size(), 2);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (Eigen::Index a = 0; a < scene.mesh.NumNodes(); ++a) {
    for (Eigen::Index b = 0; b < scene.mesh.NumNodes(); ++b) {
      const double distance =
          (scene.mesh.nodes.col(a) - scene.mesh.nodes.col(b)).norm();
      if (a == b || distance >= 3) {
        continue;
      }
      for (int i = 0; i < 2; ++i) {
        sum += (distance < 1.5 ? 0.6 : 0.2) *
               sensitivities.row(2 * a + i).transpose() *
               sensitivities.row(2 * b + i);
      }
    }
  }
  const Eigen::MatrixXd added =
      GramOfCorrelation(scene, observed, sensitivities, correlation);
  EXPECT_LT((added - sum).norm(), 1e-10 * sum.norm());
}

}  // namespace
}  // namespace elastimate
