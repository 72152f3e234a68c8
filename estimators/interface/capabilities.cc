#include "elastimate/estimators/interface/capabilities.h"

#include <algorithm>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {
namespace {

// The fit of displacements that takes the materials.
std::string FitOf(const Scene& scene) {
  return IsOneIsotropicMaterial(scene.materials) ? "reduced-fe"
                                                 : "iterative-fe";
}

// Empty when the displacement of every free component was observed.
std::string WhyNotAllDisplacements(const Scene& scene) {
  const Eigen::Index num_vertices = scene.mesh.NumVertices();
  const int dimension = scene.mesh.Dimension();
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    if (load_case.points.points.Size() != 0) {
      return "the force residual needs displacements of nodes, but load case " +
             std::to_string(k + 1) +
             " was measured at points; use --estimator=" + FitOf(scene);
    }
    if (load_case.observed.size() == 0) {
      continue;
    }
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      for (int i = 0; i < dimension; ++i) {
        if (SupportsOf(scene, Eigen::Index(k)).held(i, node) ||
            IsObserved(load_case, i, node)) {
          continue;
        }
        if (node >= num_vertices) {
          return "the force residual needs the displacement of every node, "
                 "and those of the mid-edge nodes of quadratic elements "
                 "(order 2) were not measured; use --estimator=" +
                 FitOf(scene) +
                 ", which can do without, or linear elements (--order=1)";
        }
        return "the force residual needs the displacement of every node, "
               "and node " +
               std::to_string(node) + " (" + "xyz"[i] + ") of load case " +
               std::to_string(k + 1) +
               " was not observed; use --estimator=" + FitOf(scene) +
               ", which can do without";
      }
    }
  }
  return "";
}

std::string WhyNotSupported(const Scene& scene) {
  std::string why = WhyNotHeld(scene);
  if (!why.empty() && scene.mesh.Order() == 1 && !HasUnknownMotion(scene) &&
      !HasSupportsOfCases(scene)) {
    why +=
        ", or use --estimator=closed-form or --estimator=virtual-fields, which "
        "need no supports";
  }
  return why;
}

std::string WhyNotTheseMaterials(const Capabilities& capabilities,
                                 const Scene& scene,
                                 const EstimatorOptions& options) {
  if (IsOneIsotropicMaterial(scene.materials)) {
    return "";
  }
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  const std::string why_large = WhyNotSmallStrains(parameters);
  if (!why_large.empty() && !capabilities.takes_large_strains) {
    return why_large + ", or use --estimator=iterative-fe";
  }
  if (!why_large.empty() && capabilities.needs_linear_moduli &&
      scene.mesh.section.model == SectionModel::kPlaneStress) {
    return "in plane stress, the forces of large strains are not linear in the "
           "moduli, which it needs; use --estimator=iterative-fe or "
           "--estimator=closed-form";
  }
  if (!capabilities.takes_materials) {
    return "it takes only one isotropic material without known parameters; use "
           "--estimator=iterative-fe or --estimator=virtual-fields";
  }
  if (!capabilities.takes_free_axes && HasFreeAxis(scene.materials)) {
    return "it takes only materials whose axis is known; use "
           "--estimator=iterative-fe or --estimator=reduced-fe, or give the "
           "axis";
  }
  if (options.known_poisson_ratio) {
    return "Poisson's ratio is given for the whole specimen, but the scene has "
           "materials of its own; give it there, as a known parameter";
  }
  const bool has_bounded_options =
      options.youngs_modulus.AreGiven() || options.poisson_ratio.AreGiven();
  if (has_bounded_options && !AreIsotropic(scene.materials)) {
    return "bounds on E and nu are for isotropic materials only, but the scene "
           "has others; give bounds on their parameters in the scene";
  }
  if (parameters.Free().empty()) {
    return "every parameter of the materials is known, so that there is "
           "nothing to estimate; leave one out of \"known\"";
  }
  bool has_bounds = false;
  for (const Material& material : scene.materials) {
    has_bounds = has_bounds || !material.bounds.empty();
  }
  return has_bounds && !capabilities.takes_bounds
             ? "it cannot keep the bounds of a material; use "
               "--estimator=bounded or --estimator=iterative-fe"
             : "";
}

std::string WhyNotTheseFields(const Capabilities& capabilities,
                              const Scene& scene,
                              const EstimatorOptions& options) {
  if (!HasFields(scene.materials)) {
    return "";
  }
  if (!capabilities.takes_fields) {
    return "it estimates no map of a modulus; use --estimator=iterative-fe, or "
           "leave out --map and \"fields\"";
  }
  if (!IsOneIsotropicMaterial(scene.materials) || HasPriors(scene.materials)) {
    return "a map is for one isotropic material; leave out other materials, "
           "\"known\", \"bounds\" and \"prior\", and give a known Poisson's "
           "ratio by --nu";
  }
  if (options.youngs_modulus.AreGiven() || options.poisson_ratio.AreGiven()) {
    return "a map keeps no bounds; leave out the bounds on E and nu";
  }
  if (options.kinematics == Kinematics::kLarge) {
    return "a map is of small strains; leave out --kinematics=large";
  }
  return options.loss != Loss::kNone
             ? "a map takes no loss function; leave out --loss"
             : "";
}

std::string WhyNotTheseKinematics(const Capabilities& capabilities,
                                  const Scene& scene,
                                  const EstimatorOptions& options) {
  const bool has_large_strains = HasLargeStrainLaw(scene.materials);
  const bool are_large_asked_for = options.kinematics == Kinematics::kLarge;
  if (has_large_strains && options.kinematics == Kinematics::kSmall) {
    return "a material has a law of large strains, which --kinematics=small "
           "excludes; leave out one of them";
  }
  if (are_large_asked_for && !capabilities.compares_large_strain_laws) {
    return "it does not compare laws of large strains; use "
           "--estimator=iterative-fe, or name a law instead of "
           "--kinematics=large, such as --material=neo_hookean";
  }
  if (are_large_asked_for && !AreIsotropic(scene.materials)) {
    return "only isotropic materials have laws of large strains that can be "
           "compared; name laws in the scene or by --material instead of "
           "--kinematics=large";
  }
  return "";
}

std::string WhyNotTheseMotions(const Capabilities& capabilities,
                               const EstimatorOptions& options) {
  if (!capabilities.takes_unknown_motion) {
    return "it takes only supports whose displacement is given, and no "
           "resultants; use --estimator=iterative-fe";
  }
  return options.loss != Loss::kNone ? "a loss function needs supports whose "
                                       "displacement is given; leave out --loss"
                                     : "";
}

}  // namespace

std::string WhyUnsupported(const Capabilities& capabilities, const Scene& scene,
                           const EstimatorOptions& options) {
  if (!capabilities.takes_bounds &&
      (options.poisson_ratio.AreGiven() || options.youngs_modulus.AreGiven())) {
    return "it cannot keep bounds; use --estimator=bounded or --estimator=" +
           FitOf(scene);
  }
  if (!capabilities.takes_losses && options.loss != Loss::kNone) {
    return "it takes no loss function; use --estimator=reduced-fe, or leave "
           "out --loss";
  }
  if (!capabilities.takes_refinement &&
      options.refinement != Refine::kAutomatic) {
    return "it cannot divide the mesh into finer elements; use "
           "--estimator=reduced-fe, or leave out --refine";
  }
  if (options.refinement == Refine::kAlways &&
      scene.origin != Origin::kMeasured) {
    return "finer elements say nothing about displacements that were computed "
           "with this mesh; leave out --refine, or give --origin=measured";
  }
  if (!capabilities.takes_degree && options.virtual_field_degree) {
    return "it has no virtual fields that could have a degree; use "
           "--estimator=virtual-fields, or leave out --degree";
  }
  std::string why = WhyNotTheseFields(capabilities, scene, options);
  if (why.empty()) {
    why = WhyNotTheseMaterials(capabilities, scene, options);
  }
  if (why.empty()) {
    why = WhyNotTheseKinematics(capabilities, scene, options);
  }
  if (why.empty() && HasUnknownMotion(scene)) {
    why = WhyNotTheseMotions(capabilities, options);
  }
  if (why.empty() && HasSupportsOfCases(scene) &&
      !capabilities.takes_supports_of_cases) {
    why =
        "it takes only supports that are the same in all load cases; use "
        "--estimator=iterative-fe";
  }
  if (why.empty() && capabilities.needs_all_displacements) {
    why = WhyNotAllDisplacements(scene);
  }
  if (why.empty() && capabilities.needs_supports) {
    why = WhyNotSupported(scene);
  }
  return why;
}

}  // namespace elastimate
