#include "benchmarks/naive_stiffness_product.h"

#include <Eigen/LU>
#include <cmath>

namespace elastimate {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using StrainDisplacement = Eigen::Matrix<double, 6, 12>;
using ElementMatrix = Eigen::Matrix<double, 12, 12>;
using ElementVector = Eigen::Matrix<double, 12, 1>;

StrainDisplacement MakeStrainDisplacement(const Eigen::Matrix4d& coordinates) {
  const Eigen::Matrix4d shape = coordinates.inverse();
  StrainDisplacement b;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double dx = shape(i, 1);
    const double dy = shape(i, 2);
    const double dz = shape(i, 3);
    b.middleCols<3>(3 * i) << dx, 0, 0, 0, dy, 0, 0, 0, dz,  //
        dy, dx, 0, 0, dz, dy, dz, 0, dx;
  }
  return b;
}

// V B^T D B.  The lazy products are those that Eigen unrolls; for these sizes
// it would otherwise pack blocks as for large matrices, which takes longer.
ElementMatrix MakeElementMatrix(const StrainDisplacement& b, const Matrix6d& d,
                                double volume) {
  const StrainDisplacement stress = volume * d.lazyProduct(b);
  return b.transpose().lazyProduct(stress);
}

}  // namespace

StiffnessProducts MultiplyNaively(const Mesh& mesh,
                                  const Eigen::VectorXd& displacement) {
  Matrix6d d_h = Matrix6d::Identity();
  d_h.bottomRightCorner<3, 3>() *= 0.5;
  Matrix6d d_j = -Matrix6d::Identity();
  d_j.topLeftCorner<3, 3>() =
      Eigen::Matrix3d::Ones() - 2 * Eigen::Matrix3d::Identity();

  StiffnessProducts products;
  products.h = Eigen::VectorXd::Zero(displacement.size());
  products.j = Eigen::VectorXd::Zero(displacement.size());
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    Eigen::Matrix4d coordinates;
    ElementVector q;
    for (Eigen::Index i = 0; i < 4; ++i) {
      const Eigen::Index node = mesh.elements(i, element);
      coordinates.col(i) << 1, mesh.nodes.col(node);
      q.segment<3>(3 * i) = displacement.segment<3>(3 * node);
    }
    const double volume = std::abs(coordinates.determinant()) / 6;
    const StrainDisplacement b = MakeStrainDisplacement(coordinates);
    const ElementVector a = MakeElementMatrix(b, d_h, volume) * q;
    const ElementVector p = MakeElementMatrix(b, d_j, volume) * q;
    for (Eigen::Index i = 0; i < 4; ++i) {
      const Eigen::Index node = mesh.elements(i, element);
      products.h.middleRows<3>(3 * node) += a.segment<3>(3 * i);
      products.j.middleRows<3>(3 * node) += p.segment<3>(3 * i);
    }
  }
  return products;
}

}  // namespace elastimate
