#include "benchmarks/refined_scene.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/quadratic_scene.h"

namespace elastimate {
namespace {

using Cut = std::array<int, 4>;

// At the vertices of a tetrahedron, by its quadratic nodes.
constexpr std::array<Cut, 4> kCornerCuts = {
    {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};

// The octahedron of the mid-edge nodes: a diagonal, and the way around it.
struct Diagonal {
  int a, b;
  std::array<int, 4> ring;
};
constexpr std::array<Diagonal, 3> kDiagonals = {
    {{4, 9, {5, 6, 7, 8}}, {5, 7, {4, 6, 9, 8}}, {6, 8, {4, 5, 9, 7}}}};

// A triangle, by its quadratic nodes, the same way round.
constexpr std::array<std::array<int, 3>, 4> kFacetCuts = {
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

const Diagonal& ShortestDiagonal(const Mesh& quadratic, Eigen::Index element) {
  const auto length = [&](const Diagonal& diagonal) {
    return (quadratic.nodes.col(quadratic.elements(diagonal.a, element)) -
            quadratic.nodes.col(quadratic.elements(diagonal.b, element)))
        .norm();
  };
  return *std::min_element(kDiagonals.begin(), kDiagonals.end(),
                           [&](const Diagonal& one, const Diagonal& other) {
                             return length(one) < length(other);
                           });
}

Mesh CutTetrahedra(const Mesh& quadratic) {
  Mesh mesh;
  mesh.nodes = quadratic.nodes;
  mesh.elements.resize(4, 8 * quadratic.NumElements());
  Eigen::Index count = 0;
  for (Eigen::Index e = 0; e < quadratic.NumElements(); ++e) {
    const auto add = [&](const Cut& cut) {
      for (int i = 0; i < 4; ++i) {
        mesh.elements(i, count) = quadratic.elements(cut[i], e);
      }
      ++count;
    };
    for (const Cut& cut : kCornerCuts) {
      add(cut);
    }
    const Diagonal& diagonal = ShortestDiagonal(quadratic, e);
    for (int i = 0; i < 4; ++i) {
      add({diagonal.a, diagonal.b, diagonal.ring[i],
           diagonal.ring[(i + 1) % 4]});
    }
  }
  if (quadratic.regions.size() != 0) {
    mesh.regions =
        quadratic.regions.transpose().replicate<8, 1>().reshaped().eval();
  }
  return mesh;
}

Eigen::MatrixXi CutFacets(const Eigen::MatrixXi& quadratic) {
  Eigen::MatrixXi facets(3, 4 * quadratic.cols());
  for (Eigen::Index column = 0; column < facets.cols(); ++column) {
    for (int i = 0; i < 3; ++i) {
      facets(i, column) = quadratic(kFacetCuts[column % 4][i], column / 4);
    }
  }
  return facets;
}

// One overload per kind of load.
struct LoadCutter {
  Load operator()(const NodalForces& load) const { return load; }
  Load operator()(const BodyForce& load) const { return load; }
  Load operator()(const Traction& load) const {
    return Traction{CutFacets(load.facets), load.traction};
  }
  Load operator()(const Pressure& load) const {
    return Pressure{CutFacets(load.facets), load.pressure};
  }
  Load operator()(const SurfaceForce& load) const {
    return SurfaceForce{CutFacets(load.facets), load.force};
  }
};

}  // namespace

Scene RefinedScene(const Scene& scene) {
  if (scene.mesh.kind != ElementKind::kTet4) {
    throw std::invalid_argument("only linear tetrahedra are refined, not " +
                                std::string(scene.mesh.Topology().name));
  }
  const Scene quadratic = QuadraticScene(scene);
  Scene refined;
  refined.mesh = CutTetrahedra(quadratic.mesh);
  refined.materials = scene.materials;
  refined.supports = quadratic.supports;
  for (const LoadCase& load_case : quadratic.load_cases) {
    LoadCase cut;
    for (const Load& load : load_case.loads) {
      cut.loads.push_back(std::visit(LoadCutter(), load));
    }
    refined.load_cases.push_back(std::move(cut));
  }
  return refined;
}

}  // namespace elastimate
