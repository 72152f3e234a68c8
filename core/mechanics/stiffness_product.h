#ifndef ELASTIMATE_CORE_MECHANICS_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_MECHANICS_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/mechanics/element_blocks.h"
#include "elastimate/core/mechanics/quadratic_mesh.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The products of the stiffness bases with some displacement columns.
struct StiffnessProducts {
  Eigen::MatrixXd h;  ///< a = H q, same shape as q.
  Eigen::MatrixXd j;  ///< b = J q, same shape as q.
};

/// Returns a = H q and b = J q after one pass over the elements, for the
/// stiffness bases of K = s (H + nu J) [Becker & Teschner 2007, eq. 14-22].
///
/// `displacement` is num_dofs x num_columns, row dimension * node + component
/// [length]; the products have its shape.  With the strain tensor
/// e = sym(sum_i q_i grad(N_i)^T),
///
///   a_i = integral of e grad(N_i),
///   b_i = integral of tr(e) grad(N_i) - c a_i,
///
/// with c of ShearShareOfJ, so that no element matrix is formed.  In a linear
/// simplex both factors are constant, in a quadratic one with straight edges
/// both are linear, and the integrals are exact.
///
/// Precondition: a valid mesh (ValidateMesh) and num_dofs rows.
/// Cost: one element pass, O(num_elements * num_columns) time (for quadratic
/// tetrahedra about four times that for linear ones).  Single-threaded; the
/// same input gives the same bits on the same kind of processor.
[[nodiscard]] StiffnessProducts MultiplyStiffnessBasis(
    const Mesh& mesh, const Eigen::MatrixXd& displacement);

/// The stiffness bases H and J of a mesh, to be multiplied many times.  This
/// does what MultiplyStiffnessBasis does, but with threads.  It first numbers
/// linear tetrahedra for locality if their own numbering has none, and orders
/// quadratic elements (QuadraticMesh::InBlocks).
///
///   const StiffnessOperator stiffness(mesh, 2);
///   StiffnessProducts products;
///   stiffness.Multiply(q, products);
///
/// Rounding differs from that of MultiplyStiffnessBasis where the elements are
/// visited in another order.
class StiffnessOperator {
 public:
  /// Refers to `mesh`, which has to stay as it is; a temporary one does not
  /// compile.  Precondition: a valid mesh, and at least one thread.
  ///
  /// Threads are OpenMP's, for linear tetrahedra, one for each 16384 of them at
  /// most.  There is one unless more are asked for: a pass is short, and its
  /// callers may have threads of their own, which a library cannot know.  A
  /// pass over quadratic elements of HasQuadraticPass takes longer, and has
  /// OpenMP's own number of threads.
  ///
  /// Cost: O(num_elements) time; a tenth of an element pass for linear
  /// tetrahedra with a good numbering, and else several passes
  /// (OrderForLocality).
  explicit StiffnessOperator(const Mesh& mesh, int num_threads = 1);
  explicit StiffnessOperator(const Mesh&&, int = 1) = delete;

  /// Tells whether linear tetrahedra were numbered again.
  bool IsReordered() const { return !places_.empty(); }

  /// Does what MultiplyStiffnessBasis does; matrices of the right shape in
  /// `products` are used again.  The bits do not depend on the number of
  /// threads.
  void Multiply(const Eigen::MatrixXd& displacement,
                StiffnessProducts& products) const;

  /// Returns the sum over the elements of c_0 H_e q + c_1 J_e q, with the
  /// coefficients c of each element (2 x num_elements), for each column of
  /// `displacement`.  It takes two thirds of the time of both products.
  /// Precondition: HasQuadraticPass.
  [[nodiscard]] Eigen::MatrixXd MultiplySum(
      const Eigen::Matrix2Xd& coefficients,
      const Eigen::MatrixXd& displacement) const;

 private:
  const Mesh& mesh_;
  int num_threads_;
  /// The mesh numbered for locality, and the place of each of its nodes in
  /// mesh_.  Both are empty where the numbering of mesh_ is good.
  Mesh reordered_;
  std::vector<int> places_;
  /// The blocks of the mesh that is worked on, if its tetrahedra are linear.
  ElementBlocks blocks_;
  /// It has a value where HasQuadraticPass.
  std::optional<QuadraticMesh> quadratic_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STIFFNESS_PRODUCT_H_
