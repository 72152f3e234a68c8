#include "elastimate/estimators/material_fit/space_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/materials/material.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_descent.h"
#include "elastimate/estimators/material_fit/outliers.h"
#include "elastimate/estimators/material_fit/reduced_descent.h"
#include "elastimate/estimators/material_fit/small_strain_start.h"
#include "elastimate/estimators/misfit/descent.h"
#include "elastimate/estimators/misfit/material_verdicts.h"
#include "elastimate/estimators/reduced_model/nearby_solve.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {
namespace {

// The weights of a loss whose scale is that of the residual.
DisplacementMisfit::Weights WeightsOf(Loss loss,
                                      const ObservedDisplacements& observed,
                                      const Eigen::VectorXd& residual) {
  // Exact data have no scale.
  constexpr double kExactFit = 1e-12;
  const double deviation =
      std::max(RobustStandardDeviation(residual), kExactFit);
  DisplacementMisfit::Weights weights;
  weights.factors.resize(residual.size());
  double sum_of_slopes = 0;
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    const double square_sum =
        residual.segment(point.first, point.count).squaredNorm();
    const auto [value, first, second] =
        EvaluateLoss(loss, deviation, point.count, square_sum);
    weights.factors.segment(point.first, point.count)
        .setConstant(std::sqrt(first));
    sum_of_slopes += point.count * first + 2 * square_sum * second;
  }
  weights.mean_slope = sum_of_slopes / static_cast<double>(residual.size());
  return weights;
}

// The weights at the robust minimum of the linear model u + S d.
DisplacementMisfit::Weights WeightsAtMinimum(
    Loss loss, const ObservedDisplacements& observed,
    const Eigen::VectorXd& residual, const Eigen::MatrixXd& sensitivities) {
  constexpr int kIterations = 50;
  constexpr double kSettled = 1e-4;
  DisplacementMisfit::Weights weights = WeightsOf(loss, observed, residual);
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd last = weights.factors;
    const Eigen::VectorXd step = -SolveLeastSquares(
        last.asDiagonal() * sensitivities, last.cwiseProduct(residual));
    weights = WeightsOf(loss, observed, residual + sensitivities * step);
    if ((weights.factors - last).cwiseAbs().maxCoeff() < kSettled) {
      break;
    }
  }
  return weights;
}

// Whether the step is so short that the linear model can be trusted, to about a
// fifth of the step.  Logarithms of moduli may change by 0.2, and ratios may go
// a fifth of the way to a bound.
bool IsShort(const Eigen::VectorXd& step, const Eigen::VectorXd& x,
             const std::vector<Bounds>& bounds) {
  constexpr double kLongest = 0.2;
  for (Eigen::Index i = 0; i < step.size(); ++i) {
    const double way = std::min({1.0, bounds[i].upper.value_or(x(i) + 1) - x(i),
                                 x(i) - bounds[i].lower.value_or(x(i) - 1)});
    if (!(std::abs(step(i)) < kLongest * way)) {
      return false;
    }
  }
  return true;
}

std::vector<const Scene*> WithFinest(std::vector<const Scene*> coarser,
                                     const Scene& finest) {
  coarser.push_back(&finest);
  return coarser;
}

}  // namespace

SpaceFit::SpaceFit(Scene scene, const EstimatorOptions& options,
                   const std::vector<const Scene*>& coarser,
                   const StiffnessSolver* shared)
    : options_(options),
      scene_(std::move(scene)),
      misfit_(WithFinest(coarser, scene_), options, shared) {}

void SpaceFit::Measure(const Scene& scene, Rows rows,
                       const std::vector<Outlier>& left_out) {
  for (std::size_t k = 0; k < scene_.load_cases.size(); ++k) {
    LoadCase& load_case = scene_.load_cases[k];
    load_case.displacement = scene.load_cases[k].displacement;
    load_case.observed = scene.load_cases[k].observed;
    load_case.points = scene.load_cases[k].points;
  }
  LeaveOut(left_out, scene_);
  if (rows == Rows::kSame) {
    misfit_.Remeasure(scene_);
    return;
  }
  misfit_.ObserveAnew(scene_);
  if (certified_) {
    certified_->ForgetRows();
  }
}

void SpaceFit::KeepMinimum() {
  if (certified_) {
    misfit_.ForgetPlaced();
    certified_->KeepModel();
  }
}

void SpaceFit::ForgetModel() {
  misfit_.ForgetPlaced();
  misfit_.SetSolution({});
  certified_.reset();
}

const StiffnessSolver* SpaceFit::SolverOfCoarsest() {
  if (certified_) {
    return &certified_->Solver();
  }
  return misfit_.HasLargeStrains()
             ? nullptr
             : misfit_.SmallStrainModel().SolverOfCoarsest();
}

const std::string& SpaceFit::SolverNotice() {
  const std::string& notice = misfit_.Model().Notice();
  return notice.empty() && certified_ ? certified_->SolverNotice() : notice;
}

Work SpaceFit::WorkDone() {
  const Work work = misfit_.Model().WorkDone();
  return certified_ ? work + certified_->WorkDone() : work;
}

// Empty where displacements oppose the loads.
std::optional<BoundedMinimum> SpaceFit::FindMinimum(
    Descent descent, const std::optional<Eigen::VectorXd>& start) {
  if (options_.loss != Loss::kNone && !start) {
    if (const std::optional<Eigen::VectorXd> robust =
            RobustStart(scene_, options_.loss, misfit_)) {
      return BoundedMinimum{*robust, 0,
                            std::vector<Side>(robust->size(), Side::kNone),
                            End::kDone, ""};
    }
  }
  if (misfit_.HasLargeStrains()) {
    return FindAtLargeStrains(start);
  }
  if (!start && HasFreeAxis(scene_.materials)) {
    return FindOverAxes(descent);
  }
  if (descent == Descent::kFull) {
    return start ? DescendFrom(options_, *start, Distance::kNear, misfit_)
                 : BestMinimum(scene_, options_, misfit_, fit_.estimate);
  }
  // Once there is a certificate, no start is needed.
  if (certified_ || (!start && !misfit_.SmallStrainModel().IsRefined() &&
                     CertifiedDescent::Takes(scene_))) {
    if (!certified_) {
      certified_.emplace(scene_, options_, misfit_);
      misfit_.SetNeighbours(certified_->Graph());
    }
    return certified_->Minimize();
  }
  const std::optional<BoundedMinimum> minimum =
      ReducedMinimum(start, options_, misfit_, fit_.estimate);
  // Typical values beside known ones may be those of no material.
  return minimum ? minimum
                 : ReducedMinimum(
                       VirtualFieldsStart(scene_, options_, fit_.estimate),
                       options_, misfit_, fit_.estimate);
}

// Linear elasticity turns a specimen by displacements that are linear in the
// rotation, and a camera turns by a finite one.  Which one is among computed
// displacements is not known.
std::optional<BoundedMinimum> SpaceFit::FindOverRotations(
    Descent descent, const std::optional<Eigen::VectorXd>& start) {
  using Rotations = MotionElimination::Rotations;
  if (!scene_.is_rigid_motion_free || misfit_.HasLargeStrains() ||
      scene_.origin != Origin::kComputed) {
    return FindMinimum(descent, start);
  }
  misfit_.SetRotations(Rotations::kLinear);
  const std::optional<BoundedMinimum> linear = FindMinimum(descent, start);
  misfit_.SetRotations(Rotations::kFinite);
  const std::optional<BoundedMinimum> finite = FindMinimum(descent, start);
  if (finite && (!linear || finite->cost < linear->cost)) {
    return linear ? WithOtherModel(*finite, *linear) : finite;
  }
  misfit_.SetRotations(Rotations::kLinear);
  return linear && finite ? WithOtherModel(*linear, *finite) : linear;
}

BoundedMinimum SpaceFit::WithOtherModel(BoundedMinimum best,
                                        const BoundedMinimum& other) {
  // Chi^2 of models between which the data do not decide differ by less.
  constexpr double kAlike = 9;
  if (2 * (other.cost - best.cost) < kAlike * misfit_.Variance(2 * best.cost)) {
    best.of_other_model = other.variables;
  }
  return best;
}

// Linear hexahedra and quadrilaterals of other codes take the volume of points
// where materials are compressible.  Which ones computed the displacements is
// not known, and of a specimen neither explains much more.
std::optional<BoundedMinimum> SpaceFit::FindAtLargeStrains(
    const std::optional<Eigen::VectorXd>& start) {
  misfit_.SetDilatation(Dilatation::kMeanOfElement);
  std::optional<Eigen::VectorXd> from;
  if (start) {
    from = StiffenedStart(*start, misfit_);
  }
  if (!from) {
    // Coarser elements may have left parameters that are not determined where
    // these elements are unstable.
    from = SmallStrainStart(scene_, options_, misfit_, fit_.estimate.work);
  }
  if (!from) {
    return std::nullopt;
  }
  const BoundedMinimum of_means =
      DescendFrom(options_, *from, Distance::kNear, misfit_);
  if (IsSimplex(scene_.mesh.kind) || scene_.mesh.Order() > 1 ||
      scene_.mesh.section.model == SectionModel::kPlaneStress ||
      scene_.origin == Origin::kComputedAtLargeStrains) {
    return of_means;
  }
  misfit_.SetDilatation(Dilatation::kOfPoints);
  BoundedMinimum best =
      DescendFrom(options_, of_means.variables, Distance::kNear, misfit_);
  BoundedMinimum other = of_means;
  if (of_means.cost <= best.cost) {
    std::swap(best, other);
    misfit_.SetDilatation(Dilatation::kMeanOfElement);
  }
  return WithOtherModel(best, other);
}

// The best minimum of all starts, with another axis that is nearly as probable.
std::optional<BoundedMinimum> SpaceFit::FindOverAxes(Descent descent) {
  std::vector<BoundedMinimum> minima;
  for (const Eigen::VectorXd& start : StartsOverAxes(scene_, misfit_)) {
    if (descent == Descent::kFull) {
      minima.push_back(DescendFrom(options_, start, Distance::kFar, misfit_));
    } else if (const auto minimum =
                   ReducedMinimum(start, options_, misfit_, fit_.estimate)) {
      minima.push_back(*minimum);
    }
  }
  if (minima.empty()) {
    return std::nullopt;
  }
  std::sort(minima.begin(), minima.end(),
            [](const BoundedMinimum& a, const BoundedMinimum& b) {
              return a.cost < b.cost;
            });
  const FreeParameters& free = misfit_.Free();
  const double reach =
      minima[0].cost +
      kLimits.least_axis_preference / 2 * misfit_.Variance(2 * minima[0].cost);
  fit_.has_rival_axis = std::any_of(
      minima.begin(), minima.end(), [&](const BoundedMinimum& minimum) {
        return minimum.cost < reach &&
               AreAxesApart(free.All(), free.ParametersAt(minimum.variables),
                            free.ParametersAt(minima[0].variables));
      });
  return minima[0];
}

void SpaceFit::Minimize(Descent descent,
                        const std::optional<Eigen::VectorXd>& start) {
  fit_ = MaterialFit();
  misfit_.SetWeights({});
  Estimate& estimate = fit_.estimate;
  Stopwatch stopwatch;
  const Work before = WorkDone();
  fit_.minimum = FindOverRotations(descent, start);
  if (options_.loss != Loss::kNone && fit_.minimum) {
    Reweigh();
  }
  if (fit_.minimum) {
    EnterMinimum();
  } else {
    const std::string& why_not_solved = misfit_.Model().WhyNotSolved();
    Evidence evidence;
    evidence.do_displacements_oppose_loads = why_not_solved.empty();
    evidence.solver_notice = SolverNotice();
    Judge(evidence, options_, estimate);
    if (!why_not_solved.empty()) {
      estimate.Fail(NoEquilibrium(why_not_solved));
    }
  }
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  estimate.work = estimate.work + (WorkDone() - before);
  // A certificate would need factors of the finest space, so other values of nu
  // are tried instead.
  if (!start && fit_.minimum && descent == Descent::kReduced &&
      options_.loss == Loss::kNone && !misfit_.HasLargeStrains() &&
      misfit_.SmallStrainModel().IsRefined() &&
      CertifiedDescent::Takes(scene_)) {
    MinimizeAcrossRange(descent);
  }
}

void SpaceFit::MinimizeAcrossRange(Descent descent) {
  Stopwatch stopwatch;
  const Work before = WorkDone();
  const std::vector<Eigen::VectorXd> starts =
      StartsAcrossRange(scene_, *fit_.minimum, misfit_);
  Estimate& estimate = fit_.estimate;
  estimate.work = estimate.work + (WorkDone() - before);
  estimate.stages.front().seconds += stopwatch.Lap();
  MinimizeAlsoFrom(descent, {starts.begin(), starts.end()});
}

void SpaceFit::MinimizeAlsoWithoutStart(Descent descent) {
  MinimizeAlsoFrom(descent, {std::nullopt});
}

void SpaceFit::MinimizeAlsoFrom(
    Descent descent,
    const std::vector<std::optional<Eigen::VectorXd>>& starts) {
  Stopwatch stopwatch;
  MaterialFit best = fit_;
  Work work = fit_.estimate.work;
  const double seconds = fit_.estimate.stages.front().seconds;
  for (const std::optional<Eigen::VectorXd>& start : starts) {
    Minimize(descent, start);
    work = work + fit_.estimate.work;
    if (fit_.minimum && fit_.minimum->cost < best.minimum->cost) {
      best = fit_;
    }
  }
  fit_ = best;
  const Work before = WorkDone();
  EnterMinimum();
  fit_.estimate.work = work + (WorkDone() - before);
  fit_.estimate.stages = {{"fit", seconds + stopwatch.Lap()}};
}

void SpaceFit::EnterMinimum() {
  EnterParameters(scene_, misfit_.Free(),
                  misfit_.Free().ParametersAt(fit_.minimum->variables),
                  fit_.estimate);
  Eigen::VectorXd rows;
  if (misfit_.Evaluate(fit_.minimum->variables, &rows, nullptr)) {
    fit_.displacement = misfit_.FittedDisplacement();
    fit_.cameras = misfit_.Cameras();
    square_sum_ = SquaredNorm(rows.head(misfit_.Observed().Size()));
  }
}

void SpaceFit::Reweigh() {
  // The weights of the linear model are those of the model but for the
  // curvature of a step.
  constexpr int kRounds = 3;
  for (int i = 0; i < kRounds; ++i) {
    Eigen::VectorXd residual;
    Eigen::MatrixXd sensitivities;
    misfit_.SetWeights({});
    if (!misfit_.Evaluate(fit_.minimum->variables, &residual, &sensitivities)) {
      return;
    }
    misfit_.SetWeights(WeightsAtMinimum(options_.loss, misfit_.Observed(),
                                        residual, sensitivities));
    fit_.minimum = DescendFrom(options_, fit_.minimum->variables,
                               Distance::kNear, misfit_);
  }
}

void SpaceFit::Describe(const SpaceChange* change, SpaceFit* curved) {
  // What was said before is said anew.
  Estimate estimate;
  estimate.work = fit_.estimate.work;
  estimate.stages = fit_.estimate.stages;
  Stopwatch stopwatch;
  const Work before = WorkDone();
  Evidence evidence;
  const Eigen::VectorXd& variables = fit_.minimum->variables;
  evidence.end = fit_.minimum->end;
  evidence.search_message = fit_.minimum->message;
  EnterParameters(scene_, misfit_.Free(),
                  misfit_.Free().ParametersAt(variables), estimate);
  NoteVariablesOnBounds(misfit_.Free(), *fit_.minimum, evidence, estimate);
  const std::optional<CurvedMisfit> of_curvature =
      curved == nullptr
          ? std::nullopt
          : std::optional<CurvedMisfit>(
                {curved->misfit_, curved->fit_.minimum->variables});
  fit_.errors = DescribeMinimum(scene_, *fit_.minimum, change,
                                of_curvature ? &*of_curvature : nullptr,
                                misfit_, evidence, estimate);
  Eigen::VectorXd rows;
  if (misfit_.Evaluate(variables, &rows, nullptr)) {
    DescribeMaterials(scene_, fit_.errors, misfit_, estimate);
  }
  if (IsOneIsotropicMaterial(scene_.materials)) {
    EnterElasticity(estimate);
  }
  evidence.solver_notice = SolverNotice();
  Judge(evidence, options_, estimate);
  estimate.work = estimate.work + (WorkDone() - before);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  fit_.estimate = estimate;
}

bool SpaceFit::CompareRows(SpaceFit& coarse, const Eigen::VectorXd& variables,
                           Eigen::VectorXd& change) {
  Eigen::VectorXd of_coarse;
  if (!misfit_.Evaluate(variables, &change, nullptr)) {
    return false;
  }
  coarse.misfit_.Model().BeginWith(
      misfit_.Displacement().topRows(coarse.scene_.mesh.NumDofs()));
  if (!coarse.misfit_.Evaluate(variables, &of_coarse, nullptr)) {
    return false;
  }
  change -= of_coarse;
  return true;
}

std::optional<SpaceChange> SpaceFit::ChangeFrom(SpaceFit& coarse) {
  const Eigen::VectorXd& variables = fit_.minimum->variables;
  const Eigen::VectorXd& of_coarse = coarse.fit_.minimum->variables;
  SpaceChange change;
  change.variables = variables - of_coarse;
  change.is_of_quadratic = coarse.scene_.mesh.Order() == 2;
  coarse.misfit_.SetNoise(misfit_.Noise());
  coarse.misfit_.SetWeights(misfit_.RowWeights());
  const Work before = coarse.WorkDone();
  // Large strains may have an equilibrium at one of the minima alone.
  const bool are_solved = CompareRows(coarse, variables, change.rows) ||
                          CompareRows(coarse, of_coarse, change.rows);
  Work& work = coarse.fit_.estimate.work;
  work = work + (coarse.WorkDone() - before);
  if (!are_solved) {
    return std::nullopt;
  }
  return change;
}

std::optional<Eigen::VectorXd> SpaceFit::ChangeByHolding(
    const std::vector<HeldComponent>& components, Work& work) {
  const BoundedMinimum& minimum = *fit_.minimum;
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
  if (misfit_.HasLargeStrains() || !misfit_.SmallStrainModel().IsRefined() ||
      HasSupportsOfCases(scene_) ||
      !misfit_.Evaluate(minimum.variables, &rows, &sensitivities)) {
    return std::nullopt;
  }
  const std::optional<Eigen::MatrixXd> displacement =
      DisplacementWithHeld(components, work);
  if (!displacement) {
    return std::nullopt;
  }
  Eigen::VectorXd moved = misfit_.Observed().Restrict(*displacement) -
                          misfit_.Observed().Measured();
  if (misfit_.RowWeights().factors.size() != 0) {
    moved.array() *= misfit_.RowWeights().factors.array();
  }
  const Eigen::VectorXd step = -SolveLeastSquares(sensitivities, moved);
  const bool is_better =
      SquaredNorm(moved + sensitivities * step) < SquaredNorm(rows);
  return !is_better && IsShort(step, minimum.variables,
                               misfit_.Free().VariableBounds())
             ? std::optional<Eigen::VectorXd>(step)
             : std::nullopt;
}

std::optional<Eigen::MatrixXd> SpaceFit::DisplacementWithHeld(
    const std::vector<HeldComponent>& components, Work& work) {
  constexpr double kAccuracy = 1e-5;
  constexpr int kMostIterations = 200;
  Equilibrium& model = misfit_.SmallStrainModel();
  const Eigen::VectorXd moduli =
      misfit_.Free().ModuliAt(fit_.minimum->variables);
  Eigen::MatrixXd displacement = misfit_.Displacement();
  const Eigen::VectorXd energies =
      displacement.cwiseProduct(model.Forces().Multiply(moduli, displacement))
          .colwise()
          .sum();
  std::vector<int> rows;
  for (const auto& [component, node, held_at] : components) {
    rows.push_back(int(scene_.mesh.Dimension() * node + component));
    displacement.row(rows.back()).setConstant(held_at);
  }
  const std::optional<int> iterations =
      SolveNearby(moduli, model.Load(), kAccuracy * energies.cwiseSqrt(),
                  kMostIterations, model, displacement, rows);
  work.element_passes += 2 + iterations.value_or(kMostIterations);
  return iterations ? std::optional<Eigen::MatrixXd>(displacement)
                    : std::nullopt;
}

MaterialFit FitSpace(const Scene& scene, const EstimatorOptions& options,
                     Descent descent,
                     const std::optional<Eigen::VectorXd>& start) {
  Stopwatch stopwatch;
  SpaceFit space(scene, options);
  const StageTime assembly = {"assemble and analyse", stopwatch.Lap()};
  space.Minimize(descent, start);
  std::vector<StageTime>& stages = space.Fit().estimate.stages;
  stages.insert(stages.begin(), assembly);
  if (space.Fit().minimum) {
    space.Describe(nullptr, &space);
  }
  return space.Fit();
}

}  // namespace elastimate
