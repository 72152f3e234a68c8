#include "tests/estimators/maps/map_scenes.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/linear_scene.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/scene_builder.h"
#include "tests/scenes.h"

namespace elastimate::testing {
namespace {

// Returns an n x n x ... grid of points from 0 to 1, the first coordinate the
// fastest.
Mesh UnitGrid(ElementKind kind, int n) {
  const int dimension = DimensionOf(kind);
  if (kind == ElementKind::kTet4) {
    return BoxMesh({n, n, n}, {1, 1, 1});
  }
  const int side = n + 1;
  Mesh mesh;
  mesh.kind = kind;
  if (dimension == 2) {
    mesh.section.model = SectionModel::kPlaneStrain;
  }
  mesh.nodes.resize(dimension,
                    dimension == 2 ? side * side : side * side * side);
  for (int i = 0; i < mesh.nodes.cols(); ++i) {
    mesh.nodes(0, i) = double(i % side) / n;
    mesh.nodes(1, i) = double(i / side % side) / n;
    if (dimension == 3) {
      mesh.nodes(2, i) = double(i / side / side) / n;
    }
  }
  std::vector<std::vector<int>> elements;
  for (int z = 0; z < (dimension == 3 ? n : 1); ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const int a = x + side * (y + side * z);
        const std::vector<int> base = {a, a + 1, a + 1 + side, a + side};
        if (kind == ElementKind::kTri3) {
          elements.push_back({base[0], base[1], base[2]});
          elements.push_back({base[0], base[2], base[3]});
          continue;
        }
        elements.push_back(base);
        for (int i = 0; i < 4 && dimension == 3; ++i) {
          elements.back().push_back(base[i] + side * side);
        }
      }
    }
  }
  mesh.elements.resize(Eigen::Index(elements[0].size()),
                       Eigen::Index(elements.size()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t i = 0; i < elements[e].size(); ++i) {
      mesh.elements(Eigen::Index(i), Eigen::Index(e)) = elements[e][i];
    }
  }
  return mesh;
}

}  // namespace

double LogModulusAt(const std::string& name, const Eigen::VectorXd& point) {
  const bool is_planar = point.size() == 2;
  const double height = point(point.size() - 1);
  const auto is_within = [&](double radius, const Eigen::VectorXd& centre) {
    return (point - centre).norm() < radius;
  };
  if (name == "hom") {
    return 0;
  }
  if (name.rfind("inc", 0) == 0) {
    Eigen::VectorXd centre = Eigen::VectorXd::Constant(point.size(), 0.5);
    centre(point.size() - 1) = 0.55;
    return is_within(is_planar ? 0.2 : 0.25, centre)
               ? std::log(std::stod(name.substr(3)))
               : 0;
  }
  if (name == "two") {
    const double radius = is_planar ? 0.12 : 0.15;
    const Eigen::VectorXd middle = Eigen::VectorXd::Constant(point.size(), 0.5);
    const Eigen::VectorXd off = 0.17 * Eigen::VectorXd::Unit(point.size(), 0);
    return is_within(radius, middle - off) || is_within(radius, middle + off)
               ? std::log(5.0)
               : 0;
  }
  if (name == "grad") {
    return std::log(3.0) * (height - 0.5) + 0.3 * std::sin(2 * M_PI * point(0));
  }
  if (name == "lay") {
    const double layers[] = {1, 3, 1, 2};
    return std::log(layers[std::min(3, int(4 * height))]);
  }
  if (name == "thin") {
    return std::log(height < 0.5 ? 1.0 : height < 0.5625 ? 2.0 : 4.0);
  }
  throw std::invalid_argument("no map " + name);
}

namespace {

// A body before its displacements, up to their noise, are known.
struct UnmeasuredMap {
  MapScene map;
  Scene truth;  // With a material of each element.
  Eigen::VectorXd parameters;
};

UnmeasuredMap MakeUnmeasured(const std::string& name, ElementKind kind,
                             int cells, double poisson_ratio) {
  UnmeasuredMap made;
  MapScene& map = made.map;
  Scene scene = UnsupportedScene(UnitGrid(kind, cells));
  const int dimension = scene.mesh.Dimension();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(dimension);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(dimension);
  const Eigen::VectorXd up = Eigen::VectorXd::Unit(dimension, dimension - 1);
  HoldInBox(zero, one - up, scene);
  Eigen::VectorXd traction = -up;
  if (dimension == 3) {
    traction(0) = 0.2;
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {TractionInBox(scene.mesh, up, one, traction)};

  const int num_elements = int(scene.mesh.NumElements());
  map.log_moduli.resize(num_elements);
  Scene& truth = made.truth;
  truth = scene;
  truth.mesh.regions.setLinSpaced(num_elements, 0, num_elements - 1);
  truth.materials.resize(num_elements);
  Eigen::VectorXd& parameters = made.parameters;
  parameters.resize(2 * num_elements);
  for (int e = 0; e < num_elements; ++e) {
    map.log_moduli(e) = LogModulusAt(name, ElementCentre(scene.mesh, e));
    truth.materials[e].regions = {e};
    parameters.segment<2>(2 * e) << std::exp(map.log_moduli(e)), poisson_ratio;
  }
  map.scene = scene;
  return made;
}

}  // namespace

MapScene MakeMapScene(const std::string& name, ElementKind kind, int cells,
                      double relative_noise, std::uint64_t seed,
                      double poisson_ratio) {
  UnmeasuredMap made = MakeUnmeasured(name, kind, cells, poisson_ratio);
  Scene& scene = made.map.scene;
  scene.load_cases[0].displacement =
      DisplacementsAt(made.truth, made.parameters)
          .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
  scene.origin = Origin::kComputed;
  if (relative_noise > 0) {
    made.map.noise_sd = AddNoise(relative_noise, seed, scene);
  }
  return made.map;
}

MapScene MakeSpecimen(const std::string& name, ElementKind kind, int cells,
                      double relative_noise, std::uint64_t seed) {
  UnmeasuredMap made = MakeUnmeasured(name, kind, cells, 0.3);
  Scene world = QuadraticScene(LinearScene(QuadraticScene(made.truth)));
  MeasureMaterials(made.parameters, world);
  TakeDisplacements(world, made.map.scene);
  made.map.noise_sd = AddNoise(relative_noise, seed, made.map.scene);
  return made.map;
}

namespace {

Scene BlockUnderTraction(int cells) {
  Scene scene =
      UnsupportedScene(BoxMesh({cells, cells, cells + 1}, {1, 1, 1.2}));
  HoldInBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 0), scene);
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {
      TractionInBox(scene.mesh, Eigen::Vector3d(0, 0, 1.2),
                    Eigen::Vector3d(1, 1, 1.2), Eigen::Vector3d(0.3, 0, -1))};
  return scene;
}

// Makes elements three times as stiff where their centre is.
template <class IsStiff>
void MakeStiff(const IsStiff& is_stiff, Scene& scene) {
  scene.mesh.regions.resize(scene.mesh.NumElements());
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    scene.mesh.regions(e) = is_stiff(ElementCentre(scene.mesh, e)) ? 1 : 0;
  }
  scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
}

MapScene MeasuredWithNoise(Scene world, Scene scene, double relative_noise) {
  MapScene map;
  MeasureMaterials(Eigen::Vector4d(2, 0.35, 6, 0.35), world);
  TakeDisplacements(world, scene);
  scene.materials.clear();
  scene.mesh.regions.resize(0);
  map.noise_sd = AddNoise(relative_noise, 1, scene);
  map.scene = scene;
  return map;
}

}  // namespace

MapScene HeldOutBlock(int cells, double relative_noise) {
  Scene scene = BlockUnderTraction(cells);
  MakeStiff(
      [](const Eigen::Vector3d& centre) {
        return centre(0) > 0.35 && centre(1) < 0.7 && centre(2) > 0.4 &&
               centre(2) < 1.05;
      },
      scene);
  return MeasuredWithNoise(QuadraticScene(LinearScene(QuadraticScene(scene))),
                           scene, relative_noise);
}

MapScene HeldOutBall(int cells, double relative_noise) {
  const Scene scene = BlockUnderTraction(cells);
  Scene world = LinearScene(QuadraticScene(scene));
  MakeStiff(
      [](const Eigen::Vector3d& centre) {
        return (centre - Eigen::Vector3d(0.56, 0.45, 0.65)).norm() < 0.33;
      },
      world);
  return MeasuredWithNoise(QuadraticScene(world), scene, relative_noise);
}

double MapError(const Eigen::VectorXd& estimate, const Eigen::VectorXd& truth) {
  const Eigen::VectorXd a = estimate.array() - estimate.mean();
  const Eigen::VectorXd b = truth.array() - truth.mean();
  return b.norm() > 0 ? (a - b).norm() / b.norm()
                      : std::sqrt(a.squaredNorm() / double(a.size()));
}

}  // namespace elastimate::testing
