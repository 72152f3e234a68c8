#ifndef ELASTIMATE_ESTIMATORS_MAPS_FIELD_SENSITIVITY_H_
#define ELASTIMATE_ESTIMATORS_MAPS_FIELD_SENSITIVITY_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mesh/mesh_parts.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/misfit/motion_elimination.h"

namespace elastimate {

/// Returns a scene whose elements have an isotropic material each, in their
/// order.
[[nodiscard]] Scene WithMaterialOfEachElement(Scene scene);

/// What a field of moduli and one Poisson's ratio make of a scene,
///
///   K = sum_e exp(m_e) K_e(nu),   m_e = ln E_e,   K u = F,
///
/// against what was measured, in the rows of ObservedDisplacements or, where
/// motions are unknown or resultants were measured, those of MotionElimination
/// without what motions could explain.  The sensitivity S of the rows to m is
/// never formed: with the forces of the elements F = [exp(m_e) K_e u]_e and the
/// observation P,
///
///   S v = -P K^-1 F v,   S^T w = -F^T K^-1 P^T w,
///
/// is one solve for each load case and column.
class FieldSensitivity {
 public:
  /// Preconditions are those of Estimator::Run; the supports hold the specimen.
  /// `scene` must outlive this object.  Its materials do not count.
  FieldSensitivity(const Scene& scene, SolverKind solver);
  FieldSensitivity(const FieldSensitivity&) = delete;
  FieldSensitivity& operator=(const FieldSensitivity&) = delete;

  Eigen::Index NumElements() const { return mesh_.NumElements(); }
  Eigen::Index NumRows() const;
  /// Counts the rows that noise is in: less the motions that explain some.
  Eigen::Index NumIndependentRows() const;
  const ObservedDisplacements& Observed() const { return observed_; }

  /// Moves to ln E of each element and nu, with resultants weighed for this
  /// standard deviation of a row.  One factorisation for each set of held
  /// degrees of freedom.  False where the stiffness is singular.
  [[nodiscard]] bool MoveTo(const Eigen::VectorXd& log_moduli,
                            double poisson_ratio, double noise);

  // All functions below have the precondition that MoveTo returned true.

  /// Returns measured - model, num_rows values.
  const Eigen::VectorXd& Residual() const { return residual_; }
  /// Returns |measured - model| of the displacements over |measured|.
  double RelativeResidual() const;
  /// Returns the displacement with the motions that were found: num_dofs x
  /// num_load_cases; empty where no motion is unknown.
  Eigen::MatrixXd FittedDisplacement() const;
  /// Returns the cameras that see it (MotionElimination::Cameras).
  std::vector<Camera> Cameras() const {
    return motion_ ? motion_->Cameras() : std::vector<Camera>();
  }
  /// Returns S V for num_elements x n: num_rows x n.
  Eigen::MatrixXd Multiply(const Eigen::MatrixXd& v);
  /// Returns S^T W for rows W that Eliminate has been applied to, as those of
  /// Residual and Multiply are: num_elements x n.
  Eigen::MatrixXd MultiplyTransposed(const Eigen::MatrixXd& w);
  /// Returns the derivative of the rows by nu at constant E, num_rows values.
  Eigen::VectorXd OfPoissonRatio();
  /// Returns rows without what unknown motions could explain, an orthogonal
  /// projection.
  Eigen::MatrixXd Eliminate(Eigen::MatrixXd rows);
  Work WorkDone() const { return model_.WorkDone(); }

 private:
  Eigen::Index NumCases() const { return observed_.NumLoadCases(); }
  /// Adds forces of elements, each with its factor, to those of their nodes.
  Eigen::VectorXd Scatter(
      const Eigen::MatrixXd& of_elements,
      const Eigen::Ref<const Eigen::VectorXd>& factor) const;
  /// Returns the change of the rows by forces within elements, n columns of
  /// each load case: num_rows x n.
  Eigen::MatrixXd RowsOf(const Eigen::MatrixXd& forces);

  const Mesh& mesh_;
  Scene scene_;  ///< With one material for each element.
  Equilibrium model_;
  ObservedDisplacements observed_;
  std::optional<MotionElimination> motion_;
  /// The mesh with nodes of their own for each element.
  MeshParts parts_;
  StiffnessOperator of_parts_;
  Eigen::VectorXd residual_;
  /// F, and the derivative of the element forces by nu, in each load case: the
  /// degrees of freedom of an element x num_elements.
  std::vector<Eigen::MatrixXd> forces_;
  std::vector<Eigen::MatrixXd> forces_by_poisson_ratio_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_FIELD_SENSITIVITY_H_
