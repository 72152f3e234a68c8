#include "elastimate/core/mesh/simplicial_mesh.h"

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
std::set<std::array<int, 3>> Unordered(const Eigen::MatrixXi& facets) {
  std::set<std::array<int, 3>> all;
  for (const auto& facet : facets.colwise()) {
    std::array<int, 3> nodes = {};
    std::copy(facet.begin(), facet.end(), nodes.begin());
    std::sort(nodes.begin(), nodes.end());
    all.insert(nodes);
  }
  return all;
}

class SimplicialMeshOfKind : public ::testing::TestWithParam<KindOfSection> {
 protected:
  SimplicialMeshOfKind()
      : mesh_(MeshWithRegions()), cut_(mesh_), simplices_(cut_.Simplices()) {}

  static Mesh MeshWithRegions() {
    Mesh mesh = testing::MeshOfKind(GetParam());
    mesh.regions.setLinSpaced(mesh.NumElements(), 1, 7);
    return mesh;
  }

  bool HasFlatSides() const {
    return mesh_.kind != ElementKind::kHex8 && !IsCurved(mesh_.kind);
  }

  Mesh mesh_;
  SimplicialMesh cut_;
  const Mesh& simplices_;
};

TEST_P(SimplicialMeshOfKind, HasItsNodesAndItsVolume) {
  ValidateMesh(simplices_);
  EXPECT_EQ(simplices_.nodes, mesh_.nodes);
  EXPECT_EQ(simplices_.section.thickness, mesh_.section.thickness);
  const Eigen::Index num_cuts = simplices_.NumElements() / mesh_.NumElements();
  const Eigen::VectorXd volumes = ElementVolumes(mesh_);
  const Eigen::VectorXd of_simplices = ElementVolumes(simplices_);
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    const auto cuts = of_simplices.segment(num_cuts * e, num_cuts);
    // The sides of hexahedra in a distorted block are not flat, so cutting them
    // into triangles changes the volume a little.
    const double tolerance = HasFlatSides() ? kRoundingOfCuts : 0.05;
    EXPECT_NEAR(cuts.sum(), volumes(e), tolerance * volumes(e));
    EXPECT_GT(cuts.minCoeff(), 0);
    EXPECT_TRUE((simplices_.regions.segment(num_cuts * e, num_cuts).array() ==
                 mesh_.regions(e))
                    .all());
  }
  EXPECT_NEAR(of_simplices.sum(), volumes.sum(), 0.01 * volumes.sum());
}

// Neighbours have to be cut alike, so that facets of loads are faces of the
// surface.
TEST_P(SimplicialMeshOfKind, HasItsSurface) {
  const Eigen::MatrixXi facets = cut_.FacetsOf(BoundaryFacets(mesh_));
  const Eigen::MatrixXi expected = BoundaryFacets(simplices_);
  EXPECT_EQ(facets.cols(), expected.cols());
  EXPECT_EQ(Unordered(facets), Unordered(expected));
  // The facets have to be oriented alike: then a closed surface has no vector
  // area, and encloses the volume.
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh_.Dimension());
  double volume = 0;
  for (const auto& facet : facets.colwise()) {
    const FacetWeights weights = WeightsOfFacet(simplices_, facet);
    area += weights.area_vector.rowwise().sum();
    volume +=
        weights.area_vector.cwiseProduct(simplices_.nodes(Eigen::all, facet))
            .sum();
  }
  EXPECT_LT(area.norm(), kRoundingOfCuts);
  EXPECT_NEAR(volume / mesh_.Dimension(), ElementVolumes(simplices_).sum(),
              kRoundingOfCuts);
}

TEST_P(SimplicialMeshOfKind, HasItsPoints) {
  std::mt19937_64 generator(1);
  const MeshPoints points = DrawPoints(mesh_, 500, generator);
  const MeshPoints found = cut_.PointsOf(points);
  ValidatePoints(simplices_, found);
  const Eigen::MatrixXd error =
      Interpolate(simplices_, found, simplices_.nodes) -
      Interpolate(mesh_, points, mesh_.nodes);
  const double size = mesh_.nodes.cwiseAbs().maxCoeff();
  if (HasFlatSides()) {
    EXPECT_LT(error.colwise().norm().maxCoeff(), kRoundingOfCuts * size);
  }
  // Points of sides that are not flat are off by at most the distance between a
  // side and its two triangles.
  EXPECT_LT(error.colwise().norm().maxCoeff(), 0.02 * size);
}

TEST_P(SimplicialMeshOfKind, LeavesLinearSimplicesAsTheyAre) {
  EXPECT_EQ(SimplicialMesh(simplices_).Simplices().elements,
            simplices_.elements);
}

// A grid is cut in the pattern of a union jack, in which the nodes at which
// diagonals meet alternate with the others.
TEST(SimplicialMesh, HasAlternatingDiagonals) {
  const Mesh mesh =
      testing::MeshOfKind({ElementKind::kQuad4, SectionModel::kPlaneStress}, 4);
  const Mesh simplices = SimplicialMesh(mesh).Simplices();
  Eigen::VectorXi num_triangles = Eigen::VectorXi::Zero(mesh.NumNodes());
  for (const int node : simplices.elements.reshaped()) {
    ++num_triangles(node);
  }
  // An inner node of the grid has either all eight triangles around it, or four
  // whose longest edges are opposite to it.
  EXPECT_EQ((num_triangles.array() == 8).count(), 5);
  EXPECT_EQ(num_triangles.maxCoeff(), 8);
}

INSTANTIATE_TEST_SUITE_P(All, SimplicialMeshOfKind,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
