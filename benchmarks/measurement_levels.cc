#include "benchmarks/measurement_levels.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr double kNoise = 1e-3;
constexpr double kLoadCell = 0.005;
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double kSize = 10;  // Of the plate along x and y.

enum class Side { kLeft, kBottom, kRight };

bool IsOn(const Mesh& mesh, Eigen::Index node, Side side) {
  const double tolerance = 1e-9 * kSize;
  switch (side) {
    case Side::kLeft:
      return mesh.nodes(0, node) < tolerance;
    case Side::kBottom:
      return mesh.nodes(1, node) < tolerance;
    case Side::kRight:
      break;
  }
  return mesh.nodes(0, node) > kSize - tolerance;
}

std::vector<int> NodesOf(const Mesh& mesh, Side side) {
  std::vector<int> nodes;
  for (int node = 0; node < mesh.NumNodes(); ++node) {
    if (IsOn(mesh, node, side)) {
      nodes.push_back(node);
    }
  }
  return nodes;
}

// Holds the plate as a camera without noise sees it, and the force that the
// load cell shows.
struct World {
  Scene scene;
  double force;  // On the right end, along x.
};

World MakeWorld(PlateEnds ends, int cells) {
  PlateOptions options;
  options.size = {kSize, kSize};
  options.ends = ends;
  options.cells = cells;
  World world = {PlateScene(options), 0};
  Scene& scene = world.scene;
  Equilibrium model(scene, SolverKind::kCholesky);
  const Eigen::Vector2d truth = kMeasuredSteel.Parameters();
  if (!model.Solve(model.Forces().Parameters().Moduli(truth))) {
    throw std::runtime_error("the plate of the study has no solution");
  }
  scene.load_cases[0].displacement =
      model.Displacement().col(0).reshaped(2, scene.mesh.NumNodes());
  scene.origin = Origin::kComputed;
  if (ends == PlateEnds::kTraction) {
    world.force = options.force;
  } else {
    // There are no loads, so the internal forces of the right end are its
    // reaction.
    const Eigen::MatrixXd force =
        model.Forces()
            .Multiply(model.Forces().Parameters().Moduli(truth),
                      model.Displacement())
            .reshaped(2, scene.mesh.NumNodes());
    for (const int node : NodesOf(scene.mesh, Side::kRight)) {
      world.force += force(0, node);
    }
  }
  return world;
}

// Holds what differs between the measurements of the levels.
struct Plan {
  double noise = kNoise;
  double correlation_length = 0;
  double outliers = 0;
  double load_cell = kLoadCell;
  double camera = 0;  // Of its motion, along each axis and, over the size,
                      // about it.
};

void Disturb(const Plan& plan, std::mt19937_64& generator, Scene& scene) {
  const Eigen::Index n = scene.mesh.NumNodes();
  Eigen::MatrixXd& u = scene.load_cases[0].displacement;
  u += DrawNoiseAt(scene.mesh.nodes, plan.noise, plan.correlation_length,
                   generator);
  if (plan.outliers > 0) {
    std::vector<Eigen::Index> all(n);
    for (Eigen::Index node = 0; node < n; ++node) {
      all[node] = node;
    }
    u += DrawOutliers(all, plan.outliers, plan.noise, 2, n, generator);
  }
  if (plan.camera > 0) {
    const Eigen::Vector3d motion(plan.camera, -plan.camera,
                                 plan.camera / kSize);
    for (Eigen::Index node = 0; node < n; ++node) {
      u.col(node) += RigidMotionsAt(scene.mesh.nodes.col(node)) * motion;
    }
  }
}

// Returns the force of the nodes of the right end, with the error of the load
// cell.
Resultant LoadCell(const World& world, const Plan& plan,
                   std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return {
      NodesOf(world.scene.mesh, Side::kRight),
      Eigen::Vector2d(world.force * (1 + plan.load_cell * normal(generator)),
                      kNotMeasured),
      Eigen::Vector2d::Constant(plan.load_cell * world.force)};
}

void Hold(const Mesh& mesh, Side side, bool along_x, bool along_y,
          ComponentMask& mask) {
  for (const int node : NodesOf(mesh, side)) {
    mask(0, node) = mask(0, node) || along_x;
    mask(1, node) = mask(1, node) || along_y;
  }
}

// Holds both axes of symmetry and the right end at displacements that were
// measured.
void HoldWhereMeasured(Scene& scene) {
  ComponentMask& held = scene.supports.held;
  held.setConstant(false);
  Hold(scene.mesh, Side::kLeft, true, false, held);
  Hold(scene.mesh, Side::kBottom, false, true, held);
  Hold(scene.mesh, Side::kRight, true, true, held);
  scene.supports.displacement.setZero();
  scene.supports.unknown = held;
  scene.load_cases[0].loads.clear();
}

Scene WithMeasuredEnds(const World& world, const Plan& plan,
                       std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Scene scene = world.scene;
  Disturb(plan, generator, scene);
  HoldWhereMeasured(scene);
  scene.load_cases[0].resultants = {LoadCell(world, plan, generator)};
  return scene;
}

// This is wrong: the displacements that were measured at the ends are taken as
// exact.
Scene WithEndsTakenAsExact(const World& world, const Plan& plan,
                           std::uint64_t seed) {
  Scene scene = WithMeasuredEnds(world, plan, seed);
  scene.supports.displacement = scene.load_cases[0].displacement;
  scene.supports.unknown.resize(0, 0);
  return scene;
}

// The axes of symmetry are exact supports, and the right end moved as a rigid
// body.
Scene WithRigidGrip(const World& world, const Plan& plan, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Scene scene = world.scene;
  Disturb(plan, generator, scene);
  Supports& supports = scene.supports;
  supports.displacement.setZero();
  supports.unknown.setConstant(2, scene.mesh.NumNodes(), false);
  RigidFace grip = {{},
                    Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(2, true)};
  for (const int node : NodesOf(scene.mesh, Side::kRight)) {
    grip.nodes.push_back(node);
    supports.held.col(node).setConstant(true);
    supports.unknown.col(node).setConstant(true);
  }
  supports.rigid_faces = {grip};
  scene.load_cases[0].loads.clear();
  scene.load_cases[0].resultants = {LoadCell(world, plan, generator)};
  return scene;
}

// This is wrong: the force of a rigid grip is taken as a uniform traction.
Scene WithUniformTraction(const World& world, const World& of_traction,
                          const Plan& plan, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Scene scene = of_traction.scene;
  scene.load_cases[0].displacement = world.scene.load_cases[0].displacement;
  scene.origin = Origin::kComputed;
  Disturb(plan, generator, scene);
  for (Load& load : scene.load_cases[0].loads) {
    std::get<SurfaceForce>(load).force(0) = world.force;
  }
  return scene;
}

// Traction and supports are known.  The camera moved, and `is_said` says
// whether the scene allows for that.
Scene WithMovedCamera(const World& world, const Plan& plan, bool is_said,
                      std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Scene scene = world.scene;
  Disturb(plan, generator, scene);
  scene.is_rigid_motion_free = is_said;
  return scene;
}

// Measures at random points inside the elements instead of at the nodes.
Scene AtPoints(const World& world, const Plan& plan, int num_points,
               std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  Scene scene = world.scene;
  LoadCase& load_case = scene.load_cases[0];
  std::uniform_int_distribution<int> element(
      0, static_cast<int>(scene.mesh.NumElements()) - 1);
  std::uniform_real_distribution<double> place(-1, 1);
  MeshPoints& points = load_case.points.points;
  points.elements.resize(num_points);
  points.local.resize(2, num_points);
  for (int i = 0; i < num_points; ++i) {
    points.elements(i) = element(generator);
    points.local.col(i) << place(generator), place(generator);
  }
  load_case.points.displacement =
      Interpolate(scene.mesh, points, load_case.displacement) +
      DrawNoiseAt(Interpolate(scene.mesh, points, scene.mesh.nodes), plan.noise,
                  0, generator);
  load_case.displacement.resize(0, 0);
  return scene;
}

std::string Number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  return text.back() == '.' ? text.substr(0, text.size() - 1) : text;
}

// Adds levels with measured ends and a load cell, whose noise or other errors
// `set` chooses.
void AddLevels(const World& world, const std::string& factor,
               const std::vector<double>& values,
               const std::function<void(double value, Plan& plan)>& set,
               std::vector<MeasurementLevel>& levels) {
  for (const double value : values) {
    Plan plan;
    set(value, plan);
    levels.push_back(
        {factor, Number(value), "right", [world, plan](std::uint64_t seed) {
           return WithMeasuredEnds(world, plan, seed);
         }});
  }
}

void AddPoints(const World& world, std::vector<MeasurementLevel>& levels) {
  for (const int num_points : {20, 60, 200, 600}) {
    levels.push_back({"points [1]", std::to_string(num_points), "right",
                      [world, num_points](std::uint64_t seed) {
                        return AtPoints(world, {}, num_points, seed);
                      }});
  }
}

void AddCamera(const World& world, std::vector<MeasurementLevel>& levels) {
  for (const double motion : {0.0, 0.01, 0.1, 1.0}) {
    Plan plan;
    plan.camera = motion;
    for (const bool is_said : {true, false}) {
      levels.push_back({"camera motion [mm]", Number(motion),
                        is_said ? "right" : "fixed camera",
                        [world, plan, is_said](std::uint64_t seed) {
                          return WithMovedCamera(world, plan, is_said, seed);
                        }});
    }
  }
}

void AddEnds(const World& traction, const World& grips,
             std::vector<MeasurementLevel>& levels) {
  const std::string factor = "ends";
  const Plan plan;
  levels.push_back(
      {factor, "measured", "right", [traction, plan](std::uint64_t seed) {
         return WithMeasuredEnds(traction, plan, seed);
       }});
  levels.push_back({factor, "measured", "taken as exact",
                    [traction, plan](std::uint64_t seed) {
                      return WithEndsTakenAsExact(traction, plan, seed);
                    }});
  levels.push_back(
      {factor, "rigid grip", "right", [grips, plan](std::uint64_t seed) {
         return WithRigidGrip(grips, plan, seed);
       }});
  levels.push_back({factor, "rigid grip", "measured ends",
                    [grips, plan](std::uint64_t seed) {
                      return WithMeasuredEnds(grips, plan, seed);
                    }});
  levels.push_back({factor, "rigid grip", "uniform traction",
                    [grips, traction, plan](std::uint64_t seed) {
                      return WithUniformTraction(grips, traction, plan, seed);
                    }});
  levels.push_back(
      {factor, "measured", "rigid grip", [traction, plan](std::uint64_t seed) {
         return WithRigidGrip(traction, plan, seed);
       }});
}

}  // namespace

std::vector<MeasurementLevel> MeasurementLevels(int cells) {
  const World traction = MakeWorld(PlateEnds::kTraction, cells);
  const World grips = MakeWorld(PlateEnds::kGrips, cells);
  const double spacing = kSize / cells;
  std::vector<MeasurementLevel> levels;
  AddPoints(traction, levels);
  AddLevels(
      traction, "outliers [%]", {0, 1, 5, 20},
      [](double value, Plan& plan) { plan.outliers = value / 100; }, levels);
  AddLevels(
      traction, kCorrelationFactor, {0, 0.5, 1, 2, 4},
      [spacing](double value, Plan& plan) {
        plan.correlation_length = value * spacing;
      },
      levels);
  AddLevels(
      traction, "load cell [%]", {0.1, 0.5, 2, 5},
      [](double value, Plan& plan) { plan.load_cell = value / 100; }, levels);
  AddCamera(traction, levels);
  AddEnds(traction, grips, levels);
  return levels;
}

std::vector<MeasurementLevel> NoiseLevels(int cells) {
  const World traction = MakeWorld(PlateEnds::kTraction, cells);
  std::vector<MeasurementLevel> levels;
  AddLevels(
      traction, "noise [um]", {0.2, 1, 4},
      [](double value, Plan& plan) { plan.noise = value / 1000; }, levels);
  return levels;
}

}  // namespace elastimate
