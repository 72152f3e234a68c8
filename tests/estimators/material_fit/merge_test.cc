#include "elastimate/estimators/material_fit/merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using Regions = std::vector<int>;

// A block of six regions, three along x and two along y, which have these
// parameters, with this noise relative to the root mean square displacement.
Scene BlockOfSixRegions(const std::vector<IsotropicElasticity>& truth,
                        double noise, unsigned seed) {
  Scene scene =
      testing::SceneOfKind({ElementKind::kTet4, SectionModel::kSolid}, 4);
  const Eigen::VectorXd size = scene.mesh.nodes.rowwise().maxCoeff();
  scene.mesh.regions.resize(scene.mesh.NumElements());
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    const Eigen::VectorXd centre =
        scene.mesh.nodes(Eigen::all, scene.mesh.elements.col(e))
            .rowwise()
            .mean();
    const int along_x = std::min(2, static_cast<int>(3 * centre(0) / size(0)));
    const int along_y = 2 * centre(1) < size(1) ? 0 : 1;
    scene.mesh.regions(e) = 1 + along_x + 3 * along_y;
  }
  scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
  Equilibrium model(scene, SolverKind::kCholesky);
  Eigen::VectorXd parameters(2 * Eigen::Index(truth.size()));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    parameters.segment<2>(2 * Eigen::Index(i)) << truth[i].youngs_modulus,
        truth[i].poisson_ratio;
  }
  EXPECT_TRUE(model.Solve(model.Forces().Parameters().Moduli(parameters)));
  std::mt19937_64 generator(seed);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    Eigen::MatrixXd u = model.Displacement()
                            .col(Eigen::Index(k))
                            .reshaped(3, scene.mesh.NumNodes());
    std::normal_distribution<double> error(
        0, noise * u.norm() / std::sqrt(double(u.size())));
    for (double& value : u.reshaped()) {
      value += error(generator);
    }
    scene.load_cases[k].displacement = u;
  }
  return scene;
}

// The regions of each material, ascending.
std::vector<Regions> Partition(const MaterialMerge& merge) {
  std::vector<Regions> partition;
  for (const Material& material : merge.materials) {
    partition.push_back(material.regions);
  }
  std::sort(partition.begin(), partition.end());
  return partition;
}

// How many of so many measurements lead to this partition.
int CountRight(const std::vector<IsotropicElasticity>& truth,
               const std::vector<Regions>& partition, int num_seeds) {
  constexpr double kNoise = 0.01;
  int num_right = 0;
  for (int seed = 1; seed <= num_seeds; ++seed) {
    const MaterialMerge merge =
        MergeMaterials(BlockOfSixRegions(truth, kNoise, seed), {});
    EXPECT_TRUE(merge.why_not.empty()) << merge.why_not;
    num_right += Partition(merge) == partition ? 1 : 0;
  }
  return num_right;
}

const std::vector<IsotropicElasticity> kOneMaterial(6, {5e3, 0.3});
const std::vector<Regions> kTwoMaterials = {{1, 3, 4, 6}, {2, 5}};

std::vector<IsotropicElasticity> WithOthersInTheMiddle(
    const IsotropicElasticity& other) {
  std::vector<IsotropicElasticity> truth = kOneMaterial;
  truth[1] = truth[4] = other;
  return truth;
}

// Were one of twenty wrong, 2 of 12 would be so in one test of nine.
TEST(MergeStatistics, FindsThatAllAreOne) {
  EXPECT_GE(CountRight(kOneMaterial, {}, 12), 10);
}

TEST(MergeStatistics, FindsTwoModuli) {
  EXPECT_GE(CountRight(WithOthersInTheMiddle({6e3, 0.3}), kTwoMaterials, 12),
            10);
}

TEST(MergeStatistics, FindsTwoPoissonRatios) {
  EXPECT_GE(CountRight(WithOthersInTheMiddle({5e3, 0.35}), kTwoMaterials, 12),
            9);
}

TEST(MergeMaterials, SaysWhatItDid) {
  const MaterialMerge merge = MergeMaterials(
      BlockOfSixRegions(WithOthersInTheMiddle({1e4, 0.3}), 0.01, 1), {});
  ASSERT_EQ(merge.path.size(), 5U);
  for (std::size_t i = 0; i < merge.path.size(); ++i) {
    EXPECT_EQ(merge.path[i].is_taken, i < 4);
    EXPECT_EQ(merge.path[i].chi_square < merge.path[i].limit, i < 4);
  }
  EXPECT_EQ(merge.path[4].first, Regions({1, 3, 4, 6}));
  EXPECT_EQ(merge.path[4].second, Regions({2, 5}));
  EXPECT_GT(merge.work.factorizations, 0);
}

// What nobody strains is told apart from nothing.
TEST(MergeMaterials, SaysWhyItCannot) {
  Scene scene = BlockOfSixRegions(kOneMaterial, 0.01, 1);
  for (LoadCase& load_case : scene.load_cases) {
    load_case.observed.setConstant(3, scene.mesh.NumNodes(), false);
    load_case.observed.col(scene.mesh.NumNodes() - 1).setConstant(true);
  }
  const MaterialMerge merge = MergeMaterials(scene, {});
  EXPECT_FALSE(merge.why_not.empty());
  EXPECT_EQ(merge.materials.size(), 6U);
  EXPECT_TRUE(merge.path.empty());
}

}  // namespace
}  // namespace elastimate
