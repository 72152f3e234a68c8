#include "benchmarks/deformed_bar.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/equilibrium/large_strain_model.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/statistics/scalar_search.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr double kLength = 6;
constexpr double kDegree = 3.14159265358979323846 / 180;
// The second moment of area of the unit square.
constexpr double kSecondMoment = 1.0 / 12;
constexpr double kToleranceOfLogarithm = 1e-9;

// Returns the mean position after the load of the nodes of the end whose x is
// this.
Eigen::Vector3d MeanOfEdge(const Mesh& mesh, const Eigen::VectorXd& u,
                           double x) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Vector3d position = mesh.nodes.col(node);
    if (position(0) == x && position(2) == kLength) {
      sum += position + u.segment<3>(3 * node);
      ++count;
    }
  }
  return sum / count;
}

double SizeOf(BarLoad load, const Mesh& mesh, const Eigen::VectorXd& u) {
  const Eigen::Vector3d left = MeanOfEdge(mesh, u, 0);
  const Eigen::Vector3d right = MeanOfEdge(mesh, u, 1);
  const Eigen::Vector3d across = right - left;
  return load == BarLoad::kBending
             ? std::atan2(-across(2), across(0)) / kDegree
             : 100 * ((left(2) + right(2)) / 2 / kLength - 1);
}

// Returns the force that would be right for small strains of a slender bar.
double SmallStrainForce(BarLoad load, double size) {
  return load == BarLoad::kBending ? 2 * size * kDegree * kBarParameters(0) *
                                         kSecondMoment / (kLength * kLength)
                                   : size / 100 * kBarParameters(0);
}

}  // namespace

std::string BarLoadName(BarLoad load) {
  return load == BarLoad::kBending ? "bending" : "stretch";
}

Scene DeformedBar(BarLoad load, const std::string& law, double size) {
  CuboidOptions options;
  options.cells = {2, 2, 6};
  options.size = {1, 1, kLength};
  // Linear tetrahedra that are so large would be too stiff in bending.
  Scene scene = QuadraticScene(CuboidScene(options));
  scene.load_cases[0].observed.resize(0, 0);  // Mid-edge nodes are as well.
  scene.materials.resize(1);
  scene.materials[0].law = law;
  const Eigen::MatrixXi end = BoundaryFacetsWhere(scene.mesh, [&](int node) {
    return scene.mesh.nodes(2, node) == kLength;
  });
  const Eigen::Vector3d direction =
      Eigen::Vector3d::Unit(load == BarLoad::kBending ? 0 : 2);
  scene.load_cases[0].loads = {SurfaceForce{end, direction}};

  LargeStrainEquilibrium model(scene);
  const Eigen::VectorXd moduli =
      model.Forces().Parameters().Moduli(kBarParameters);
  Eigen::VectorXd u;
  // Forces are linear in the moduli, so that moduli divided by the force take
  // the place of the force.
  const std::function<double(double)> excess = [&](double log_force) {
    const LargeStrainState state =
        model.Solve(moduli * std::exp(-log_force), 0);
    if (state.status != EquilibriumStatus::kDone) {
      throw std::runtime_error(BarLoadName(load) + " of a bar of " + law +
                               ": " + WhyNotInEquilibrium(state));
    }
    u = state.displacement;
    return SizeOf(load, scene.mesh, u) - size;
  };
  constexpr double kStep = 0.4;
  double lower = std::log(SmallStrainForce(load, size) / 2);
  double upper = lower + kStep;
  double at_lower = excess(lower);
  double at_upper = excess(upper);
  while (at_upper < 0) {
    lower = upper;
    at_lower = at_upper;
    upper += kStep;
    at_upper = excess(upper);
  }
  const double log_force = ZeroBetween(excess, lower, at_lower, upper, at_upper,
                                       kToleranceOfLogarithm);
  static_cast<void>(excess(log_force));
  scene.load_cases[0].loads = {
      SurfaceForce{end, std::exp(log_force) * direction}};
  scene.load_cases[0].displacement = u.reshaped(3, scene.mesh.NumNodes());
  return scene;
}

Eigen::Matrix2d UnitCramerRao(const Scene& bar) {
  LargeStrainModel model(bar);
  const MaterialParameters& chart = model.Parameters();
  if (!model.Solve(chart.Moduli(kBarParameters))) {
    throw std::runtime_error(model.WhyNotSolved());
  }
  const Eigen::Vector2d units(kBarParameters(0), 1);
  const Eigen::MatrixXd sensitivities = model.Sensitivities(
      chart.ModuliJacobian(kBarParameters) * units.asDiagonal());
  const Eigen::Matrix2d information = sensitivities.transpose() * sensitivities;
  return information.inverse();
}

}  // namespace elastimate
