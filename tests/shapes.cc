#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <stdexcept>

#include "tests/scenes.h"

namespace elastimate::testing {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// Returns a box of these cells over [-1, 1] x [-1, 1] x [0, 1], moved by a map.
Mesh MappedBox(const Vector3i& cells,
               const std::function<Vector3d(double, double, double)>& map) {
  Mesh mesh = BoxMesh(cells, {2, 2, 1});
  for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
    const Vector3d p = mesh.nodes.col(i);
    mesh.nodes.col(i) = map(p.x() - 1, p.y() - 1, p.z());
  }
  return mesh;
}

// Returns the unit cubes of a grid that are kept.
Mesh Voxels(const Vector3i& cells,
            const std::function<bool(int, int, int)>& is_kept) {
  const Mesh box = BoxMesh(cells, cells.cast<double>());
  std::vector<Eigen::Index> kept;
  std::vector<int> place(box.NumNodes(), -1);
  for (Eigen::Index e = 0; e < box.NumElements(); ++e) {
    Vector3d centre = Vector3d::Zero();
    for (const int node : box.elements.col(e)) {
      centre += box.nodes.col(node) / 4;
    }
    if (is_kept(int(centre.x()), int(centre.y()), int(centre.z()))) {
      kept.push_back(e);
      for (const int node : box.elements.col(e)) {
        place[node] = 0;
      }
    }
  }
  int num_nodes = 0;
  for (int& p : place) {
    p = p < 0 ? -1 : num_nodes++;
  }
  Mesh mesh;
  mesh.nodes.resize(3, num_nodes);
  for (Eigen::Index i = 0; i < box.NumNodes(); ++i) {
    if (place[i] >= 0) {
      mesh.nodes.col(place[i]) = box.nodes.col(i);
    }
  }
  mesh.elements = box.elements(Eigen::all, kept);
  for (int& node : mesh.elements.reshaped()) {
    node = place[node];
  }
  return mesh;
}

// Maps the square [-1, 1]^2 to the unit disk.
Vector3d Disk(double x, double y) {
  return {x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2), 0};
}

Mesh Bracket() {
  return Voxels({8, 3, 8}, [](int i, int, int k) { return i < 2 || k >= 6; });
}

// A spherical cap.
Mesh Dome() {
  return MappedBox({8, 8, 2}, [](double x, double y, double z) {
    const Vector3d d = Disk(x, y);
    const double radius = 3 + 0.2 * z;
    const double polar = 1.1 * d.norm();
    const double azimuth = std::atan2(d.y(), d.x());
    return Vector3d(radius * std::sin(polar) * std::cos(azimuth),
                    radius * std::sin(polar) * std::sin(azimuth),
                    radius * std::cos(polar));
  });
}

Mesh Dumbbell() {
  return MappedBox({4, 4, 12}, [](double x, double y, double z) {
    const double radius = 1 - 0.65 * std::exp(-std::pow((z - 0.5) / 0.2, 4));
    return Vector3d(radius * Disk(x, y) + 6 * z * Vector3d::UnitZ());
  });
}

Mesh Frame() {
  return Voxels({10, 2, 12}, [](int i, int, int k) {
    return i < 2 || i >= 8 || k < 2 || k >= 9;
  });
}

// The edges of eight cells of a cubic grid.
Mesh Lattice() {
  return Voxels({9, 9, 9}, [](int i, int j, int k) {
    return (i % 4 == 0) + (j % 4 == 0) + (k % 4 == 0) >= 2;
  });
}

// Three quarters of a torus.
Mesh Ring() {
  return MappedBox({3, 3, 18}, [](double x, double y, double z) {
    const Vector3d d = 0.8 * Disk(x, y);
    const double angle = 4.7 * z;
    return Vector3d((3 + d.x()) * std::cos(angle),
                    (3 + d.x()) * std::sin(angle), d.y());
  });
}

// Two turns of a helix.
Mesh Spring() {
  return MappedBox({2, 2, 40}, [](double x, double y, double z) {
    const Vector3d d = 0.5 * Disk(x, y);
    const double angle = 12 * z;
    return Vector3d((3 + d.x()) * std::cos(angle),
                    (3 + d.x()) * std::sin(angle), 4 * z + d.y());
  });
}

// A trunk with a cross of boughs, three of which bend upwards.
Mesh Tree() {
  return Voxels({9, 9, 10}, [](int i, int j, int k) {
    const bool in_middle_x = std::abs(i - 4) <= 1;
    const bool in_middle_y = std::abs(j - 4) <= 1;
    if (k < 5) {
      return in_middle_x && in_middle_y;
    }
    if (k < 7) {
      return in_middle_x || in_middle_y;
    }
    return (i <= 1 && in_middle_y) || (j >= 7 && in_middle_x) ||
           (i == 8 && j == 4 && k < 9);
  });
}

// Twisted, and a tenth as wide at its upper end.
Mesh Wedge() {
  return MappedBox({4, 4, 10}, [](double x, double y, double z) {
    const Eigen::AngleAxisd twist(1.5 * z, Vector3d::UnitZ());
    return Vector3d(twist *
                    Vector3d((1.1 - z) * x, 0.5 * (1.1 - z) * y, 4 * z));
  });
}

const std::map<std::string, std::function<Mesh()>>& Shapes() {
  static const std::map<std::string, std::function<Mesh()>> shapes = {
      {"bracket", Bracket}, {"dome", Dome},       {"dumbbell", Dumbbell},
      {"frame", Frame},     {"lattice", Lattice}, {"ring", Ring},
      {"spring", Spring},   {"tree", Tree},       {"wedge", Wedge}};
  return shapes;
}

Vector3d ForceOf(const std::string& load, const Vector3d& arm, bool is_upper) {
  if (load == "gravity") {
    return {0.3, 0, -1};
  }
  if (load == "swelling") {
    return arm;
  }
  if (!is_upper) {
    return Vector3d::Zero();
  }
  if (load == "tension") {
    return {0, 0, 1};
  }
  if (load == "torsion") {
    return {-arm.y(), arm.x(), 0};
  }
  if (load == "bending") {
    return {1, 0.3, 0};
  }
  throw std::invalid_argument("no load " + load);
}

}  // namespace

std::vector<std::string> ShapeNames() {
  std::vector<std::string> names;
  for (const auto& [name, make] : Shapes()) {
    names.push_back(name);
  }
  return names;
}

Mesh ShapeMesh(const std::string& shape) { return Shapes().at(shape)(); }

std::vector<std::string> ShapeLoads() {
  return {"tension", "torsion", "bending", "gravity", "swelling"};
}

Scene LoadedScene(const Mesh& mesh, const std::string& load) {
  Scene scene = HeldAtBottom(mesh, mesh, Vector3d::Zero());
  const double low = mesh.nodes.row(2).minCoeff();
  const double height = mesh.nodes.row(2).maxCoeff() - low;
  const Vector3d centre = mesh.nodes.rowwise().mean();
  Eigen::MatrixXd& force =
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force;
  for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
    const double z = (mesh.nodes(2, i) - low) / height;
    scene.supports.held.col(i).setConstant(z < 0.12);
    force.col(i) = ForceOf(load, mesh.nodes.col(i) - centre, z > 0.9);
  }
  return scene;
}

Scene ShapeScene(const std::string& shape, const std::string& load) {
  return LoadedScene(ShapeMesh(shape), load);
}

}  // namespace elastimate::testing
