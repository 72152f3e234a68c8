#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_CAPABILITIES_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_CAPABILITIES_H_

#include <string>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

struct EstimatorOptions;

/// What an estimator takes.  Every estimator takes each element kind and
/// section.
struct Capabilities {
  /// It needs the displacement of every free component.
  bool needs_all_displacements = false;
  /// It needs supports that hold the specimen.
  bool needs_supports = false;
  bool takes_bounds = false;  ///< On E and nu.
  bool takes_losses = false;
  /// Finer elements that tell of the mesh error.
  bool takes_refinement = false;
  /// It has virtual fields, of a degree that may be chosen.
  bool takes_degree = false;
  /// Materials other than one isotropic one of which nothing is known.
  bool takes_materials = false;
  /// Materials whose axis is to be found with their parameters.
  bool takes_free_axes = false;
  /// Materials with a parameter that differs between elements.
  bool takes_fields = false;
  /// Laws of large strains.
  bool takes_large_strains = false;
  /// It needs forces that are linear in the moduli.  In plane stress, those of
  /// large strains are not.
  bool needs_linear_moduli = false;
  /// Kinematics::kLarge.
  bool compares_large_strain_laws = false;
  /// Supports that moved by unknown amounts, resultants of supports, and a
  /// rigid motion of all that is free.
  bool takes_unknown_motion = false;
  /// Supports that differ between load cases.
  bool takes_supports_of_cases = false;
};

/// Why an estimator of these capabilities cannot serve the scene with the
/// options, and what could; empty when it can.  The only place where refusals
/// are written.
/// Preconditions: a valid scene and valid options.  O(num_dofs num_load_cases),
/// and the cost of WhyNotHeld where it needs supports.
[[nodiscard]] std::string WhyUnsupported(const Capabilities& capabilities,
                                         const Scene& scene,
                                         const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_CAPABILITIES_H_
