#include "elastimate/estimators/material_fit/outliers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

std::vector<Outlier> AtNodes(std::vector<Eigen::Index> nodes) {
  std::sort(nodes.begin(), nodes.end());
  std::vector<Outlier> outliers;
  outliers.reserve(nodes.size());
  for (const Eigen::Index node : nodes) {
    outliers.push_back({0, node, false});
  }
  return outliers;
}

Scene MeasuredBlock() {
  Scene scene = testing::BlockUnderTraction({6, 6, 12}, {1, 1, 2});
  Measure({1e4, 0.3}, scene);
  return scene;
}

// Nodes are numbered along x first: these are of a corner of the top.
const std::vector<Eigen::Index> kSideBySide = {588, 589, 590, 595, 596, 597};

TEST(OutliersApart, AreThoseWithoutNeighboursWhereManyHaveSome) {
  const Scene scene = MeasuredBlock();
  const ObservedDisplacements observed(scene);
  EXPECT_EQ(OutliersApart(scene, observed, {}), AtNodes({}));
  EXPECT_EQ(OutliersApart(scene, observed, AtNodes(kSideBySide)), AtNodes({}));
  std::vector<Eigen::Index> with_others = kSideBySide;
  with_others.push_back(200);
  EXPECT_EQ(OutliersApart(scene, observed, AtNodes(with_others)),
            AtNodes({200}));
}

// In one of a thousand draws they may be taken for others: of 200 draws, two
// are in one test of sixty.
TEST(OutliersApart, AreAllOfThoseDrawnAtRandom) {
  const Scene scene = MeasuredBlock();
  const ObservedDisplacements observed(scene);
  std::mt19937_64 generator(5);
  int num_kept = 0;
  for (int draw = 0; draw < 200; ++draw) {
    std::vector<Eigen::Index> nodes;
    for (const ObservedDisplacements::Point& point : observed.Points()) {
      if (std::uniform_real_distribution<double>(0, 1)(generator) <
          (draw % 2 == 0 ? 0.03 : 0.1)) {
        nodes.push_back(point.index);
      }
    }
    const std::vector<Outlier> outliers = AtNodes(nodes);
    num_kept += OutliersApart(scene, observed, outliers) == outliers ? 1 : 0;
  }
  EXPECT_GE(num_kept, 198);
}

// An area that moved otherwise is not left out as if it had been mismeasured:
// the estimate is refused, or holds what it may change.
TEST(OutliersApart, DoNotHideWhatTheModelLacks) {
  Scene scene = testing::BlockUnderTraction({6, 6, 12}, {1, 1, 2});
  testing::DivideIntoRegions({1, 1, 2}, {1, 1, 2}, scene);
  const Eigen::VectorXd truth = Eigen::Vector4d(1e4, 0.3, 2e4, 0.2);
  MeasureMaterials(truth, scene);
  testing::AddNoise(0.001, 1, scene);
  Eigen::MatrixXd& displacement = scene.load_cases[0].displacement;
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  const double far = 0.1 * displacement.cwiseAbs().maxCoeff();
  for (Eigen::Index node = 0; node < nodes.cols(); ++node) {
    if (nodes(2, node) > 0.7 && nodes(2, node) < 1.2) {
      displacement.col(node).array() += far;
    }
  }
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, {});
  EXPECT_LT(estimate.outliers.size(), 10U);
  for (std::size_t i = 0; i < 4 && estimate.IsUsable(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    EXPECT_NEAR(parameter.value, truth(Eigen::Index(i)),
                3 * *parameter.standard_error)
        << parameter.Label();
  }
}

// A block between platens, a corner of which is stiffer, taken for one material
// of known nu: displacements say nothing of E there, the load cell does.
Scene BlockOfUnknownInclusion() {
  Scene scene;
  scene.mesh = testing::BoxMesh({4, 4, 4}, {10, 10, 10});
  Mesh& mesh = scene.mesh;
  scene.supports.held.setConstant(3, mesh.NumNodes(), false);
  scene.supports.displacement.setZero(3, mesh.NumNodes());
  std::vector<int> top;
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    const double z = mesh.nodes(2, node);
    scene.supports.held.col(node).setConstant(z < 0.1 || z > 9.9);
    if (z > 9.9) {
      scene.supports.displacement(2, node) = -0.1;
      top.push_back(node);
    }
  }
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const Eigen::Vector3d centre =
        mesh.nodes(Eigen::all, mesh.elements.col(e)).rowwise().mean();
    mesh.regions(e) = (centre.array() < 5).all() ? 2 : 1;
  }
  scene.materials = IsotropicMaterialOfEachRegion(mesh);
  scene.load_cases.resize(1);
  LoadCase& load_case = scene.load_cases[0];
  const std::vector<IsotropicElasticity> truth = {{1e-2, 0.45}, {0.04, 0.45}};
  const Eigen::VectorXd exact = testing::SolveByTextbook(scene, truth);
  const Eigen::MatrixXd force =
      (testing::TextbookStiffness(scene, truth) * exact)
          .reshaped(3, mesh.NumNodes());
  const double total = force(2, top).sum();
  constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
  load_case.resultants = {
      {top, Eigen::Vector3d(kNotMeasured, kNotMeasured, total),
       Eigen::Vector3d(kNotMeasured, kNotMeasured, 0.01 * std::abs(total))}};
  load_case.displacement = exact.reshaped(3, mesh.NumNodes());
  std::mt19937_64 generator(2);
  std::normal_distribution<double> noise(0, 5e-5);
  for (double& value : load_case.displacement.reshaped()) {
    value += noise(generator);
  }
  mesh.regions.resize(0);
  scene.origin = Origin::kComputed;
  scene.materials = {Material()};
  scene.materials[0].known = {{"poisson_ratio", 0.45}};
  return scene;
}

TEST(FarNodes, OfAnotherMaterialDoNotHideWhatResultantsTell) {
  const Estimate estimate =
      MakeEstimator("iterative-fe")->Run(BlockOfUnknownInclusion(), {});
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_GT(estimate.elasticity.youngs_modulus, 1e-2);
  EXPECT_LT(estimate.elasticity.youngs_modulus, 0.04);
  // That they are far off is noticed, and changes less than the value itself.
  EXPECT_TRUE(estimate.error_budget.outliers(0) > 0 &&
              estimate.error_budget.outliers(0) < 1)
      << estimate.error_budget.outliers.transpose();
  EXPECT_TRUE(estimate.Has(FindingCode::kSmoothResidual) ||
              estimate.Has(FindingCode::kOutliers));
}

}  // namespace
}  // namespace elastimate
