#include "elastimate/estimators/material_fit/refined_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/simplicial_scene.h"
#include "elastimate/core/scene/support_ends.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/material_fit/inlier_fit.h"
#include "elastimate/estimators/material_fit/outliers.h"

namespace elastimate {
namespace {

// Elements of the mesh that is divided.
Eigen::Index MostDividedElements(int dimension) {
  return dimension == 3 ? 20000 : 100000;
}

// Next to the end of the range of a ratio a misfit hardly has a slope: where
// coarse elements end there, finer ones start farther inside.
Eigen::VectorXd AwayFromEnds(const FreeParameters& free,
                             Eigen::VectorXd variables) {
  constexpr double kShareOfRange = 0.02;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const Bounds& bounds = free.VariableBounds()[i];
    const LawParameter& parameter =
        *free.All().All()[free.All().Free()[i]].law_parameter;
    if (bounds.lower && bounds.upper && !parameter.is_modulus) {
      const double margin = kShareOfRange * (*bounds.upper - *bounds.lower);
      variables(i) = std::clamp(variables(i), *bounds.lower + margin,
                                *bounds.upper - margin);
    }
  }
  return variables;
}

bool HasOpenEnds(const Scene& scene) {
  return !scene.supports.ends.empty() ||
         std::any_of(scene.load_cases.begin(), scene.load_cases.end(),
                     [](const LoadCase& load_case) {
                       return load_case.supports &&
                              !load_case.supports->ends.empty();
                     });
}

// Holds all nodes in doubt, or none.
Supports Ended(const Supports& supports, bool are_held) {
  std::vector<std::size_t> num_steps;
  for (const SupportEnd& end : supports.ends) {
    num_steps.push_back(are_held ? end.steps.size() : 0);
  }
  return EndingAfter(num_steps, supports);
}

Scene WithEnds(Scene scene, bool are_held) {
  scene.supports = Ended(scene.supports, are_held);
  for (LoadCase& load_case : scene.load_cases) {
    if (load_case.supports) {
      load_case.supports = Ended(*load_case.supports, are_held);
    }
  }
  return scene;
}

// Whether linear elements explain so much more than quadratic ones that they
// computed the measurement: displacements of a specimen never ask for that, and
// those of linear elements always do.
bool AreOfLinearElements(Eigen::Index num_rows, double of_linear,
                         double of_quadratic) {
  constexpr double kLogLikelihoodRatio = -9;
  // Where the strain is uniform, both are exact; the measurement has norm 1.
  constexpr double kExact = kLimits.exact_residual * kLimits.exact_residual;
  return of_quadratic > kExact &&
         static_cast<double>(num_rows) * std::log(of_linear / of_quadratic) <
             kLogLikelihoodRatio;
}

// What is left where the mesh is not divided.
bool IsMeshErrorSmall(const Estimate& estimate) {
  constexpr double kShareOfNoise = 0.5;
  const ParameterErrors& mesh = estimate.error_budget.discretization;
  const ParameterErrors& noise = estimate.error_budget.noise;
  if (!estimate.IsUsable() || mesh.size() == 0 ||
      noise.size() != mesh.size()) {
    return false;
  }
  for (Eigen::Index i = 0; i < mesh.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double tolerance = parameter.IsStiffness()
                                 ? kLimits.notable_youngs_modulus_error
                                 : kLimits.notable_poisson_ratio_error;
    if (!parameter.is_known &&
        !(mesh(i) <= std::max(tolerance, kShareOfNoise * noise(i)))) {
      return false;
    }
  }
  return true;
}

bool IsSolved(const MaterialFit& fit) {
  return fit.minimum && fit.minimum->end != End::kSingularStiffness &&
         fit.minimum->end != End::kSearchFailed;
}

// The fits of one scene on finer and finer elements.
class Refinement {
 public:
  Refinement(const Scene& scene, const EstimatorOptions& options,
             Descent descent)
      : scene_(scene), options_(options), descent_(descent) {}

  MaterialFit Fit(const std::optional<Eigen::VectorXd>& start);

 private:
  /// The second and third fit; with the minimum of other support ends in
  /// `other`, the mean of both.
  MaterialFit FitQuadratic(const Scene& quadratic,
                           const std::optional<Eigen::VectorXd>& start,
                           const std::optional<Eigen::VectorXd>& other);
  std::unique_ptr<SpaceFit> MinimizeOn(
      const Scene& scene, const std::optional<Eigen::VectorXd>& start,
      const std::vector<const Scene*>& coarser = {}) const {
    auto space = std::make_unique<SpaceFit>(scene, options_, coarser);
    space->Minimize(descent_, start);
    // Iterations may not converge for flat elements and next to nu = 1/2.
    if (!coarser.empty() && !IsSolved(space->Fit())) {
      space = std::make_unique<SpaceFit>(scene, options_);
      space->Minimize(descent_, start);
    }
    return space;
  }
  bool MayDivide(const Scene& quadratic) const {
    return options_.refinement != Refine::kNever &&
           (options_.refinement == Refine::kAlways ||
            quadratic.mesh.NumElements() <=
                MostDividedElements(scene_.mesh.Dimension()));
  }

  const Scene& scene_;
  const EstimatorOptions& options_;
  Descent descent_;
  /// Where the elements of the scene are linear.
  std::unique_ptr<SpaceFit> linear_;
  /// Its simplices, which the quadratic ones are nested in.
  std::optional<Scene> simplicial_;
  /// The least residual of the second fits, on any support ends.
  double least_of_quadratic_ = std::numeric_limits<double>::infinity();
};

// Describes the finer one of two fits by what changed, which the other support
// ends shift.
void DescribeChange(SpaceFit& coarse, bool is_last,
                    const std::optional<Eigen::VectorXd>& other,
                    SpaceFit& fine) {
  std::optional<SpaceChange> change = fine.ChangeFrom(coarse);
  if (!change) {
    fine.Describe(nullptr);
    return;
  }
  change->is_kept_for_its_size = is_last;
  if (other) {
    change->by_supports = (*other - fine.Fit().minimum->variables) / 2;
  }
  fine.Describe(&*change);
}

MaterialFit Refinement::FitQuadratic(
    const Scene& quadratic, const std::optional<Eigen::VectorXd>& start,
    const std::optional<Eigen::VectorXd>& other) {
  std::vector<const Scene*> coarser;
  // The elimination of motions asks for a solution for each of its steps.
  if (simplicial_ && !HasUnknownMotion(scene_)) {
    coarser.push_back(&*simplicial_);
  }
  std::unique_ptr<SpaceFit> coarse = MinimizeOn(quadratic, start, coarser);
  if (!coarse->Fit().minimum) {
    return coarse->Fit();
  }
  const MaterialFit of_all = coarse->Fit();
  // A loss takes the weight from outliers.
  const InlierFit inliers =
      options_.loss == Loss::kNone
          ? LeaveOutliersOut(
                quadratic,
                [&](const Scene& others,
                    const std::optional<Eigen::VectorXd>& from) {
                  return MinimizeOn(others, from, coarser)->Fit();
                },
                of_all)
          : InlierFit{of_all, {}};
  Work work = inliers.fit.estimate.work;
  if (!inliers.left_out.empty() && inliers.fit.minimum) {
    coarse = MinimizeOn(WithoutOutliers(quadratic, inliers.left_out),
                        inliers.fit.Variables(), coarser);
    work = work + coarse->Fit().estimate.work;
    if (linear_) {
      linear_ = MinimizeOn(WithoutOutliers(scene_, inliers.left_out),
                           linear_->Fit().Variables());
      work = work + linear_->Fit().estimate.work;
    }
  }
  std::unique_ptr<SpaceFit> finest = std::move(coarse);
  least_of_quadratic_ =
      std::min(least_of_quadratic_, finest->SquareSum());
  if (linear_ && linear_->Fit().minimum) {
    DescribeChange(*linear_, true, other, *finest);
  } else {
    finest->Describe(nullptr);
  }
  if (MayDivide(quadratic) &&
      (options_.refinement == Refine::kAlways ||
       !IsMeshErrorSmall(finest->Fit().estimate))) {
    if (!HasUnknownMotion(scene_)) {
      coarser.push_back(&finest->OwnScene());
    }
    std::unique_ptr<SpaceFit> divided = MinimizeOn(
        FinerScene(finest->OwnScene()), finest->Fit().Variables(), coarser);
    if (divided->Fit().minimum) {
      DescribeChange(*finest, false, other, *divided);
      work = work + divided->Fit().estimate.work;
      divided->Fit().estimate.mesh_divisions = 1;
      finest = std::move(divided);
    }
  }
  MaterialFit fit = finest->Fit();
  fit.estimate.work = work;
  EnterOutliers(inliers.left_out, of_all.estimate, inliers.fit.estimate,
                fit.estimate);
  return fit;
}

MaterialFit Refinement::Fit(const std::optional<Eigen::VectorXd>& start) {
  std::optional<Eigen::VectorXd> last = start;
  Work work;
  if (scene_.mesh.Order() == 1) {
    linear_ = MinimizeOn(scene_, start);
    simplicial_ = SimplicialScene(scene_);
    if (!linear_->Fit().minimum) {
      return linear_->Fit();
    }
    work = linear_->Fit().estimate.work;
    last = AwayFromEnds(linear_->Misfit().Free(),
                        linear_->Fit().minimum->variables);
  }
  const Scene quadratic =
      scene_.mesh.Order() == 1 ? FinerScene(scene_) : scene_;
  std::optional<Eigen::VectorXd> of_held;
  if (HasOpenEnds(quadratic)) {
    const MaterialFit held =
        FitQuadratic(WithEnds(quadratic, true), last, std::nullopt);
    of_held = held.Variables();
    last = of_held ? of_held : last;
    work = work + held.estimate.work;
  }
  MaterialFit fit = FitQuadratic(WithEnds(quadratic, false), last, of_held);
  fit.estimate.work = fit.estimate.work + work;
  if (linear_ && linear_->Fit().minimum &&
      AreOfLinearElements(linear_->NumRows(), linear_->SquareSum(),
                          least_of_quadratic_)) {
    fit.estimate.Fail(ComputedByLinearElements());
  }
  if (fit.displacement.size() != 0) {
    fit.displacement =
        fit.displacement.topRows(scene_.mesh.NumDofs()).eval();
  }
  return fit;
}

}  // namespace

MaterialFit FitRefined(const Scene& scene, const EstimatorOptions& options,
                       Descent descent,
                       const std::optional<Eigen::VectorXd>& start) {
  return Refinement(scene, options, descent).Fit(start);
}

}  // namespace elastimate
