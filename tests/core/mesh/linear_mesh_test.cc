#include "elastimate/core/mesh/linear_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "elastimate/core/mesh/facets.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

constexpr double kRoundingOfCuts = 1e-12;

// Returns the nodes of each facet without its sense of rotation.
std::set<std::array<int, 4>> Unordered(const Eigen::MatrixXi& facets) {
  std::set<std::array<int, 4>> all;
  for (const auto& facet : facets.colwise()) {
    std::array<int, 4> nodes = {};
    std::copy(facet.begin(), facet.end(), nodes.begin());
    std::sort(nodes.begin(), nodes.end());
    all.insert(nodes);
  }
  return all;
}

class LinearMeshOfKind : public ::testing::TestWithParam<KindOfSection> {
 protected:
  LinearMeshOfKind()
      : mesh_(MeshWithRegions()), cut_(mesh_), parts_(cut_.Parts()) {}

  static Mesh MeshWithRegions() {
    Mesh mesh = testing::MeshOfKind(GetParam());
    mesh.regions.setLinSpaced(mesh.NumElements(), 1, 7);
    return mesh;
  }

  bool IsStraight() const { return !IsCurved(mesh_.kind); }

  Mesh mesh_;
  LinearMesh cut_;
  const Mesh& parts_;
};

TEST_P(LinearMeshOfKind, HasItsNodesAndItsVolume) {
  ValidateMesh(parts_);
  EXPECT_EQ(parts_.nodes, mesh_.nodes);
  EXPECT_EQ(parts_.section.thickness, mesh_.section.thickness);
  const Eigen::Index num_cuts = parts_.NumElements() / mesh_.NumElements();
  const Eigen::VectorXd volumes = ElementVolumes(mesh_);
  const Eigen::VectorXd of_parts = ElementVolumes(parts_);
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    const auto cuts = of_parts.segment(num_cuts * e, num_cuts);
    // Parts of curved elements are not curved.
    const double tolerance = IsStraight() ? kRoundingOfCuts : 0.05;
    EXPECT_NEAR(cuts.sum(), volumes(e), tolerance * volumes(e));
    EXPECT_GT(cuts.minCoeff(), 0);
    EXPECT_TRUE((parts_.regions.segment(num_cuts * e, num_cuts).array() ==
                 mesh_.regions(e))
                    .all());
  }
  EXPECT_NEAR(of_parts.sum(), volumes.sum(), 0.01 * volumes.sum());
}

// Neighbours have to be cut alike, so that facets of loads are faces of the
// surface.
TEST_P(LinearMeshOfKind, HasItsSurface) {
  const Eigen::MatrixXi facets = cut_.FacetsOf(BoundaryFacets(mesh_));
  const Eigen::MatrixXi expected = BoundaryFacets(parts_);
  EXPECT_EQ(facets.cols(), expected.cols());
  EXPECT_EQ(Unordered(facets), Unordered(expected));
  // The facets have to be oriented alike: then a closed surface has no vector
  // area, and encloses the volume.
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh_.Dimension());
  double volume = 0;
  for (const auto& facet : facets.colwise()) {
    const FacetWeights weights = WeightsOfFacet(parts_, facet);
    area += weights.area_vector.rowwise().sum();
    volume +=
        weights.area_vector.cwiseProduct(parts_.nodes(Eigen::all, facet)).sum();
  }
  EXPECT_LT(area.norm(), kRoundingOfCuts);
  EXPECT_NEAR(volume / mesh_.Dimension(), ElementVolumes(parts_).sum(),
              kRoundingOfCuts);
}

TEST_P(LinearMeshOfKind, HasItsPoints) {
  std::mt19937_64 generator(1);
  const MeshPoints points = DrawPoints(mesh_, 500, generator);
  const MeshPoints found = cut_.PointsOf(points);
  ValidatePoints(parts_, found);
  const Eigen::MatrixXd error = Interpolate(parts_, found, parts_.nodes) -
                                Interpolate(mesh_, points, mesh_.nodes);
  const double size = mesh_.nodes.cwiseAbs().maxCoeff();
  if (IsStraight()) {
    EXPECT_LT(error.colwise().norm().maxCoeff(), kRoundingOfCuts * size);
  }
  // Points of curved sides are off by at most the distance between a side and
  // its flat parts.
  EXPECT_LT(error.colwise().norm().maxCoeff(), 0.02 * size);
}

TEST_P(LinearMeshOfKind, LeavesLinearElementsAsTheyAre) {
  EXPECT_EQ(parts_.kind, LinearKind(mesh_.kind));
  EXPECT_EQ(LinearMesh(parts_).Parts().elements, parts_.elements);
}

INSTANTIATE_TEST_SUITE_P(All, LinearMeshOfKind,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
