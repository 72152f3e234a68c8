#include "python/simulation.h"

#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {
namespace {

void RequireKnownSupports(const Scene& scene) {
  const std::string why_not_held = WhyNotHeld(scene);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(why_not_held);
  }
  if (HasUnknownMotion(scene)) {
    throw std::invalid_argument(
        "a simulation needs supports whose displacement is known; give it as a "
        "vector, and leave out resultants and a free rigid motion");
  }
}

Eigen::MatrixXd LargeDisplacements(const Scene& scene,
                                   const Eigen::VectorXd& parameters) {
  LargeStrainEquilibrium model(scene);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(parameters);
  const LargeStrainSolution solution = SolveLoadCases(moduli, model);
  if (!solution.why_not.empty()) {
    throw std::invalid_argument(solution.why_not);
  }
  return solution.displacement;
}

Eigen::MatrixXd SmallDisplacements(const std::vector<const Scene*>& spaces,
                                   const Eigen::VectorXd& parameters) {
  try {
    return DisplacementsAt(spaces, parameters);
  } catch (const std::runtime_error&) {
    throw std::invalid_argument(
        "the stiffness matrix is singular to working precision; check the mesh "
        "for flat elements, and Poisson's ratio");
  }
}

}  // namespace

Scene SimulatedScene(const Scene& scene, const Eigen::VectorXd& parameters,
                     int order, double noise_sd, std::uint64_t seed) {
  ValidateScene(scene);
  RequireKnownSupports(scene);
  const bool is_raised = order > scene.mesh.Order();
  const std::optional<Scene> quadratic =
      is_raised ? std::optional<Scene>(QuadraticScene(scene)) : std::nullopt;
  std::vector<const Scene*> spaces = {&scene};
  if (quadratic) {
    spaces.push_back(&*quadratic);
  }
  const bool is_large = HasLargeStrainLaw(scene.materials);
  const Eigen::MatrixXd displacements =
      is_large ? LargeDisplacements(*spaces.back(), parameters)
               : SmallDisplacements(spaces, parameters);

  Scene simulated = scene;
  MeasurementErrors errors;
  errors.noise_sd = noise_sd;
  std::mt19937_64 generator(seed);
  for (std::size_t k = 0; k < simulated.load_cases.size(); ++k) {
    const auto place = Eigen::Index(k);
    // The vertices come first among the nodes of quadratic elements.
    Eigen::MatrixXd displacement =
        displacements.col(place)
            .head(scene.mesh.NumDofs())
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
    AddErrors(errors, scene.mesh.nodes, SupportsOf(scene, place).held,
              generator, displacement);
    LoadCase& load_case = simulated.load_cases[k];
    load_case.displacement = displacement;
    load_case.observed.resize(0, 0);  // "= {}" would set it to false.
    load_case.points = {};
    load_case.noise_sd =
        noise_sd > 0 ? std::optional<double>(noise_sd) : std::nullopt;
  }
  simulated.origin = is_raised  ? Origin::kMeasured
                     : is_large ? Origin::kComputedAtLargeStrains
                                : Origin::kComputed;
  return simulated;
}

}  // namespace elastimate
