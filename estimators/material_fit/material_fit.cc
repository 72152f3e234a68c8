#include "elastimate/estimators/material_fit/material_fit.h"

#include <cmath>
#include <memory>
#include <optional>

#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/material_fit/inlier_fit.h"
#include "elastimate/estimators/material_fit/nearest_symmetry.h"
#include "elastimate/estimators/material_fit/refined_fit.h"

namespace elastimate {
namespace {

// Where Poisson's ratio of one isotropic material is known, that material.
std::vector<Material> WithKnownPoissonRatio(const EstimatorOptions& options) {
  Material material;
  material.known.push_back({"poisson_ratio", *options.known_poisson_ratio});
  return {material};
}

// Where the fit of a scene with free axes starts: next to that of the same
// moduli without a symmetry.  Adds its work.
std::optional<Eigen::VectorXd> StartOfFreeAxes(const Scene& scene,
                                               const EstimatorOptions& options,
                                               Descent descent, Work& work) {
  const Scene without = WithoutFreeAxes(scene);
  const MaterialFit fit = FitSpace(without, options, descent, std::nullopt);
  work = work + fit.estimate.work;
  if (fit.errors.total.size() == 0) {
    return std::nullopt;
  }
  return NearestVariables(FreeParameters(scene, options),
                          FreeParameters(without, options),
                          fit.errors.variables, fit.errors.total);
}

// The fit of the scene as its origin asks for it, without outliers.
MaterialFit FitByOrigin(const Scene& scene, const EstimatorOptions& options,
                        Descent descent,
                        const std::optional<Eigen::VectorXd>& start) {
  if (scene.origin == Origin::kMeasured) {
    MaterialFit refined = FitRefined(scene, options, descent, start);
    if (HasUnknownMotion(scene)) {
      refined.estimate.fitted_displacement = refined.displacement;
    }
    return refined;
  }
  MaterialFit of_all = FitSpace(scene, options, descent, start);
  if (options.loss != Loss::kNone) {
    return of_all;
  }
  InlierFit inliers = LeaveOutliersOut(
      scene,
      [&](const Scene& others, const std::optional<Eigen::VectorXd>& from) {
        return FitSpace(others, options, descent, from);
      },
      of_all);
  EnterOutliers(inliers.left_out, of_all.estimate, inliers.fit.estimate,
                inliers.fit.estimate);
  if (HasUnknownMotion(scene)) {
    inliers.fit.estimate.fitted_displacement = inliers.fit.displacement;
  }
  return inliers.fit;
}

// Starts where the last usable fit ended.
class MaterialFitPreparation : public Preparation {
 public:
  MaterialFitPreparation(const EstimatorOptions& options, Descent descent)
      : options_(options), descent_(descent) {}

  Estimate Run(const Scene& scene) override {
    MaterialFit fit = FitMaterialsFrom(start_, scene, options_, descent_);
    if (start_ && !fit.estimate.IsUsable()) {
      const Work work = fit.estimate.work;
      fit = FitMaterialsFrom(std::nullopt, scene, options_, descent_);
      fit.estimate.work = fit.estimate.work + work;
    }
    start_ = fit.estimate.IsUsable() ? fit.Variables() : std::nullopt;
    return fit.estimate;
  }
  bool TakesOtherLoadCases() const override { return true; }

 private:
  const EstimatorOptions& options_;
  Descent descent_;
  std::optional<Eigen::VectorXd> start_;
};

}  // namespace

bool IsForMaterialFit(const Scene& scene) {
  return scene.origin == Origin::kMeasured ||
         !IsOneIsotropicMaterial(scene.materials) || HasUnknownMotion(scene) ||
         HasSupportsOfCases(scene);
}

MaterialFit FitMaterialsFrom(const std::optional<Eigen::VectorXd>& start,
                             const Scene& scene,
                             const EstimatorOptions& options, Descent descent) {
  if (!start && HasFreeAxis(scene)) {
    Work work;
    const std::optional<Eigen::VectorXd> nearest =
        StartOfFreeAxes(scene, options, descent, work);
    MaterialFit fit = FitByOrigin(scene, options, descent, nearest);
    fit.estimate.work = fit.estimate.work + work;
    return fit;
  }
  if (!IsOneIsotropicMaterial(scene.materials) ||
      !options.known_poisson_ratio) {
    return FitByOrigin(scene, options, descent, start);
  }
  Scene known = scene;
  known.materials = WithKnownPoissonRatio(options);
  EstimatorOptions other_options = options;
  other_options.known_poisson_ratio.reset();
  MaterialFit fit = FitByOrigin(known, other_options, descent, start);
  const ParameterErrors& of_mesh = fit.estimate.error_budget.discretization;
  if (of_mesh.size() > 0 && std::isfinite(of_mesh(0))) {
    fit.estimate.discretization_error = of_mesh(0);
  }
  EnterElasticity(fit.estimate);
  return fit;
}

Estimate FitMaterials(const Scene& scene, const EstimatorOptions& options,
                      Descent descent) {
  return FitMaterialsFrom(std::nullopt, scene, options, descent).estimate;
}

std::unique_ptr<Preparation> PrepareMaterialFit(const EstimatorOptions& options,
                                                Descent descent) {
  return std::make_unique<MaterialFitPreparation>(options, descent);
}

}  // namespace elastimate
