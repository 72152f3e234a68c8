#include "benchmarks/large_deformation_limits.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kModulus = 1e4;
constexpr double kColumnLength = 6;
// Where theory is exact, so is Newton's method to this part of the height.
constexpr double kLargestError = 1e-6;

const char* StatusOf(EquilibriumStatus status) {
  switch (status) {
    case EquilibriumStatus::kDone:
      return "equilibrium";
    case EquilibriumStatus::kUnstable:
      return "unstable";
    case EquilibriumStatus::kInverted:
      return "inverted";
    case EquilibriumStatus::kNoEquilibrium:
      break;
  }
  return "no_equilibrium";
}

// What theory says of a load.
struct Theory {
  EquilibriumStatus status = EquilibriumStatus::kDone;
  double share = 1;  // Of the load that can be reached.
  // The displacement of the top along z; not known where it is no number.
  double top = kNotKnown;
  // Whether no state at all bears the load, so that a search that finds nothing
  // is right as well.
  bool is_beyond_all = false;

  std::string Expected() const {
    return std::string(StatusOf(status)) +
           (is_beyond_all ? " or no_equilibrium" : "");
  }
  bool Takes(EquilibriumStatus found) const {
    return found == status ||
           (is_beyond_all && found == EquilibriumStatus::kNoEquilibrium);
  }
};

Scene UprightBar(const Eigen::Vector3i& cells, const Eigen::Vector3d& size,
                 const std::string& law) {
  CuboidOptions options;
  options.kind = ElementKind::kHex8;
  options.cells = cells;
  options.size = size;
  Scene scene = CuboidScene(options);
  scene.materials.resize(1);
  scene.materials[0].law = law;
  scene.load_cases[0].loads.clear();
  return scene;
}

void PressTop(const Eigen::Vector3d& force, Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const double top = mesh.nodes.row(2).maxCoeff();
  scene.load_cases[0].loads = {SurfaceForce{
      BoundaryFacetsWhere(mesh,
                          [&](int node) { return mesh.nodes(2, node) == top; }),
      force}};
}

class LimitTable {
 public:
  void Add(const std::string& specimen, double load, const Scene& scene,
           double poisson_ratio, const Theory& theory) {
    LargeStrainEquilibrium model(scene);
    const LargeStrainState state =
        model.Solve(model.Forces().Parameters().Moduli(
                        Eigen::Vector2d(kModulus, poisson_ratio)),
                    0);
    const double top = scene.mesh.nodes.row(2).maxCoeff();
    double error = kNotKnown;
    if (state.status == EquilibriumStatus::kDone && std::isfinite(theory.top)) {
      error = 0;
      for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
        if (scene.mesh.nodes(2, node) == top) {
          error = std::max(
              error,
              std::abs(state.displacement(3 * node + 2) - theory.top) / top);
        }
      }
    }
    const bool is_right =
        theory.Takes(state.status) && !(error > kLargestError);
    table_.AddRow({specimen, scene.materials[0].law, load, theory.Expected(),
                   StatusOf(state.status), is_right ? "yes" : "no",
                   theory.share, state.load_share, error,
                   std::int64_t{state.num_tangents}});
  }

  const Table& Get() const { return table_; }

 private:
  Table table_ = {"large_deformation_limits",
                  {"specimen", "law", "load_over_limit [1]", "expected",
                   "found", "is_right", "expected_share [1]",
                   "reached_share [1]", "error_of_top [1]", "tangents [1]"}};
};

// The load of Euler, by the stiffness k = 3 E I / L^3 of this very mesh against
// a small force across: pi^2 E I / (4 L^2) = pi^2 k L / 12.
double BucklingLoad(Scene column) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kSmallForce = 1e-3;
  PressTop(Eigen::Vector3d(kSmallForce, 0, 0), column);
  LargeStrainEquilibrium model(column);
  const Eigen::VectorXd u = model
                                .Solve(model.Forces().Parameters().Moduli(
                                           Eigen::Vector2d(kModulus, 0.3)),
                                       0)
                                .displacement;
  // The last node is at the top.
  const double stiffness = kSmallForce / u(u.size() - 3);
  return kPi * kPi * stiffness * kColumnLength / 12;
}

void AddColumns(LimitTable& table) {
  Scene column = UprightBar({2, 2, 12}, {1, 1, kColumnLength}, "neo_hookean");
  const double limit = BucklingLoad(column);
  for (const double load : {0.5, 0.9, 1.1, 2.0, 5.0}) {
    PressTop(Eigen::Vector3d(0, 0, -load * limit), column);
    table.Add(
        "straight column", load, column, 0.3,
        load < 1 ? Theory{} : Theory{EquilibriumStatus::kUnstable, 1 / load});
  }
  // A column that is also pushed sideways bends away, and is stable.
  for (const double load : {0.5, 0.9, 1.1, 1.5, 2.0}) {
    PressTop(load * limit * Eigen::Vector3d(0.01, 0, -1), column);
    table.Add("column pushed sideways by 1 %", load, column, 0.3, {});
  }
}

// A cube with nu = 0 that keeps its cross-section.
Scene GuidedBlock(const std::string& law) {
  Scene block = UprightBar({2, 2, 2}, {1, 1, 1}, law);
  block.supports.held.topRows(2).setConstant(true);
  return block;
}

void AddPressedBlock(const std::string& law, double limit, double load,
                     const Theory& theory, LimitTable& table) {
  Scene block = GuidedBlock(law);
  PressTop(Eigen::Vector3d(0, 0, -load * limit * kModulus), block);
  table.Add("block under a force", load, block, 0, theory);
}

// The force of St Venant and Kirchhoff, E (s - s^3) / 2 at the stretch s, is
// largest at s = 1 / sqrt(3).
void AddForcesOnBlocks(LimitTable& table) {
  const double limit = 1 / std::sqrt(27.0);
  for (const double load : {0.5, 0.9, 0.999, 1.001, 1.1, 2.0}) {
    // s = 2 / sqrt(3) cos(phi / 3) solves s^3 - s + 2 F / E = 0, where
    // cos(phi) = -F / F_limit.
    const double stretch = 2 / std::sqrt(3.0) * std::cos(std::acos(-load) / 3);
    AddPressedBlock("st_venant_kirchhoff", limit, load,
                    load < 1 ? Theory{EquilibriumStatus::kDone, 1, stretch - 1}
                             : Theory{EquilibriumStatus::kUnstable, 1 / load,
                                      kNotKnown, true},
                    table);
  }
  // The force of the corotated law is E (1 - s).
  for (const double load : {0.5, 0.9, 1.1, 2.0}) {
    AddPressedBlock("corotated", 1, load,
                    load < 1 ? Theory{EquilibriumStatus::kDone, 1, -load}
                             : Theory{EquilibriumStatus::kInverted, 1 / load},
                    table);
  }
  // The force of the neo-Hookean law, E (1 / s - s) / 2, has no limit.
  for (const double load : {1.0, 10.0, 40.0}) {
    const double stretch = std::sqrt(load * load + 1) - load;
    AddPressedBlock("neo_hookean", 1, load,
                    {EquilibriumStatus::kDone, 1, stretch - 1}, table);
  }
}

void AddPlatens(LimitTable& table) {
  for (const std::string law :
       {"corotated", "neo_hookean", "st_venant_kirchhoff"}) {
    // Beyond the largest force, one layer of a block gives way, and the other
    // one recovers.
    const bool gives_way = law == "st_venant_kirchhoff";
    const double limit = gives_way ? 1 - 1 / std::sqrt(3.0) : 1;
    for (const double load : {0.5, 0.9, 1.1}) {
      Scene block = GuidedBlock(law);
      block.supports.displacement.setZero(3, block.mesh.NumNodes());
      for (Eigen::Index node = 0; node < block.mesh.NumNodes(); ++node) {
        if (block.mesh.nodes(2, node) == 1) {
          block.supports.held(2, node) = true;
          block.supports.displacement(2, node) = -load * limit;
        }
      }
      table.Add("block pressed by a platen", load, block, 0,
                load < 1 ? Theory{EquilibriumStatus::kDone, 1, -load * limit}
                         : Theory{gives_way ? EquilibriumStatus::kUnstable
                                            : EquilibriumStatus::kInverted,
                                  1 / load});
    }
  }
}

}  // namespace

Table LargeDeformationLimits() {
  LimitTable table;
  AddColumns(table);
  AddForcesOnBlocks(table);
  AddPlatens(table);
  return table.Get();
}

}  // namespace elastimate
