#include "benchmarks/stability_factors.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <sstream>
#include <utility>

#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

using Levels = std::vector<StabilityLevel>;
using Nodes = std::vector<Eigen::Index>;

constexpr IsotropicElasticity kTruth = {10e3, 0.3};
constexpr double kDeviation = 0.01;
constexpr double kOutlierDistance = 20;  // In standard deviations of the noise.
// The noise has the seed of the trial.  The choice of nodes adds this offset,
// so that it does not depend on the noise.
constexpr std::uint64_t kFirstChoiceSeed = 1000000;

const Eigen::Vector3i kCells = {5, 4, 4};
constexpr double kCellEdge = 0.1;
const Eigen::Vector3d kTraction = {200, 0, -100};

std::string Text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

double Length(const Mesh& mesh) { return mesh.nodes.row(0).maxCoeff(); }

Nodes NodesWhere(const Eigen::Array<bool, 1, Eigen::Dynamic>& condition) {
  Nodes nodes;
  for (Eigen::Index node = 0; node < condition.size(); ++node) {
    if (condition[node]) {
      nodes.push_back(node);
    }
  }
  return nodes;
}

Nodes NodesAt(const Mesh& mesh, double x) {
  return NodesWhere((mesh.nodes.row(0).array() - x).abs() < 1e-9);
}

Eigen::MatrixXi FacetsAtEnd(const Mesh& mesh, int axis) {
  const double end = mesh.nodes.row(axis).maxCoeff();
  return BoundaryFacetsWhere(
      mesh, [&](int node) { return mesh.nodes(axis, node) == end; });
}

// Returns a block that is held at x = 0 and bears no loads.
Scene HeldBlock(const Eigen::Vector3i& cells) {
  CuboidOptions options;
  options.cells = cells;
  options.size = kCellEdge * cells.cast<double>();
  Scene scene = CuboidScene(options);
  scene.supports.held =
      (scene.mesh.nodes.row(0).array() == 0).replicate<3, 1>();
  scene.load_cases = {LoadCase()};
  return scene;
}

Scene Measured(Scene scene, const IsotropicElasticity& truth = kTruth) {
  Measure(truth, scene);
  return scene;
}

Scene Pulled(Scene scene, const Eigen::Vector3d& traction = kTraction) {
  scene.load_cases[0].loads = {Traction{FacetsAtEnd(scene.mesh, 0), traction}};
  return scene;
}

Scene Base(const IsotropicElasticity& truth = kTruth) {
  return Measured(Pulled(HeldBlock(kCells)), truth);
}

StabilityLevel WithNoiseOnly(std::string factor, std::string level,
                             const Scene& exact,
                             const IsotropicElasticity& truth = kTruth,
                             double deviation = kDeviation) {
  return {std::move(factor), std::move(level), truth,
          [exact, deviation](std::uint64_t seed) {
            return WithNoise(exact, deviation, seed);
          },
          NoiseSd(exact, deviation)(0)};
}

Nodes Choose(const Nodes& nodes, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 generator(kFirstChoiceSeed + seed);
  Nodes chosen;
  std::sample(nodes.begin(), nodes.end(), std::back_inserter(chosen), count,
              generator);
  return chosen;
}

std::size_t Share(double percent, const Nodes& nodes) {
  return static_cast<std::size_t>(
      std::lround(percent / 100 * static_cast<double>(nodes.size())));
}

void AddPoissonRatios(Levels& levels) {
  const auto add = [&](const char* factor, double poisson_ratio) {
    const IsotropicElasticity truth = {kTruth.youngs_modulus, poisson_ratio};
    levels.push_back(
        WithNoiseOnly(factor, Text(poisson_ratio), Base(truth), truth));
  };
  for (const double nu : {0.3, 0.4, 0.45, 0.49, 0.499, 0.4999}) {
    add("nu near 1/2", nu);
  }
  for (const double nu : {0., -0.5, -0.9, -0.99}) {
    add("nu near -1", nu);
  }
}

void AddNoise(Levels& levels) {
  const Scene exact = Base();
  for (const double percent : {0., 0.01, 0.1, 1., 3., 10., 30., 100.}) {
    levels.push_back(WithNoiseOnly("noise [%]", Text(percent), exact, kTruth,
                                   percent / 100));
  }
}

void AddSlenderness(Levels& levels) {
  for (const auto& [slenderness, width] :
       {std::pair(1, 4), {3, 3}, {10, 2}, {30, 1}, {100, 1}}) {
    const Scene block = HeldBlock({slenderness * width, width, width});
    levels.push_back(WithNoiseOnly("slenderness [1]", Text(slenderness),
                                   Measured(Pulled(block))));
  }
}

double SmallestAngle(const Mesh& mesh) {
  return SmallestDihedralAngles(mesh).minCoeff() * 180 / M_PI;
}

// Moves the node in the middle, in one of its tetrahedra, towards the opposite
// facet, until the smallest angle is `angle`.
Mesh WithSliver(const Mesh& mesh, double angle) {
  const Eigen::Vector3d middle = mesh.nodes.rowwise().mean();
  Eigen::Index node = 0;
  (mesh.nodes.colwise() - middle).colwise().norm().minCoeff(&node);
  Eigen::Index element = 0;
  while ((mesh.elements.col(element).array() != int(node)).all()) {
    ++element;
  }
  const Eigen::Vector3d facet =
      (4 * ElementCentre(mesh, element) - mesh.nodes.col(node)) / 3;
  const auto moved = [&](double share) {
    Mesh result = mesh;
    result.nodes.col(node) += share * (facet - mesh.nodes.col(node));
    return result;
  };
  double good = 0;
  double flat = 1;
  while (SmallestAngle(moved(good)) > angle * (1 + 1e-6)) {
    const double share = (good + flat) / 2;
    (SmallestAngle(moved(share)) > angle ? good : flat) = share;
  }
  return moved(good);
}

void AddSlivers(Levels& levels) {
  const Scene block = Pulled(HeldBlock(kCells));
  const std::string factor = "smallest angle [degree]";
  levels.push_back(WithNoiseOnly(
      factor, Text(std::round(SmallestAngle(block.mesh))), Measured(block)));
  for (const double angle : {10., 1., 0.1}) {
    Scene scene = block;
    scene.mesh = WithSliver(block.mesh, angle);
    levels.push_back(WithNoiseOnly(factor, Text(angle), Measured(scene)));
  }
}

// Returns a single tetrahedron that is held at three of its nodes.
Scene Tetrahedron() {
  Scene scene;
  scene.mesh.nodes =
      kCellEdge *
      Eigen::Matrix<double, 3, 4>{{0, 0, 0, 1}, {0, 1, 0, 0.3}, {0, 0, 1, 0.3}};
  scene.mesh.elements = Eigen::Vector4i(0, 1, 2, 3);
  scene.supports.held.setConstant(3, 4, true);
  scene.supports.held.col(3) = false;
  scene.supports.displacement.setZero(3, 4);
  NodalForces force{Eigen::MatrixXd::Zero(3, 4)};
  force.force.col(3) = kCellEdge * kCellEdge * kTraction;
  scene.load_cases.emplace_back().loads = {force};
  return scene;
}

void AddMeshSizes(Levels& levels) {
  const auto add = [&](const Scene& scene) {
    levels.push_back(WithNoiseOnly("tetrahedra [1]",
                                   std::to_string(scene.mesh.NumElements()),
                                   Measured(scene)));
  };
  for (const Eigen::Vector3i& cells :
       {kCells, Eigen::Vector3i(3, 3, 3), Eigen::Vector3i(2, 2, 2),
        Eigen::Vector3i(2, 1, 1), Eigen::Vector3i(1, 1, 1)}) {
    add(Pulled(HeldBlock(cells)));
  }
  add(Tetrahedron());
}

void AddLoads(Levels& levels) {
  const Scene block = HeldBlock(kCells);
  const Mesh& mesh = block.mesh;
  const auto add = [&](const char* level, const Load& load) {
    Scene scene = block;
    scene.load_cases[0].loads = {load};
    levels.push_back(WithNoiseOnly("load", level, Measured(scene)));
  };
  const Eigen::MatrixXi end = FacetsAtEnd(mesh, 0);
  add("oblique", Traction{end, kTraction});
  add("tension", Traction{end, Eigen::Vector3d(200, 0, 0)});
  add("bending", Traction{end, Eigen::Vector3d(0, 0, -100)});
  add("pressure", Pressure{FacetsAtEnd(mesh, 2), 200});
  const Nodes end_nodes = NodesAt(mesh, Length(mesh));
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Index node : end_nodes) {
    center += mesh.nodes.col(node) / static_cast<double>(end_nodes.size());
  }
  NodalForces indentation{Eigen::MatrixXd::Zero(3, mesh.NumNodes())};
  NodalForces torsion = indentation;
  for (const Eigen::Index node : end_nodes) {
    const Eigen::Vector3d arm = mesh.nodes.col(node) - center;
    torsion.force.col(node) = 5 * Eigen::Vector3d::UnitX().cross(arm);
    if (arm.norm() < kCellEdge / 2) {
      indentation.force(0, node) = -10;
    }
  }
  add("indented node", indentation);
  add("torsion", torsion);
}

// Rotates a measurement as the far part of a bending specimen rotates: each
// node's deformed position is turned about the y axis through the middle of the
// support, by an angle that grows linearly from the support to the far end.
Scene Rotated(Scene scene, double degrees) {
  const Mesh& mesh = scene.mesh;
  const Nodes held = NodesAt(mesh, 0);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Index node : held) {
    center += mesh.nodes.col(node) / static_cast<double>(held.size());
  }
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Vector3d x = mesh.nodes.col(node);
    auto u = scene.load_cases[0].displacement.col(node);
    const double angle = degrees * M_PI / 180 * x[0] / Length(mesh);
    const Eigen::AngleAxisd rotation(angle, Eigen::Vector3d::UnitY());
    u = center + rotation * (x + u - center) - x;
  }
  return scene;
}

void AddRotations(Levels& levels) {
  for (const double degrees : {0., 1., 5., 15., 45.}) {
    levels.push_back(WithNoiseOnly("rotation [degree]", Text(degrees),
                                   Rotated(Base(), degrees)));
  }
}

void AddOutliers(Levels& levels) {
  const Scene exact = Base();
  const double noise_sd = NoiseSd(exact, kDeviation)(0);
  const Nodes free = NodesWhere(!exact.supports.held.row(0));
  for (const double percent : {0., 1., 3., 10., 30.}) {
    const auto measure = [=](std::uint64_t seed) {
      Scene scene = WithNoise(exact, kDeviation, seed);
      std::mt19937_64 generator(kFirstChoiceSeed + seed);
      for (const Eigen::Index node : Choose(free, Share(percent, free), seed)) {
        scene.load_cases[0].displacement.col(node) += DrawNoise(
            NoiseLaw::kGaussian, 3, kOutlierDistance * noise_sd, generator);
      }
      return scene;
    };
    levels.push_back({"outliers [% of nodes]", Text(percent), kTruth, measure,
                      noise_sd, true});
  }
}

// The model takes nodes of the support for free, or nodes of the next layer for
// held.
void AddWrongSupports(Levels& levels) {
  const Scene exact = Base();
  const double noise_sd = NoiseSd(exact, kDeviation)(0);
  const auto add = [&](const char* factor, double percent, const Nodes& nodes,
                       bool is_held) {
    const auto measure = [=](std::uint64_t seed) {
      Scene scene = exact;
      for (const Eigen::Index node :
           Choose(nodes, Share(percent, nodes), seed)) {
        scene.supports.held.col(node) = is_held;
        scene.load_cases[0].displacement.col(node).setZero();
      }
      return WithNoise(scene, kDeviation, seed);
    };
    levels.push_back({factor, Text(percent), kTruth, measure, noise_sd});
  };
  for (const double percent : {0., 4., 20., 50., 80., 100.}) {
    add("support nodes left free [%]", percent, NodesAt(exact.mesh, 0), false);
  }
  for (const double percent : {0., 4., 20., 50., 100.}) {
    add("next nodes held [%]", percent, NodesAt(exact.mesh, kCellEdge), true);
  }
}

void AddForceScales(Levels& levels) {
  const Scene exact = Base();
  for (const double scale : {1., 0.8, 1.25, 0.5, 2.}) {
    Scene scene = exact;
    std::get<Traction>(scene.load_cases[0].loads[0]).traction *= scale;
    levels.push_back(WithNoiseOnly("force scale [1]", Text(scale), scene));
    levels.back().is_knowable = scale == 1;
  }
}

void AddObservations(Levels& levels) {
  const Scene exact = Base();
  const Nodes free = NodesWhere(!exact.supports.held.row(0));
  levels.push_back(WithNoiseOnly("observed nodes", "all", exact));
  Scene surface = exact;
  surface.load_cases[0].observed.setConstant(3, exact.mesh.NumNodes(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(exact.mesh);
  for (const int node : facets.reshaped()) {
    surface.load_cases[0].observed.col(node) = true;
  }
  levels.push_back(WithNoiseOnly("observed nodes", "surface", surface));
  for (const std::size_t count : {10, 5, 3, 2, 1}) {
    const auto measure = [=](std::uint64_t seed) {
      Scene scene = WithNoise(exact, kDeviation, seed);
      ComponentMask& observed = scene.load_cases[0].observed;
      observed.setConstant(3, scene.mesh.NumNodes(), false);
      for (const Eigen::Index node : Choose(free, count, seed)) {
        observed.col(node) = true;
      }
      return scene;
    };
    levels.push_back({"observed nodes", std::to_string(count), kTruth, measure,
                      NoiseSd(exact, kDeviation)(0)});
  }
}

Eigen::MatrixXd DenseStiffness(const Mesh& mesh,
                               const IsotropicElasticity& elasticity) {
  const Eigen::Index size = 3 * mesh.NumNodes();
  const StiffnessProducts products =
      MultiplyStiffnessBasis(mesh, Eigen::MatrixXd::Identity(size, size));
  const double nu = elasticity.poisson_ratio;
  return elasticity.youngs_modulus / ((1 + nu) * (1 - 2 * nu)) *
         (products.h + nu * products.j);
}

// Returns the tetrahedra of the cells that are not at the surface.
Mesh Inclusion(const Mesh& mesh) {
  const Eigen::Vector3d size = mesh.nodes.rowwise().maxCoeff();
  Mesh inclusion = mesh;
  Eigen::Index count = 0;
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    const Eigen::Vector3d center = ElementCentre(mesh, element);
    if (center.minCoeff() > kCellEdge &&
        (size - center).minCoeff() > kCellEdge) {
      inclusion.elements.col(count++) = mesh.elements.col(element);
    }
  }
  inclusion.elements.conservativeResize(Eigen::NoChange, count);
  return inclusion;
}

void AddInclusions(Levels& levels) {
  const Scene block = Pulled(HeldBlock(kCells));
  const DegreesOfFreedom dofs(block.supports);
  const Eigen::MatrixXd stiffness = DenseStiffness(block.mesh, kTruth);
  const Eigen::MatrixXd inclusion =
      DenseStiffness(Inclusion(block.mesh), kTruth);
  const Eigen::VectorXd force = dofs.Restrict(AssembleLoadCases(block));
  for (const double contrast : {1., 2., 5., 10., 30., 100.}) {
    const Eigen::MatrixXd both = stiffness + (contrast - 1) * inclusion;
    const Eigen::VectorXd displacement =
        dofs.Extend(both(dofs.free, dofs.free).eval().ldlt().solve(force));
    Scene scene = block;
    scene.load_cases[0].displacement =
        displacement.reshaped(3, block.mesh.NumNodes());
    scene.origin = Origin::kComputed;
    levels.push_back(
        WithNoiseOnly("inclusion stiffness [1]", Text(contrast), scene));
  }
}

}  // namespace

std::vector<StabilityLevel> StabilityLevels() {
  Levels levels;
  AddPoissonRatios(levels);
  AddNoise(levels);
  AddSlenderness(levels);
  AddSlivers(levels);
  AddMeshSizes(levels);
  AddLoads(levels);
  AddRotations(levels);
  AddOutliers(levels);
  AddWrongSupports(levels);
  AddForceScales(levels);
  AddObservations(levels);
  AddInclusions(levels);
  return levels;
}

}  // namespace elastimate
