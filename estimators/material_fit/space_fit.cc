#include "elastimate/estimators/material_fit/space_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/materials/material.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/material_fit/material_descent.h"
#include "elastimate/estimators/material_fit/reduced_descent.h"
#include "elastimate/estimators/misfit/descent.h"
#include "elastimate/estimators/misfit/material_verdicts.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {
namespace {

// Empty where displacements oppose the loads.
std::optional<BoundedMinimum> FindMinimum(
    const Scene& scene, const EstimatorOptions& options, Descent descent,
    const std::optional<Eigen::VectorXd>& start, DisplacementMisfit& misfit,
    Estimate& estimate) {
  if (descent == Descent::kFull) {
    return start ? DescendFrom(options, *start, Distance::kNear, misfit)
                 : BestMinimum(scene, options, misfit, estimate);
  }
  const std::optional<BoundedMinimum> minimum =
      ReducedMinimum(start, options, misfit, estimate);
  // Typical values beside known ones may be those of no material.
  return minimum ? minimum
                 : ReducedMinimum(VirtualFieldsStart(scene, options, estimate),
                                  options, misfit, estimate);
}

// The roots of the weights of a loss whose scale is that of the residual.
Eigen::VectorXd FactorsOf(Loss loss, const ObservedDisplacements& observed,
                          const Eigen::VectorXd& residual) {
  // Exact data have no scale.
  constexpr double kExactFit = 1e-12;
  const NodeLosses losses(
      loss, std::max(RobustStandardDeviation(residual), kExactFit));
  Eigen::VectorXd factors(residual.size());
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    const double square_sum =
        residual.segment(point.first, point.count).squaredNorm();
    factors.segment(point.first, point.count)
        .setConstant(std::sqrt(losses.Evaluate(point.count, square_sum)[1]));
  }
  return factors;
}

// The factors at the robust minimum of the linear model u + S d.
Eigen::VectorXd FactorsAtMinimum(Loss loss,
                                 const ObservedDisplacements& observed,
                                 const Eigen::VectorXd& residual,
                                 const Eigen::MatrixXd& sensitivities) {
  constexpr int kIterations = 50;
  constexpr double kSettled = 1e-4;
  Eigen::VectorXd factors = FactorsOf(loss, observed, residual);
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd step = -SolveLeastSquares(
        factors.asDiagonal() * sensitivities, factors.cwiseProduct(residual));
    const Eigen::VectorXd last = factors;
    factors = FactorsOf(loss, observed, residual + sensitivities * step);
    if ((factors - last).cwiseAbs().maxCoeff() < kSettled) {
      break;
    }
  }
  return factors;
}

std::vector<const Scene*> WithFinest(std::vector<const Scene*> coarser,
                                     const Scene& finest) {
  coarser.push_back(&finest);
  return coarser;
}

}  // namespace

SpaceFit::SpaceFit(Scene scene, const EstimatorOptions& options,
                   const std::vector<const Scene*>& coarser)
    : options_(options),
      scene_(std::move(scene)),
      misfit_(WithFinest(coarser, scene_), options) {}

void SpaceFit::Minimize(Descent descent,
                        const std::optional<Eigen::VectorXd>& start) {
  Estimate& estimate = fit_.estimate;
  Stopwatch stopwatch;
  fit_.minimum =
      FindMinimum(scene_, options_, descent, start, misfit_, estimate);
  if (options_.loss != Loss::kNone && fit_.minimum) {
    Reweigh();
  }
  if (fit_.minimum) {
    EnterMinimum();
  } else {
    Evidence evidence;
    evidence.do_displacements_oppose_loads = true;
    evidence.solver_notice = misfit_.Model().Notice();
    Judge(evidence, options_, estimate);
  }
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  estimate.work = estimate.work + misfit_.Model().WorkDone();
}

void SpaceFit::EnterMinimum() {
  EnterParameters(scene_, misfit_.Free(),
                  misfit_.Free().ParametersAt(fit_.minimum->variables),
                  fit_.estimate);
  Eigen::VectorXd rows;
  if (misfit_.Evaluate(fit_.minimum->variables, &rows, nullptr)) {
    fit_.displacement = misfit_.FittedDisplacement();
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
    misfit_.SetFactors({});
    if (!misfit_.Evaluate(fit_.minimum->variables, &residual, &sensitivities)) {
      return;
    }
    misfit_.SetFactors(FactorsAtMinimum(options_.loss, misfit_.Observed(),
                                        residual, sensitivities));
    fit_.minimum = DescendFrom(options_, fit_.minimum->variables,
                               Distance::kNear, misfit_);
  }
}

void SpaceFit::Describe(const SpaceChange* change) {
  // What was said before is said anew.
  Estimate estimate;
  estimate.work = fit_.estimate.work;
  estimate.stages = fit_.estimate.stages;
  Stopwatch stopwatch;
  const Work before = misfit_.Model().WorkDone();
  Evidence evidence;
  const Eigen::VectorXd& variables = fit_.minimum->variables;
  evidence.end = fit_.minimum->end;
  evidence.search_message = fit_.minimum->message;
  EnterParameters(scene_, misfit_.Free(),
                  misfit_.Free().ParametersAt(variables), estimate);
  NoteVariablesOnBounds(misfit_.Free(), *fit_.minimum, evidence, estimate);
  fit_.errors =
      DescribeMinimum(scene_, variables, change, misfit_, evidence, estimate);
  Eigen::VectorXd rows;
  if (misfit_.Evaluate(variables, &rows, nullptr)) {
    DescribeMaterials(scene_, fit_.errors, misfit_, estimate);
  }
  if (IsOneIsotropicMaterial(scene_.materials)) {
    EnterElasticity(estimate);
  }
  evidence.solver_notice = misfit_.Model().Notice();
  Judge(evidence, options_, estimate);
  estimate.work = estimate.work + (misfit_.Model().WorkDone() - before);
  estimate.stages.push_back({"statistics", stopwatch.Lap()});
  fit_.estimate = estimate;
}

std::optional<SpaceChange> SpaceFit::ChangeFrom(SpaceFit& coarse) {
  const Eigen::VectorXd& variables = fit_.minimum->variables;
  SpaceChange change;
  change.variables = variables - coarse.fit_.minimum->variables;
  change.is_of_quadratic = coarse.scene_.mesh.Order() == 2;
  const Work before = coarse.misfit_.Model().WorkDone();
  Eigen::VectorXd of_coarse;
  coarse.misfit_.SetNoise(misfit_.Noise());
  coarse.misfit_.SetFactors(misfit_.Factors());
  const bool is_solved =
      misfit_.Evaluate(variables, &change.rows, nullptr) &&
      coarse.misfit_.Evaluate(variables, &of_coarse, nullptr);
  coarse.fit_.estimate.work =
      coarse.fit_.estimate.work + (coarse.misfit_.Model().WorkDone() - before);
  if (!is_solved) {
    return std::nullopt;
  }
  change.rows -= of_coarse;
  return change;
}

MaterialFit FitSpace(const Scene& scene, const EstimatorOptions& options,
                     Descent descent,
                     const std::optional<Eigen::VectorXd>& start) {
  Stopwatch stopwatch;
  SpaceFit space(scene, options);
  space.Fit().estimate.stages.push_back(
      {"assemble and analyse", stopwatch.Lap()});
  space.Minimize(descent, start);
  if (space.Fit().minimum) {
    space.Describe(nullptr);
  }
  return space.Fit();
}

}  // namespace elastimate
