#include "elastimate/core/mechanics/stiffness_product.h"

#include <cassert>
#include <utility>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mechanics/element_stiffness_product.h"
#include "elastimate/core/mechanics/tensor_stiffness_product.h"
#include "elastimate/core/mechanics/tet10_stiffness_product.h"
#include "elastimate/core/mechanics/tet4_stiffness_product.h"
#include "elastimate/core/mesh/node_order.h"

namespace elastimate {
namespace {

// Multiplies for all kinds but linear tetrahedra.
void MultiplyOtherKinds(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                        StiffnessProducts& products) {
  if (mesh.kind == ElementKind::kTet10) {
    MultiplyQuadraticTetrahedra(mesh, displacement, products);
    return;
  }
  if (mesh.kind == ElementKind::kHex27 || mesh.kind == ElementKind::kQuad9) {
    MultiplyTensorElements(mesh, displacement, products);
    return;
  }
  products.h.setZero(displacement.rows(), displacement.cols());
  products.j.setZero(displacement.rows(), displacement.cols());
  AddStrainProducts(mesh, displacement, products.h, products.j);
  products.j -= ShearShareOfJ(mesh.section.model) * products.h;
}

}  // namespace

StiffnessProducts MultiplyStiffnessBasis(const Mesh& mesh,
                                         const Eigen::MatrixXd& displacement) {
  assert(displacement.rows() == mesh.NumDofs());
  StiffnessProducts products;
  if (mesh.kind == ElementKind::kTet4) {
    MultiplyLinearTetrahedra(mesh, ChooseElementBlocks(mesh), {}, displacement,
                             1, products);
  } else {
    MultiplyOtherKinds(mesh, displacement, products);
  }
  return products;
}

StiffnessOperator::StiffnessOperator(const Mesh& mesh, int num_threads)
    : mesh_(mesh), num_threads_(num_threads) {
  assert(num_threads >= 1);
  if (mesh.kind != ElementKind::kTet4) {
    return;
  }
  if (!HasLocality(mesh)) {
    OrderedMesh ordered = OrderForLocality(mesh);
    reordered_ = std::move(ordered.mesh);
    places_ = std::move(ordered.places);
  }
  blocks_ = ChooseElementBlocks(IsReordered() ? reordered_ : mesh);
}

void StiffnessOperator::Multiply(const Eigen::MatrixXd& displacement,
                                 StiffnessProducts& products) const {
  assert(displacement.rows() == mesh_.NumDofs());
  if (mesh_.kind == ElementKind::kTet4) {
    MultiplyLinearTetrahedra(IsReordered() ? reordered_ : mesh_, blocks_,
                             places_, displacement, num_threads_, products);
  } else {
    MultiplyOtherKinds(mesh_, displacement, products);
  }
}

}  // namespace elastimate
