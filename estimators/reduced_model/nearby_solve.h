#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_NEARBY_SOLVE_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_NEARBY_SOLVE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"

namespace elastimate {

/// Solves K(theta) x = b in the free rows by conjugate gradients, with the
/// factor at hand of other moduli as preconditioner, or where there is none,
/// the cycle over coarser spaces of those moduli (Equilibrium::Precondition): b
/// and x are num_dofs x n of each load case side by side, and x starts at what
/// it is, of which the held rows are kept.
///
/// Ends where the error of each column is expected to be below its tolerance in
/// the energy norm: a step lowers the square of the error by its own energy
/// [Hestenes & Stiefel 1952], and the next one is at most as long in proportion
/// as this one is to the last.  Returns how many it took; empty when more than
/// `most_iterations` are needed.  Cost: an element pass and an application of
/// the preconditioner for each column in each iteration.
///
/// The rows `also_held` are held as well, at what x has there.
///
/// Precondition: the last Solve of the equilibrium returned true.
std::optional<int> SolveNearby(const Eigen::VectorXd& moduli,
                               Eigen::MatrixXd forces,
                               const Eigen::VectorXd& tolerances,
                               int most_iterations, Equilibrium& equilibrium,
                               Eigen::MatrixXd& x,
                               const std::vector<int>& also_held = {});

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_NEARBY_SOLVE_H_
