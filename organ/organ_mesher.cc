#include "elastimate/organ/organ_mesher.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/organ/organ_shape.h"

namespace elastimate {
namespace {

/// Runs a step of the meshing; Gmsh throws strings.
template <typename Step>
void Run(const std::string& name, Step step) {
  try {
    step();
  } catch (const std::string& reason) {
    throw std::runtime_error("Gmsh failed to " + name + ": " + reason + ".");
  }
}

/// Holds Gmsh with the options for an organ of this edge length.
class GmshSession {
 public:
  explicit GmshSession(double edge_length) {
    gmsh::initialize(0, nullptr, false);
    SetOption("General.Terminal", 0);
    SetOption("General.NumThreads", 1);
    SetOption("Mesh.RandomSeed", 1);
    SetOption("Mesh.Algorithm", 6);    // Frontal Delaunay.
    SetOption("Mesh.Algorithm3D", 1);  // Delaunay.
    SetOption("Mesh.Optimize", 0);     // Optimize() does.
    // The size is the edge length everywhere: the number of tetrahedra hardly
    // jumps when it changes.
    SetOption("Mesh.MeshSizeFromPoints", 0);
    SetOption("Mesh.MeshSizeExtendFromBoundary", 0);
    SetOption("Mesh.MeshSizeMin", edge_length);
    SetOption("Mesh.MeshSizeMax", edge_length);
  }
  ~GmshSession() {
    try {
      gmsh::finalize();
    } catch (...) {  // NOLINT(bugprone-empty-catch): nothing left to undo.
    }
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  static void SetOption(const char* name, double value) {
    gmsh::option::setNumber(name, value);
  }
};

// The triangulated surface from which Gmsh makes its geometry: an octahedron
// subdivided into a lattice of points (i, j, k), |i| + |j| + |k| = kSteps,
// blown up to the sphere, and mapped to the organ.  The plane j = 0 cuts it
// along the organ's rim into a front and a back, which are flat enough for one
// parametrisation each.
constexpr int kSteps = 48;

constexpr int kLine = 1;  // Gmsh's element types.
constexpr int kTriangle = 2;
constexpr int kTetrahedron = 4;
constexpr int kPoint = 15;

/// Returns |k| of a lattice point.
int Rest(int i, int j) { return kSteps - std::abs(i) - std::abs(j); }

/// Returns the node at the lattice point whose k has this sign.
std::size_t NodeTag(int i, int j, int sign_k) {
  const bool below = sign_k < 0 && Rest(i, j) > 0;
  return 1 + 2 * ((i + kSteps) * (2 * kSteps + 1) + j + kSteps) + below;
}

/// Each dimension has two entities, which a coordinate's sign tells apart: the
/// ends by i, the halves of the rim by k, the front and the back by j.
int EntityTag(int sign) { return sign < 0 ? 1 : 2; }

void AddLatticeNode(int i, int j, int sign_k) {
  const int k = sign_k * Rest(i, j);
  const bool at_end = std::abs(i) == kSteps;
  const int dimension = at_end ? 0 : j == 0 ? 1 : 2;
  const int entity = EntityTag(at_end ? i : j == 0 ? k : j);
  const Eigen::Vector3d point =
      OrganPoint(Eigen::Vector3d(i, j, k).normalized());
  gmsh::model::mesh::addNodes(dimension, entity, {NodeTag(i, j, sign_k)},
                              {point.x(), point.y(), point.z()});
}

void AddLatticeNodes() {
  for (int i = -kSteps; i <= kSteps; ++i) {
    const int width = kSteps - std::abs(i);
    for (int j = -width; j <= width; ++j) {
      AddLatticeNode(i, j, 1);
      if (Rest(i, j) > 0) {
        AddLatticeNode(i, j, -1);
      }
    }
  }
}

/// Returns the lines of the lower or the upper half of the rim, from end to
/// end.
std::vector<std::size_t> RimLines(int sign_k) {
  std::vector<std::size_t> lines;
  for (int i = -kSteps; i < kSteps; ++i) {
    lines.insert(lines.end(),
                 {NodeTag(i, 0, sign_k), NodeTag(i + 1, 0, sign_k)});
  }
  return lines;
}

/// Adds the triangles of one of the octahedron's faces.
void AddFace(int sign_i, int sign_j, int sign_k,
             std::vector<std::size_t>& triangles) {
  const auto tag = [&](int i, int j) {
    return NodeTag(sign_i * i, sign_j * j, sign_k);
  };
  const bool mirrored = sign_i * sign_j * sign_k < 0;
  const auto add = [&](std::size_t p, std::size_t q, std::size_t r) {
    triangles.insert(triangles.end(), {p, mirrored ? r : q, mirrored ? q : r});
  };
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; i + j < kSteps; ++j) {
      add(tag(i, j), tag(i + 1, j), tag(i, j + 1));
      if (i + j + 1 < kSteps) {
        add(tag(i + 1, j), tag(i + 1, j + 1), tag(i, j + 1));
      }
    }
  }
}

/// Returns the triangles of the front or the back.
std::vector<std::size_t> SideTriangles(int sign_j) {
  std::vector<std::size_t> triangles;
  for (const int sign_i : {-1, 1}) {
    for (const int sign_k : {-1, 1}) {
      AddFace(sign_i, sign_j, sign_k, triangles);
    }
  }
  return triangles;
}

void AddSurface() {
  gmsh::model::add("lattice");
  const std::vector<int> both = {EntityTag(-1), EntityTag(1)};
  for (const int dimension : {0, 1, 2}) {
    for (const int entity : both) {
      gmsh::model::addDiscreteEntity(
          dimension, entity, dimension == 0 ? std::vector<int>{} : both);
    }
  }
  AddLatticeNodes();
  for (const int sign : {-1, 1}) {
    using gmsh::model::mesh::addElementsByType;
    const int entity = EntityTag(sign);
    addElementsByType(entity, kPoint, {}, {NodeTag(sign * kSteps, 0, 1)});
    addElementsByType(entity, kLine, {}, RimLines(sign));
    addElementsByType(entity, kTriangle, {}, SideTriangles(sign));
  }
}

/// Replaces the lattice by a mesh of the organ's surface.  Gmsh puts its nodes
/// on the triangles of the lattice; they are moved out to the organ's surface.
void MeshSurface() {
  gmsh::model::mesh::createGeometry();
  gmsh::model::mesh::generate(2);
  std::vector<std::size_t> tags;
  std::vector<double> positions;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, positions, parameters);
  for (auto point = positions.begin(); point != positions.end(); point += 3) {
    Eigen::Map<Eigen::Vector3d> position(&*point);
    position = OrganPoint(BallPoint(position).normalized());
  }
  std::vector<std::size_t> elements;
  std::vector<std::size_t> corners;
  gmsh::model::mesh::getElementsByType(kTriangle, elements, corners);
  // A new model, because in this one meshing the volume moves the nodes back.
  gmsh::model::remove();
  gmsh::model::add("organ");
  gmsh::model::addDiscreteEntity(2, 1);
  gmsh::model::mesh::addNodes(2, 1, tags, positions);
  gmsh::model::mesh::addElementsByType(1, kTriangle, {}, corners);
}

void MeshVolume() {
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop({1})});
  gmsh::model::geo::synchronize();
  gmsh::model::mesh::generate(3);
}

/// Repeats passes: each leaves a few slivers behind, which the next removes
/// because it is asked for a higher quality.
void Optimize() {
  for (const double threshold : {0.4, 0.5, 0.6}) {
    GmshSession::SetOption("Mesh.OptimizeThreshold", threshold);
    gmsh::model::mesh::optimize("");
  }
}

Mesh CurrentMesh() {
  std::vector<std::size_t> tags;
  std::vector<double> positions;
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(tags, positions, parameters);
  std::vector<std::size_t> elements;
  std::vector<std::size_t> corners;
  gmsh::model::mesh::getElementsByType(kTetrahedron, elements, corners);
  if (corners.empty()) {
    throw std::runtime_error("Gmsh made no tetrahedra of the organ.");
  }
  Mesh mesh;
  mesh.nodes = Eigen::Matrix3Xd::Map(positions.data(), 3, tags.size());
  std::vector<int> node_of_tag(*std::max_element(tags.begin(), tags.end()) + 1);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    node_of_tag[tags[i]] = static_cast<int>(i);
  }
  mesh.elements.resize(4, elements.size());
  std::transform(corners.begin(), corners.end(), mesh.elements.data(),
                 [&](std::size_t tag) { return node_of_tag[tag]; });
  return mesh;
}

Mesh MeshWithEdges(double edge_length) {
  Mesh mesh;
  Run("start", [&] {
    const GmshSession session(edge_length);
    Run("add the organ's surface", AddSurface);
    Run("mesh the organ's surface", MeshSurface);
    Run("mesh the organ's volume", MeshVolume);
    Run("optimise the organ's mesh", Optimize);
    Run("hand over the organ's mesh", [&] { mesh = CurrentMesh(); });
  });
  return mesh;
}

/// Returns the edge length that gave `tetrahedra` tetrahedra, by a fit to
/// meshes of 200 to 2 000 000.
double EstimatedEdgeLength(double tetrahedra) {
  double edge_length = 0.1;
  for (int i = 0; i < 20; ++i) {
    edge_length = std::cbrt((0.475 + 1.5 * edge_length) / tetrahedra);
  }
  return edge_length;
}

}  // namespace

Mesh MeshOrgan(int tetrahedra) {
  constexpr int kMaxTrials = 30;
  constexpr double kTolerance = 0.05;
  constexpr double kGoodAngle = 15.0 * kDegree;
  // For more tetrahedra, another mesh takes too long, and is as likely to have
  // a sliver.
  constexpr int kMaxTetrahedraToRepeat = 100000;
  const int max_fitting = tetrahedra <= kMaxTetrahedraToRepeat ? 8 : 1;
  Mesh best;
  double best_angle = -1.0;
  int num_fitting = 0;
  double edge_length = EstimatedEdgeLength(tetrahedra);
  for (int trial = 0; trial < kMaxTrials; ++trial) {
    Mesh mesh = MeshWithEdges(edge_length);
    const double ratio = static_cast<double>(mesh.NumElements()) / tetrahedra;
    if (std::abs(ratio - 1.0) <= kTolerance) {
      const double angle = SmallestDihedralAngles(mesh).minCoeff();
      if (angle > best_angle) {
        best = std::move(mesh);
        best_angle = angle;
      }
      if (best_angle >= kGoodAngle || ++num_fitting == max_fitting) {
        return best;
      }
    }
    // The number goes about as the inverse cube of the edge length.  A small
    // further step makes sure that no edge length is tried twice.
    edge_length *= 0.999 * std::cbrt(ratio);
  }
  if (num_fitting > 0) {
    return best;
  }
  throw std::runtime_error("No mesh of the organ has " +
                           std::to_string(tetrahedra) +
                           " tetrahedra within 5 %.");
}

}  // namespace elastimate
