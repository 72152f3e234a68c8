#include "tests/scenes.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/linear_scene.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/scene_builder.h"
#include "tests/dense_reference.h"

namespace elastimate::testing {

Mesh BoxMesh(const Eigen::Vector3i& cells, const Eigen::Vector3d& size) {
  const Eigen::Vector3i points = cells.array() + 1;
  const auto node = [&](int i, int j, int k) {
    return i + points(0) * (j + points(1) * k);
  };
  Mesh mesh;
  mesh.nodes.resize(3, points.prod());
  for (int k = 0; k < points(2); ++k) {
    for (int j = 0; j < points(1); ++j) {
      for (int i = 0; i < points(0); ++i) {
        mesh.nodes.col(node(i, j, k)) = Eigen::Array3d(i, j, k) * size.array() /
                                        cells.cast<double>().array();
      }
    }
  }
  // Each path goes along the axes from one corner of a cube to the opposite
  // one.  It is the order in which the axes are taken.
  constexpr int kPaths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  mesh.elements.resize(4, 6 * Eigen::Index(cells.prod()));
  Eigen::Index element = 0;
  for (int k = 0; k < cells(2); ++k) {
    for (int j = 0; j < cells(1); ++j) {
      for (int i = 0; i < cells(0); ++i) {
        for (const auto& path : kPaths) {
          Eigen::Vector3i corner(i, j, k);
          mesh.elements(0, element) = node(i, j, k);
          for (int step = 0; step < 3; ++step) {
            ++corner(path[step]);
            mesh.elements(step + 1, element) =
                node(corner(0), corner(1), corner(2));
          }
          ++element;
        }
      }
    }
  }
  return mesh;
}

Mesh Distorted(Mesh mesh) {
  const double length = mesh.nodes.row(2).maxCoeff();
  for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i);
    const double height = x(2) / length;
    const double angle = 0.6 * height;
    const double width = 1 - 0.3 * height;
    mesh.nodes.col(i) << width *
                             (std::cos(angle) * x(0) - std::sin(angle) * x(1)),
        width * (std::sin(angle) * x(0) + std::cos(angle) * x(1)),
        x(2) + 0.2 * x(0) * x(0) - 0.1 * x(0) * x(1);
    mesh.nodes(0, i) += 0.2 * length * height * height;
  }
  return mesh;
}

Scene HeldAtBottom(const Mesh& mesh, const Mesh& reference,
                   const Eigen::Vector3d& force_per_node) {
  Scene scene;
  scene.mesh = mesh;
  scene.supports.held = ComponentMask::Constant(3, mesh.NumNodes(), false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  NodalForces forces{Eigen::MatrixXd::Zero(3, mesh.NumNodes())};
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (reference.nodes(2, node) == 0) {
      scene.supports.held.col(node) = true;
    } else {
      forces.force.col(node) = force_per_node;
    }
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads.emplace_back(forces);
  return scene;
}

std::vector<std::string> SmallSceneNames() {
  return {"cuboid", "bar", "organ"};
}

void HoldPlane(int axis, double place, double displacement, Scene& scene) {
  const Eigen::Index d = scene.mesh.Dimension();
  const double kFar = 1e6;
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(d, -kFar);
  Eigen::VectorXd upper = Eigen::VectorXd::Constant(d, kFar);
  lower(axis) = upper(axis) = place;
  Eigen::Array<bool, Eigen::Dynamic, 1> components =
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(d, false);
  components(axis) = true;
  Eigen::VectorXd held = Eigen::VectorXd::Zero(d);
  held(axis) = displacement;
  HoldInBox(lower, upper, components, held, scene);
}

Scene SmallScene(const std::string& shape) {
  if (shape == "cuboid") {
    const Mesh mesh = BoxMesh({3, 3, 2}, {1, 1, 0.7});
    return HeldAtBottom(mesh, mesh, {0, 0, -30});
  }
  if (shape == "bar") {
    const Mesh mesh = BoxMesh({2, 2, 10}, {0.2, 0.2, 1});
    return HeldAtBottom(mesh, mesh, {0.1, 0.2, -1});
  }
  if (shape == "organ") {
    const Mesh box = BoxMesh({3, 3, 4}, {1, 0.8, 1.2});
    return HeldAtBottom(Distorted(box), box, {5, -10, 20});
  }
  throw std::invalid_argument("no scene " + shape);
}

double AddNoise(double relative, std::uint64_t seed, Scene& scene) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const DegreesOfFreedom dofs(scene.supports);
  double first_sd = 0;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    auto displacement = scene.load_cases[k].displacement.reshaped();
    double square_sum = 0;
    for (const Eigen::Index dof : dofs.free) {
      square_sum += displacement(dof) * displacement(dof);
    }
    const double sd =
        relative * std::sqrt(square_sum / static_cast<double>(dofs.NumFree()));
    for (const Eigen::Index dof : dofs.free) {
      displacement(dof) += sd * normal(generator);
    }
    first_sd = k == 0 ? sd : first_sd;
  }
  return first_sd;
}

void TakeDisplacements(const Scene& finer, Scene& scene) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        finer.load_cases[k].displacement.leftCols(scene.mesh.NumNodes());
  }
  scene.origin = Origin::kMeasured;
}

void MeasureInRefinedWorld(const IsotropicElasticity& elasticity,
                           Scene& scene) {
  Scene finer = QuadraticScene(LinearScene(QuadraticScene(scene)));
  Measure(elasticity, finer);
  TakeDisplacements(finer, scene);
}

Scene WithThreeForces(const Scene& scene) {
  Scene three = scene;
  const double size = std::get<NodalForces>(scene.load_cases[0].loads[0])
                          .force.colwise()
                          .norm()
                          .maxCoeff();
  three.load_cases.clear();
  for (int axis = 0; axis < 3; ++axis) {
    NodalForces forces{Eigen::MatrixXd::Zero(3, scene.mesh.NumNodes())};
    forces.force.row(axis).setConstant(size);
    LoadCase load_case;
    load_case.loads.emplace_back(forces);
    three.load_cases.push_back(load_case);
  }
  return three;
}

// Maps the square section of a box to a disc.
Mesh CylinderMesh(int cells_per_side) {
  constexpr double kPi = 3.14159265358979323846;
  Mesh mesh = BoxMesh({cells_per_side, cells_per_side, 2}, {2, 2, 1});
  for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
    const double a = mesh.nodes(0, i) - 1;
    const double b = mesh.nodes(1, i) - 1;
    const double radius = std::max(std::abs(a), std::abs(b));
    double angle = 0;
    if (std::abs(a) >= std::abs(b) && radius > 0) {
      angle = (a > 0 ? 0 : kPi) + kPi / 4 * b / a;
    } else if (radius > 0) {
      angle = (b > 0 ? kPi / 2 : -kPi / 2) - kPi / 4 * a / b;
    }
    mesh.nodes(0, i) = radius * std::cos(angle);
    mesh.nodes(1, i) = radius * std::sin(angle);
  }
  return mesh;
}

Scene UnderBodyForce(Scene scene) {
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector3d(100, 20, -300)}};
  return scene;
}

Scene ShearedBlock() {
  Scene scene = SmallScene("cuboid");
  const Mesh& mesh = scene.mesh;
  Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  displacement.row(0) = 0.01 * mesh.nodes.row(1);
  const Eigen::MatrixXd stiffness =
      DenseStiffness<double>(mesh, HookeMatrix(5e4, 0.3));
  NodalForces forces{
      (stiffness * displacement.reshaped()).reshaped(3, mesh.NumNodes())};
  // The held corners are those at the origin, along x, and along y.
  scene.supports.held.setConstant(false);
  scene.supports.held.col(0).setConstant(true);
  scene.supports.held.col(3) << false, true, true;
  scene.supports.held.col(12) << false, false, true;
  scene.load_cases[0].loads = {forces};
  scene.load_cases[0].displacement = displacement;
  scene.origin = Origin::kComputed;
  return scene;
}

}  // namespace elastimate::testing
