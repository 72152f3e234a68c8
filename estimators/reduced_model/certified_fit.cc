#include "elastimate/estimators/reduced_model/certified_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/laws/elasticity.h"

namespace elastimate {
namespace {

// The last of the first poles, unless nu is known or bounded away from it.
constexpr double kMainPole = 0.3;
// In LogStiffnessRatio, how far some twenty vectors of a pole reach: from 0.3
// to 0.49 and to -0.9.
constexpr double kReach = 3.5;
// The error bound, relative to the responses, before the first fit.
constexpr double kFirstTolerance = 1e-2;
// A factorisation costs as much as 30 (45 000 tetrahedra) to 100 (300 000)
// solves, and the vectors of all poles are kept.
constexpr int kMostVectorsOfAPole = 30;
constexpr int kMostPoles = 8;
// The error of the observed displacements that may remain, relative to the
// noise, to the residual, and to the displacements: of direct solves, and of
// multigrid, which leaves errors of StiffnessSolver::kAccurate.
constexpr double kErrorOverNoise = 0.1;
constexpr double kErrorOverResidual = 5e-4;
constexpr double kSmallestError = 1e-8;
constexpr double kSmallestErrorOfMultigrid = 1e-6;

double MiddleOf(double nu, double other) {
  return PoissonRatioOfLogStiffnessRatio(
      (LogStiffnessRatio(nu) + LogStiffnessRatio(other)) / 2);
}

double DistanceOf(double nu, double other) {
  return std::abs(LogStiffnessRatio(nu) - LogStiffnessRatio(other));
}

double NuAtDistance(double nu, double distance) {
  return PoissonRatioOfLogStiffnessRatio(LogStiffnessRatio(nu) + distance);
}

// Returns the tolerance of iterative solves: an inexact vector counts by its
// share of the response, which is about the present error.
double SolveTolerance(double error, double limit) {
  constexpr double kUsualLimit = 1e-6;
  constexpr double kShare = 0.1;
  return std::clamp(kShare * std::min(limit, kUsualLimit) / error, 1e-9, 1e-2);
}

}  // namespace

CertifiedFit::CertifiedFit(const Scene& scene, const Bounds& poisson_ratio,
                           const Bounds& youngs_modulus, SolverKind solver,
                           std::function<void(int)> on_factorization)
    : on_factorization_(std::move(on_factorization)),
      model_(scene, solver),
      largest_range_(poisson_ratio),
      searched_(poisson_ratio),
      youngs_modulus_(youngs_modulus) {
  if (*searched_.lower == kSmallestPoissonRatio &&
      *searched_.upper > kUsualSmallest) {
    searched_.lower = kUsualSmallest;
  }
  if (*searched_.upper == kLargestPoissonRatio && model_.UsesMultigrid() &&
      *searched_.lower < kUsualLargestOfMultigrid) {
    searched_.upper = kUsualLargestOfMultigrid;
  }
  const double lower = *searched_.lower;
  const double upper = *searched_.upper;
  const double main = std::clamp(kMainPole, lower, upper);
  // The main pole is last: its factorisation is the one to have at hand.
  if (DistanceOf(main, upper) > 2 * kReach) {
    const double edge = NuAtDistance(main, kReach);
    if (SetPole(MiddleOf(edge, upper))) {
      EnlargeUntil(upper, kFirstTolerance);
    }
  }
  if (DistanceOf(main, lower) > 2 * kReach) {
    const double edge = NuAtDistance(main, -kReach);
    if (SetPole(MiddleOf(edge, lower))) {
      EnlargeUntil(lower, kFirstTolerance);
    }
  }
  is_regular_ = SetPole(main);
  if (is_regular_) {
    for (const double distance : {-kReach, kReach}) {
      EnlargeUntil(std::clamp(NuAtDistance(main, distance), lower, upper),
                   kFirstTolerance);
    }
  }
}

bool CertifiedFit::SetPole(double nu) {
  if (on_factorization_) {
    on_factorization_(num_poles_ + 1);
  }
  ++num_poles_;
  num_vectors_of_pole_ = 0;
  return model_.SetPole(nu);
}

bool CertifiedFit::EnlargeUntil(double nu, double limit) {
  constexpr int kStep = 2;
  double error = model_.RelativeErrorBound(nu);
  while (error > limit) {
    for (int i = 0; i < kStep; ++i) {
      ++num_vectors_of_pole_;
      if (num_vectors_of_pole_ > kMostVectorsOfAPole ||
          !model_.Enlarge(SolveTolerance(error, limit))) {
        return false;
      }
    }
    const double before = error;
    error = model_.RelativeErrorBound(nu);
    if (error > limit && !(error < before)) {
      return false;  // Rounding is all that is left.
    }
    const double steps_to_come =
        std::log(error / limit) / std::log(before / error);
    if (steps_to_come * kStep >
        2.0 * (kMostVectorsOfAPole - num_vectors_of_pole_)) {
      return false;
    }
  }
  return true;
}

bool CertifiedFit::Run(const ObservedDisplacements& observed) {
  has_converged_ = false;
  if (!is_regular_) {
    return false;
  }
  if (compliance_norm_ == 0) {
    compliance_norm_ = model_.ComplianceNormAtPole(observed.BoundingWeights());
    compliance_pole_ = model_.Pole();
  }
  for (;;) {
    Fit(observed);
    std::vector<ReducedFit::ModelError> errors;
    for (const double nu : least_squares_->Scan()) {
      errors.push_back(ErrorAt(nu));
    }
    const std::vector<ReducedFit::ResidualBracket> brackets =
        least_squares_->BracketResiduals(observed.Measured(), errors);
    if (SearchFurther(observed, brackets)) {
      continue;
    }
    std::optional<Doubt> doubt = DoubtAtTheEstimate(observed);
    if (!doubt) {
      doubt = DoubtElsewhere(observed, brackets);
    }
    has_converged_ = !doubt;
    if (has_converged_ || !Improve(*doubt)) {
      return true;
    }
  }
}

void CertifiedFit::ForgetRows() {
  compliance_norm_ = 0;
  least_squares_.reset();
}

void CertifiedFit::KeepModel() {
  least_squares_.reset();
  model_.KeepResponses();
}

void CertifiedFit::Fit(const ObservedDisplacements& observed) {
  if (!least_squares_ || fitted_version_ != model_.Version()) {
    least_squares_ = std::make_unique<ReducedFit>(model_, observed, searched_,
                                                  youngs_modulus_);
    fitted_version_ = model_.Version();
  }
  best_ = least_squares_->Fit(observed.Measured());
}

double CertifiedFit::NoiseOf(const ObservedDisplacements& observed) const {
  const double left =
      std::sqrt(best_.square_sum / static_cast<double>(observed.Size()));
  return observed.GivenNoise() ? std::min(left, 1 / observed.Norm()) : left;
}

double CertifiedFit::SmallestError() const {
  return model_.UsesMultigrid() ? kSmallestErrorOfMultigrid : kSmallestError;
}

double CertifiedFit::AllowedError(const ObservedDisplacements& observed) const {
  return std::max(SmallestError(), kErrorOverNoise * NoiseOf(observed));
}

bool CertifiedFit::IsAccurateAt(const ReducedFit::Point& point,
                                const ObservedDisplacements& observed) const {
  const ReducedFit::ModelError error = ErrorAt(point.poisson_ratio);
  return std::abs(point.compliance_scale) * error.w + error.v <=
         AllowedError(observed);
}

ReducedFit::ModelError CertifiedFit::ErrorAt(double nu) const {
  const double of_energy =
      compliance_norm_ /
      std::sqrt(SmallestEnergyRatio(nu, compliance_pole_, model_.Section()));
  double square_sum = 0;
  const Eigen::Index num_cases = model_.NumLoadCases();
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    const double error = model_.ErrorBound(k, nu);
    square_sum += error * error;
  }
  const double of_supports = model_.HasSupportResponse()
                                 ? std::sqrt(static_cast<double>(num_cases)) *
                                       model_.ErrorBound(num_cases, nu)
                                 : 0;
  return {of_energy * std::sqrt(square_sum), of_energy * of_supports};
}

std::optional<CertifiedFit::Doubt> CertifiedFit::DoubtAtTheEstimate(
    const ObservedDisplacements& observed) const {
  const double nu = best_.poisson_ratio;
  const ReducedFit::ModelError error = ErrorAt(nu);
  const double size = std::abs(best_.compliance_scale) * error.w + error.v;
  const double allowed = AllowedError(observed);
  if (size <= allowed) {
    return std::nullopt;
  }
  return Doubt{nu, allowed / size, nu};
}

std::optional<CertifiedFit::Doubt> CertifiedFit::DoubtElsewhere(
    const ObservedDisplacements& observed,
    const std::vector<ReducedFit::ResidualBracket>& brackets) const {
  const double residual = std::sqrt(best_.square_sum);
  const double allowed =
      std::max(SmallestError(), std::min(kErrorOverNoise * NoiseOf(observed),
                                         kErrorOverResidual * residual));
  const Eigen::VectorXd& scan = least_squares_->Scan();
  const Eigen::Index size = scan.size();
  const auto is_in_doubt = [&](Eigen::Index i) {
    return brackets[i].least < residual - allowed;
  };
  // The nearest to the pole of those in doubt, and the range around it.
  Eigen::Index nearest = -1;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (is_in_doubt(i) &&
        (nearest < 0 || DistanceOf(scan(i), model_.Pole()) <
                            DistanceOf(scan(nearest), model_.Pole()))) {
      nearest = i;
    }
  }
  if (nearest < 0) {
    return std::nullopt;
  }
  Eigen::Index first = nearest;
  Eigen::Index last = nearest;
  while (first > 0 && is_in_doubt(first - 1)) {
    --first;
  }
  while (last + 1 < size && is_in_doubt(last + 1)) {
    ++last;
  }
  const ReducedFit::ResidualBracket& bracket = brackets[nearest];
  const double room = bracket.reduced - (residual - allowed);
  return Doubt{scan(nearest), room / (bracket.reduced - bracket.least),
               MiddleOf(scan(first), scan(last))};
}

bool CertifiedFit::Improve(const Doubt& doubt) {
  // Bounds are not met to the last digit, and others move with the fit.
  constexpr double kSafety = 0.5;
  const double limit =
      kSafety * doubt.factor * model_.RelativeErrorBound(doubt.poisson_ratio);
  const int version = model_.Version();
  if (EnlargeUntil(doubt.poisson_ratio, limit)) {
    return true;
  }
  if (num_poles_ < kMostPoles) {
    return SetPole(doubt.middle);
  }
  return model_.Version() != version;
}

bool CertifiedFit::SearchFurther(
    const ObservedDisplacements& observed,
    const std::vector<ReducedFit::ResidualBracket>& brackets) {
  // Beyond this excess of the sum of squares over its least, in variances, no
  // interval of nu ends.
  constexpr double kFarExcess = 10;
  // A fit that leaves more than this share of the measurement may be that of
  // another nu, far below the usual ones.
  constexpr double kPoorFit = 0.05;
  const double variance =
      best_.square_sum / static_cast<double>(observed.Size());
  const auto is_near_least = [&](const ReducedFit::ResidualBracket& end) {
    return end.reduced * end.reduced - best_.square_sum <=
           kFarExcess * variance;
  };
  bool has_grown = false;
  const bool is_poor =
      best_.square_sum > kPoorFit * kPoorFit * SquaredNorm(observed.Measured());
  const auto search_from = [&](double lower) {
    has_grown = has_grown || lower < *searched_.lower;
    searched_.lower = std::min(*searched_.lower, lower);
  };
  if (is_poor) {
    search_from(std::max(*largest_range_.lower, kSmallestOfPoorFits));
  }
  if (is_near_least(brackets.front())) {
    search_from(*largest_range_.lower);
  }
  if (*searched_.upper < *largest_range_.upper &&
      is_near_least(brackets.back())) {
    searched_.upper = largest_range_.upper;
    has_grown = true;
  }
  if (has_grown) {
    least_squares_.reset();
  }
  return has_grown;
}

}  // namespace elastimate
