#include "elastimate/io/examples/example_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/examples/organ_mesh.h"

namespace elastimate {
namespace {

constexpr int kMinOrganTetrahedra = 200;
constexpr int kMaxOrganTetrahedra = 2000000;
constexpr int kMaxCuboidTetrahedra = 10000000;
constexpr int kTetrahedraPerCell = 5;

// A scene may have these magnitudes (RequireRepresentable).
constexpr double kSmallest = 1e-50;
constexpr double kLargest = 1e50;

// Beyond this, the reader takes the tetrahedra of a cell for flat.
constexpr double kMaxCellAspect = 1e5;

// This square number of cells is about the largest number of other geometries.
constexpr int kMaxPlateCells = 1414;
// Beyond this, the cells beside a corner are slivers.
constexpr double kMaxPlateAspect = 100;
// The largest radius over the shorter edge; beyond it, hardly any ligament is
// left.
constexpr double kLargestHole = 0.99;
// The usual elongation over W.
constexpr double kUsualElongation = 1e-3;

template <typename Value>
std::string TextOf(const Value& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

template <typename Values>
std::string CommaSeparated(const Values& values) {
  std::string text;
  for (const auto& value : values) {
    text += (text.empty() ? "" : ",") + TextOf(value);
  }
  return text;
}

void Require(bool condition, const std::string& option,
             const std::string& value, const std::string& rule) {
  if (!condition) {
    throw std::invalid_argument(option + "=" + value + "; " + rule);
  }
}

std::string Range() {
  return "from " + TextOf(kSmallest) + " to " + TextOf(kLargest);
}

bool IsInRange(double value) { return value >= kSmallest && value <= kLargest; }

void CheckForce(const Eigen::VectorXd& force) {
  Require(force.allFinite() &&
              (force.isZero(0) || IsInRange(force.cwiseAbs().maxCoeff())),
          "force", CommaSeparated(force),
          "the largest must be " + Range() + ", or all zero");
}

/// Checks a grid of cells, each of which is cut into no more than five
/// elements.
void CheckGrid(const Eigen::VectorXi& cells, const Eigen::VectorXd& size) {
  Require(cells.minCoeff() >= 1, "cells", CommaSeparated(cells),
          "each must be at least 1");
  Require(
      kTetrahedraPerCell * cells.cast<double>().prod() <= kMaxCuboidTetrahedra,
      "cells", CommaSeparated(cells),
      "the product must be at most " +
          std::to_string(kMaxCuboidTetrahedra / kTetrahedraPerCell));
  Require(std::all_of(size.begin(), size.end(), IsInRange), "size",
          CommaSeparated(size), "each must be " + Range());
  const Eigen::ArrayXd edges = size.array() / cells.cast<double>().array();
  Require(edges.maxCoeff() <= kMaxCellAspect * edges.minCoeff(), "size",
          CommaSeparated(size),
          "a cell of " + CommaSeparated(edges) +
              " is too flat; its longest edge must be at most " +
              TextOf(kMaxCellAspect) + " times its shortest");
}

void CheckOptions(const CuboidOptions& options) {
  Require(
      options.kind == ElementKind::kTet4 || options.kind == ElementKind::kHex8,
      "elements", std::string(TopologyOf(options.kind).name),
      "a cuboid is made of tet4 or hex8");
  CheckGrid(options.cells, options.size);
  CheckForce(options.force);
}

/// Checks the elements and the section of a planar `geometry`.
void CheckSheet(const std::string& geometry, ElementKind kind,
                const Section& section) {
  Require(kind == ElementKind::kTri3 || kind == ElementKind::kQuad4, "elements",
          std::string(TopologyOf(kind).name),
          "a " + geometry + " is made of tri3 or quad4");
  Require(section.model != SectionModel::kSolid, "model",
          std::string(SectionModelName(section.model)),
          "a " + geometry + " is in plane_stress or plane_strain");
  Require(IsInRange(section.thickness), "thickness", TextOf(section.thickness),
          "it must be " + Range());
}

void CheckOptions(const RectangleOptions& options) {
  CheckSheet("rectangle", options.kind, options.section);
  CheckGrid(options.cells, options.size);
  CheckForce(options.force);
}

void CheckOptions(const PlateOptions& options) {
  CheckSheet("plate", options.kind, options.section);
  Require(std::all_of(options.size.begin(), options.size.end(), IsInRange),
          "size", CommaSeparated(options.size), "each must be " + Range());
  Require(options.size.maxCoeff() <= kMaxPlateAspect * options.size.minCoeff(),
          "size", CommaSeparated(options.size),
          "the plate is too slender; its longer edge must be at most " +
              TextOf(kMaxPlateAspect) + " times the shorter");
  const double smallest = options.size.maxCoeff() / kMaxCellAspect;
  const double largest = kLargestHole * options.size.minCoeff();
  Require(options.hole >= smallest && options.hole <= largest, "hole",
          TextOf(options.hole),
          "a plate of size " + CommaSeparated(options.size) +
              " takes a hole of radius " + TextOf(smallest) + " to " +
              TextOf(largest));
  Require(options.cells >= 2 && options.cells <= kMaxPlateCells, "cells",
          TextOf(options.cells),
          "it must be from 2 to " + std::to_string(kMaxPlateCells));
  CheckForce(Eigen::VectorXd::Constant(1, options.force));
  Require(!options.elongation || IsInRange(std::abs(*options.elongation)),
          "elongation", TextOf(options.elongation.value_or(0)),
          "its magnitude must be " + Range());
}

void CheckOptions(const OrganOptions& options) {
  Require(options.tetrahedra >= kMinOrganTetrahedra &&
              options.tetrahedra <= kMaxOrganTetrahedra,
          "tetrahedra", TextOf(options.tetrahedra),
          "it must be from " + std::to_string(kMinOrganTetrahedra) + " to " +
              std::to_string(kMaxOrganTetrahedra));
  Require(IsInRange(options.length), "length", TextOf(options.length),
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

/// The five tetrahedra of a cell: four corners that are cut off, and what
/// remains.  Bits 0, 1 and 2 of a corner are its steps along x, y and z.
using CellCut = std::array<std::array<int, 4>, kTetrahedraPerCell>;

/// Faces of neighbouring cells have the same diagonal when every other cell is
/// cut the mirrored way.
constexpr CellCut kEvenCut = {
    {{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}}};
constexpr CellCut kOddCut = {
    {{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 5, 0, 6}, {7, 3, 5, 6}, {0, 5, 3, 6}}};

Eigen::MatrixXi CuboidTetrahedra(const Eigen::Vector3i& cells) {
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

Eigen::MatrixXi CuboidHexahedra(const Eigen::Vector3i& cells) {
  const int row = cells.x() + 1;
  const int layer = row * (cells.y() + 1);
  Eigen::MatrixXi elements(8, cells.prod());
  Eigen::Index element = 0;
  for (int k = 0; k < cells.z(); ++k) {
    for (int j = 0; j < cells.y(); ++j) {
      for (int i = 0; i < cells.x(); ++i) {
        const int n = i + row * j + layer * k;
        elements.col(element++) << n, n + 1, n + row + 1, n + row, n + layer,
            n + layer + 1, n + layer + row + 1, n + layer + row;
      }
    }
  }
  return elements;
}

Eigen::Matrix2Xd RectangleNodes(const RectangleOptions& options) {
  Eigen::Matrix2Xd nodes(2, (options.cells.array() + 1).prod());
  Eigen::Index node = 0;
  for (int j = 0; j <= options.cells.y(); ++j) {
    for (int i = 0; i <= options.cells.x(); ++i) {
      // Divided first, so that the last node is at the size exactly.
      nodes.col(node++) = Eigen::Array2d(i, j) /
                          options.cells.cast<double>().array() *
                          options.size.array();
    }
  }
  return nodes;
}

Eigen::MatrixXi RectangleElements(ElementKind kind,
                                  const Eigen::Vector2i& cells) {
  const int row = cells.x() + 1;
  const bool is_cut = kind == ElementKind::kTri3;
  Eigen::MatrixXi elements(is_cut ? 3 : 4, (is_cut ? 2 : 1) * cells.prod());
  Eigen::Index element = 0;
  for (int j = 0; j < cells.y(); ++j) {
    for (int i = 0; i < cells.x(); ++i) {
      const int n = i + row * j;
      if (!is_cut) {
        elements.col(element++) << n, n + 1, n + row + 1, n + row;
      } else if ((i + j) % 2 == 0) {
        elements.col(element++) << n, n + 1, n + row + 1;
        elements.col(element++) << n, n + row + 1, n + row;
      } else {
        elements.col(element++) << n, n + 1, n + row;
        elements.col(element++) << n + 1, n + row + 1, n + row;
      }
    }
  }
  return elements;
}

/// Returns where rays from the origin at about equal angles, one of them
/// through the corner, leave a rectangle of this size: from (W, 0) to (0, H), 2
/// x (n + 1).
Eigen::Matrix2Xd EndsOfRays(const Eigen::Vector2d& size, int n) {
  constexpr double kRightAngle = 1.5707963267948966;
  const double corner = std::atan2(size.y(), size.x());
  const int n_right = std::clamp<int>(
      static_cast<int>(std::lround(n * corner / kRightAngle)), 1, n - 1);
  Eigen::Matrix2Xd ends(2, n + 1);
  for (int j = 0; j <= n; ++j) {
    if (j < n_right) {
      const double angle = corner * j / n_right;
      ends.col(j) << size.x(), size.x() * std::tan(angle);
    } else if (j == n_right) {
      ends.col(j) = size;
    } else {  // Measured from the y axis, so that the last one is on it
              // exactly.
      const double angle = (kRightAngle - corner) * (n - j) / (n - n_right);
      ends.col(j) << size.y() * std::tan(angle), size.y();
    }
  }
  return ends;
}

Eigen::Matrix2Xd PlateNodes(const PlateOptions& options) {
  const int n = options.cells;
  const Eigen::Matrix2Xd ends = EndsOfRays(options.size, n);
  Eigen::Matrix2Xd nodes(2, ends.cols() * ends.cols());
  Eigen::Index node = 0;
  for (int j = 0; j <= n; ++j) {
    const double ratio = options.hole / ends.col(j).norm();
    for (int i = 0; i <= n; ++i) {
      nodes.col(node++) = ends.col(j) * std::pow(ratio, 1 - double(i) / n);
    }
  }
  return nodes;
}

/// Returns the facets all of whose nodes are at the largest x.
Eigen::MatrixXi EndFacets(const Mesh& mesh) {
  const double end = mesh.nodes.row(0).maxCoeff();
  const Eigen::MatrixXi boundary = BoundaryFacets(mesh);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < boundary.cols(); ++i) {
    if ((mesh.nodes(0, boundary.col(i)).array() == end).all()) {
      chosen.push_back(i);
    }
  }
  return boundary(Eigen::all, chosen);
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

/// Returns the surface nodes about where a liver is tied to the diaphragm, its
/// bare area, at the back and the top of the right lobe.
Eigen::Array<bool, 1, Eigen::Dynamic> BareArea(const Mesh& organ) {
  constexpr double kRadius = 0.225;  // Of an organ of length 1.
  const Eigen::Vector3d center(-0.16144296140505487, 0.11372351560737334,
                               0.2433738249689186);
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
  mesh.kind = options.kind;
  mesh.elements = mesh.kind == ElementKind::kHex8
                      ? CuboidHexahedra(options.cells)
                      : CuboidTetrahedra(options.cells);
  const Eigen::Array<bool, 1, Eigen::Dynamic> held =
      mesh.nodes.row(2).array() == 0.0;
  return HeldAndLoaded(std::move(mesh), held, options.force);
}

Scene RectangleScene(const RectangleOptions& options) {
  CheckOptions(options);
  Scene scene;
  scene.mesh = {options.kind,
                options.section,
                RectangleNodes(options),
                RectangleElements(options.kind, options.cells),
                {}};
  scene.supports.held =
      (scene.mesh.nodes.row(0).array() == 0.0).replicate(2, 1);
  scene.supports.displacement.setZero(2, scene.mesh.NumNodes());
  scene.load_cases.emplace_back().loads.emplace_back(
      SurfaceForce{EndFacets(scene.mesh), options.force});
  return scene;
}

Scene PlateScene(const PlateOptions& options) {
  CheckOptions(options);
  Scene scene;
  scene.mesh = {
      options.kind,
      options.section,
      PlateNodes(options),
      RectangleElements(options.kind, Eigen::Vector2i::Constant(options.cells)),
      {}};
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  Supports& supports = scene.supports;
  // Symmetry holds each component on the line across it.
  supports.held = nodes.array() == 0.0;
  supports.displacement.setZero(2, nodes.cols());
  LoadCase& load_case = scene.load_cases.emplace_back();
  if (options.ends == PlateEnds::kTraction) {
    load_case.loads.emplace_back(SurfaceForce{
        EndFacets(scene.mesh), Eigen::Vector2d(options.force, 0.0)});
    return scene;
  }
  const double elongation =
      options.elongation.value_or(kUsualElongation * options.size.x());
  for (Eigen::Index node = 0; node < nodes.cols(); ++node) {
    if (nodes(0, node) == options.size.x()) {
      supports.held.col(node).setConstant(true);
      supports.displacement(0, node) = elongation;
    }
  }
  return scene;
}

Scene OrganScene(const OrganOptions& options) {
  CheckOptions(options);
  Mesh mesh = OrganMesh(options.tetrahedra);
  const Eigen::Array<bool, 1, Eigen::Dynamic> held = BareArea(mesh);
  mesh.nodes *= options.length;
  return HeldAndLoaded(std::move(mesh), held, options.force);
}

}  // namespace elastimate
