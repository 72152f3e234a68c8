#include "elastimate/estimators/maps/smooth_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

constexpr int kMostSmoothSteps = 20;
constexpr int kMostSmoothHalvings = 5;
// The evidence is flat about its maximum, where k might push the field to and
// fro.  After so many steps it stays.
constexpr int kMostRatios = 10;
// Steps end where ln E changes by less, as a root mean square, and k by less,
// relative to it.
constexpr double kSettledField = 3e-3;
constexpr double kSettledRatio = 0.03;
// The modes are renewed where ln E has changed by so much since.
constexpr double kStaleModes = 0.1;
// Modes are added until k lambda falls below this; LanczosSums count what is
// beside them.
constexpr double kLeastOfModes = 3.0;
constexpr double kAccurateSmooth = 1e-3;

double RootMeanSquareOf(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / double(values.size()));
}

// The evidence as a function of k where the field is y so far.  Changes of the
// field count from there, so that modes of a state nearby do no harm: for
// (I / k + H) delta = g, g = A^T S^T Pi r - y / k,
//
//   q = |Pi r|^2 + |y|^2 / k - g^T delta.
struct FieldEvidence {
  const MapProblem& problem;
  const CurvatureModes& modes;
  double square_sum;         // |Pi r|^2.
  Eigen::VectorXd gradient;  // A^T S^T Pi r.
  Eigen::VectorXd y;
  double degrees_of_freedom;  // N - p.

  Eigen::VectorXd SlopeAt(double k) const { return gradient - y / k; }
  double QuadraticAt(double k, const Eigen::VectorXd& delta) const {
    return square_sum + y.squaredNorm() / k - SlopeAt(k).dot(delta);
  }
  // Returns -2 ln ev + a constant, for q of this k.
  double Of(double k, double q) const {
    const double least = degrees_of_freedom * problem.Variance(0, 1);
    return (problem.noise ? q / problem.Variance(0, 1)
                          : degrees_of_freedom * std::log(std::max(q, least))) +
           modes.LogDeterminant(k);
  }
};

// Evaluates FieldEvidence::Of for many k.  With the coordinates U^T g of the
// modes, and Lanczos' sums of what is beside them,
//
//   g^T delta = sum k / (1 + k lambda) (U^T g)^2 + g^T k (I + k H)^-1 g.
class EvidenceOfModes {
 public:
  EvidenceOfModes(const FieldEvidence& evidence,
                  const ColumnOperator& curvature)
      : evidence_(evidence),
        gradient_(
            ProductOfTransposed(evidence.modes.Vectors(), evidence.gradient)),
        y_(ProductOfTransposed(evidence.modes.Vectors(), evidence.y)),
        scale_of_y_(evidence.y.isZero(0) || evidence.gradient.isZero(0)
                        ? 1
                        : evidence.gradient.norm() / evidence.y.norm()),
        beside_(evidence.modes.BesideModes(curvature, VectorsBeside())) {}

  double At(double log_k) const {
    const double k = std::exp(log_k);
    const double along_modes = (k / (1 + k * evidence_.modes.Values().array()) *
                                (gradient_ - y_ / k).array().square())
                                   .sum();
    const auto beside = [&](Eigen::Index column) {
      return beside_.Of(column,
                        [k](double value) { return k / (1 + k * value); });
    };
    const double of_y = 1 / (k * scale_of_y_);
    const double twice_mixed = beside(2) - beside(0) - beside(1);
    return evidence_.Of(
        k, evidence_.square_sum + evidence_.y.squaredNorm() / k - along_modes -
               beside(0) + of_y * twice_mixed - of_y * of_y * beside(1));
  }

 private:
  // Returns the gradient, y scaled to its length, and the sum of both, from
  // whose squares their product follows.
  Eigen::MatrixXd VectorsBeside() const {
    Eigen::MatrixXd vectors(evidence_.y.size(), 3);
    vectors << evidence_.gradient, scale_of_y_ * evidence_.y,
        evidence_.gradient + scale_of_y_ * evidence_.y;
    return vectors;
  }

  const FieldEvidence& evidence_;
  Eigen::VectorXd gradient_;  // U^T A^T S^T Pi r.
  Eigen::VectorXd y_;         // U^T y.
  double scale_of_y_;
  LanczosSums beside_;
};

// Returns the k of the greatest evidence: of a scan, and then between its
// points.  The data cannot support nearly as many parameters as there are
// measurements: noise that is not known would then be found to be zero, and
// where it is known, the model is wrong rather than the body that uneven.
double BestRatio(const EvidenceOfModes& of_modes,
                 const FieldEvidence& evidence) {
  constexpr int kPoints = 65;
  const double most_supported =
      evidence.degrees_of_freedom * (evidence.problem.noise ? 2.0 : 1.0) / 3;
  const double largest = std::max(evidence.modes.Values()(0), 1e-300);
  const double lower = std::log(1e-4 / largest);
  const double upper = std::log(1e12 / largest);
  const double step = (upper - lower) / (kPoints - 1);
  const auto value_at = [&](double log_k) {
    return evidence.modes.EffectiveNumber(std::exp(log_k)) > most_supported
               ? std::numeric_limits<double>::infinity()
               : of_modes.At(log_k);
  };
  double best = lower;
  double least = value_at(lower);
  for (int i = 1; i < kPoints; ++i) {
    const double value = value_at(lower + i * step);
    if (value < least) {
      least = value;
      best = lower + i * step;
    }
  }
  constexpr double kGolden = 0.618033988749894848;
  double a = best - step;
  double b = best + step;
  while (b - a > 1e-3) {
    const double left = b - kGolden * (b - a);
    const double right = a + kGolden * (b - a);
    if (value_at(left) < value_at(right)) {
      b = right;
    } else {
      a = left;
    }
  }
  return std::exp((a + b) / 2);
}

// Finds k, unless it is to stay as it is, and as many modes as count at that k.
void FindRatio(const FieldEvidence& evidence, bool stays,
               const ColumnOperator& curvature, SmoothMap& map) {
  for (Eigen::Index size = -1; size != map.modes.Size();) {
    size = map.modes.Size();
    if (!stays) {
      map.ratio = BestRatio(EvidenceOfModes(evidence, curvature), evidence);
    }
    map.modes.AddUntil(kLeastOfModes / map.ratio, curvature);
  }
}

// Returns the change of y at the k of the map, and sets the variance, the
// effective number and the evidence of the map.
Eigen::VectorXd SolveForChange(const FieldEvidence& evidence,
                               double homogeneous_square_sum,
                               const ColumnOperator& curvature,
                               SmoothMap& map) {
  ConjugateGradientOptions options;
  options.tolerance = kAccurateSmooth;
  options.most_iterations = 500;
  const Eigen::VectorXd delta = map.modes.SolveFor(
      map.ratio, curvature, evidence.SlopeAt(map.ratio), options);
  const double q = evidence.QuadraticAt(map.ratio, delta);
  map.variance = evidence.problem.Variance(q, evidence.degrees_of_freedom);
  map.effective_number = map.modes.EffectiveNumber(map.ratio);
  map.log_evidence =
      (evidence.Of(0, homogeneous_square_sum) - evidence.Of(map.ratio, q)) / 2;
  return delta;
}

// Takes as much of a change of ln E, of nu and of y as lowers the penalised
// square sum, and returns that share.
double Advance(const MapProblem& problem, const Eigen::VectorXd& step,
               double step_of_nu, const Eigen::VectorXd& delta,
               SmoothMap& map) {
  const double before = map.square_sum + map.y.squaredNorm() / map.ratio;
  const double share = TakeStep(
      problem, step, step_of_nu, std::sqrt(map.variance), kMostSmoothHalvings,
      [&](double of_step, const MapState&) {
        return problem.model.Residual().squaredNorm() +
                   (map.y + of_step * delta).squaredNorm() / map.ratio <
               before;
      },
      map.state);
  map.y += share * delta;
  return share;
}

}  // namespace

ColumnOperator CurvatureOf(const MapProblem& problem, const FieldPrior& prior,
                           const FlatUnknowns& unknowns) {
  return [&](const Eigen::MatrixXd& y) {
    return prior.ApplyTransposed(problem.model.MultiplyTransposed(
        unknowns.Project(problem.model.Multiply(prior.Apply(y)))));
  };
}

SmoothMap FitSmoothMap(const MapProblem& problem, const FieldPrior& prior,
                       const LevelFit& homogeneous) {
  FieldSensitivity& model = problem.model;
  const Eigen::Index n = prior.NumElements();
  const double num_rows = double(model.NumIndependentRows());
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(n, 1);
  SmoothMap map = {
      homogeneous.state, Eigen::VectorXd::Zero(n), 0, 0, 0, 0, 0, false,
      CurvatureModes(n)};
  map.variance = problem.Variance(homogeneous.square_sum,
                                  num_rows - homogeneous.unknowns.Rank());
  double change_since_modes = 0;
  for (int i = 0;; ++i) {
    const FlatUnknowns unknowns(problem, map.state, ones);
    const ColumnOperator curvature = CurvatureOf(problem, prior, unknowns);
    const Eigen::VectorXd residual = model.Residual();
    map.square_sum = residual.squaredNorm();
    const Eigen::VectorXd data = unknowns.Project(residual);
    FieldEvidence evidence = {
        problem,
        map.modes,
        data.squaredNorm(),
        prior.ApplyTransposed(model.MultiplyTransposed(data)),
        map.y,
        num_rows - double(unknowns.Rank())};
    const double last_ratio = map.ratio;
    if (map.modes.Size() == 0) {
      map.modes.AddUntil(kLeastOfModes / 1e3, curvature);
    } else if (change_since_modes > kStaleModes) {
      map.modes.Renew(curvature);
      change_since_modes = 0;
    }
    FindRatio(evidence, i > kMostRatios, curvature, map);
    const Eigen::VectorXd delta =
        SolveForChange(evidence, homogeneous.square_sum, curvature, map);
    const Eigen::VectorXd field = prior.Apply(delta);
    const Eigen::VectorXd flat =
        unknowns.Solve(residual - model.Multiply(field));
    const Eigen::VectorXd step = field + flat(0) * ones;
    const double change = RootMeanSquareOf(step);
    const bool is_settled =
        change < kSettledField &&
        std::abs(std::log(map.ratio / last_ratio)) < kSettledRatio;
    if (is_settled && change_since_modes == 0) {
      map.has_converged = true;
      return map;
    }
    if (is_settled) {
      change_since_modes = 2 * kStaleModes;  // Renews the modes for the end.
      continue;
    }
    if (i == kMostSmoothSteps) {
      return map;
    }
    const double share = Advance(problem, step, flat(1), delta, map);
    if (share == 0) {
      map.has_converged = change < 10 * kSettledField;
      return map;
    }
    change_since_modes += share * change;
  }
}

double LogEvidenceByModes(const MapProblem& problem, const FieldPrior& other,
                          const FieldPrior& prior, const SmoothMap& map) {
  FieldSensitivity& model = problem.model;
  const Eigen::Index n = prior.NumElements();
  const FlatUnknowns unknowns(problem, map.state, Eigen::MatrixXd::Ones(n, 1));
  // Smaller ones hardly count.  There is always a largest one.
  const Eigen::Index size = std::max<Eigen::Index>(
      (map.ratio * map.modes.Values().array() >= kLeastOfModes).count(), 1);
  const auto vectors = map.modes.Vectors().leftCols(size);
  const Eigen::MatrixXd of_other =
      other.ApplyTransposed(prior.ApplyInverseTransposed(vectors));
  // S^T Pi S = G G^T.
  const CurvatureModes modes = CurvatureModes::OfRoot(
      of_other * map.modes.Values().head(size).cwiseSqrt().asDiagonal());
  // A^T S^T Pi r = y / k at the map.
  const FieldEvidence evidence = {
      problem,
      modes,
      unknowns.Project(model.Residual()).squaredNorm(),
      of_other * (vectors.transpose() * map.y) / map.ratio,
      other.ApplyInverse(prior.Apply(map.y)),
      double(model.NumIndependentRows() - unknowns.Rank())};
  const EvidenceOfModes of_modes(evidence, [](const Eigen::MatrixXd& columns) {
    return Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  });
  return -of_modes.At(std::log(BestRatio(of_modes, evidence))) / 2;
}

}  // namespace elastimate
