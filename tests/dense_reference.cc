#include "tests/dense_reference.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate::testing {

Eigen::Matrix<double, 6, 12> StrainDisplacement(
    const Eigen::Matrix<double, 3, 4>& x, double* volume) {
  Eigen::Matrix4d coordinates;
  coordinates << Eigen::RowVector4d::Ones(), x;
  *volume = std::abs(coordinates.determinant()) / 6;
  // Row i of the inverse holds the coefficients of shape function i.
  const Eigen::Matrix4d shape = coordinates.inverse();
  Eigen::Matrix<double, 6, 12> b;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double dx = shape(i, 1);
    const double dy = shape(i, 2);
    const double dz = shape(i, 3);
    b.middleCols<3>(3 * i) << dx, 0, 0, 0, dy, 0, 0, 0, dz,  //
        dy, dx, 0, 0, dz, dy, dz, 0, dx;
  }
  return b;
}

template Eigen::MatrixXd DenseStiffness<double>(
    const Mesh& mesh, const Eigen::Matrix<double, 6, 6>& d);

Eigen::MatrixXd SolveDensely(const Eigen::MatrixXd& a,
                             const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b);
}

Eigen::MatrixXd InvertDensely(const Eigen::MatrixXd& a) { return a.inverse(); }

Eigen::VectorXd SymmetricEigenvalues(const Eigen::MatrixXd& a) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues();
}

Eigen::VectorXd DenseFreeDisplacement(const Scene& scene,
                                      const IsotropicElasticity& elasticity,
                                      Eigen::Index load_case) {
  const DegreesOfFreedom dofs(scene.supports);
  const Eigen::MatrixXd stiffness = DenseStiffness<double>(
      scene.mesh,
      HookeMatrix(elasticity.youngs_modulus, elasticity.poisson_ratio));
  const Eigen::VectorXd force = AssembleLoadCases(scene).col(load_case);
  return SolveDensely(stiffness(dofs.free, dofs.free), force(dofs.free));
}

}  // namespace elastimate::testing
