#include "elastimate/core/algebra/dense_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace elastimate {

QrDecomposition DecomposeQr(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::Index rank = std::min(a.rows(), a.cols());
  return {qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), rank),
          qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>()};
}

Eigen::MatrixXd TriangularFactor(const Eigen::MatrixXd& a) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(a)
      .matrixQR()
      .topRows(std::min(a.rows(), a.cols()))
      .triangularView<Eigen::Upper>();
}

Eigen::MatrixXd OrthonormalBasis(const Eigen::MatrixXd& a, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  qr.setThreshold(threshold);
  return qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), qr.rank());
}

Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a,
                                  const Eigen::MatrixXd& b, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  qr.setThreshold(threshold);
  // The solve of Eigen counts pivots that are not zero by its own threshold.
  const Eigen::Index rank = qr.rank();
  const Eigen::MatrixXd q =
      qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), rank);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  x.topRows(rank) = qr.matrixQR()
                        .topLeftCorner(rank, rank)
                        .triangularView<Eigen::Upper>()
                        .solve(q.transpose() * b);
  return qr.colsPermutation() * x;
}

Eigen::MatrixXd SolveLeastSquares(const Eigen::MatrixXd& a,
                                  const Eigen::MatrixXd& b) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(a).solve(b);
}

SingularValueDecomposition DecomposeSingularValues(const Eigen::MatrixXd& a) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
      a, Eigen::ComputeThinU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

SymmetricEigenDecomposition DecomposeSymmetric(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigenDecomposition DecomposeSymmetric(const Eigen::MatrixXd& a,
                                               const Eigen::MatrixXd& b) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a) { return a.inverse(); }

}  // namespace elastimate
