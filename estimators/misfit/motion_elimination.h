#ifndef ELASTIMATE_ESTIMATORS_MISFIT_MOTION_ELIMINATION_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_MOTION_ELIMINATION_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/camera.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {

/// The rows of a fit of displacements whose supports moved by unknown amounts,
/// and of which resultants were measured: those of ObservedDisplacements, and
/// below them the resultants of all load cases, each weighted by the standard
/// deviation of a displacement row over its own.  In equilibrium at some
/// moduli, the rows of amounts x = (b, a) of UnknownMotion are
///
///   A x = rows of (Extend(G b) + R a).
///
/// Rotations are of any size: the displacement that a camera sees is C (X + u)
/// + c - X, with a rotation C and a translation c of each load case (Camera),
/// and rigid faces turn likewise beside large strains.  Then x are increments
/// about the present state, of which C, c and the displacement of supports are
/// made up by finite rotations, and
///
///   A x = rows of (C Extend(G b) + R a),
///
/// where G and R are the rigid motions of what has been moved.
///
/// To eliminate x from a row vector y is to take the least squares residual
/// y - A x, by conjugate gradients on the normal equations [Paige & Saunders
/// 1982], whose number of iterations does not grow with the mesh: displacements
/// that were measured are as many equations of condition 1.  An iteration is
/// two solves for each load case.  Where amounts are few, up to 400, the
/// columns of A are solved for at the moduli of the first fit, and (A^T A)^-1
/// of there is the preconditioner: 3 to 5 iterations.  Up to 32, they are
/// solved for anew at all moduli, and A is dense.
class MotionElimination {
 public:
  /// Preconditions: a valid scene, with a measurement in each load case.  The
  /// objects must outlive this one.
  MotionElimination(const Scene& scene, const ObservedDisplacements& observed,
                    ForwardModel& model);

  /// The numbers of all rows, and of the amounts of all load cases.
  Eigen::Index NumRows() const {
    return observed_.Size() + Eigen::Index(resultants_.size());
  }
  Eigen::Index NumResultants() const {
    return Eigen::Index(resultants_.size());
  }
  Eigen::Index NumAmounts() const { return amounts_.size(); }

  /// Whether cameras turn by finite rotations, or the motion of the whole
  /// specimen is R a, as in displacements that linear elasticity computed.
  enum class Rotations { kFinite, kLinear };
  /// Begins anew with such rotations; they are finite until this is called.
  /// Precondition of kLinear: the model is linear.
  void SetRotations(Rotations rotations);

  /// Sets the standard deviation of a displacement row, which weighs the
  /// resultants; zero leaves them out.
  void SetNoise(double standard_deviation);
  double Noise() const { return noise_; }

  /// Returns the motion of supports by the amounts of the last fit: num_dofs x
  /// num_load_cases, zero in the free rows.
  const Eigen::MatrixXd& HeldMotion() const { return held_; }

  /// Moves the displacements of the model, which was solved with HeldMotion(),
  /// by the amounts that fit the measurement best, and returns the rows of what
  /// is left, model - measurement.  Where the model is not linear in the motion
  /// of supports, by Gauss-Newton steps.  Empty where the model cannot be
  /// solved on the way.
  std::optional<Eigen::VectorXd> Fit();
  /// Fits again at the moduli of the last Fit, under another noise.
  std::optional<Eigen::VectorXd> Refit();

  /// The displacements of the specimen by the last Fit, with the motion R a of
  /// all where rotations are linear: num_dofs x num_load_cases.
  Eigen::MatrixXd FittedDisplacement() const;
  /// The cameras that see them, one for each load case; none where rotations
  /// are linear, or the motion of all is not free.
  const std::vector<Camera>& Cameras() const { return cameras_; }
  /// The displacements that the cameras see of the undeformed nodes.
  Eigen::MatrixXd SeenAtRest() const;

  /// The rows of changes of displacements and of forces of supports, num_dofs x
  /// num_load_cases, without what amounts could explain.
  Eigen::VectorXd Eliminate(const Eigen::MatrixXd& displacements,
                            const Eigen::MatrixXd& support_forces);

  /// Turns changes of seen displacements, num_dofs x num_load_cases, as the
  /// specimen sees them: the transpose of what Eliminate turns.
  Eigen::MatrixXd TurnedBack(Eigen::MatrixXd changes) const;

  /// The rows without what amounts could explain.
  Eigen::VectorXd Eliminate(Eigen::VectorXd rows);

  /// Picks the measured ones of the forces of supports, each over its standard
  /// deviation.
  Eigen::VectorXd Resultants(const Eigen::MatrixXd& support_forces) const;
  /// Multiplies rows of resultants, weighted as all rows are, by the transpose
  /// of what makes them of the forces of supports: num_dofs x num_load_cases.
  Eigen::MatrixXd ResultantsTransposed(const Eigen::VectorXd& rows) const;
  /// What was measured of them, likewise.
  Eigen::VectorXd MeasuredResultants() const;

 private:
  /// One measured component of a force.
  struct ResultantRow {
    Eigen::Index load_case;
    std::vector<Eigen::Index> held;  ///< Degrees of freedom.
    double force;
    double noise_sd;
  };

  /// A of one load case, where its columns are few: of displacement rows, and
  /// of resultants over their standard deviations; and the (pseudo-)inverse of
  /// A^T A, by which iterations become one or two.
  struct Columns {
    Eigen::MatrixXd of_displacements;
    Eigen::MatrixXd of_resultants;
    Eigen::MatrixXd inverse_gram;
  };

  Eigen::Index NumResultantsOf(Eigen::Index k) const {
    return first_resultant_[k + 1] - first_resultant_[k];
  }
  Eigen::Index NumObservedOf(Eigen::Index k) const {
    return observed_.CaseStart(k + 1) - observed_.CaseStart(k);
  }
  const UnknownMotion& MotionOf(Eigen::Index k) const {
    return motions_[motion_of_case_[k]];
  }
  /// Returns the part that load case `k` has of all amounts: those of its
  /// supports, and then those of the motion as a whole.
  template <class Amounts>
  auto AmountsOf(Eigen::Index k, Amounts& amounts) const {
    return amounts.segment(first_amount_[k], MotionOf(k).NumAmounts());
  }
  Eigen::VectorXd ResultantsOfCase(Eigen::Index k,
                                   const Eigen::VectorXd& support_forces) const;
  /// Returns where the camera of load case `k` sees the undeformed nodes, and
  /// the positions about which it turns: dimension x num_nodes.
  Eigen::MatrixXd SeenAtRest(Eigen::Index k) const;
  Eigen::MatrixXd PositionsOfCamera(Eigen::Index k) const;
  /// Returns the measured displacement of supports in the frame of the
  /// specimen, num_dofs.
  Eigen::VectorXd MeasuredMotionOfSupports(Eigen::Index k) const;
  /// Turns changes of displacements in load case `k` (num_dofs x n) as its
  /// camera does, or back; as they are where no camera turns.
  Eigen::MatrixXd Turned(Eigen::Index k, const Eigen::MatrixXd& changes) const;
  Eigen::MatrixXd TurnedBack(Eigen::Index k,
                             const Eigen::MatrixXd& changes) const;
  /// Does so with a column for each load case.
  Eigen::MatrixXd Turned(Eigen::MatrixXd changes) const;
  /// Takes the increments of motions about the present state.
  void Linearize();
  /// Adds increments to the motions, those of cameras and, where the model is
  /// not linear, of rigid faces by finite rotations, and moves the supports of
  /// the model likewise.  False where that has no equilibrium.
  bool Move(const Eigen::VectorXd& increments);
  /// Where amounts are few, a solve for each, unless others' will do.
  void SolveForColumns();
  bool AreAmountsFew() const;
  /// Solves for the columns of the load cases that have this motion.
  void SolveForColumnsOf(std::size_t index);
  void AddResultants(const Scene& scene, Eigen::Index k);
  void InvertGrams();
  Eigen::VectorXd MultiplyColumns(const Eigen::VectorXd& amounts) const;
  Eigen::VectorXd MultiplyColumnsTransposed(const Eigen::VectorXd& rows) const;
  Eigen::VectorXd Precondition(const Eigen::VectorXd& gradient) const;
  Eigen::VectorXd RowsOf(const Eigen::MatrixXd& displacements,
                         const Eigen::MatrixXd& support_forces) const;
  /// num_dofs x num_load_cases: those of the supports alone, in equilibrium,
  /// and with the motion of all.
  Eigen::MatrixXd HeldMotion(const Eigen::VectorXd& amounts) const;
  Eigen::MatrixXd SupportMotion(const Eigen::VectorXd& amounts);
  Eigen::MatrixXd WithMotionOfAll(const Eigen::VectorXd& amounts,
                                  Eigen::MatrixXd displacements) const;
  Eigen::VectorXd Multiply(const Eigen::VectorXd& amounts);
  Eigen::VectorXd MultiplyTransposed(const Eigen::VectorXd& rows);
  /// The x of least ||rows - A x||; leaves rows - A x behind.
  Eigen::VectorXd Minimize(double tolerance, Eigen::VectorXd& rows);

  const Scene& scene_;
  const ObservedDisplacements& observed_;
  ForwardModel& model_;
  /// One for each set of supports, or for each load case where the model is
  /// not linear or there are cameras, since tangents and rotations differ.
  std::vector<UnknownMotion> motions_;
  std::vector<std::size_t> motion_of_case_;
  std::vector<Eigen::Index> first_amount_;  ///< By load cases.
  std::vector<ResultantRow> resultants_;    ///< By load cases.
  std::vector<Eigen::Index> first_resultant_;
  std::vector<Columns> columns_;  ///< By load cases; empty where they are many.
  bool are_columns_of_here_ = false;  ///< Rather than of other moduli.
  double noise_ = 0;
  Eigen::VectorXd amounts_;      ///< In all load cases, by the last fit.
  Eigen::MatrixXd held_;         ///< The motion of supports by these amounts.
  std::vector<Camera> cameras_;  ///< By load cases; see Cameras().
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_MOTION_ELIMINATION_H_
