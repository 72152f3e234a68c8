#include "elastimate/core/mesh/facet_bulge.h"

#include <Eigen/Geometry>
#include <vector>

#include "elastimate/core/mesh/facets.h"

namespace elastimate {
namespace {

// A facet at one of its vertices, with its weight in the normal there.
struct Corner {
  Eigen::Index facet;
  double weight;
};

double WeightAt(const Mesh& mesh,
                const Eigen::Ref<const Eigen::VectorXi>& facet, int k) {
  const int num_vertices = mesh.Topology().NumVerticesOfFace();
  const auto edge_to = [&](int i) {
    return Eigen::VectorXd(mesh.nodes.col(facet(i % num_vertices)) -
                           mesh.nodes.col(facet(k)));
  };
  const Eigen::VectorXd next = edge_to(k + 1);
  if (num_vertices == 2) {
    return 1 / next.norm();
  }
  const Eigen::VectorXd last = edge_to(k + num_vertices - 1);
  return Eigen::Vector3d(next).cross(Eigen::Vector3d(last)).norm() /
         (next.squaredNorm() * last.squaredNorm());
}

// The outer surface, with the unit normal of each facet.
class Surface {
 public:
  Surface(const Mesh& mesh, const Eigen::MatrixXi& facets)
      : mesh_(mesh),
        facets_(facets),
        num_vertices_(mesh.Topology().NumVerticesOfFace()),
        normals_(UnitNormals(mesh, facets)),
        corners_(mesh.NumNodes()) {
    for (Eigen::Index i = 0; i < facets.cols(); ++i) {
      for (int k = 0; k < num_vertices_; ++k) {
        corners_[facets(k, i)].push_back({i, WeightAt(mesh, facets.col(i), k)});
      }
    }
  }

  double BulgeOf(Eigen::Index facet) const {
    // A planar mesh has one edge in a facet.
    const int num_edges = num_vertices_ == 2 ? 1 : num_vertices_;
    double rise = 0;
    for (int k = 0; k < num_edges; ++k) {
      const int i = facets_(k, facet);
      const int j = facets_((k + 1) % num_vertices_, facet);
      rise += (NormalAt(j, facet) - NormalAt(i, facet))
                  .dot(mesh_.nodes.col(j) - mesh_.nodes.col(i)) /
              8;
    }
    return (num_vertices_ == 2 ? 2 : 1) * rise / 3;
  }

 private:
  Eigen::VectorXd NormalAt(int node, Eigen::Index facet) const {
    constexpr double kCosineOfEdge = 0.766;  // Of 40 degrees.
    Eigen::VectorXd normal = Eigen::VectorXd::Zero(mesh_.Dimension());
    for (const Corner& corner : corners_[node]) {
      if (normals_.col(corner.facet).dot(normals_.col(facet)) > kCosineOfEdge) {
        normal += corner.weight * normals_.col(corner.facet);
      }
    }
    return normal.normalized();
  }

  const Mesh& mesh_;
  const Eigen::MatrixXi& facets_;
  int num_vertices_;
  Eigen::MatrixXd normals_;
  std::vector<std::vector<Corner>> corners_;  // Of each node.
};

}  // namespace

Eigen::VectorXd BulgeOfFacets(const Mesh& mesh, const Eigen::MatrixXi& facets) {
  const Surface surface(mesh, facets);
  return Eigen::VectorXd::NullaryExpr(
      facets.cols(), [&](Eigen::Index i) { return surface.BulgeOf(i); });
}

}  // namespace elastimate
