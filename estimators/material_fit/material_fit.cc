#include "elastimate/estimators/material_fit/material_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_descent.h"
#include "elastimate/estimators/material_fit/nearest_symmetry.h"
#include "elastimate/estimators/material_fit/outliers.h"
#include "elastimate/estimators/material_fit/reduced_descent.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/misfit/finer_elements.h"
#include "elastimate/estimators/misfit/material_verdicts.h"
#include "elastimate/estimators/misfit/minimum_statistics.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

// Where Poisson's ratio of one isotropic material is known, that material.
std::vector<Material> WithKnownPoissonRatio(const EstimatorOptions& options) {
  Material material;
  material.known.push_back({"poisson_ratio", *options.known_poisson_ratio});
  return {material};
}

// Says what is known at the minimum of the fit, which has one; `finer` may be
// null.
void DescribeFit(const Scene& scene, const EstimatorOptions& options,
                 DisplacementMisfit& misfit, FinerElements* finer,
                 MaterialFit& fit) {
  Estimate& estimate = fit.estimate;
  Evidence evidence;
  const Eigen::VectorXd& variables = fit.minimum->variables;
  evidence.end = fit.minimum->end;
  evidence.search_message = fit.minimum->message;
  EnterParameters(scene, misfit.Free(), misfit.Free().ParametersAt(variables),
                  estimate);
  NoteVariablesOnBounds(misfit.Free(), *fit.minimum, evidence, estimate);
  fit.errors =
      DescribeMinimum(scene, variables, finer, misfit, evidence, estimate);
  Eigen::VectorXd rows;
  if (misfit.Evaluate(variables, &rows, nullptr)) {
    fit.displacement = misfit.FittedDisplacement();
    fit.displacement_of_specimen =
        finer == nullptr ? fit.displacement
                         : finer->DisplacementOfSpecimen(
                               fit.errors.of_finer, fit.errors.share_of_finer,
                               fit.displacement);
    DescribeMaterials(scene, fit.errors, misfit, estimate);
  }
  if (IsOneIsotropicMaterial(scene.materials)) {
    EnterElasticity(estimate);
  }
  evidence.solver_notice = misfit.Model().Notice();
  Judge(evidence, options, estimate);
}

// From `start` on, or from where FitMaterials says; elements are taken as
// exact.
MaterialFit FitAll(const Scene& scene, const EstimatorOptions& options,
                   Descent descent,
                   const std::optional<Eigen::VectorXd>& start) {
  MaterialFit fit;
  Estimate& estimate = fit.estimate;
  Stopwatch stopwatch;
  DisplacementMisfit misfit(scene, options);
  estimate.stages.push_back({"assemble and analyse", stopwatch.Lap()});
  if (descent == Descent::kReduced) {
    fit.minimum = ReducedMinimum(start, options, misfit, estimate);
    if (!fit.minimum) {
      // Typical values beside known ones may be those of no material.
      fit.minimum = ReducedMinimum(
          VirtualFieldsStart(scene, options, misfit.Free(), estimate), options,
          misfit, estimate);
    }
  } else {
    fit.minimum = start ? DescendFrom(options, *start, Distance::kNear, misfit)
                        : BestMinimum(scene, options, misfit, estimate);
  }
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  fit.noise = misfit.Noise();
  if (fit.minimum) {
    DescribeFit(scene, options, misfit, nullptr, fit);
  } else {
    Evidence evidence;
    evidence.do_displacements_oppose_loads = true;
    evidence.solver_notice = misfit.Model().Notice();
    Judge(evidence, options, estimate);
  }
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  estimate.work = estimate.work + misfit.Model().WorkDone();
  return fit;
}

// Where the fit of a scene with free axes starts: next to that of the same
// moduli without a symmetry.  Adds its work.
std::optional<Eigen::VectorXd> StartOfFreeAxes(const Scene& scene,
                                               const EstimatorOptions& options,
                                               Descent descent, Work& work) {
  const Scene without = WithoutFreeAxes(scene);
  const MaterialFit fit = FitAll(without, options, descent, std::nullopt);
  work = work + fit.estimate.work;
  if (fit.errors.total.size() == 0) {
    return std::nullopt;
  }
  return NearestVariables(FreeParameters(scene, options),
                          FreeParameters(without, options),
                          fit.errors.variables, fit.errors.total);
}

// The same fit with a look at what its elements miss, where these are not too
// many.
MaterialFit LookAtElements(const Scene& scene, const EstimatorOptions& options,
                           const MaterialFit& of_elements) {
  Stopwatch stopwatch;
  const std::unique_ptr<FinerElements> finer =
      FinerElements::Of(scene, options);
  if (!finer || !of_elements.minimum) {
    return of_elements;
  }
  MaterialFit fit;
  fit.minimum = of_elements.minimum;
  DisplacementMisfit misfit(scene, options);
  misfit.SetNoise(of_elements.noise);
  DescribeFit(scene, options, misfit, finer.get(), fit);
  Estimate& estimate = fit.estimate;
  estimate.stages = of_elements.estimate.stages;
  estimate.stages.push_back({"elements", stopwatch.Lap()});
  estimate.work =
      of_elements.estimate.work + misfit.Model().WorkDone() + finer->WorkDone();
  return fit;
}

// The largest change of ln E, or of another stiffness, and of nu, from one
// estimate to another.
Eigen::Vector2d LargestChange(const Estimate& from, const Estimate& to) {
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < to.parameters.size(); ++i) {
    const ParameterEstimate& parameter = to.parameters[i];
    const double before = from.parameters[i].value;
    const double after = parameter.value;
    const double change = parameter.is_modulus
                              ? std::log(after / before)
                              : (after - before) / parameter.ErrorUnit();
    double& value = largest(parameter.IsStiffness() ? 0 : 1);
    value = std::abs(change) > std::abs(value) ? change : value;
  }
  return largest;
}

// Whether it is a node of a support that moved as measured.
bool IsAsMeasured(const Scene& scene, const Outlier& outlier) {
  const ComponentMask supports =
      AsMeasured(SupportsOf(scene, outlier.load_case));
  return !outlier.is_point && supports.size() != 0 &&
         supports.col(outlier.index).any();
}

// The outliers of a fit that some were left out of.  Little is known of the
// motion of a support that was not followed, which has to be farther off.
std::vector<Outlier> OutliersOf(const Scene& scene,
                                const ObservedDisplacements& observed,
                                const MaterialFit& fit,
                                const std::vector<Outlier>& left_out) {
  constexpr double kFarFromUnknown = 3;
  const OutlierSearch search(scene, observed, fit.displacement_of_specimen);
  const std::vector<Outlier> far = search.Beyond(kFarFromUnknown);
  std::vector<Outlier> outliers = search.Beyond(1);
  const auto is_among = [](const std::vector<Outlier>& all,
                           const Outlier& outlier) {
    return std::find(all.begin(), all.end(), outlier) != all.end();
  };
  outliers.erase(std::remove_if(outliers.begin(), outliers.end(),
                                [&](const Outlier& outlier) {
                                  return is_among(left_out, outlier) &&
                                         !is_among(far, outlier) &&
                                         IsAsMeasured(scene, outlier);
                                }),
                 outliers.end());
  return outliers;
}

// The same as a fit tells that follows no supports beside them either.
std::vector<Outlier> OutliersWithoutSuspects(
    const Scene& scene, const EstimatorOptions& options, Descent descent,
    const ObservedDisplacements& observed, const MaterialFit& fit,
    const std::vector<Outlier>& outliers, Work& work) {
  std::vector<Outlier> left_out = SuspectedSupports(scene, outliers);
  if (left_out.empty()) {
    return outliers;
  }
  left_out.insert(left_out.end(), outliers.begin(), outliers.end());
  const MaterialFit other =
      LookAtElements(WithoutOutliers(scene, left_out), options,
                     FitAll(WithoutOutliers(scene, left_out), options, descent,
                            fit.Variables()));
  work = work + other.estimate.work;
  return other.displacement.size() == 0
             ? outliers
             : OutliersOf(scene, observed, other, left_out);
}

// Without what is no outlier of a specimen that is finer than the elements.
std::vector<Outlier> StillAmong(const std::vector<Outlier>& outliers,
                                const std::vector<Outlier>& left_out) {
  std::vector<Outlier> still;
  std::copy_if(left_out.begin(), left_out.end(), std::back_inserter(still),
               [&](const Outlier& outlier) {
                 return std::find(outliers.begin(), outliers.end(), outlier) !=
                        outliers.end();
               });
  return still;
}

struct FitOfOthers {
  MaterialFit fit;
  std::vector<Outlier> left_out;
};

// Fits again without the outliers, until they are those of the fit without
// them; only those that lie apart are left out in the end.
FitOfOthers LeaveOutliersOut(const Scene& scene,
                             const EstimatorOptions& options, Descent descent,
                             const ObservedDisplacements& observed,
                             const MaterialFit& of_all) {
  constexpr int kRounds = 8;
  // What more points contradict is wrong in another way.
  constexpr double kMost = 1.0 / 3;
  const auto num_points = static_cast<double>(observed.Points().size());
  FitOfOthers others = {of_all, {}};
  MaterialFit& fit = others.fit;
  std::vector<Outlier>& left_out = others.left_out;
  const auto leave_out = [&](const std::vector<Outlier>& outliers) {
    const Work work = fit.estimate.work;
    left_out = outliers;
    if (outliers.empty()) {
      fit = of_all;
      fit.estimate.work = work;
      return;
    }
    fit = FitAll(WithoutOutliers(scene, outliers), options, descent,
                 fit.Variables());
    fit.estimate.work = fit.estimate.work + work;
  };
  Work of_suspects;
  std::vector<std::vector<Outlier>> tried = {{}};
  for (int i = 0; i < kRounds && fit.displacement.size() != 0; ++i) {
    std::vector<Outlier> outliers = OutliersOf(scene, observed, fit, left_out);
    if (outliers == left_out) {
      outliers = OutliersWithoutSuspects(scene, options, descent, observed, fit,
                                         outliers, of_suspects);
    }
    // Others were left out before, and led here.
    if (std::find(tried.begin(), tried.end(), outliers) != tried.end()) {
      break;
    }
    tried.push_back(outliers);
    if (static_cast<double>(outliers.size()) > kMost * num_points) {
      leave_out({});
      break;
    }
    leave_out(outliers);
  }
  const std::vector<Outlier> apart = OutliersApart(scene, observed, left_out);
  if (apart != left_out) {
    leave_out(apart);
  }
  fit.estimate.work = fit.estimate.work + of_suspects;
  return others;
}

// The fit without outliers, as far as they are none of finer elements either.
MaterialFit FitWithoutOutliers(const Scene& scene,
                               const EstimatorOptions& options, Descent descent,
                               const std::optional<Eigen::VectorXd>& start) {
  const ObservedDisplacements observed(scene);
  const MaterialFit of_all = FitAll(scene, options, descent, start);
  auto [fit, left_out] =
      LeaveOutliersOut(scene, options, descent, observed, of_all);
  Eigen::Vector2d by_outliers = LargestChange(of_all.estimate, fit.estimate);
  if (fit.estimate.IsUsable()) {
    MaterialFit looked =
        LookAtElements(WithoutOutliers(scene, left_out), options, fit);
    const std::vector<Outlier> outliers =
        StillAmong(OutliersOf(scene, observed, looked, left_out), left_out);
    if (outliers != left_out) {
      left_out = outliers;
      fit = FitAll(WithoutOutliers(scene, outliers), options, descent,
                   fit.Variables());
      fit.estimate.work = fit.estimate.work + looked.estimate.work;
      by_outliers = LargestChange(of_all.estimate, fit.estimate);
      looked = LookAtElements(WithoutOutliers(scene, outliers), options, fit);
    }
    fit = looked;
  }
  if (!left_out.empty()) {
    fit.estimate.outliers = left_out;
    fit.estimate.Add(OutliersLeftOut(left_out, by_outliers, fit.estimate));
  }
  if (HasUnknownMotion(scene)) {
    fit.estimate.fitted_displacement = fit.displacement;
  }
  return fit;
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
  return !IsOneIsotropicMaterial(scene.materials) || HasUnknownMotion(scene) ||
         HasSupportsOfCases(scene);
}

MaterialFit FitMaterialsFrom(const std::optional<Eigen::VectorXd>& start,
                             const Scene& scene,
                             const EstimatorOptions& options, Descent descent) {
  if (!start && HasFreeAxis(scene)) {
    Work work;
    const std::optional<Eigen::VectorXd> nearest =
        StartOfFreeAxes(scene, options, descent, work);
    MaterialFit fit = FitWithoutOutliers(scene, options, descent, nearest);
    fit.estimate.work = fit.estimate.work + work;
    return fit;
  }
  if (!IsOneIsotropicMaterial(scene.materials) ||
      !options.known_poisson_ratio) {
    return FitWithoutOutliers(scene, options, descent, start);
  }
  Scene known = scene;
  known.materials = WithKnownPoissonRatio(options);
  EstimatorOptions other_options = options;
  other_options.known_poisson_ratio.reset();
  MaterialFit fit = FitWithoutOutliers(known, other_options, descent, start);
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
