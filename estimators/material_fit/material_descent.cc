#include "elastimate/estimators/material_fit/material_descent.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/force_balance/virtual_work_regression.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/material_fit/certified_descent.h"

namespace elastimate {
namespace {

// Whether displacements at x are nearer to the measured ones than none at all
// are.
bool ExplainsAnything(const Eigen::VectorXd& x, DisplacementMisfit& misfit) {
  Eigen::VectorXd residual;
  return misfit.Evaluate(x, &residual, nullptr) &&
         Norm(residual.head(misfit.Observed().Size())) < 1;
}

struct Start {
  Eigen::VectorXd variables;
  double cost;
};

// Some nu over the range of one isotropic material, each with the E that fits
// best there; none of other scenes, and where E or nu is known.  They descend,
// as the coarse spaces of multigrid for one nu serve all smaller ones, and so
// the fit that follows.
std::vector<Start> StartsOverPoissonRatios(
    const Scene& scene, Loss loss, DisplacementMisfit& misfit,
    std::initializer_list<double> ratios = {0.499, 0.495, 0.48, 0.45, 0.3, 0.0,
                                            -0.5, -0.85}) {
  std::vector<Start> starts;
  const FreeParameters& free = misfit.Free();
  if (!CertifiedDescent::Takes(scene) || free.Size() < 2) {
    return starts;
  }
  const Bounds& range = free.VariableBounds()[1];
  for (const double nu : ratios) {
    const double within = std::clamp(nu, *range.lower, *range.upper);
    if (!starts.empty() && starts.back().variables(1) == within) {
      continue;
    }
    const auto fit =
        misfit.FitScale(free.All().Moduli(Eigen::Vector2d(1, within)), loss);
    if (fit) {
      starts.push_back(
          {free.VariablesOf(Eigen::Vector2d(1 / fit->compliance, within)),
           fit->cost});
    }
  }
  return starts;
}

// Starts that fit better than their neighbours: descents from them lead to
// every minimum that shows.
std::vector<Start> LeastOf(const std::vector<Start>& all) {
  std::vector<Start> starts;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!(i > 0 && all[i - 1].cost < all[i].cost) &&
        !(i + 1 < all.size() && all[i + 1].cost < all[i].cost)) {
      starts.push_back(all[i]);
    }
  }
  return starts;
}

}  // namespace

std::optional<Eigen::VectorXd> TypicalStart(DisplacementMisfit& misfit) {
  const FreeParameters& free = misfit.Free();
  const std::optional<double> known = free.All().KnownModulus();
  const double scale = known.value_or(1);
  const auto fit = misfit.FitScale(free.All().Moduli(free.All().Typical(scale)),
                                   Loss::kNone);
  if (fit) {
    return free.VariablesOf(free.All().Typical(scale / fit->compliance));
  }
  return known ? std::optional<Eigen::VectorXd>(
                     free.VariablesOf(free.All().Typical(*known)))
               : std::nullopt;
}

std::optional<Eigen::VectorXd> RobustStart(const Scene& scene, Loss loss,
                                           DisplacementMisfit& misfit) {
  const std::vector<Start> starts =
      StartsOverPoissonRatios(scene, loss, misfit);
  const auto best = std::min_element(
      starts.begin(), starts.end(),
      [](const Start& a, const Start& b) { return a.cost < b.cost; });
  return best == starts.end() ? std::nullopt
                              : std::optional<Eigen::VectorXd>(best->variables);
}

std::vector<Eigen::VectorXd> StartsAcrossRange(const Scene& scene,
                                               const BoundedMinimum& known,
                                               DisplacementMisfit& misfit) {
  std::vector<Start> all = StartsOverPoissonRatios(
      scene, Loss::kNone, misfit, {0.48, 0.3, 0.15, 0, -0.15, -0.3, -0.6});
  if (!all.empty()) {
    // Starts beside the known minimum lead to it.  Costs of starts are square
    // sums, and those of minima half of them.
    all.push_back({known.variables, 2 * known.cost});
    std::sort(all.begin(), all.end(), [](const Start& a, const Start& b) {
      return a.variables(1) > b.variables(1);
    });
  }
  std::vector<Eigen::VectorXd> starts;
  for (const Start& start : LeastOf(all)) {
    // Between two ratios, a descent gains less than half of what is left.
    if (start.variables != known.variables && start.cost < 4 * known.cost) {
      starts.push_back(start.variables);
    }
  }
  return starts;
}

std::optional<Eigen::VectorXd> VirtualFieldsStart(
    const Scene& scene, const EstimatorOptions& options, Estimate& estimate) {
  // Near the minimum is near enough.
  constexpr int kIterations = 10;
  EstimatorOptions of_virtual_fields = options;
  of_virtual_fields.max_iterations = kIterations;
  of_virtual_fields.on_factorization = {};
  const VirtualFields virtual_fields;
  if (!virtual_fields.WhyUnsupported(scene, of_virtual_fields).empty()) {
    return std::nullopt;
  }
  const std::optional<BoundedMinimum> minimum =
      MinimizeVirtualWork(scene, of_virtual_fields, estimate.work);
  return minimum ? std::optional<Eigen::VectorXd>(minimum->variables)
                 : std::nullopt;
}

std::optional<BoundedMinimum> BestMinimum(const Scene& scene,
                                          const EstimatorOptions& options,
                                          DisplacementMisfit& misfit,
                                          Estimate& estimate) {
  std::vector<std::optional<Eigen::VectorXd>> starts;
  for (const Start& start :
       LeastOf(StartsOverPoissonRatios(scene, Loss::kNone, misfit))) {
    starts.emplace_back(start.variables);
  }
  if (starts.empty()) {
    starts.push_back(TypicalStart(misfit));
  }
  starts.push_back(VirtualFieldsStart(scene, options, estimate));
  // The costs of descents to the same minimum differ by rounding, which must
  // not choose between them.
  constexpr double kSame = 1e-9;
  std::optional<BoundedMinimum> best;
  for (const std::optional<Eigen::VectorXd>& start : starts) {
    // A descent that begins beyond all data takes hundreds of steps, and ends
    // there.
    if (start && (!best || ExplainsAnything(*start, misfit))) {
      BoundedMinimum minimum =
          DescendFrom(options, *start, Distance::kFar, misfit, best);
      if (!best || minimum.cost < (1 - kSame) * best->cost) {
        best = minimum;
      }
    }
  }
  return best;
}

}  // namespace elastimate
