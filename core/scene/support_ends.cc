#include "elastimate/core/scene/support_ends.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

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

// The components of edges where it is open whether they are held, with the ends
// that are held.
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
  // Returns the held and the free node of an open edge.
  std::pair<int, int> HeldAndFree(Eigen::Index edge) const {
    const int low = edges_.Ends()(0, edge);
    const int high = edges_.Ends()(1, edge);
    for (Eigen::Index i = 0; i < open_.rows(); ++i) {
      if (open_(i, edge) && supports_.held(i, high)) {
        return {high, low};
      }
    }
    return {low, high};
  }

 private:
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

// Returns the open edges of each end.
std::vector<std::vector<Eigen::Index>> ConnectedEdges(
    const Mesh& mesh, const Edges& edges, const ComponentMask& open) {
  std::vector<int> parent(mesh.NumNodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[node] != node) {
      node = parent[node] = parent[parent[node]];
    }
    return node;
  };
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    if (open.col(edge).any()) {
      parent[root(edges.Ends()(0, edge))] = root(edges.Ends()(1, edge));
    }
  }
  std::map<int, std::vector<Eigen::Index>> of_root;
  for (Eigen::Index edge = 0; edge < edges.Size(); ++edge) {
    if (open.col(edge).any()) {
      of_root[root(edges.Ends()(0, edge))].push_back(edge);
    }
  }
  std::vector<std::vector<Eigen::Index>> all;
  for (const auto& [unused, of_end] : of_root) {
    all.push_back(of_end);
  }
  return all;
}

// Returns how far the free points, as columns, are beyond the held ones in a
// direction.
double Gap(const Eigen::VectorXd& direction, const Eigen::MatrixXd& held,
           const Eigen::MatrixXd& free) {
  return (direction.transpose() * free).minCoeff() -
         (direction.transpose() * held).maxCoeff();
}

Eigen::MatrixXd ScatterMatrix(const Eigen::MatrixXd& points) {
  const Eigen::MatrixXd centred = points.colwise() - points.rowwise().mean();
  return centred * centred.transpose();
}

// Returns a direction in which the free points are beyond the held ones, if one
// is known.
std::optional<Eigen::VectorXd> SeparatingDirection(
    const Eigen::MatrixXd& held, const Eigen::MatrixXd& free) {
  // These are shares of the extent.
  constexpr double kLeastGap = 1e-9;
  constexpr double kRidge = 1e-6;
  const Eigen::Index dimension = held.rows();
  std::vector<Eigen::VectorXd> directions;
  for (Eigen::Index i = 0; i < dimension; ++i) {
    directions.push_back(Eigen::VectorXd::Unit(dimension, i));
    directions.push_back(-Eigen::VectorXd::Unit(dimension, i));
  }
  const auto widest = std::max_element(
      directions.begin(), directions.end(), [&](const auto& a, const auto& b) {
        return Gap(a, held, free) < Gap(b, held, free);
      });
  const Eigen::MatrixXd scatter = ScatterMatrix(held) + ScatterMatrix(free);
  const Eigen::MatrixXd ridge = kRidge * scatter.trace() *
                                Eigen::MatrixXd::Identity(dimension, dimension);
  const Eigen::VectorXd fisher =
      (scatter + ridge)
          .ldlt()
          .solve(free.rowwise().mean() - held.rowwise().mean())
          .normalized();
  const double least_gap =
      kLeastGap *
      (free.rowwise().maxCoeff() - free.rowwise().minCoeff()).norm();
  for (const Eigen::VectorXd& direction : {*widest, fisher}) {
    if (Gap(direction, held, free) > least_gap) {
      return direction;
    }
  }
  return std::nullopt;
}

// Returns the edges in the order of their middles in a direction; those whose
// middles are equally far form one step.
std::vector<std::vector<Eigen::Index>> Steps(
    const std::vector<Eigen::Index>& of_end,
    const Eigen::RowVectorXd& distance) {
  constexpr double kSamePlace = 1e-6;
  const double tolerance =
      kSamePlace * (distance.maxCoeff() - distance.minCoeff());
  std::vector<std::size_t> order(of_end.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance(Eigen::Index(a)) < distance(Eigen::Index(b));
  });
  std::vector<std::vector<Eigen::Index>> steps;
  double last = 0;
  for (const std::size_t i : order) {
    const double here = distance(Eigen::Index(i));
    if (steps.empty() || here > last + tolerance) {
      steps.emplace_back();
    }
    steps.back().push_back(of_end[i]);
    last = here;
  }
  return steps;
}

}  // namespace

std::vector<SupportEnd> FindSupportEnds(const Supports& supports,
                                        const Mesh& mesh, const Edges& edges,
                                        const ComponentMask& held) {
  const OpenEdges open_edges(supports, mesh, edges, held);
  const ComponentMask& open = open_edges.Open();
  std::vector<SupportEnd> ends;
  for (const auto& of_end : ConnectedEdges(mesh, edges, open)) {
    const Eigen::Index size = Eigen::Index(of_end.size());
    Eigen::MatrixXd held_points(mesh.Dimension(), size);
    Eigen::MatrixXd free_points(mesh.Dimension(), size);
    for (Eigen::Index k = 0; k < size; ++k) {
      const auto [held_node, free_node] = open_edges.HeldAndFree(of_end[k]);
      held_points.col(k) = mesh.nodes.col(held_node);
      free_points.col(k) = mesh.nodes.col(free_node);
    }
    const std::optional<Eigen::VectorXd> direction =
        SeparatingDirection(held_points, free_points);
    const Eigen::RowVectorXd distance =
        direction ? Eigen::RowVectorXd(direction->transpose() *
                                       (held_points + free_points) / 2)
                  : Eigen::RowVectorXd::Zero(size);
    SupportEnd end;
    for (const auto& step : Steps(of_end, distance)) {
      end.steps.emplace_back();
      for (const Eigen::Index edge : step) {
        const int held_node = open_edges.HeldAndFree(edge).first;
        for (Eigen::Index i = 0; i < open.rows(); ++i) {
          if (open(i, edge)) {
            end.steps.back().push_back({i, mesh.NumNodes() + edge,
                                        supports.displacement(i, held_node)});
          }
        }
      }
    }
    ends.push_back(std::move(end));
  }
  return ends;
}

Supports EndingAfter(const std::vector<std::size_t>& num_steps,
                     const Supports& supports) {
  Supports ended = supports;
  ended.ends.clear();
  for (std::size_t k = 0; k < num_steps.size(); ++k) {
    for (std::size_t step = 0; step < num_steps[k]; ++step) {
      for (const HeldComponent& component : supports.ends[k].steps[step]) {
        ended.held(component.component, component.node) = true;
        ended.displacement(component.component, component.node) =
            component.displacement;
      }
    }
  }
  return ended;
}

}  // namespace elastimate
