#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_RESIDUAL_STATISTICS_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_RESIDUAL_STATISTICS_H_

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"

namespace elastimate {

/// Calls visit(a, b) for each two neighbours in one load case, by their places
/// in observed.Points(): nodes that share an element, and other points that are
/// near each other.  `graph` is that of the mesh.  O(num_pairs) for each load
/// case.
void VisitNeighbours(
    const NodeGraph& graph, const ObservedDisplacements& observed,
    const std::function<void(Eigen::Index a, Eigen::Index b)>& visit);

/// How alike the residuals of neighbours are [Moran 1950] (VisitNeighbours).
struct NeighbourCorrelation {
  /// Mean product of the residuals of two neighbours, over the mean square:
  /// near 0 for independent noise, near 1 for a smooth field.
  double correlation;
  double standard_deviation;  ///< How much independent noise makes of it.
};

/// Empty when no two neighbours were observed, or all residuals are zero.
/// `graph` is that of the mesh.  Cost: O(num_pairs) time for each load case.
std::optional<NeighbourCorrelation> CorrelateNeighbours(
    const NodeGraph& graph, const ObservedDisplacements& observed,
    const Eigen::VectorXd& residual);

/// Variance of the normalised residuals, and whether it is that of the noise.
struct ResidualVariance {
  double variance;
  bool is_explained_by_given_noise;
};

/// From the residuals themselves, or as given when they do not contradict it,
/// which is evidence.  Fills in the noise of `estimate`.  `num_free` parameters
/// were fitted.
ResidualVariance EstimateVariance(const ObservedDisplacements& observed,
                                  double square_sum, Eigen::Index num_free,
                                  Evidence& evidence, Estimate& estimate);

/// What the square sum of the part of the residual may be that neighbours
/// share: at least, beyond what independent noise explains, growing from zero,
/// and at most.
struct SmoothSquareSum {
  double least;
  double most;
};

/// Fills in the correlation of `estimate`, and whether it puts the model in
/// doubt.
SmoothSquareSum MeasureSmoothPart(const NodeGraph& graph,
                                  const ObservedDisplacements& observed,
                                  const Eigen::VectorXd& residual,
                                  Estimate& estimate);

/// The change of the parameters from the least-squares fit to a robust one, in
/// the linear model u + S delta of sensitivities S: the weighted least squares
/// of Huber's loss.  Rows after those of `observed`, as of resultants, are no
/// outliers.
Eigen::VectorXd RobustChange(const ObservedDisplacements& observed,
                             const Eigen::VectorXd& residual,
                             const Eigen::MatrixXd& sensitivities);

/// Whether some residuals are much larger than the bulk of them.
bool HasHeavyTails(const Eigen::VectorXd& residual);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_RESIDUAL_STATISTICS_H_
