#include "elastimate/estimators/material_fit/refined_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/material_fit/inlier_fit.h"
#include "elastimate/estimators/material_fit/outliers.h"

namespace elastimate {
namespace {

// Elements of the mesh that is divided.  A hexahedron has the nodes of six
// tetrahedra, and a quadrilateral those of two triangles.
Eigen::Index MostDividedElements(const Scene& scene) {
  // A fit of large strains factorises the finest tangent several dozen times.
  constexpr Eigen::Index kOfLargeStrains = 16;
  const bool is_simplex = IsSimplex(scene.mesh.kind);
  return (scene.mesh.Dimension() == 3 ? (is_simplex ? 20000 : 3300)
                                      : (is_simplex ? 100000 : 50000)) /
         (HasLargeStrainLaw(scene.materials) ? kOfLargeStrains : 1);
}

// Next to the end of the range of a ratio a misfit hardly has a slope: where
// coarse elements end there, finer ones start farther inside.
Eigen::VectorXd AwayFromEnds(const FreeParameters& free,
                             Eigen::VectorXd variables) {
  constexpr double kShareOfRange = 0.02;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const Bounds& bounds = free.VariableBounds()[i];
    const LawParameter& parameter = *free.Free(i).law_parameter;
    if (bounds.lower && bounds.upper && !parameter.is_modulus) {
      const double margin = kShareOfRange * (*bounds.upper - *bounds.lower);
      variables(i) = std::clamp(variables(i), *bounds.lower + margin,
                                *bounds.upper - margin);
    }
  }
  return variables;
}

// Whether the nodes where a support may end (Supports::in_doubt) are held.
enum class SupportEnds { kFree, kHeld };

// Returns the scene with quadratic elements.
Scene WithQuadraticElements(const Scene& scene, SupportEnds ends) {
  Scene quadratic = scene.mesh.Order() == 1 ? FinerScene(scene) : scene;
  if (ends == SupportEnds::kHeld) {
    Supports& supports = quadratic.supports;
    for (const auto& [component, node, displacement] : supports.in_doubt) {
      supports.held(component, node) = true;
      supports.displacement(component, node) = displacement;
    }
  }
  return quadratic;
}

// Whether a divided mesh could hardly lower the errors, of which noise has
// more.
bool IsMeshErrorSmall(const Estimate& estimate) {
  const ParameterErrors& mesh = estimate.error_budget.discretization;
  const ParameterErrors& noise = estimate.error_budget.noise;
  if (!estimate.IsUsable() || mesh.size() == 0 || noise.size() != mesh.size()) {
    return false;
  }
  for (Eigen::Index i = 0; i < mesh.size(); ++i) {
    if (!estimate.parameters[i].is_known && !(mesh(i) <= noise(i))) {
      return false;
    }
  }
  return true;
}

// The fits of one scene on finer and finer elements.
class Refinement {
 public:
  Refinement(const Scene& scene, const EstimatorOptions& options,
             Descent descent)
      : scene_(scene),
        options_(options),
        descent_(descent),
        neighbours_(scene.mesh) {
    neighbours_.element_pairs.resize(0, 0);  // Only assembly needs these.
  }

  MaterialFit Fit(const std::optional<Eigen::VectorXd>& start,
                  MisfitCurvature curvature);

 private:
  /// The second fit and, where the mesh is divided, the third, with what
  /// changed to the last one.
  struct Chain {
    std::unique_ptr<SpaceFit> quadratic;
    std::unique_ptr<SpaceFit> divided;
    /// The fit before the last one; null where the last one is the only one.
    SpaceFit* coarser = nullptr;
    /// Empty where the coarser one has no equilibrium at the last minimum.
    std::optional<SpaceChange> change;
    std::vector<Outlier> left_out;
    Estimate of_all;      ///< Before outliers were left out of the second fit.
    Estimate of_inliers;  ///< After that, where there were some.
    Work work;

    SpaceFit& Finest() const { return divided ? *divided : *quadratic; }
  };

  Chain FitQuadratic(SupportEnds ends,
                     const std::optional<Eigen::VectorXd>& start);
  /// Fits with the nodes where supports may end free, and finds or fits the
  /// minimum with them held.  Returns the better fit, to be moved to the mean
  /// of both.
  Chain FitOverSupportEnds(const std::optional<Eigen::VectorXd>& start);
  /// Looks for a better minimum than the one that coarser elements led to.
  void LookForBetterMinimum(const SpaceFit& coarser, SpaceFit& fit) const;
  void LeaveOut(const MaterialFit& of_all, SupportEnds ends,
                const std::vector<const Scene*>& coarser, Chain& chain);
  static Chain MeanOf(Chain held, Chain free);
  /// Whether the mesh is to be divided.  Describes the second fit where its
  /// errors decide that.
  bool AsksForDivision(Chain& chain) const;
  static void Describe(Chain& chain, SpaceFit* curved);
  /// Begins, at large strains, with the displacements of `last`, a fit of
  /// coarser elements. `last` gives back memory (SpaceFit::KeepMinimum).
  std::unique_ptr<SpaceFit> MinimizeOn(
      Scene scene, const std::optional<Eigen::VectorXd>& start,
      const std::vector<const Scene*>& coarser = {}, SpaceFit* last = nullptr) {
    auto space = std::make_unique<SpaceFit>(std::move(scene), options_, coarser,
                                            last != nullptr && !coarser.empty()
                                                ? last->SolverOfCoarsest()
                                                : nullptr);
    space->Misfit().SetNeighbours(neighbours_);
    if (last != nullptr) {
      last->KeepMinimum();
    }
    if (space->Misfit().HasLargeStrains() && last != nullptr &&
        last->Fit().displacement.size() > 0) {
      space->Misfit().Model().BeginWith(
          FinerNodes(last->OwnScene().mesh, space->OwnScene().mesh)
              .Interpolate(last->Fit().displacement));
    }
    space->Minimize(descent_, start);
    has_rival_axis_ = has_rival_axis_ || space->Fit().has_rival_axis;
    return space;
  }
  /// Fits again in the same space, to the measurement of a scene less some
  /// outliers.  `scene` makes the scene when it is called, so that a large one
  /// is in memory only meanwhile.
  template <class MakeScene>
  void Refit(const MakeScene& scene, const std::vector<Outlier>& left_out,
             const std::optional<Eigen::VectorXd>& start,
             const std::vector<const Scene*>& coarser,
             std::unique_ptr<SpaceFit>& space) {
    if (HasUnknownMotion(scene_)) {
      space = MinimizeOn(WithoutOutliers(scene(), left_out), start, coarser);
    } else {
      space->Measure(scene(), SpaceFit::Rows::kOther, left_out);
      space->Minimize(descent_, start);
    }
  }
  /// Whether linear elements explain so much more than quadratic ones that they
  /// computed the measurement: displacements of a specimen never ask for that,
  /// and those of linear elements always do.
  bool IsOfLinearElements() const {
    constexpr double kLogLikelihoodRatio = -9;
    // Where the strain is uniform, both are exact; the measurement has norm 1.
    constexpr double kExact = kLimits.exact_residual * kLimits.exact_residual;
    // Elements that leave half of the measurement did not compute it.
    constexpr double kOther = 0.25;
    // Supports that follow the noise of their nodes leave another residual of
    // it in each space.
    return linear_ && linear_->Fit().minimum && !HasBounds() &&
           !HasUnknownMotion(scene_) && least_of_quadratic_ > kExact &&
           linear_->SquareSum() < kOther &&
           static_cast<double>(linear_->NumRows()) *
                   std::log(linear_->SquareSum() / least_of_quadratic_) <
               kLogLikelihoodRatio;
  }
  /// Whether linear elements, too, leave so much that the model is wrong.
  bool LeavesSmoothPart(const Estimate& finest) const {
    return finest.IsRefusedFor(FindingCode::kSmoothResidual) &&
           linear_->SquareSum() >
               kLimits.large_residual * kLimits.large_residual;
  }
  /// Whether bounds are given, which a fit may end on that would go on without.
  bool HasBounds() const {
    return options_.youngs_modulus.AreGiven() ||
           options_.poisson_ratio.AreGiven() ||
           std::any_of(scene_.materials.begin(), scene_.materials.end(),
                       [](const Material& material) {
                         return !material.bounds.empty();
                       });
  }
  bool MayDivide() const {
    return options_.refinement != Refine::kNever &&
           (options_.refinement == Refine::kAlways ||
            scene_.mesh.NumElements() <= MostDividedElements(scene_));
  }

  const Scene& scene_;
  const EstimatorOptions& options_;
  Descent descent_;
  NodeGraph neighbours_;
  /// Where the elements of the scene are linear.
  std::unique_ptr<SpaceFit> linear_;
  /// The least residual of the second fits, on any support ends.
  double least_of_quadratic_ = std::numeric_limits<double>::infinity();
  /// Only fits without a start look for one.
  bool has_rival_axis_ = false;
};

void Refinement::LeaveOut(const MaterialFit& of_all, SupportEnds ends,
                          const std::vector<const Scene*>& coarser,
                          Chain& chain) {
  const auto quadratic = [&] { return WithQuadraticElements(scene_, ends); };
  // Where motions are unknown, each fit is a new SpaceFit, so that the search
  // needs a scene that outlives them.
  const Scene copy = HasUnknownMotion(scene_) ? quadratic() : Scene();
  bool is_refitted = false;
  const InlierFit inliers = LeaveOutliersOut(
      HasUnknownMotion(scene_) ? copy : chain.quadratic->OwnScene(),
      [&](const std::vector<Outlier>& left_out,
          const std::optional<Eigen::VectorXd>& from) {
        is_refitted = true;
        Refit(quadratic, left_out, from, coarser, chain.quadratic);
        return chain.quadratic->Fit();
      },
      of_all);
  chain.work = inliers.fit.estimate.work;
  if (!is_refitted) {
    return;
  }
  const bool are_some_left_out =
      !inliers.left_out.empty() && inliers.fit.minimum;
  const std::vector<Outlier> left_out =
      are_some_left_out ? inliers.left_out : std::vector<Outlier>();
  const std::optional<Eigen::VectorXd> variables =
      are_some_left_out ? inliers.fit.Variables() : of_all.Variables();
  // The last fit of the search may have been of others.
  Refit(quadratic, left_out, variables, coarser, chain.quadratic);
  chain.work = chain.work + chain.quadratic->Fit().estimate.work;
  if (are_some_left_out) {
    chain.left_out = left_out;
    chain.of_inliers = inliers.fit.estimate;
    if (linear_) {
      Refit([&]() -> const Scene& { return scene_; }, left_out,
            linear_->Fit().Variables(), {}, linear_);
      chain.work = chain.work + linear_->Fit().estimate.work;
    }
  }
}

// Coarse elements that lock may end far from the right nu.  A finer fit that
// starts there may come to a minimum that is not the best.
bool MayLeadAstray(const SpaceFit& coarser, SpaceFit& fit) {
  // Square sums are relative to that of the measured displacements.
  constexpr double kLocked = kLimits.large_residual * kLimits.large_residual;
  // At small strains, other values of nu are looked at in any case
  // (CovarianceAcrossRange).
  const double least_trusted = fit.Misfit().HasLargeStrains() ? 0 : -0.98;
  return coarser.SquareSum() > std::max(kLocked, 4 * fit.SquareSum()) ||
         fit.Fit().minimum->variables.tail<1>()(0) < least_trusted;
}

void Refinement::LookForBetterMinimum(const SpaceFit& coarser,
                                      SpaceFit& fit) const {
  if (!coarser.Fit().minimum || !fit.Fit().minimum ||
      options_.loss != Loss::kNone || HasUnknownMotion(scene_) ||
      !MayLeadAstray(coarser, fit)) {
    return;
  }
  if (fit.Misfit().HasLargeStrains()) {
    fit.MinimizeAlsoWithoutStart(descent_);
  } else if (IsOneIsotropicMaterial(scene_.materials)) {
    fit.MinimizeAcrossRange(descent_);
  }
}

Refinement::Chain Refinement::FitQuadratic(
    SupportEnds ends, const std::optional<Eigen::VectorXd>& start) {
  Chain chain;
  std::vector<const Scene*> coarser;
  // The elimination of motions asks for a solution for each of its steps.
  if (linear_ && !HasUnknownMotion(scene_)) {
    coarser.push_back(&scene_);
  }
  chain.quadratic = MinimizeOn(WithQuadraticElements(scene_, ends), start,
                               coarser, linear_.get());
  if (linear_) {
    LookForBetterMinimum(*linear_, *chain.quadratic);
  }
  chain.work = chain.quadratic->Fit().estimate.work;
  if (!chain.quadratic->Fit().minimum) {
    return chain;
  }
  const MaterialFit of_all = chain.quadratic->Fit();
  chain.of_all = of_all.estimate;
  // A loss takes the weight from outliers.
  if (options_.loss == Loss::kNone) {
    LeaveOut(of_all, ends, coarser, chain);
  }
  SpaceFit& fit = *chain.quadratic;
  least_of_quadratic_ = std::min(least_of_quadratic_, fit.SquareSum());
  if (linear_ && linear_->Fit().minimum) {
    chain.coarser = linear_.get();
    chain.change = fit.ChangeFrom(*linear_);
    if (chain.change) {
      chain.change->is_kept_for_its_size = true;
    }
  }
  if (AsksForDivision(chain)) {
    if (!HasUnknownMotion(scene_)) {
      coarser.push_back(&fit.OwnScene());
    }
    std::unique_ptr<SpaceFit> divided = MinimizeOn(
        FinerScene(fit.OwnScene()), fit.Fit().Variables(), coarser, &fit);
    LookForBetterMinimum(fit, *divided);
    chain.work = chain.work + divided->Fit().estimate.work;
    if (divided->Fit().minimum) {
      chain.coarser = &fit;
      chain.change = divided->ChangeFrom(fit);
      chain.divided = std::move(divided);
    }
  }
  return chain;
}

bool Refinement::AsksForDivision(Chain& chain) const {
  if (!MayDivide() || IsOfLinearElements() ||
      chain.quadratic->Fit().minimum->end == End::kSearchFailed) {
    return false;
  }
  if (options_.refinement == Refine::kAlways) {
    return true;
  }
  Describe(chain, nullptr);
  return !IsMeshErrorSmall(chain.quadratic->Fit().estimate);
}

// Describes the finest fit by what changed to it.
void Refinement::Describe(Chain& chain, SpaceFit* curved) {
  SpaceFit& fit = chain.Finest();
  const Work before = fit.Fit().estimate.work;
  fit.Describe(chain.change ? &*chain.change : nullptr, curved);
  chain.work = chain.work + (fit.Fit().estimate.work - before);
  if (chain.coarser != nullptr && !chain.change) {
    fit.Fit().estimate.Fail(
        SearchFailed("the coarser elements have no equilibrium with the "
                     "parameters of the finer ones"));
  }
}

// Takes the ends of supports that leave less, shifted to the mean of both.
Refinement::Chain Refinement::MeanOf(Chain held, Chain free) {
  Chain& best =
      held.Finest().SquareSum() < free.Finest().SquareSum() ? held : free;
  const Chain& other = &best == &held ? free : held;
  if (best.change) {
    best.change->by_supports = (other.Finest().Fit().minimum->variables -
                                best.Finest().Fit().minimum->variables) /
                               2;
  }
  best.work = best.work + other.work;
  return std::move(best);
}

Refinement::Chain Refinement::FitOverSupportEnds(
    const std::optional<Eigen::VectorXd>& start) {
  Chain free = FitQuadratic(SupportEnds::kFree, start);
  const std::vector<HeldComponent>& in_doubt =
      free.quadratic->OwnScene().supports.in_doubt;
  if (in_doubt.empty() || !free.Finest().Fit().minimum) {
    return free;
  }
  const std::optional<Eigen::VectorXd> change =
      free.divided ? std::nullopt
                   : free.quadratic->ChangeByHolding(in_doubt, free.work);
  if (change && free.change) {
    free.change->by_supports = *change / 2;
    return free;
  }
  Chain held = FitQuadratic(SupportEnds::kHeld, start);
  return held.Finest().Fit().minimum ? MeanOf(std::move(held), std::move(free))
                                     : std::move(free);
}

MaterialFit Refinement::Fit(const std::optional<Eigen::VectorXd>& start,
                            MisfitCurvature curvature) {
  std::optional<Eigen::VectorXd> last = start;
  Work work;
  if (scene_.mesh.Order() == 1) {
    linear_ = MinimizeOn(scene_, start);
    if (!linear_->Fit().minimum) {
      return linear_->Fit();
    }
    work = linear_->Fit().estimate.work;
    last = AwayFromEnds(linear_->Misfit().Free(),
                        linear_->Fit().minimum->variables);
  }
  Chain chain = FitOverSupportEnds(last);
  const bool is_of_linear_elements = IsOfLinearElements();
  // A wrong law of large strains may explain more with stiffer elements.
  const bool may_be_of_another_law =
      is_of_linear_elements && linear_->Misfit().HasLargeStrains();
  if (may_be_of_another_law) {
    chain.Finest().Fit().minimum->of_other_model =
        linear_->Fit().minimum->variables;
  }
  if (linear_) {
    linear_->ForgetModel();
  }
  if (chain.Finest().Fit().minimum) {
    // A divided mesh would hardly change the curvature.
    Describe(chain, curvature == MisfitCurvature::kConsidered
                        ? chain.quadratic.get()
                        : nullptr);
  }
  MaterialFit fit = chain.Finest().Fit();
  fit.has_rival_axis = has_rival_axis_;
  fit.estimate.mesh_divisions = chain.divided ? 1 : 0;
  fit.estimate.work = work + chain.work;
  EnterOutliers(chain.left_out, chain.of_all, chain.of_inliers, fit.estimate);
  if (may_be_of_another_law) {
    fit.estimate.Add(ComputedByLinearElements(Severity::kWarning));
  } else if (is_of_linear_elements && !LeavesSmoothPart(fit.estimate)) {
    // What else there is to say follows from that.
    fit.estimate.findings.clear();
    fit.estimate.Fail(ComputedByLinearElements(Severity::kError));
  }
  if (fit.displacement.size() != 0) {
    fit.displacement = fit.displacement.topRows(scene_.mesh.NumDofs()).eval();
  }
  return fit;
}

}  // namespace

MaterialFit FitRefined(const Scene& scene, const EstimatorOptions& options,
                       Descent descent,
                       const std::optional<Eigen::VectorXd>& start,
                       MisfitCurvature curvature) {
  return Refinement(scene, options, descent).Fit(start, curvature);
}

}  // namespace elastimate
