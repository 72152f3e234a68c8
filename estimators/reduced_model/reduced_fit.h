#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_FIT_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_FIT_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/reduced_model/reduced_model.h"

namespace elastimate {

/// The least-squares fit of a ReducedModel to observed displacements q,
///
///   min over nu and t of ||t w(nu) + v(nu) - q||^2,
///
/// compressed: with the QR factorisation of the observed rows of the bases of
/// each load case, the sum of squares is one over the basis vectors and a
/// constant.  What does not depend on q is prepared once.
class ReducedFit {
 public:
  /// The best fit at one nu.
  struct Point {
    double poisson_ratio;
    double compliance_scale;
    double square_sum;
  };

  /// Precondition: both bounds on nu are given.
  /// Cost: O(rows m^2) for m basis vectors of a load case.
  ReducedFit(const ReducedModel& model, const ObservedDisplacements& observed,
             const Bounds& poisson_ratio, const Bounds& youngs_modulus);

  /// The best fit to `measured`, rows as in ObservedDisplacements: the whole
  /// range of nu is scanned, and the zeros of the slope beside all minima of
  /// the scan are found.  A fit with a positive E is better than any without.
  ///
  /// The scan is even in ln((1 + nu) / (1 - 2 nu)), in which the responses are
  /// analytic up to a distance of pi from the real axis: they do not change
  /// between two points of the scan, 0.1 or less apart.
  /// Cost: O(rows m), then about 200 m + 20 m^2 operations.
  Point Fit(const Eigen::VectorXd& measured) const;

  /// How far the observed rows of w and v may be from those of the full model.
  struct ModelError {
    double w;
    double v;
  };
  /// Norms of residuals at one nu, at the best t > 0 within the bounds on E.
  struct ResidualBracket {
    double least;    ///< A lower bound of what the full model leaves.
    double reduced;  ///< What the reduced model leaves.
  };
  /// At each point of the scan.  `errors` are those at the points of the scan.
  std::vector<ResidualBracket> BracketResiduals(
      const Eigen::VectorXd& measured,
      const std::vector<ModelError>& errors) const;
  /// nu of the scan, ascending.
  const Eigen::VectorXd& Scan() const { return scan_; }

 private:
  // The observed rows of w and v in an orthonormal basis: stacked over the load
  // cases.
  struct Responses {
    Eigen::VectorXd w;
    Eigen::VectorXd v;
  };
  struct LoadCaseFit {
    /// Orthonormal columns, rows x rank.
    Eigen::MatrixXd q;
    /// The modes of the load case and of the held displacements in them.
    Eigen::MatrixXd load_modes;
    Eigen::MatrixXd support_modes;
    ReducedModes load;
    ReducedModes support;
  };
  /// A measurement in the orthonormal bases.
  struct Projection {
    Eigen::VectorXd measured;
    double rest_square_sum;
  };

  Projection Project(const Eigen::VectorXd& measured) const;
  /// `values` of all modes.
  Responses Combine(Eigen::VectorXd (ReducedModes::*values)(double) const,
                    double poisson_ratio) const;
  /// The t nearest to this one within the bounds on E.
  double WithinBounds(double poisson_ratio, double t) const;
  /// The best t within the bounds on E.
  double ComplianceScale(double poisson_ratio,
                         const Eigen::Ref<const Eigen::VectorXd>& w,
                         const Eigen::Ref<const Eigen::VectorXd>& rest) const;
  Point PointOf(double poisson_ratio,
                const Eigen::Ref<const Eigen::VectorXd>& w,
                const Eigen::Ref<const Eigen::VectorXd>& v,
                const Projection& projection) const;
  Point At(double poisson_ratio, const Projection& projection) const;
  /// d (sum of squares) / d nu along the best t.
  double SlopeAt(double poisson_ratio, const Projection& projection) const;
  /// The zero of the slope between two values of nu, from the first of which
  /// the sum of squares falls towards the second.
  double FindMinimum(double inner, double inner_slope, double outer,
                     const Projection& projection) const;

  SectionModel section_model_;
  Bounds youngs_modulus_;
  std::vector<LoadCaseFit> load_cases_;
  /// How many vectors the orthonormal bases of all load cases have.
  Eigen::Index num_projected_ = 0;
  Eigen::VectorXd scan_;
  /// The responses at the points of the scan, one column each.
  Eigen::MatrixXd scan_w_;
  Eigen::MatrixXd scan_v_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_FIT_H_
