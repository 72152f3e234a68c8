#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_ELEMENT_ERRORS_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_ELEMENT_ERRORS_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/statistics/finer_specimen.h"

namespace elastimate {

/// A fit in its free parameters.
struct FreeFit {
  const Eigen::VectorXd& residual;  ///< u - q.
  Eigen::MatrixXd sensitivities;    ///< S, rows x num_free.
  /// S^T W S, with what is known beforehand of what the data do not determine.
  Eigen::MatrixXd information;
  /// How much each row counts, diag(W); 1 without a loss.
  const Eigen::VectorXd& weights;
  bool is_least_squares;
  /// What a bound leaves in the residual is no doubt about the model.
  bool is_on_bound;
};

/// What finer elements change in the rows of a fit.
struct RowChange {
  Eigen::VectorXd rows;  ///< For the finer elements minus for those of the fit.
  /// What noise of a standard deviation of 1 adds to the change, one draw of
  /// it: supports that move as measured follow it.  Empty where nothing.
  Eigen::VectorXd by_noise;
  /// What was taken from the measurement as such a change before the fit; empty
  /// where nothing.
  Eigen::VectorXd taken;
};

/// What the elements of a fit miss, and what that does to the free parameters:
///
/// - Where a change e to finer ones is known: c = (S^T W S)^-1 S^T W e are the
///   parameters that take it up at the weights of the fit, g = e - S c shows in
///   the residual.
///   FinerSpecimen says how much of it is there; by the mean of that the
///   parameters are corrected, and its variance is theirs.
/// - Where none is known: by the strain energy that they miss
///   (DiscretizationError).
class ElementErrors {
 public:
  /// Precondition: at least one free parameter.
  ElementErrors(const Scene& scene, const NodeGraph& graph,
                const ObservedDisplacements& observed, const FreeFit& fit,
                const std::optional<RowChange>& change,
                const Eigen::MatrixXd& displacement,
                const IsotropicElasticity& elasticity);

  /// Whether there is anything to say: there is not for a single element of
  /// which no change is known.
  bool AreKnown() const { return missed_norm_.has_value(); }
  /// The residual without what a finer specimen explains of it.
  const Eigen::VectorXd& Rest() const { return rest_; }
  /// Of the free parameters, from those of the fit; empty unless finer elements
  /// are known.
  const std::optional<Eigen::VectorXd>& Correction() const {
    return correction_;
  }

  /// The correction, or what a finer specimen would ask for where something
  /// else in the residual hides how much of that there is.
  const Eigen::VectorXd& LikelyChange() const { return likely_change_; }

  /// Of the change to finer elements, as far as it is expected to be there.
  double Share() const { return share_; }
  /// Of that share, where finer elements are known.
  double ShareVariance() const { return share_variance_; }

  /// The square sum of a model error in the direction of any parameter, where
  /// its part in the residual has `smooth`: a multiple of that as far as finer
  /// elements do not explain what neighbouring residuals share.
  double ModelSquareSum(double smooth) const;

  // The smooth part of the rest has a square sum of at most `smooth`.

  /// The square sum of what is missed beside the change, in the direction of
  /// any parameter.
  double MissedSquareSum(double smooth) const;
  /// The covariance of the free parameters that comes with the change.
  Eigen::MatrixXd CovarianceOfChange() const;

 private:
  /// What the residual says of the part of the change that it would show, the
  /// weighted square sum of which has this much of noise in it for each unit of
  /// its variance, beside something of a weighted norm `missed_size` that the
  /// change does not hold.
  FinerSpecimen Compare(const NodeGraph& graph,
                        const ObservedDisplacements& observed,
                        const FreeFit& fit, const Eigen::VectorXd& visible,
                        double visible_noise, double missed_size);

  SpecimenPrior prior_;
  Eigen::VectorXd rest_;
  /// The residual of a fit to the measurement as it is.
  Eigen::VectorXd of_measurement_;
  std::optional<Eigen::VectorXd> correction_;
  Eigen::VectorXd likely_change_;
  /// c; zero where no change is known.
  Eigen::VectorXd of_parameters_;
  /// What neighbouring residuals share beside the share of g, over that, up to
  /// 1; 0 where g is not known.
  double unexplained_ = 0;
  /// What of g something else of the size of the rest may hide.
  double hidden_share_ = 0;
  double share_ = 0;
  /// Of that share, where finer elements are known.
  double share_variance_ = 0;
  /// Of what is missed beside the change.
  std::optional<double> missed_norm_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_ELEMENT_ERRORS_H_
