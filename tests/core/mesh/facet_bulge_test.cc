#include "elastimate/core/mesh/facet_bulge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/core/mesh/facets.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kPi = 3.14159265358979323846;

// The volume that lies outside the facets, by their mean bulge.
double VolumeOutside(const Mesh& mesh) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  const Eigen::VectorXd bulge = BulgeOfFacets(mesh, facets);
  double volume = 0;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    volume += bulge(i) * WeightsOfFacet(mesh, facets.col(i)).area.sum();
  }
  return volume;
}

TEST(FacetBulge, OfACylinderIsWhatAPolygonLacks) {
  for (const int cells_per_side : {3, 4, 6}) {
    const Mesh mesh = testing::CylinderMesh(cells_per_side);
    const double lacks = kPi - ElementVolumes(mesh).sum();
    EXPECT_NEAR(VolumeOutside(mesh), lacks, 0.03 * lacks) << cells_per_side;
  }
}

// Eight sides meet at 45 degrees, as those of a prism may.
TEST(FacetBulge, EndsAtEdges) {
  EXPECT_NEAR(VolumeOutside(testing::CylinderMesh(2)), 0, 1e-12);
  EXPECT_NEAR(VolumeOutside(testing::BoxMesh({2, 3, 4}, {1, 1, 1})), 0, 1e-12);
}

// Edges of one circle whose lengths differ by a factor of three.
TEST(FacetBulge, OfAHoleIsNegative) {
  constexpr int kAround = 24;
  Mesh ring;
  ring.kind = ElementKind::kQuad4;
  ring.section = {SectionModel::kPlaneStress, 0.5};
  ring.nodes.resize(2, Eigen::Index{2} * kAround);
  ring.elements.resize(4, kAround);
  const auto angle_of = [](int i) {
    return 2 * kPi * (i + (i % 2 == 1 ? 0.5 : 0)) / kAround;
  };
  for (int i = 0; i < kAround; ++i) {
    const double angle = angle_of(i);
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    ring.nodes.col(i) = direction;
    ring.nodes.col(kAround + i) = 2 * direction;
    const int next = (i + 1) % kAround;
    ring.elements.col(i) << i, kAround + i, kAround + next, next;
  }
  const Eigen::MatrixXi edges = BoundaryFacets(ring);
  const Eigen::VectorXd bulge = BulgeOfFacets(ring, edges);
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    const double radius = edges(0, i) < kAround ? 1 : 2;
    const Eigen::VectorXd edge =
        ring.nodes.col(edges(1, i)) - ring.nodes.col(edges(0, i));
    const double rise =
        radius - std::sqrt(radius * radius - edge.squaredNorm() / 4);
    EXPECT_NEAR(bulge(i), (radius == 1 ? -1 : 1) * 2 * rise / 3, 0.03 * rise);
  }
}

}  // namespace
}  // namespace elastimate
