#include "elastimate/io/examples/example_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/io/examples/organ_mesh.h"
#include "elastimate/io/gmsh/organ_shape.h"

namespace elastimate {
namespace {

constexpr int kMinOrganTetrahedra = 200;
constexpr int kMaxOrganTetrahedra = 2000000;
constexpr int kMaxCuboidTetrahedra = 10000000;
constexpr int kTetrahedraPerCell = 5;

// The magnitudes that a scene may have (RequireRepresentable).
constexpr double kSmallest = 1e-50;
constexpr double kLargest = 1e50;

// Beyond, the reader takes the tetrahedra of a cell for flat.
constexpr double kMaxCellAspect = 1e5;

template <typename Value>
std::string Text(const Value& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

template <typename Triple>
std::string TripleText(const Triple& triple) {
  return Text(triple[0]) + "," + Text(triple[1]) + "," + Text(triple[2]);
}

void Require(bool condition, const std::string& option,
             const std::string& value, const std::string& rule) {
  if (!condition) {
    throw std::invalid_argument(option + "=" + value + "; " + rule);
  }
}

std::string Range() {
  return "from " + Text(kSmallest) + " to " + Text(kLargest);
}

bool IsInRange(double value) { return value >= kSmallest && value <= kLargest; }

void CheckForce(const Eigen::Vector3d& force) {
  Require(force.allFinite() &&
              (force.isZero(0) || IsInRange(force.cwiseAbs().maxCoeff())),
          "force", TripleText(force),
          "the largest must be " + Range() + ", or all zero");
}

void CheckOptions(const CuboidOptions& options) {
  Require(options.cells.minCoeff() >= 1, "cells", TripleText(options.cells),
          "each must be at least 1");
  const Eigen::Vector3d cells = options.cells.cast<double>();
  Require(kTetrahedraPerCell * cells.prod() <= kMaxCuboidTetrahedra, "cells",
          TripleText(options.cells),
          "the product must be at most " +
              std::to_string(kMaxCuboidTetrahedra / kTetrahedraPerCell));
  Require(std::all_of(options.size.begin(), options.size.end(), IsInRange),
          "size", TripleText(options.size), "each must be " + Range());
  const Eigen::Array3d edges = options.size.array() / cells.array();
  Require(edges.maxCoeff() <= kMaxCellAspect * edges.minCoeff(), "size",
          TripleText(options.size),
          "a cell of " + TripleText(edges) +
              " is too flat; its longest edge must be at most " +
              Text(kMaxCellAspect) + " times its shortest");
  CheckForce(options.force);
}

void CheckOptions(const OrganOptions& options) {
  Require(options.tetrahedra >= kMinOrganTetrahedra &&
              options.tetrahedra <= kMaxOrganTetrahedra,
          "tetrahedra", Text(options.tetrahedra),
          "it must be from " + std::to_string(kMinOrganTetrahedra) + " to " +
              std::to_string(kMaxOrganTetrahedra));
  Require(IsInRange(options.length), "length", Text(options.length),
          "it must be " + Range());
  CheckForce(options.force);
}

Eigen::Matrix3Xd CuboidNodes(const CuboidOptions& options) {
  const Eigen::Vector3i counts = options.cells.array() + 1;
  Eigen::Matrix3Xd nodes(3, counts.prod());
  Eigen::Index node = 0;
  for (int k = 0; k < counts.z(); ++k) {
    for (int j = 0; j < counts.y(); ++j) {
      for (int i = 0; i < counts.x(); ++i) {
        // Divided first, so that the last node is at the size exactly.
        nodes.col(node++) = Eigen::Array3d(i, j, k) /
                            options.cells.cast<double>().array() *
                            options.size.array();
      }
    }
  }
  return nodes;
}

/// Five tetrahedra of a cell: four corners cut off, and what remains. Bits 0, 1
/// and 2 of a corner are its steps along x, y and z.
using CellCut = std::array<std::array<int, 4>, kTetrahedraPerCell>;

/// Faces of neighbouring cells have the same diagonal when every other cell is
/// cut the mirrored way.
constexpr CellCut kEvenCut = {
    {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}}};
constexpr CellCut kOddCut = {
    {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 5, 0, 6}, {7, 3, 5, 6}, {0, 5, 3, 6}}};

Eigen::MatrixXi CuboidElements(const Eigen::Vector3i& cells) {
  const int row = cells.x() + 1;
  const int layer = row * (cells.y() + 1);
  Eigen::MatrixXi elements(4, Eigen::Index{kTetrahedraPerCell} * cells.prod());
  Eigen::Index element = 0;
  for (int k = 0; k < cells.z(); ++k) {
    for (int j = 0; j < cells.y(); ++j) {
      for (int i = 0; i < cells.x(); ++i) {
        const int first = i + row * j + layer * k;
        for (const std::array<int, 4>& corners :
             (i + j + k) % 2 == 0 ? kEvenCut : kOddCut) {
          for (int n = 0; n < 4; ++n) {
            const int corner = corners[n];
            elements(n, element) = first + (corner & 1) +
                                   row * (corner >> 1 & 1) +
                                   layer * (corner >> 2);
          }
          ++element;
        }
      }
    }
  }
  return elements;
}

/// Holds the given nodes at zero, and puts `force` on all others.
Scene HeldAndLoaded(Mesh mesh,
                    const Eigen::Array<bool, 1, Eigen::Dynamic>& held,
                    const Eigen::Vector3d& force) {
  Scene scene;
  scene.mesh = std::move(mesh);
  scene.supports.held = held.replicate<3, 1>();
  scene.supports.displacement.setZero(3, held.size());
  NodalForces forces{force.replicate(1, held.size())};
  for (Eigen::Index node = 0; node < held.size(); ++node) {
    if (held[node]) {
      forces.force.col(node).setZero();
    }
  }
  scene.load_cases.emplace_back().loads.emplace_back(std::move(forces));
  return scene;
}

/// The surface nodes about where a liver is tied to the diaphragm: its bare
/// area, at the back and the top of the right lobe.
Eigen::Array<bool, 1, Eigen::Dynamic> BareArea(const Mesh& organ) {
  constexpr double kRadius = 0.225;  // Of an organ of length 1.
  const Eigen::Vector3d center =
      OrganPoint(Eigen::Vector3d(-0.35, 0.7, 0.75).normalized());
  Eigen::Array<bool, 1, Eigen::Dynamic> held =
      Eigen::Array<bool, 1, Eigen::Dynamic>::Constant(organ.NumNodes(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(organ);
  for (const int node : facets.reshaped()) {
    held[node] = (organ.nodes.col(node) - center).norm() < kRadius;
  }
  return held;
}

}  // namespace

Scene CuboidScene(const CuboidOptions& options) {
  CheckOptions(options);
  Mesh mesh;
  mesh.nodes = CuboidNodes(options);
  mesh.elements = CuboidElements(options.cells);
  const Eigen::Array<bool, 1, Eigen::Dynamic> held =
      mesh.nodes.row(2).array() == 0.0;
  return HeldAndLoaded(std::move(mesh), held, options.force);
}

Scene OrganScene(const OrganOptions& options) {
  CheckOptions(options);
  Mesh mesh = OrganMesh(options.tetrahedra);
  const Eigen::Array<bool, 1, Eigen::Dynamic> held = BareArea(mesh);
  mesh.nodes *= options.length;
  return HeldAndLoaded(std::move(mesh), held, options.force);
}

}  // namespace elastimate
