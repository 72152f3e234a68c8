#include "elastimate/estimators/material_fit/material_fit.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/material_fit/certified_descent.h"
#include "elastimate/estimators/material_fit/facet_error.h"
#include "elastimate/estimators/material_fit/inlier_fit.h"
#include "elastimate/estimators/material_fit/outliers.h"
#include "elastimate/estimators/material_fit/refined_fit.h"
#include "elastimate/estimators/material_fit/shear_modulus.h"

namespace elastimate {
namespace {

// The fit of a scene whose elements computed it, without outliers.
class ComputedFit {
 public:
  ComputedFit(const Scene& scene, const EstimatorOptions& options,
              Descent descent)
      : options_(options), descent_(descent), space_(scene, options) {}

  MaterialFit Fit(const Scene& scene,
                  const std::optional<Eigen::VectorXd>& start) {
    MaterialFit of_all = FitFrom(start);
    if (options_.loss != Loss::kNone) {
      return of_all;
    }
    InlierFit inliers = LeaveOutliersOut(
        scene,
        [&](const std::vector<Outlier>& left_out,
            const std::optional<Eigen::VectorXd>& from) {
          if (HasUnknownMotion(scene)) {
            return FitSpace(WithoutOutliers(scene, left_out), options_,
                            descent_, from);
          }
          space_.Measure(scene, SpaceFit::Rows::kOther, left_out);
          has_other_rows_ = true;
          return FitFrom(from);
        },
        of_all);
    EnterOutliers(inliers.left_out, of_all.estimate, inliers.fit.estimate,
                  inliers.fit.estimate);
    // Only the fit without a start looks for another axis.
    inliers.fit.has_rival_axis = of_all.has_rival_axis;
    return inliers.fit;
  }

  /// Takes another measurement at the same nodes.
  void Remeasure(const Scene& scene) {
    space_.Measure(scene, std::exchange(has_other_rows_, false)
                              ? SpaceFit::Rows::kOther
                              : SpaceFit::Rows::kSame);
  }

 private:
  MaterialFit FitFrom(const std::optional<Eigen::VectorXd>& start) {
    space_.Minimize(descent_, start);
    if (space_.Fit().minimum) {
      space_.Describe(nullptr, &space_);
    }
    return space_.Fit();
  }

  const EstimatorOptions& options_;
  Descent descent_;
  SpaceFit space_;
  bool has_other_rows_ = false;
};

// Starts where the last usable fit of determined parameters ended.
class MaterialFitPreparation : public Preparation {
 public:
  MaterialFitPreparation(const EstimatorOptions& options, Descent descent)
      : options_(options), descent_(descent) {}

  Estimate Run(const Scene& scene) override {
    MaterialFit fit = FitMaterialsFrom(start_, scene, options_, descent_);
    if (start_ && !IsGoodStart(fit)) {
      const Work work = fit.estimate.work;
      fit = FitMaterialsFrom(std::nullopt, scene, options_, descent_);
      fit.estimate.work = fit.estimate.work + work;
    }
    start_ = IsGoodStart(fit) ? fit.Variables() : std::nullopt;
    return fit.estimate;
  }
  bool TakesOtherLoadCases() const override { return true; }
  void ForgetStart() override { start_.reset(); }

 private:
  static bool IsGoodStart(const MaterialFit& fit) {
    return fit.estimate.IsUsable() && !fit.is_undetermined;
  }

  const EstimatorOptions& options_;
  Descent descent_;
  std::optional<Eigen::VectorXd> start_;
};

// Looks for the shear modulus where the parameters are not determined, and says
// what flat facets may do.
void Complete(const Scene& scene, const EstimatorOptions& options,
              Descent descent, MaterialFit& fit) {
  fit.is_undetermined = FindShearModulus(
      scene, options,
      [&](const EstimatorOptions& others) {
        return FitMaterials(scene, others, descent);
      },
      fit.estimate);
  WarnOfFlatFacets(scene, fit.displacement, fit.estimate);
}

// Keeps the reduced model with its certificate.  It needs no start, but each
// measurement may enlarge it.
class CertifiedPreparation : public Preparation {
 public:
  explicit CertifiedPreparation(const EstimatorOptions& options)
      : options_(options) {}

  Estimate Run(const Scene& scene) override {
    if (fit_) {
      fit_->Remeasure(scene);
    } else {
      fit_.emplace(scene, options_, Descent::kReduced);
    }
    MaterialFit fit = fit_->Fit(scene, std::nullopt);
    Complete(scene, options_, Descent::kReduced, fit);
    return fit.estimate;
  }

 private:
  const EstimatorOptions& options_;
  /// Empty before the first measurement.
  std::optional<ComputedFit> fit_;
};

}  // namespace

MaterialFit FitMaterialsFrom(const std::optional<Eigen::VectorXd>& start,
                             const Scene& scene,
                             const EstimatorOptions& options, Descent descent) {
  MaterialFit fit =
      scene.origin == Origin::kMeasured
          ? FitRefined(scene, options, descent, start)
          : ComputedFit(scene, options, descent).Fit(scene, start);
  if (fit.has_rival_axis && fit.estimate.IsUsable()) {
    fit.estimate.Fail(OtherAxisAlike());
  }
  Complete(scene, options, descent, fit);
  if (HasUnknownMotion(scene)) {
    fit.estimate.fitted_displacement = fit.displacement;
    fit.estimate.cameras = fit.cameras;
  }
  return fit;
}

Estimate FitMaterials(const Scene& scene, const EstimatorOptions& options,
                      Descent descent) {
  return FitMaterialsFrom(std::nullopt, scene, options, descent).estimate;
}

std::unique_ptr<Preparation> PrepareMaterialFit(const Scene& scene,
                                                const EstimatorOptions& options,
                                                Descent descent) {
  if (descent == Descent::kReduced && scene.origin == Origin::kComputed &&
      CertifiedDescent::Takes(scene)) {
    return std::make_unique<CertifiedPreparation>(options);
  }
  return std::make_unique<MaterialFitPreparation>(options, descent);
}

}  // namespace elastimate
