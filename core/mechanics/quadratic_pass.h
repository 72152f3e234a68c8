#ifndef ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_H_
#define ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_H_

#include <Eigen/Core>
#include <cstddef>
#include <functional>

#include "elastimate/core/mechanics/quadratic_mesh.h"
#include "elastimate/core/mechanics/stiffness_product.h"

namespace elastimate {

/// The record of a node has groups of four values, of which the last is zero:
/// one group for its displacement, one for the sum at it, and one for the sum
/// of the second product if there are two.  In the plane the third value is
/// zero, too.
inline constexpr std::ptrdiff_t kFour = 4;
inline constexpr std::ptrdiff_t kSizeForSum = 2 * kFour;
inline constexpr std::ptrdiff_t kSizeForProducts = 3 * kFour;

/// One pass over a block of quadratic elements with straight edges, for one
/// column.  Several columns in one pass would share the geometry of an element,
/// but their records would not fit into the cache together, which costs more.
struct QuadraticPass {
  const int* elements;  ///< num_nodes of the kind x num_elements.
  std::ptrdiff_t num_elements;
  /// These are dimension x num_nodes.  Four values may be read at each vertex.
  const double* positions;
  double thickness;
  /// If these are null, the record of a node receives two products, a =
  /// integral of e grad(N) and then p = integral of tr(e) grad(N).  Otherwise
  /// it receives their sum with these coefficients of each element.  Both
  /// arrays then are longer than the number of elements, by kMostLanes.
  const double* coefficients_of_a;
  const double* coefficients_of_p;
  /// This is the node whose record comes first.
  std::ptrdiff_t first_node;
  double* records;
};

/// The largest number of elements that are worked on at a time.
inline constexpr std::ptrdiff_t kMostLanes = 8;

/// Adds what the elements contribute to the records.
using RunPass = std::function<void(const QuadraticPass&)>;

/// Sets the products H q and J q of MultiplyStiffnessBasis.  OpenMP's threads
/// share the blocks of the mesh, except within an outer parallel region; the
/// bits do not depend on how many there are.
void MultiplyByPass(const QuadraticMesh& mesh,
                    const Eigen::MatrixXd& displacement, const RunPass& run,
                    StiffnessProducts& products);

/// Returns the sum over the elements of c_0 H_e q + c_1 J_e q, with the
/// coefficients c of each element (2 x num_elements).  Threads share the blocks
/// as above.
Eigen::MatrixXd MultiplyByPass(const QuadraticMesh& mesh,
                               const Eigen::Matrix2Xd& coefficients,
                               const Eigen::MatrixXd& displacement,
                               const RunPass& run);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_H_
