#ifndef ELASTIMATE_CORE_MECHANICS_TET4_STIFFNESS_PRODUCT_H_
#define ELASTIMATE_CORE_MECHANICS_TET4_STIFFNESS_PRODUCT_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mechanics/element_blocks.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Computes a = H q and b = J q on linear tetrahedra, for each column q of
/// `displacement`; all three are (3 num_nodes) x num_columns.
///
/// With the edges e_i = x_i - x_0, the cofactors c_1 = e_2 x e_3 (and so on),
/// det J = e_1 . c_1 and w = V / (det J)^2 = 1 / (6 |det J|),
///
///   S = w sym(sum_i (q_i - q_0) c_i^T),   a_i = S c_i,
///   b_i = tr(S) c_i - 2 a_i,
///
/// for i = 1..3, and the values of node 0 are the negative sums.
///
/// Node i of the mesh has the rows 3 places[i], 3 places[i] + 1 and 3 places[i]
/// + 2 of the columns; an empty `places` stands for places[i] = i.  That lets a
/// mesh be numbered for locality while the columns are not.
///
/// The instructions are those of the processor that the program runs on.  One
/// column is worked on with eight (AVX-512), four (AVX2) elements or one
/// element at a time, several columns with as many columns at a time.  On one
/// processor the values of a column do not depend on the other columns.
///
/// Elements are worked on in the blocks that ChooseElementBlocks finds, whose
/// nodes are copied to memory that stays in the cache: first every second
/// block, each by one of `num_threads` threads, then those in between.  Blocks
/// of the same turn share no nodes, so that the bits do not depend on the
/// number of threads.  A single block is worked on by one thread.
void MultiplyLinearTetrahedra(const Mesh& mesh, const ElementBlocks& blocks,
                              const std::vector<int>& places,
                              const Eigen::MatrixXd& displacement,
                              int num_threads, StiffnessProducts& products);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TET4_STIFFNESS_PRODUCT_H_
