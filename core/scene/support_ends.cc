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

// The components of middles where it is open whether they are held, with the
// vertices that hold them.
class OpenMiddles {
 public:
  OpenMiddles(const Supports& supports, const Mesh& mesh,
              const Middles& middles, const ComponentMask& held)
      : supports_(supports),
        mesh_(mesh),
        middles_(middles),
        held_(held),
        open_(
            ComponentMask::Constant(mesh.Dimension(), middles.Size(), false)) {
    OpenInVolumes();
    OpenOnSurface();
  }

  const ComponentMask& Open() const { return open_; }
  // Returns the vertices of an open middle that hold its first open component,
  // or those that leave it free.
  std::vector<int> VerticesWhere(bool is_held, Eigen::Index middle) const {
    Eigen::Index component = 0;
    while (!open_(component, middle)) {
      ++component;
    }
    return VerticesWhere(is_held, component, middle);
  }

 private:
  std::vector<int> VerticesWhere(bool is_held, Eigen::Index i,
                                 Eigen::Index middle) const {
    std::vector<int> vertices;
    for (const int node : middles_.Vertices()[middle]) {
      if (supports_.held(i, node) == is_held) {
        vertices.push_back(node);
      }
    }
    return vertices;
  }

  // Returns the vertices that hold a component which others leave free, while
  // nothing says where the support ends; else none.
  std::vector<int> HeldVertices(Eigen::Index i, Eigen::Index middle) const {
    std::vector<int> vertices = VerticesWhere(true, i, middle);
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
        const std::vector<int> vertices = HeldVertices(i, middle);
        open_(i, middle) =
            std::any_of(vertices.begin(), vertices.end(),
                        [&](int node) { return is_at_volume[node]; });
      }
    }
  }

  void OpenOnSurface() {
    const SurfaceFacets surface(mesh_);
    std::vector<int> around;
    for (Eigen::Index facet = 0; facet < surface.Facets().cols(); ++facet) {
      for (const auto& places : mesh_.Topology().middles_of_face) {
        around.clear();
        for (const int place : places) {
          around.push_back(surface.Facets()(place, facet));
        }
        const Eigen::Index middle = middles_.Find(around);
        for (Eigen::Index i = 0; i < open_.rows(); ++i) {
          const std::vector<int> vertices = HeldVertices(i, middle);
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

// Returns the open middles of each end.
std::vector<std::vector<Eigen::Index>> ConnectedMiddles(
    const Mesh& mesh, const Middles& middles, const ComponentMask& open) {
  std::vector<int> parent(mesh.NumNodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[node] != node) {
      node = parent[node] = parent[parent[node]];
    }
    return node;
  };
  for (Eigen::Index middle = 0; middle < middles.Size(); ++middle) {
    if (open.col(middle).any()) {
      const auto vertices = middles.Vertices()[middle];
      for (const int node : vertices) {
        parent[root(vertices(0))] = root(node);
      }
    }
  }
  std::map<int, std::vector<Eigen::Index>> of_root;
  for (Eigen::Index middle = 0; middle < middles.Size(); ++middle) {
    if (open.col(middle).any()) {
      of_root[root(middles.Vertices()[middle](0))].push_back(middle);
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

// Returns the middles in their order in a direction; those that are equally far
// form one step.
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
                                        const Mesh& mesh,
                                        const Middles& middles,
                                        const ComponentMask& held) {
  const OpenMiddles open_middles(supports, mesh, middles, held);
  const ComponentMask& open = open_middles.Open();
  std::vector<SupportEnd> ends;
  for (const auto& of_end : ConnectedMiddles(mesh, middles, open)) {
    const Eigen::Index size = Eigen::Index(of_end.size());
    Eigen::MatrixXd held_points(mesh.Dimension(), size);
    Eigen::MatrixXd free_points(mesh.Dimension(), size);
    Eigen::MatrixXd positions(mesh.Dimension(), size);
    for (Eigen::Index k = 0; k < size; ++k) {
      const auto mean = [&](const auto& vertices) {
        return mesh.nodes(Eigen::all, vertices).rowwise().mean();
      };
      held_points.col(k) = mean(open_middles.VerticesWhere(true, of_end[k]));
      free_points.col(k) = mean(open_middles.VerticesWhere(false, of_end[k]));
      positions.col(k) = mean(middles.Vertices()[of_end[k]]);
    }
    const std::optional<Eigen::VectorXd> direction =
        SeparatingDirection(held_points, free_points);
    const Eigen::RowVectorXd distance =
        direction ? Eigen::RowVectorXd(direction->transpose() * positions)
                  : Eigen::RowVectorXd::Zero(size);
    SupportEnd end;
    for (const auto& step : Steps(of_end, distance)) {
      end.steps.emplace_back();
      for (const Eigen::Index middle : step) {
        const std::vector<int> vertices =
            open_middles.VerticesWhere(true, middle);
        for (Eigen::Index i = 0; i < open.rows(); ++i) {
          if (open(i, middle)) {
            end.steps.back().push_back(
                {i, mesh.NumNodes() + middle,
                 supports.displacement.row(i)(vertices).mean()});
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
