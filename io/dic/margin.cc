#include "elastimate/io/dic/margin.h"

#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

struct FreeEdges {
  double length = 0;
  double mean_length = 0;
  double length_of_steps = 0;
};

// Returns the edges that no support holds.
Eigen::MatrixXi FreeEdgeNodes(const Scene& scene) {
  const ComponentMask& held = SupportsOf(scene, 0).held;
  const Eigen::MatrixXi edges = BoundaryFacets(scene.mesh);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    if (!(held.col(edges(0, i)).any() && held.col(edges(1, i)).any())) {
      free.push_back(i);
    }
  }
  return edges(Eigen::all, free);
}

// Returns the straight side of each edge, as the place of one of its edges.
std::vector<Eigen::Index> SidesOf(const Mesh& mesh,
                                  const Eigen::MatrixXi& edges) {
  boost::disjoint_sets_with_storage<> sets(edges.cols());
  std::map<std::pair<int, bool>, Eigen::Index> first;  // By node, direction.
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    const Eigen::VectorXd along =
        mesh.nodes.col(edges(1, i)) - mesh.nodes.col(edges(0, i));
    const bool is_upright = std::abs(along(1)) > std::abs(along(0));
    for (const int node : edges.col(i)) {
      const auto found = first.emplace(std::pair(node, is_upright), i).first;
      sets.union_set(i, found->second);
    }
  }
  std::vector<Eigen::Index> sides;
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    sides.push_back(Eigen::Index(sets.find_set(i)));
  }
  return sides;
}

// Tells of each edge whether its straight side is a step: on a grid, the points
// inside of a slanted or curved edge make a stair, whose sides have a corner of
// one element at one end and of three at the other, or are short, as around a
// small hole.
std::vector<bool> AreSteps(const Mesh& mesh, const Eigen::MatrixXi& edges) {
  constexpr Eigen::Index kShort = 5;
  struct Side {
    Eigen::Index num_edges = 0;
    bool has_outer_corner = false;
    bool has_inner_corner = false;
  };
  std::vector<int> num_elements(mesh.NumNodes(), 0);
  for (const int node : mesh.elements.reshaped()) {
    ++num_elements[node];
  }
  const std::vector<Eigen::Index> side_of = SidesOf(mesh, edges);
  std::vector<Side> sides(edges.cols());
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    Side& side = sides[side_of[i]];
    ++side.num_edges;
    for (const int node : edges.col(i)) {
      side.has_outer_corner |= num_elements[node] == 1;
      side.has_inner_corner |= num_elements[node] == 3;
    }
  }
  std::vector<bool> are_steps;
  for (const Eigen::Index place : side_of) {
    const Side& side = sides[place];
    are_steps.push_back(side.num_edges < kShort ||
                        (side.has_outer_corner && side.has_inner_corner));
  }
  return are_steps;
}

// Tells whether an edge lies on the box of all nodes, as no step does.
bool IsOnBox(const Mesh& mesh, const Eigen::Vector2i& edge) {
  const Eigen::VectorXd low = mesh.nodes.rowwise().minCoeff();
  const Eigen::VectorXd high = mesh.nodes.rowwise().maxCoeff();
  const auto a = mesh.nodes.col(edge(0)).array();
  const auto b = mesh.nodes.col(edge(1)).array();
  return ((a == low.array() && b == low.array()) ||
          (a == high.array() && b == high.array()))
      .any();
}

FreeEdges FreeEdgesOf(const Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const Eigen::MatrixXi edges = FreeEdgeNodes(scene);
  const std::vector<bool> are_steps = AreSteps(mesh, edges);
  FreeEdges free;
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    const double length =
        (mesh.nodes.col(edges(0, i)) - mesh.nodes.col(edges(1, i))).norm();
    free.length += length;
    if (mesh.kind == ElementKind::kQuad4 && are_steps[i] &&
        !IsOnBox(mesh, edges.col(i))) {
      free.length_of_steps += length;
    }
  }
  free.mean_length =
      edges.cols() == 0 ? 0 : free.length / static_cast<double>(edges.cols());
  return free;
}

// Returns the area by the shoelace formula.
double AreaOf(const Mesh& mesh) {
  double twice = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    double of_element = 0;
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      const Eigen::Vector2d a = mesh.nodes.col(mesh.elements(i, e));
      const Eigen::Vector2d b =
          mesh.nodes.col(mesh.elements((i + 1) % mesh.elements.rows(), e));
      of_element += a(0) * b(1) - a(1) * b(0);
    }
    twice += std::abs(of_element);
  }
  return twice / 2;
}

void AddNotice(const std::string& what, double added,
               std::vector<std::string>& notices) {
  if (added > 0) {
    notices.push_back(what + " adds " + Percent(added) +
                      " to the cross section, as if the specimen were so much "
                      "thicker");
  }
}

}  // namespace

void AllowForMargin(std::optional<double> margin, Scene& scene,
                    std::vector<std::string>& notices) {
  const FreeEdges free = FreeEdgesOf(scene);
  const double area = AreaOf(scene.mesh);
  Section& section = scene.mesh.section;
  if (!margin) {
    section.thickness_relative_sd = free.mean_length / 2 * free.length / area;
    return;
  }
  // The mean distance of an edge from the steps inside of it is half a spacing.
  const double of_steps = free.mean_length / 2 * free.length_of_steps / area;
  const double of_margin = *margin * free.length / area;
  section.thickness_relative_sd = of_steps;
  section.thickness *= 1 + of_steps + of_margin;
  AddNotice("the margin of " + NumberText(*margin), of_margin, notices);
  AddNotice(
      "half a spacing of the points at slanted and curved edges, on which no "
      "points lie,",
      of_steps, notices);
}

}  // namespace elastimate
