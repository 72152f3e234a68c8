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

void MultiplyQuadratic(const QuadraticMesh& mesh,
                       const Eigen::MatrixXd& displacement,
                       StiffnessProducts& products) {
  if (mesh.Kind() == ElementKind::kTet10) {
    MultiplyQuadraticTetrahedra(mesh, displacement, products);
  } else {
    MultiplyTensorElements(mesh, displacement, products);
  }
}

Eigen::MatrixXd MultiplyQuadratic(const QuadraticMesh& mesh,
                                  const Eigen::Matrix2Xd& coefficients,
                                  const Eigen::MatrixXd& displacement) {
  return mesh.Kind() == ElementKind::kTet10
             ? MultiplyQuadraticTetrahedra(mesh, coefficients, displacement)
             : MultiplyTensorElements(mesh, coefficients, displacement);
}

// Multiplies for all kinds but linear tetrahedra and those of HasQuadraticPass.
void MultiplyOtherKinds(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                        StiffnessProducts& products) {
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
  } else if (HasQuadraticPass(mesh.kind)) {
    MultiplyQuadratic(QuadraticMesh(mesh), displacement, products);
  } else {
    MultiplyOtherKinds(mesh, displacement, products);
  }
  return products;
}

StiffnessOperator::StiffnessOperator(const Mesh& mesh, int num_threads)
    : mesh_(mesh), num_threads_(num_threads) {
  assert(num_threads >= 1);
  if (HasQuadraticPass(mesh.kind)) {
    quadratic_.emplace(QuadraticMesh::InBlocks(mesh));
  }
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
  } else if (quadratic_) {
    MultiplyQuadratic(*quadratic_, displacement, products);
  } else {
    MultiplyOtherKinds(mesh_, displacement, products);
  }
}

Eigen::MatrixXd StiffnessOperator::MultiplySum(
    const Eigen::Matrix2Xd& coefficients,
    const Eigen::MatrixXd& displacement) const {
  assert(HasQuadraticPass(mesh_.kind));
  return MultiplyQuadratic(*quadratic_, coefficients, displacement);
}

}  // namespace elastimate
