#ifndef ELASTIMATE_ESTIMATORS_PLAN_EXPECTED_INFORMATION_H_
#define ELASTIMATE_ESTIMATORS_PLAN_EXPECTED_INFORMATION_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// What the measurement of one load case says about the free parameters.
struct CaseInformation {
  /// I = S^T S / sigma^2 of the observed rows (of resultants, over their
  /// variance), S with respect to ln p of moduli p and to other parameters,
  /// without what unknown motions explain: num_free x num_free.
  Eigen::MatrixXd information;
  /// Root mean square of the displacement in the observed rows [length].
  double rms_displacement;
};

/// Returns the Fisher information [Rao 1945] of each load case at `parameters`
/// of the materials of the scene (in the order of MaterialParameters).  Its
/// inverse is the Cramer-Rao bound of the covariance.
///
/// In load cases without a measurement, and in those from `first_planned` on,
/// whose displacements say only what is observed, displacements are those of
/// the model, whose supports of unknown motion stand still.  Where the standard
/// deviation of the noise is not given, it is `relative_noise` times the root
/// mean square of the rows, measured or, where they are not, as the parameters
/// make them.
///
/// Precondition: a scene that is valid with such displacements, and held.
/// Throws std::runtime_error when the stiffness is singular to working
/// precision, and std::invalid_argument where nothing that is observed moves.
/// Cost: a factorisation for each set of supports, and for each load case a
/// solve for its displacement and one for each free parameter.  Where `solver`
/// is or takes multigrid, as for large meshes, iterations take the place of the
/// factorisations.
std::vector<CaseInformation> ExpectedInformation(
    const Scene& scene, std::size_t first_planned,
    const Eigen::VectorXd& parameters, double relative_noise,
    SolverKind solver);

/// Returns the Cramer-Rao bound of the free parameters [Cramer 1946], in their
/// own units: no unbiased estimator has a smaller covariance under independent
/// Gaussian noise with these standard deviations [length], one for each load
/// case.  Measured displacements say only what is observed.  Infinite where the
/// data do not determine all free parameters.
/// Preconditions, exceptions and cost are those of ExpectedInformation.
Eigen::MatrixXd CramerRaoBound(Scene scene, const Eigen::VectorXd& parameters,
                               const Eigen::VectorXd& noise_sd);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_PLAN_EXPECTED_INFORMATION_H_
