#include "elastimate/estimators/misfit/descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {
namespace {

// Steps below this part of a standard error end a search.
constexpr double kSmallestStepOfErrors = 1e-2;

// Next to nu = 1/2 and nu = -1, displacements change with the distance to these
// ends.  Steps in nu would overshoot the ends at once, and return only slowly.
// So the search of one material takes its steps in
// ln((1 + nu) / (1/2 - nu)) instead.  Among several whose stiffnesses differ by
// 10^4, such steps led to a minimum that leaves 28 times as much.
class SearchVariables {
 public:
  explicit SearchVariables(const FreeParameters& free)
      : bounds_(free.VariableBounds()) {
    for (Eigen::Index i = 0; i < free.Size(); ++i) {
      is_ratio_.push_back(free.All().NumMaterials() == 1 &&
                          free.Free(i).law_parameter->name == "poisson_ratio");
    }
  }

  Eigen::VectorXd Of(Eigen::VectorXd variables) const {
    for (Eigen::Index i = 0; i < variables.size(); ++i) {
      if (is_ratio_[i]) {
        variables(i) = OfRatio(variables(i));
      }
    }
    return variables;
  }
  std::vector<Bounds> SearchBounds() const {
    std::vector<Bounds> bounds = bounds_;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      if (is_ratio_[i]) {
        bounds[i] = {OfRatio(*bounds[i].lower), OfRatio(*bounds[i].upper)};
      }
    }
    return bounds;
  }
  Eigen::VectorXd Back(Eigen::VectorXd searched) const {
    for (Eigen::Index i = 0; i < searched.size(); ++i) {
      if (is_ratio_[i]) {
        // Rounding must not leave the bounds.
        searched(i) = std::clamp(0.5 - 1.5 / (1 + std::exp(searched(i))),
                                 *bounds_[i].lower, *bounds_[i].upper);
      }
    }
    return searched;
  }
  // d variables / d searched, a diagonal.
  Eigen::VectorXd Slopes(const Eigen::VectorXd& variables) const {
    Eigen::VectorXd slopes = Eigen::VectorXd::Ones(variables.size());
    for (Eigen::Index i = 0; i < variables.size(); ++i) {
      if (is_ratio_[i]) {
        slopes(i) = (1 + variables(i)) * (0.5 - variables(i)) / 1.5;
      }
    }
    return slopes;
  }

 private:
  static double OfRatio(double nu) {
    const double within =
        std::clamp(nu, kSmallestPoissonRatio, kLargestPoissonRatio);
    return std::log((1 + within) / (0.5 - within));
  }

  const std::vector<Bounds>& bounds_;
  std::vector<bool> is_ratio_;
};

BoundedMinimum Search(const EstimatorOptions& estimator_options,
                      const Eigen::VectorXd& start, Distance distance,
                      DisplacementMisfit& misfit) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = estimator_options.max_iterations;
  // Far from the minimum, Gauss-Newton steps lead weakly determined parameters
  // astray; the radius grows with each step that holds what it promised.
  constexpr double kLargeRadius = 1e8;
  options.initial_trust_region_radius =
      distance == Distance::kFar ? 1 : kLargeRadius;
  // A step of k standard errors lowers the cost by about k^2 / n of itself.
  options.function_tolerance = kSmallestStepOfErrors * kSmallestStepOfErrors /
                               static_cast<double>(misfit.NumRows());
  // Exact displacements leave small gradients far from the minimum, too.
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-11;
  options.logging_type = ceres::SILENT;
  // A trial without an equilibrium costs more than a step of the search, and a
  // search that meets many of them ends in nothing.
  int failures_left = std::numeric_limits<int>::max();
  if (misfit.HasLargeStrains()) {
    failures_left = 8;
    options.max_num_line_search_step_size_iterations = 5;
  }
  const SearchVariables searched(misfit.Free());
  BoundedMinimum minimum = MinimizeOverVariables(
      [&](const Eigen::VectorXd& at, Eigen::VectorXd* residual,
          Eigen::MatrixXd* jacobian) {
        const Eigen::VectorXd x = searched.Back(at);
        const bool is_solved =
            failures_left > 0 && misfit.Evaluate(x, residual, jacobian);
        failures_left -= is_solved ? 0 : 1;
        if (is_solved && jacobian != nullptr) {
          *jacobian = (*jacobian * searched.Slopes(x).asDiagonal()).eval();
        }
        return is_solved;
      },
      misfit.NumRows(), searched.SearchBounds(), searched.Of(start), options);
  minimum.variables = searched.Back(minimum.variables);
  return minimum;
}

// Whether a search from far has ended at a minimum that is known.
bool EndedAt(const BoundedMinimum& known, const BoundedMinimum& minimum,
             const std::vector<Bounds>& bounds) {
  // Relative in moduli; in ratios, of the way to the nearer end of the range.
  constexpr double kOfModulus = 0.01;
  constexpr double kOfWay = 0.05;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double value = known.variables(Eigen::Index(i));
    const double difference =
        std::abs(minimum.variables(Eigen::Index(i)) - value);
    const double way =
        bounds[i].lower && bounds[i].upper
            ? std::min(value - *bounds[i].lower, *bounds[i].upper - value)
            : kOfModulus / kOfWay;
    if (!(difference < kOfWay * way)) {
      return false;
    }
  }
  return minimum.cost >= known.cost;
}

// The small radius of a search from far shortens its last steps as well, so
// that it ends early; one without that radius follows.
BoundedMinimum Descend(const EstimatorOptions& options,
                       const Eigen::VectorXd& start, Distance distance,
                       DisplacementMisfit& misfit,
                       const std::optional<BoundedMinimum>& known) {
  const BoundedMinimum minimum = Search(options, start, distance, misfit);
  if (known && EndedAt(*known, minimum, misfit.Free().VariableBounds())) {
    return *known;
  }
  return distance == Distance::kFar && minimum.end == End::kDone
             ? Search(options, minimum.variables, Distance::kNear, misfit)
             : minimum;
}

// The standard deviation of a displacement row at x, as given or from what is
// left there, at least kLeastNoise.
double NoiseAt(const Eigen::VectorXd& x, DisplacementMisfit& misfit) {
  const ObservedDisplacements& observed = misfit.Observed();
  Eigen::VectorXd residual;
  // What is given costs no evaluation.
  if (observed.GivenNoise() || !misfit.Evaluate(x, &residual, nullptr)) {
    return std::sqrt(misfit.Variance(0));
  }
  return std::sqrt(
      misfit.Variance(SquaredNorm(residual.head(observed.Size()))));
}

// From the start on, with resultants that weigh as much as their errors say
// beside those of the displacements, which the fit shows.
BoundedMinimum DescendWithResultants(const EstimatorOptions& options,
                                     const Eigen::VectorXd& start,
                                     Distance distance,
                                     DisplacementMisfit& misfit) {
  constexpr int kWeightings = 5;
  constexpr double kSettled = 0.05;
  double noise = NoiseAt(start, misfit);
  misfit.SetNoise(noise);
  BoundedMinimum minimum = Descend(options, start, distance, misfit, {});
  for (int i = 0; i < kWeightings; ++i) {
    const double last = noise;
    noise = NoiseAt(minimum.variables, misfit);
    if (std::abs(noise - last) < kSettled * last) {
      break;
    }
    misfit.SetNoise(noise);
    minimum = Descend(options, minimum.variables, Distance::kNear, misfit, {});
  }
  return minimum;
}

}  // namespace

BoundedMinimum DescendFrom(const EstimatorOptions& options,
                           const Eigen::VectorXd& start, Distance distance,
                           DisplacementMisfit& misfit,
                           const std::optional<BoundedMinimum>& known) {
  return misfit.NumResultants() > 0
             ? DescendWithResultants(options, start, distance, misfit)
             : Descend(options, start, distance, misfit, known);
}

}  // namespace elastimate
