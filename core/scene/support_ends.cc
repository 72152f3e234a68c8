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
  SurfaceFacets(const Mesh& mesh, const Eigen::MatrixXi& facets)
      : facets_(facets),
        normals_(UnitNormals(mesh, facets_)),
        of_node_(mesh.NumNodes()) {
    for (Eigen::Index facet = 0; facet < facets_.cols(); ++facet) {
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
  const Eigen::MatrixXi& facets_;
  Eigen::MatrixXd normals_;
  std::vector<std::vector<Eigen::Index>> of_node_;
};

// The components of middles where it is open whether they are held.
class OpenMiddles {
 public:
  OpenMiddles(const Supports& supports, const Mesh& mesh,
              const Eigen::MatrixXi& facets, const Middles& middles,
              const ComponentMask& held)
      : supports_(supports),
        mesh_(mesh),
        middles_(middles),
        held_(held),
        open_(
            ComponentMask::Constant(mesh.Dimension(), middles.Size(), false)) {
    OpenInVolumes();
    OpenOnSurface(facets);
  }

  const ComponentMask& Open() const { return open_; }
  // Returns the vertices of a middle that hold a component.
  std::vector<int> HeldVertices(Eigen::Index i, Eigen::Index middle) const {
    std::vector<int> vertices;
    for (const int node : middles_.Vertices()[middle]) {
      if (supports_.held(i, node)) {
        vertices.push_back(node);
      }
    }
    return vertices;
  }

 private:
  // Returns the vertices that hold a component which others leave free, while
  // nothing says where the support ends; else none.
  std::vector<int> VerticesOfEnd(Eigen::Index i, Eigen::Index middle) const {
    std::vector<int> vertices = HeldVertices(i, middle);
    if (held_(i, middle) ||
        Eigen::Index(vertices.size()) == middles_.Vertices()[middle].size() ||
        std::any_of(vertices.begin(), vertices.end(), [&](int node) {
          return !supports_.IsGiven(static_cast<int>(i), node) ||
                 IsToldByPlace(supports_, mesh_, i, node);
        })) {
      vertices.clear();
    }
    return vertices;
  }

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
      for (Eigen::Index middle = 0; middle < middles_.Size(); ++middle) {
        const auto vertices = middles_.Vertices()[middle];
        if (vertices.size() == 2 &&
            (is_in_volume[vertices(0)] || is_in_volume[vertices(1)])) {
          is_at_volume[vertices(0)] = is_at_volume[vertices(1)] = true;
        }
      }
      for (Eigen::Index middle = 0; middle < middles_.Size(); ++middle) {
        const std::vector<int> vertices = VerticesOfEnd(i, middle);
        open_(i, middle) =
            std::any_of(vertices.begin(), vertices.end(),
                        [&](int node) { return is_at_volume[node]; });
      }
    }
  }

  void OpenOnSurface(const Eigen::MatrixXi& facets) {
    const SurfaceFacets surface(mesh_, facets);
    std::vector<int> around;
    for (Eigen::Index facet = 0; facet < surface.Facets().cols(); ++facet) {
      for (const auto& places : mesh_.Topology().middles_of_face) {
        around.clear();
        for (const int place : places) {
          around.push_back(surface.Facets()(place, facet));
        }
        const Eigen::Index middle = middles_.Find(around);
        for (Eigen::Index i = 0; i < open_.rows(); ++i) {
          const std::vector<int> vertices = VerticesOfEnd(i, middle);
          if (std::any_of(vertices.begin(), vertices.end(), [&](int node) {
                return surface.GoesOnFromHeld(facet, node,
                                              supports_.held.row(i));
              })) {
            open_(i, middle) = true;
          }
        }
      }
    }
  }

  const Supports& supports_;
  const Mesh& mesh_;
  const Middles& middles_;
  const ComponentMask& held_;
  ComponentMask open_;
};

}  // namespace

std::vector<HeldComponent> FindSupportEnds(const Supports& supports,
                                           const Mesh& mesh,
                                           const Eigen::MatrixXi& surface,
                                           const Middles& middles,
                                           const ComponentMask& held) {
  const OpenMiddles open_middles(supports, mesh, surface, middles, held);
  std::vector<HeldComponent> in_doubt;
  for (Eigen::Index middle = 0; middle < middles.Size(); ++middle) {
    for (Eigen::Index i = 0; i < mesh.Dimension(); ++i) {
      if (open_middles.Open()(i, middle)) {
        const std::vector<int> holding = open_middles.HeldVertices(i, middle);
        in_doubt.push_back({i, mesh.NumNodes() + middle,
                            supports.displacement.row(i)(holding).mean()});
      }
    }
  }
  return in_doubt;
}

}  // namespace elastimate
