#ifndef ELASTIMATE_TESTS_DENSE_REFERENCE_H_
#define ELASTIMATE_TESTS_DENSE_REFERENCE_H_

#include <Eigen/Core>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

/// Returns the strain-displacement matrix B (6 x 12, engineering shear strains)
/// of a linear tetrahedron with the nodes `x`, and its volume.  Both come from
/// the inverse of the matrix of nodal coordinates, as in textbooks; no code is
/// shared with the library.
Eigen::Matrix<double, 6, 12> StrainDisplacement(
    const Eigen::Matrix<double, 3, 4>& x, double* volume);

/// Returns the sum over the elements of V B^T D B, (3 num_nodes)^2.  T is the
/// scalar of D: double, or a number with derivatives.
template <typename T>
Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> DenseStiffness(
    const Mesh& mesh, const Eigen::Matrix<T, 6, 6>& d) {
  using MatrixXT = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  MatrixXT stiffness(3 * mesh.NumNodes(), 3 * mesh.NumNodes());
  stiffness.setConstant(T(0));
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    Eigen::Matrix<double, 3, 4> x;
    for (int i = 0; i < 4; ++i) {
      x.col(i) = mesh.nodes.col(mesh.elements(i, e));
    }
    double volume = 0;
    const Eigen::Matrix<T, 6, 12> b =
        StrainDisplacement(x, &volume).template cast<T>();
    const Eigen::Matrix<T, 12, 12> element = T(volume) * b.transpose() * d * b;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        stiffness.template block<3, 3>(3 * mesh.elements(i, e),
                                       3 * mesh.elements(j, e)) +=
            element.template block<3, 3>(3 * i, 3 * j);
      }
    }
  }
  return stiffness;
}

extern template Eigen::MatrixXd DenseStiffness<double>(
    const Mesh& mesh, const Eigen::Matrix<double, 6, 6>& d);

/// Returns Hooke's law in Voigt notation for these Lame parameters.
template <typename T>
Eigen::Matrix<T, 6, 6> HookeMatrix(const T& youngs_modulus,
                                   const T& poisson_ratio) {
  const T lambda = youngs_modulus * poisson_ratio /
                   ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  const T mu = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
  Eigen::Matrix<T, 6, 6> d;
  d.setConstant(T(0));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      d(i, j) = lambda;
    }
    d(i, i) += 2.0 * mu;
    d(i + 3, i + 3) = mu;
  }
  return d;
}

/// D_H = diag(1, 1, 1, 1/2, 1/2, 1/2).
inline Eigen::Matrix<double, 6, 6> DenseDH() {
  Eigen::Matrix<double, 6, 1> diagonal;
  diagonal << 1, 1, 1, 0.5, 0.5, 0.5;
  return diagonal.asDiagonal();
}

/// D_J = [[-1, 1, 1], [1, -1, 1], [1, 1, -1]] (+) -I_3.
inline Eigen::Matrix<double, 6, 6> DenseDJ() {
  Eigen::Matrix<double, 6, 6> d = -Eigen::Matrix<double, 6, 6>::Identity();
  d.topLeftCorner<3, 3>() =
      Eigen::Matrix3d::Ones() - 2 * Eigen::Matrix3d::Identity();
  return d;
}

/// Returns A^-1 B for a symmetric matrix A, by LDL^T.
Eigen::MatrixXd SolveDensely(const Eigen::MatrixXd& a,
                             const Eigen::MatrixXd& b);

/// Returns A^-1 by LU.  It is not inline, so that LU is compiled only once.
Eigen::MatrixXd InvertDensely(const Eigen::MatrixXd& a);

/// Returns the eigenvalues of a symmetric matrix, in ascending order.
Eigen::VectorXd SymmetricEigenvalues(const Eigen::MatrixXd& a);

/// Returns the free displacements of a load case; they are 3 num_nodes where
/// all are free.
Eigen::VectorXd DenseFreeDisplacement(const Scene& scene,
                                      const IsotropicElasticity& elasticity,
                                      Eigen::Index load_case);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_DENSE_REFERENCE_H_
