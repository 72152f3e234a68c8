#include "elastimate/core/scene/support_ends.h"

#include <algorithm>

#include "elastimate/core/mesh/facets.h"

namespace elastimate {
namespace {

// Tells whether something says where the support of a component ends.
bool IsToldByPlace(const Supports& supports, const Mesh& mesh, Eigen::Index i,
                   int node) {
  if (supports.delimited.size() != 0 && supports.delimited(i, node)) {
    return true;
  }
  return std::any_of(
      supports.boxes.begin(), supports.boxes.end(), [&](const HeldBox& box) {
        return box.components(i) && box.Contains(mesh.nodes.col(node));
      });
}

// The facets of the surface of a mesh.
class SurfaceFacets {
 public:
  explicit SurfaceFacets(const Mesh& mesh)
      : facets_(BoundaryFacets(mesh)),
        normals_(mesh.Dimension(), facets_.cols()),
        of_node_(mesh.NumNodes()) {
    for (Eigen::Index facet = 0; facet < facets_.cols(); ++facet) {
      normals_.col(facet) = WeightsOfFacet(mesh, facets_.col(facet))
                                .area_vector.rowwise()
                                .sum()
                                .normalized();
      for (const int node : facets_.col(facet)) {
        of_node_[node].push_back(facet);
      }
    }
  }

  const Eigen::MatrixXi& Facets() const { return facets_; }
  // Tells whether a facet goes on without a crease from one at a node all of
  // whose nodes are held.
  bool GoesOnFromHeld(Eigen::Index facet, int node,
                      const Eigen::Array<bool, 1, Eigen::Dynamic>& held) const {
    // This is about the cosine of an angle of 45 degrees.
    constexpr double kSmooth = 0.7;
    return std::any_of(
        of_node_[node].begin(), of_node_[node].end(), [&](Eigen::Index other) {
          return held(facets_.col(other)).all() &&
                 normals_.col(other).dot(normals_.col(facet)) > kSmooth;
        });
  }

 private:
  Eigen::MatrixXi facets_;
  Eigen::MatrixXd normals_;
  std::vector<std::vector<Eigen::Index>> of_node_;
};

// The components of edges where it is open whether they are held.
class OpenEdges {
 public:
  OpenEdges(const Supports& supports, const Mesh& mesh, const Edges& edges,
            const ComponentMask& held)
      : supports_(supports),
        mesh_(mesh),
        edges_(edges),
        held_(held),
        open_(ComponentMask::Constant(mesh.Dimension(), edges.Size(), false)) {
    OpenInVolumes();
    OpenOnSurface();
  }

  const ComponentMask& Open() const { return open_; }
  // Returns the only end at which a component is held while nothing says where
  // its support ends; -1 where there is none.
  int HeldEnd(Eigen::Index i, Eigen::Index edge) const {
    const int low = edges_.Ends()(0, edge);
    const int high = edges_.Ends()(1, edge);
    if (held_(i, edge) || supports_.held(i, low) == supports_.held(i, high)) {
      return -1;
    }
    const int end = supports_.held(i, low) ? low : high;
    return supports_.IsGiven(static_cast<int>(i), end) &&
                   !IsToldByPlace(supports_, mesh_, i, end)
               ? end
               : -1;
  }

 private:
  void OpenInVolumes() {
    for (Eigen::Index i = 0; i < open_.rows(); ++i) {
      std::vector<bool> is_in_volume(mesh_.NumNodes(), false);
      for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
        if (supports_.held.row(i)(mesh_.elements.col(e)).all()) {
          for (const int node : mesh_.elements.col(e)) {
            is_in_volume[node] = true;
          }
        }
      }
      // The nodes of a layer that is held in part are next to the volume.
      std::vector<bool> is_at_volume = is_in_volume;
      for (Eigen::Index edge = 0; edge < edges_.Size(); ++edge) {
        const int low = edges_.Ends()(0, edge);
        const int high = edges_.Ends()(1, edge);
        if (is_in_volume[low] || is_in_volume[high]) {
          is_at_volume[low] = is_at_volume[high] = true;
        }
      }
      for (Eigen::Index edge = 0; edge < edges_.Size(); ++edge) {
        const int end = HeldEnd(i, edge);
        open_(i, edge) = end >= 0 && is_at_volume[end];
      }
    }
  }

  void OpenOnSurface() {
    const SurfaceFacets surface(mesh_);
    for (Eigen::Index facet = 0; facet < surface.Facets().cols(); ++facet) {
      const auto nodes = surface.Facets().col(facet);
      for (Eigen::Index a = 0; a < nodes.size(); ++a) {
        for (Eigen::Index b = 0; b < a; ++b) {
          const Eigen::Index edge = edges_.Find(nodes(a), nodes(b));
          for (Eigen::Index i = 0; i < open_.rows(); ++i) {
            const int end = HeldEnd(i, edge);
            if (end >= 0 &&
                surface.GoesOnFromHeld(facet, end, supports_.held.row(i))) {
              open_(i, edge) = true;
            }
          }
        }
      }
    }
  }

  const Supports& supports_;
  const Mesh& mesh_;
  const Edges& edges_;
  const ComponentMask& held_;
  ComponentMask open_;
};

}  // namespace

std::vector<HeldComponent> FindSupportEnds(const Supports& supports,
                                           const Mesh& mesh, const Edges& edges,
                                           const ComponentMask& held) {
  const OpenEdges open_edges(supports, mesh, edges, held);
  std::vector<HeldComponent> in_doubt;
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    for (Eigen::Index i = 0; i < mesh.Dimension(); ++i) {
      if (open_edges.Open()(i, edge)) {
        in_doubt.push_back(
            {i, mesh.NumNodes() + edge,
             supports.displacement(i, open_edges.HeldEnd(i, edge))});
      }
    }
  }
  return in_doubt;
}

}  // namespace elastimate
