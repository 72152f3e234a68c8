#include "elastimate/estimators/interface/input_checks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

// Whether the loads act on a free degree of freedom.
bool IsLoaded(const Scene& scene, Eigen::Index k) {
  const LoadCase& load_case = scene.load_cases[k];
  const auto acts = [&](const Eigen::MatrixXd& force) {
    return (!SupportsOf(scene, k).held && force.array() != 0).any();
  };
  const NodalForces* const nodal_forces =
      load_case.loads.size() == 1
          ? std::get_if<NodalForces>(&load_case.loads.front())
          : nullptr;
  return nodal_forces != nullptr
             ? acts(nodal_forces->force)
             : acts(AssembleLoads(scene.mesh, load_case.loads));
}

// What one load case measured at the free degrees of freedom.
struct MeasurementSummary {
  bool any_observed = false;
  double largest_displacement = 0;
  double free_square_sum = 0;
  double held_deviation_square_sum = 0;
};

MeasurementSummary Summarize(const Scene& scene, Eigen::Index k) {
  const LoadCase& load_case = scene.load_cases[k];
  const Supports& supports = SupportsOf(scene, k);
  MeasurementSummary summary;
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    for (int i = 0; i < scene.mesh.Dimension(); ++i) {
      const bool held = supports.IsGiven(i, node);
      if (!IsObserved(load_case, i, node)) {
        continue;
      }
      const double q = load_case.displacement(i, node);
      if (held && !scene.is_rigid_motion_free) {
        const double deviation = q - supports.displacement(i, node);
        summary.held_deviation_square_sum += deviation * deviation;
      } else {
        summary.any_observed = true;
        summary.largest_displacement =
            std::max(summary.largest_displacement, std::abs(q));
        summary.free_square_sum += q * q;
      }
    }
  }
  summary.any_observed |= AreFreePointsMeasured(scene, k);
  for (const double q : load_case.points.displacement.reshaped()) {
    if (!std::isnan(q)) {
      summary.largest_displacement =
          std::max(summary.largest_displacement, std::abs(q));
      summary.free_square_sum += q * q;
    }
  }
  return summary;
}

bool HasKnownNoise(const LoadCase& load_case) {
  return load_case.noise_sd || (load_case.displacement.size() == 0 &&
                                load_case.points.noise_sd.size() != 0);
}

// Noise that is larger than all displacements is in another unit.
void CheckNoise(const Scene& scene, double largest_displacement) {
  for (const LoadCase& load_case : scene.load_cases) {
    if (load_case.noise_sd && *load_case.noise_sd > 2 * largest_displacement) {
      throw std::invalid_argument(
          "the standard deviation of the noise, " +
          NumberText(*load_case.noise_sd) +
          ", is larger than every measured displacement (the largest is " +
          NumberText(largest_displacement) + "); check its unit");
    }
  }
}

}  // namespace

void CheckOptions(const EstimatorOptions& options) {
  const std::string why_invalid = options.WhyInvalid();
  if (!why_invalid.empty()) {
    throw std::invalid_argument(why_invalid);
  }
}

void CheckSupported(const Estimator& estimator, const Scene& scene,
                    const EstimatorOptions& options) {
  const std::string why_unsupported = estimator.WhyUnsupported(scene, options);
  if (!why_unsupported.empty()) {
    throw std::invalid_argument(std::string(estimator.Name()) + ": " +
                                why_unsupported);
  }
}

std::vector<Finding> CheckMeasurements(const Scene& scene) {
  std::vector<std::size_t> moved;
  double largest_displacement = 0;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const std::string name = "load case " + std::to_string(k + 1);
    if (!IsMeasured(load_case)) {
      throw std::invalid_argument(name +
                                  " has no measured displacements; add them");
    }
    const MeasurementSummary summary = Summarize(scene, Eigen::Index(k));
    if (!summary.any_observed) {
      throw std::invalid_argument(
          "no free component of the displacement was measured in " + name +
          "; measure free nodes, or leave what was measured out of the "
          "supports");
    }
    if (summary.largest_displacement == 0) {
      throw std::invalid_argument(
          "the measured displacement of " + name +
          " is zero at every free node, so that nothing can be estimated; "
          "check the columns or arrays that it was read from");
    }
    largest_displacement =
        std::max(largest_displacement, summary.largest_displacement);
    // Measurement noise on held nodes is no contradiction; a motion is.
    if (summary.held_deviation_square_sum >
        kLimits.held_motion * kLimits.held_motion * summary.free_square_sum) {
      moved.push_back(k + 1);
    }
  }
  CheckNoise(scene, largest_displacement);
  return moved.empty() ? std::vector<Finding>{}
                       : std::vector<Finding>{HeldNodesMoved(moved)};
}

void CheckLoads(const Scene& scene) {
  bool any_force = false;
  std::size_t num_with_noise_sd = 0;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    any_force = any_force || !load_case.resultants.empty() ||
                IsLoaded(scene, Eigen::Index(k));
    num_with_noise_sd += HasKnownNoise(load_case) ? 1 : 0;
  }
  if (!any_force &&
      !MaterialParameters(scene.materials, scene.mesh.section.model)
           .KnownModulus()) {
    throw std::invalid_argument(
        "the loads are zero on every free node, so that no modulus can be "
        "estimated; give a load, the measured force of a support as a load of "
        "type \"resultant\", or a known modulus");
  }
  if (num_with_noise_sd != 0 && num_with_noise_sd != scene.load_cases.size()) {
    throw std::invalid_argument(
        "the standard deviation of the noise is given for some load cases "
        "only; give it for all or for none");
  }
}

}  // namespace elastimate
