#include "elastimate/core/algebra/dense_algebra.h"

#include <cblas.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <utility>

// LAPACK has no header of its own in OpenBLAS.
extern "C" void dsyevd_(const char* job, const char* triangle, const int* size,
                        double* a, const int* leading, double* values,
                        double* work, const int* work_size, int* integers,
                        const int* num_integers, int* info);

namespace elastimate {
namespace {

// Smaller matrices gain nothing from LAPACK.
constexpr Eigen::Index kLargeSymmetric = 100;

Eigen::MatrixXd ProductBy(CBLAS_TRANSPOSE transposed,
                          const Eigen::Ref<const Eigen::MatrixXd>& a,
                          const Eigen::MatrixXd& b) {
  const Eigen::Index num_rows = transposed == CblasTrans ? a.cols() : a.rows();
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(num_rows, b.cols());
  if (product.size() == 0 || b.rows() == 0) {
    return product;
  }
  if (b.cols() == 1) {
    // dgemm would copy A, which takes longer than the product.
    cblas_dgemv(CblasColMajor, transposed, int(a.rows()), int(a.cols()), 1,
                a.data(), int(a.outerStride()), b.data(), 1, 0, product.data(),
                1);
  } else {
    cblas_dgemm(CblasColMajor, transposed, CblasNoTrans, int(num_rows),
                int(b.cols()), int(b.rows()), 1, a.data(), int(a.outerStride()),
                b.data(), int(b.rows()), 0, product.data(), int(num_rows));
  }
  return product;
}

// Divide and conquer.  Empty where LAPACK does not converge.
SymmetricEigenDecomposition DecomposeByLapack(Eigen::MatrixXd a) {
  const int size = int(a.rows());
  const int query = -1;
  Eigen::VectorXd values(size);
  double work_size = 0;
  int num_integers = 0;
  int info = 0;
  dsyevd_("V", "L", &size, a.data(), &size, values.data(), &work_size, &query,
          &num_integers, &query, &info);
  Eigen::VectorXd work{Eigen::Index(work_size)};
  Eigen::VectorXi integers(num_integers);
  const int num_work = int(work.size());
  dsyevd_("V", "L", &size, a.data(), &size, values.data(), work.data(),
          &num_work, integers.data(), &num_integers, &info);
  if (info != 0) {
    return {};
  }
  return {std::move(values), std::move(a)};
}

}  // namespace

Eigen::MatrixXd Product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                        const Eigen::MatrixXd& b) {
  return ProductBy(CblasNoTrans, a, b);
}

Eigen::MatrixXd ProductOfTransposed(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                    const Eigen::MatrixXd& b) {
  return ProductBy(CblasTrans, a, b);
}

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
  if (a.size() == 0) {  // Eigen reads outside of an empty matrix.
    return {Eigen::VectorXd(0), a};
  }
  if (a.rows() >= kLargeSymmetric && a.allFinite()) {
    SymmetricEigenDecomposition decomposition = DecomposeByLapack(a);
    if (decomposition.values.size() > 0) {
      return decomposition;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigenDecomposition DecomposeSymmetric(const Eigen::MatrixXd& a,
                                               const Eigen::MatrixXd& b) {
  if (a.size() == 0) {
    return {Eigen::VectorXd(0), a};
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, b);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd Inverse(const Eigen::MatrixXd& a) { return a.inverse(); }

}  // namespace elastimate
