#include "elastimate/estimators/interface/kinematic_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mechanics/large_strain_forces.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

// A failed estimate may have no parameters, of which a ratio is then taken to
// be free.
bool IsARatioFree(const Estimate& estimate) {
  return estimate.parameters.empty() ||
         std::any_of(estimate.parameters.begin(), estimate.parameters.end(),
                     [](const ParameterEstimate& parameter) {
                       return !parameter.is_known && !parameter.IsStiffness();
                     });
}

bool IsUnusable(const KinematicError& error, bool is_ratio_free) {
  return !(error.log_modulus <= kLimits.unusable_error) ||
         (is_ratio_free &&
          !(error.ratio <= kLimits.unusable_poisson_ratio_bias));
}

// Adds the squares of errors that are independent of the others, and enters
// them as those of a cause.
void AddError(const KinematicError& error, ParameterErrors& of_cause,
              Estimate& estimate) {
  of_cause.resize(Eigen::Index(estimate.parameters.size()));
  for (Eigen::Index i = 0; i < of_cause.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double relative =
        parameter.IsStiffness() ? error.log_modulus : error.ratio;
    of_cause(i) = parameter.is_known ? Estimate::kUnknown : relative;
    estimate.parameter_covariance(i, i) +=
        std::pow(relative * parameter.ErrorUnit(), 2);
  }
}

// Returns the smallest det F of the elements all of whose nodes were measured;
// 1 where there are none.
VolumeRatio SmallestMeasuredRatio(const Scene& scene, std::size_t k) {
  const LoadCase& load_case = scene.load_cases[k];
  if (load_case.displacement.size() == 0) {
    return {1, 0};
  }
  std::vector<Eigen::Index> measured;
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    bool is_measured = true;
    for (const int node : scene.mesh.elements.col(e)) {
      for (int i = 0; i < scene.mesh.Dimension(); ++i) {
        is_measured = is_measured && IsObserved(load_case, i, node);
      }
    }
    if (is_measured) {
      measured.push_back(e);
    }
  }
  if (measured.empty()) {
    return {1, 0};
  }
  Mesh mesh = scene.mesh;
  mesh.elements = scene.mesh.elements(Eigen::all, measured);
  const VolumeRatio smallest =
      SmallestVolumeRatio(mesh, load_case.displacement.reshaped());
  return {smallest.value, measured[smallest.element]};
}

bool HasLargeStrains(const Scene& scene, const Estimate& estimate) {
  return HasLargeStrainLaw(scene.materials) ||
         !estimate.large_strain_law.empty();
}

// Returns the largest rotation, to first order, of a rigid face that has free
// components.
double LargestLinearTurn(const Scene& scene, Eigen::Index k,
                         const Eigen::MatrixXd& displacement) {
  const int dimension = scene.mesh.Dimension();
  double largest = 0;
  for (const RigidFace& face : SupportsOf(scene, k).rigid_faces) {
    if (!face.components.all()) {
      const Eigen::VectorXd motion = RigidMotionNearest(
          scene.mesh.nodes(Eigen::all, face.nodes),
          displacement.col(k).reshaped(dimension, scene.mesh.NumNodes())(
              Eigen::all, face.nodes));
      largest = std::max(
          largest, motion.tail(NumRigidMotions(dimension) - dimension).norm());
    }
  }
  return largest;
}

}  // namespace

bool IsMentioned(const DeformationSize& size) {
  return size.strain >= kLimits.mentioned_strain ||
         size.rotation >= kLimits.mentioned_rotation;
}

bool IsPossible(const DeformationSize& size) {
  return size.strain < kLimits.doubtful_strain ||
         (size.strain < kLimits.impossible_strain &&
          size.volume_change < kLimits.volume_change_of_rubber);
}

KinematicError KinematicErrorOf(const DeformationSize& size) {
  if (!IsMentioned(size)) {
    return {0, 0};
  }
  const double square = size.rotation * size.rotation;
  return {0.8 * size.strain + 0.54 * square, 0.35 * size.strain + 0.8 * square};
}

void JudgeKinematics(const Scene& scene, Estimate& estimate) {
  if (estimate.Has(FindingCode::kLargeDeformation) || estimate.series) {
    return;
  }
  estimate.deformation = MeasureDeformation(scene);
  if (HasLargeStrainLaw(scene.materials)) {
    if (!IsPossible(estimate.deformation) && !estimate.IsUsable()) {
      estimate.Add(LargeDeformation(estimate.deformation, 0, Severity::kWarning,
                                    scene.is_rigid_motion_free));
    }
    return;
  }
  if (!IsMentioned(estimate.deformation)) {
    return;
  }
  if (scene.origin == Origin::kComputed) {
    if (estimate.deformation.strain > kLimits.doubtful_strain) {
      return;
    }
    estimate.Add(TakenAsLinear(estimate.deformation));
    return;
  }
  const KinematicError error = KinematicErrorOf(estimate.deformation);
  const bool is_unusable = IsUnusable(error, IsARatioFree(estimate));
  Finding finding =
      LargeDeformation(estimate.deformation, error.log_modulus,
                       is_unusable ? Severity::kError : Severity::kWarning,
                       scene.is_rigid_motion_free);
  if (HasFields(scene.materials)) {
    finding.advice = "apply smaller loads, because maps are of small strains";
  }
  if (is_unusable) {
    estimate.Fail(finding);
    return;
  }
  estimate.Add(finding);
  if (estimate.IsUsable()) {
    AddError(error, estimate.error_budget.kinematics, estimate);
  }
}

void JudgeInversion(const Scene& scene, Estimate& estimate) {
  if (!HasLargeStrains(scene, estimate) || estimate.series ||
      estimate.Has(FindingCode::kInvertedElements)) {
    return;
  }
  std::size_t load_case = 0;
  VolumeRatio smallest = {1, 0};
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const VolumeRatio of_case = SmallestMeasuredRatio(scene, k);
    if (of_case.value < smallest.value) {
      load_case = k;
      smallest = of_case;
    }
  }
  if (smallest.value <= 0) {
    estimate.Add(
        InvertedElements(load_case + 1, smallest.element, smallest.value));
  }
}

void JudgeRigidFaces(const Scene& scene, Estimate& estimate) {
  const Eigen::MatrixXd& displacement = estimate.fitted_displacement;
  if (!HasLargeStrains(scene, estimate) || estimate.series ||
      displacement.rows() != scene.mesh.NumDofs() ||
      estimate.Has(FindingCode::kRigidFaceTurned)) {
    return;
  }
  double largest = 0;
  Eigen::Index load_case = 0;
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    const double turn = LargestLinearTurn(scene, k, displacement);
    if (turn > largest) {
      largest = turn;
      load_case = k;
    }
  }
  if (largest >= kLimits.mentioned_rotation) {
    estimate.Add(RigidFaceTurned(std::size_t(load_case) + 1, largest));
  }
}

void JudgeThickness(const Scene& scene, Estimate& estimate) {
  const double error = scene.mesh.section.thickness_relative_sd;
  if (error == 0 || !estimate.IsUsable() ||
      estimate.Has(FindingCode::kMarginNotGiven)) {
    return;
  }
  estimate.Add(MarginNotGiven(error));
  AddError({error, 0}, estimate.error_budget.section, estimate);
}

void JudgeSignOfPoissonRatio(Estimate& estimate) {
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (estimate.IsUsable() && parameter.name == "poisson_ratio" &&
        parameter.standard_error &&
        parameter.value < -2 * *parameter.standard_error) {
      estimate.Add(NegativePoissonRatio(parameter));
    }
  }
}

}  // namespace elastimate
