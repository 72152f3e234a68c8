#ifndef ELASTIMATE_CORE_MECHANICS_LAW_PRODUCTS_H_
#define ELASTIMATE_CORE_MECHANICS_LAW_PRODUCTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/materials/material_frames.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// Tangents are given in the frame of each material, to which the gradients in
/// its elements are rotated.

/// Adds, for tangents C_k = dP_k / dH of small strains of each element's
/// material, and each column u of `displacement`,
///
///   f_k,i = integral of (C_k : grad u) grad(N_i)
///
/// to products[k], num_dofs x n each.  `tangents[material][k]` is dimension^2 x
/// dimension^2 over gradients in the order of their columns.  One element pass.
void AddLawProducts(const Mesh& mesh,
                    const std::vector<int>& material_of_element,
                    const MaterialFrames& frames,
                    const std::vector<std::vector<Eigen::MatrixXd>>& tangents,
                    const Eigen::MatrixXd& displacement,
                    std::vector<Eigen::MatrixXd>& products);

/// Returns the stiffness blocks K_ij = integral of grad(N_i) . C . grad(N_j)
/// for each pair of the graph and one tangent C of each material, side by side:
/// dimension x (dimension num_pairs).  One element pass.
Eigen::MatrixXd StiffnessBlocks(const Mesh& mesh, const NodeGraph& graph,
                                const std::vector<int>& material_of_element,
                                const MaterialFrames& frames,
                                const std::vector<Eigen::MatrixXd>& tangents);

/// Returns the blocks c_0 H_ij + c_1 J_ij of isotropic materials, for these
/// coefficients of each element, 2 x num_elements, in a fifth of the time: with
/// M_ij = integral of grad(N_i) grad(N_j)^T and c of ShearShareOfJ they are
///
///   H_ij = (M_ij^T + tr(M_ij) I) / 2,   J_ij = M_ij - c H_ij.
Eigen::MatrixXd StiffnessBlocks(const Mesh& mesh, const NodeGraph& graph,
                                const Eigen::Matrix2Xd& coefficients);

/// Returns only the blocks K_ii of StiffnessBlocks, those of all nodes side by
/// side: dimension x num_dofs.  One element pass, which needs no graph.
Eigen::MatrixXd DiagonalStiffnessBlocks(
    const Mesh& mesh, const std::vector<int>& material_of_element,
    const MaterialFrames& frames, const std::vector<Eigen::MatrixXd>& tangents);

/// Returns these blocks for isotropic materials, in a third of the time.
Eigen::MatrixXd DiagonalStiffnessBlocks(const Mesh& mesh,
                                        const Eigen::Matrix2Xd& coefficients);

/// Returns the strain energy of each element over its volume, for a
/// displacement of num_dofs values and one tangent C of each material: the mean
/// of grad u : C : grad u / 2, num_elements values [pressure].
Eigen::VectorXd LawEnergyDensity(const Mesh& mesh,
                                 const std::vector<int>& material_of_element,
                                 const MaterialFrames& frames,
                                 const std::vector<Eigen::MatrixXd>& tangents,
                                 const Eigen::VectorXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_LAW_PRODUCTS_H_
