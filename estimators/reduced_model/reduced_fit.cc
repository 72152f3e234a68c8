#include "elastimate/estimators/reduced_model/reduced_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/statistics/scalar_search.h"

namespace elastimate {
namespace {

// Intervals of the scan over nu.
constexpr int kScanIntervals = 220;

bool IsBetter(const ReducedFit::Point& a, const ReducedFit::Point& b) {
  const bool a_is_positive = a.compliance_scale > 0;
  const bool b_is_positive = b.compliance_scale > 0;
  return a_is_positive == b_is_positive ? a.square_sum < b.square_sum
                                        : a_is_positive;
}

// Just one where nu is known.
Eigen::VectorXd ScanOf(const Bounds& poisson_ratio) {
  const double lower = *poisson_ratio.lower;
  const double upper = *poisson_ratio.upper;
  return lower == upper ? Eigen::VectorXd::Constant(1, lower)
                        : EvenPoissonRatios(lower, upper, kScanIntervals + 1);
}

}  // namespace

ReducedFit::ReducedFit(const ReducedModel& model,
                       const ObservedDisplacements& observed,
                       const Bounds& poisson_ratio,
                       const Bounds& youngs_modulus)
    : section_model_(model.Section()),
      youngs_modulus_(youngs_modulus),
      scan_(ScanOf(poisson_ratio)) {
  const Eigen::Index num_cases = model.NumLoadCases();
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    const Eigen::Index first = observed.CaseStart(k);
    const Eigen::Index rows = observed.CaseStart(k + 1) - first;
    const Eigen::Index load_columns = model.Basis(k).cols();
    const Eigen::Index support_columns =
        model.HasSupportResponse() ? model.Basis(num_cases).cols() : 0;
    Eigen::MatrixXd bases(rows, load_columns + support_columns);
    for (Eigen::Index i = 0; i < bases.cols(); ++i) {
      bases.col(i) = observed.RestrictToCase(
          k, i < load_columns ? model.Basis(k).col(i)
                              : model.Basis(num_cases).col(i - load_columns));
    }
    QrDecomposition qr = DecomposeQr(bases);
    LoadCaseFit fit;
    fit.q = std::move(qr.q);
    fit.load = model.Modes(k);
    fit.load_modes = qr.r.leftCols(load_columns) * fit.load.vectors;
    if (model.HasSupportResponse()) {
      fit.support = model.Modes(num_cases);
      fit.support_modes = qr.r.rightCols(support_columns) * fit.support.vectors;
    }
    load_cases_.push_back(fit);
    num_projected_ += qr.r.rows();
  }
  scan_w_.resize(num_projected_, scan_.size());
  scan_v_.resize(num_projected_, scan_.size());
  for (Eigen::Index i = 0; i < scan_.size(); ++i) {
    const Responses responses = Combine(&ReducedModes::At, scan_(i));
    scan_w_.col(i) = responses.w;
    scan_v_.col(i) = responses.v;
  }
}

ReducedFit::Point ReducedFit::Fit(const Eigen::VectorXd& measured) const {
  const Projection projection = Project(measured);
  std::vector<Point> points;
  for (Eigen::Index i = 0; i < scan_.size(); ++i) {
    points.push_back(
        PointOf(scan_(i), scan_w_.col(i), scan_v_.col(i), projection));
  }
  Point best = points[0];
  const auto take_if_better = [&best](const Point& point) {
    if (IsBetter(point, best)) {
      best = point;
    }
  };
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    take_if_better(points[i]);
    const bool is_minimum = !(i > 0 && IsBetter(points[i - 1], points[i])) &&
                            !(i < last && IsBetter(points[i + 1], points[i]));
    if (!is_minimum) {
      continue;
    }
    const double slope = SlopeAt(points[i].poisson_ratio, projection);
    if (slope > 0 ? i > 0 : i < last) {
      const Point& other = points[slope > 0 ? i - 1 : i + 1];
      take_if_better(At(FindMinimum(points[i].poisson_ratio, slope,
                                    other.poisson_ratio, projection),
                        projection));
    }
  }
  return best;
}

std::vector<ReducedFit::ResidualBracket> ReducedFit::BracketResiduals(
    const Eigen::VectorXd& measured,
    const std::vector<ModelError>& errors) const {
  const Projection projection = Project(measured);
  std::vector<ResidualBracket> brackets;
  for (Eigen::Index i = 0; i < scan_.size(); ++i) {
    const auto w = scan_w_.col(i);
    const Eigen::VectorXd rest = projection.measured - scan_v_.col(i);
    const double w_norm = w.norm();
    const double t_best = w.dot(rest) / w.squaredNorm();
    const double rest_norm = std::sqrt(projection.rest_square_sum +
                                       (rest - t_best * w).squaredNorm());
    // The least of ||rest - t w|| - t error over t, which is convex.
    const ModelError& error = errors[i];
    const double sine = error.w / w_norm;
    const double t_least =
        sine < 1
            ? t_best + rest_norm * sine / (w_norm * std::sqrt(1 - sine * sine))
            : std::numeric_limits<double>::infinity();
    const double t = WithinBounds(scan_(i), std::max(0.0, t_least));
    const auto residual_at = [&](double scale) {
      return std::hypot(rest_norm, (scale - t_best) * w_norm);
    };
    brackets.push_back(
        {std::isfinite(t)
             ? std::max(0.0, residual_at(t) - t * error.w - error.v)
             : 0,
         residual_at(WithinBounds(scan_(i), std::max(0.0, t_best)))});
  }
  return brackets;
}

ReducedFit::Projection ReducedFit::Project(
    const Eigen::VectorXd& measured) const {
  Projection projection;
  projection.measured.resize(scan_w_.rows());
  projection.rest_square_sum = 0;
  Eigen::Index first = 0;
  Eigen::Index first_projected = 0;
  for (const LoadCaseFit& load_case : load_cases_) {
    const Eigen::Index rows = load_case.q.rows();
    const Eigen::VectorXd of_case = measured.segment(first, rows);
    auto projected =
        projection.measured.segment(first_projected, load_case.q.cols());
    projected = InnerProducts(load_case.q, of_case);
    projection.rest_square_sum +=
        std::max(0.0, SquaredNorm(of_case) - projected.squaredNorm());
    first += rows;
    first_projected += projected.size();
  }
  return projection;
}

ReducedFit::Responses ReducedFit::Combine(
    Eigen::VectorXd (ReducedModes::*values)(double) const,
    double poisson_ratio) const {
  Responses responses = {Eigen::VectorXd::Zero(num_projected_),
                         Eigen::VectorXd::Zero(num_projected_)};
  Eigen::Index first = 0;
  for (const LoadCaseFit& load_case : load_cases_) {
    const Eigen::Index rank = load_case.q.cols();
    responses.w.segment(first, rank).noalias() =
        load_case.load_modes * (load_case.load.*values)(poisson_ratio);
    if (load_case.support_modes.cols() > 0) {
      responses.v.segment(first, rank).noalias() =
          load_case.support_modes * (load_case.support.*values)(poisson_ratio);
    }
    first += rank;
  }
  return responses;
}

double ReducedFit::WithinBounds(double poisson_ratio, double t) const {
  // E > 0 asks for t > 0, which no bound on E says.
  if (youngs_modulus_.upper) {
    t = std::max(t, ComplianceFactor(poisson_ratio, section_model_) /
                        *youngs_modulus_.upper);
  }
  if (youngs_modulus_.lower) {
    t = std::min(t, ComplianceFactor(poisson_ratio, section_model_) /
                        *youngs_modulus_.lower);
  }
  return t;
}

double ReducedFit::ComplianceScale(
    double poisson_ratio, const Eigen::Ref<const Eigen::VectorXd>& w,
    const Eigen::Ref<const Eigen::VectorXd>& rest) const {
  return WithinBounds(poisson_ratio, w.dot(rest) / w.squaredNorm());
}

ReducedFit::Point ReducedFit::PointOf(
    double poisson_ratio, const Eigen::Ref<const Eigen::VectorXd>& w,
    const Eigen::Ref<const Eigen::VectorXd>& v,
    const Projection& projection) const {
  const Eigen::VectorXd rest = projection.measured - v;
  const double t = ComplianceScale(poisson_ratio, w, rest);
  return {poisson_ratio, t,
          projection.rest_square_sum + (rest - t * w).squaredNorm()};
}

ReducedFit::Point ReducedFit::At(double poisson_ratio,
                                 const Projection& projection) const {
  const Responses responses = Combine(&ReducedModes::At, poisson_ratio);
  return PointOf(poisson_ratio, responses.w, responses.v, projection);
}

double ReducedFit::SlopeAt(double poisson_ratio,
                           const Projection& projection) const {
  const Responses responses = Combine(&ReducedModes::At, poisson_ratio);
  const Responses slopes = Combine(&ReducedModes::DerivativeAt, poisson_ratio);
  const Eigen::VectorXd rest = projection.measured - responses.v;
  const double t = ComplianceScale(poisson_ratio, responses.w, rest);
  const Eigen::VectorXd residual = rest - t * responses.w;
  // Where t is free, the residual is orthogonal to w and dt/dnu has no effect;
  // on a bound t = ComplianceFactor / E.
  const double dt_dnu =
      t * LogYoungsModulusSlope(poisson_ratio, section_model_);
  return -2 * residual.dot(t * slopes.w + dt_dnu * responses.w + slopes.v);
}

double ReducedFit::FindMinimum(double inner, double inner_slope, double outer,
                               const Projection& projection) const {
  constexpr double kTolerance = 1e-13;
  return ZeroBetween([&](double nu) { return SlopeAt(nu, projection); }, inner,
                     inner_slope, outer, SlopeAt(outer, projection),
                     kTolerance);
}

}  // namespace elastimate
