#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Virtual fields on a mesh: all that an estimate by virtual work needs of a
/// mesh and its supports, prepared once for any number of measurements.
///
/// The fields are the columns of V (num_free x k): an orthonormal basis of the
/// polynomials of degree <= d along each axis on the free degrees of freedom,
/// without those that supports or a small mesh make dependent, and without the
/// motions without strain that the supports leave free, whose internal work is
/// zero for every material.
///
/// [H V, J V] is kept as the triangle of a QR factorisation, since the
/// condition number of a Gram matrix is the square of its own, which has no
/// bound as nu tends to -1 or 1/2.
class VirtualWork {
 public:
  /// Cost: one element pass of 3 (d + 1)(d + 2)(d + 3) / 6 columns (12, 30, 60;
  /// in two dimensions (d + 1)(d + 2))
  /// and the QR factorisation of twice as many; memory for about as many
  /// vectors over the nodes as one third of that number, and a block of fixed
  /// size.  Single-threaded, deterministic.
  /// Preconditions: a valid scene's mesh and supports; 1 <= degree <= 3.
  ///
  /// With windows (num_nodes x n) the fields are the products of each with the
  /// polynomials, n times as many.
  VirtualWork(const Mesh& mesh, const Supports& supports, int degree,
              const Eigen::MatrixXd& windows = {});

  /// k.
  Eigen::Index NumFields() const { return h_.cols(); }

  /// V in all rows, zero in the held ones: num_dofs x k [-].
  Eigen::MatrixXd Fields() const;

  /// V^T of the free rows of nodal forces, num_dofs x n: k x n.
  Eigen::MatrixXd Of(const Eigen::MatrixXd& nodal_forces) const;

  /// The largest share of the nodal forces (num_dofs x n) that is not in
  /// balance: |v.f| / (|v|.|f|) over the motions v without strain that the
  /// supports leave free.  Zero when there are none.
  double Imbalance(const Eigen::MatrixXd& nodal_forces) const;

  /// H V and J V, (2 k0) x k each, rotated to the rows of the triangle: their
  /// products with each other are those of H V and J V, k0 >= k.
  const Eigen::MatrixXd& H() const { return h_; }
  const Eigen::MatrixXd& J() const { return j_; }

 private:
  /// For each component V of its rows before the rotation, num_nodes x m each,
  /// zero in the held rows.
  std::vector<Eigen::MatrixXd> polynomials_;
  /// From the polynomials (k0) to the fields (k0 x k), and to the free motions.
  Eigen::MatrixXd fields_;
  Eigen::MatrixXd free_motions_;
  Eigen::MatrixXd h_;
  Eigen::MatrixXd j_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_WORK_H_
