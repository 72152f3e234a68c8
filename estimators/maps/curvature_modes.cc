#include "elastimate/estimators/maps/curvature_modes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/maps/random_columns.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kFirstModes = 64;
// Each of three matrices has at most so many entries, which take 0.8 GB in all,
// or those of the first modes where a mesh has more than 547 000 elements.
constexpr double kMostModeEntries = 3.5e7;
// Random vectors for sums over what is beside the modes: as many as cost
// little, since a sum of f has the variance 2 |f|^2 over their number.
constexpr Eigen::Index kLeastProbes = 8;
constexpr Eigen::Index kMostProbes = 32;
constexpr Eigen::Index kProbeEntries = 50000;
// Beside the accurate modes k lambda is at most some tens, where 20 steps are
// accurate to a per cent.
constexpr int kLanczosSteps = 20;

// Returns orthonormal columns up to rounding times the square of the condition
// of those given, which is small for random ones.  A second time mends that.
Eigen::MatrixXd Orthonormalised(const Eigen::MatrixXd& columns) {
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Upper> gram(
      ProductOfTransposed(columns, columns));
  return Product(columns, gram.matrixU().solve(Eigen::MatrixXd::Identity(
                              columns.cols(), columns.cols())));
}

}  // namespace

void CurvatureModes::AddUntil(double least, const ColumnOperator& multiply) {
  const Eigen::Index size = basis_.rows();
  const Eigen::Index most = std::min<Eigen::Index>(
      size, std::max<Eigen::Index>(
                kFirstModes, Eigen::Index(kMostModeEntries / double(size))));
  // All modes cost no more than the sums beside some of them.
  const bool takes_all = size <= kLanczosSteps * kMostProbes;
  while (basis_.cols() < most && !HasWholeSpan() &&
         (Size() == 0 || values_(Size() - 1) > least)) {
    const Eigen::Index old = basis_.cols();
    const Eigen::Index more =
        takes_all ? size - old
                  : std::min(std::max(kFirstModes, old / 2), most - old);
    std::mt19937_64 generator(old + 1);
    Eigen::MatrixXd columns = StandardNormal(size, more, generator);
    for (int i = 0; i < 2; ++i) {
      columns -= Product(basis_, ProductOfTransposed(basis_, columns));
      columns = Orthonormalised(columns);
    }
    basis_.conservativeResize(Eigen::NoChange, old + more);
    products_.conservativeResize(Eigen::NoChange, old + more);
    basis_.rightCols(more) = columns;
    products_.rightCols(more) = multiply(columns);
    Decompose();
    rest_.reset();
  }
  if (!rest_) {
    MeasureRest(multiply);
  }
}

void CurvatureModes::Renew(const ColumnOperator& multiply) {
  products_ = multiply(basis_);
  Decompose();
  MeasureRest(multiply);
}

CurvatureModes CurvatureModes::OfRoot(const Eigen::MatrixXd& g) {
  CurvatureModes modes(g.rows());
  modes.TakeModesOf(g, 0);
  modes.num_accurate_ = modes.Size();
  return modes;
}

void CurvatureModes::TakeModesOf(const Eigen::MatrixXd& g, double shift) {
  const SymmetricEigenDecomposition gram =
      DecomposeSymmetric(ProductOfTransposed(g, g));
  values_ = (gram.values.reverse().array() - shift).cwiseMax(0.0);
  vectors_ = Product(g, gram.vectors.rowwise().reverse() *
                            gram.values.reverse()
                                .cwiseMax(std::numeric_limits<double>::min())
                                .cwiseSqrt()
                                .cwiseInverse()
                                .asDiagonal());
  // The last vectors are rounding where H has a null space.
  Eigen::Index kept = values_.size();
  while (kept > 1 && values_(kept - 1) <= 1e-13 * values_(0)) {
    --kept;
  }
  values_.conservativeResize(kept);
  vectors_.conservativeResize(Eigen::NoChange, kept);
}

void CurvatureModes::Decompose() {
  const Eigen::Index size = basis_.rows();
  // A small shift keeps the factor of the sketch definite.
  const double shift = std::sqrt(double(size)) *
                       std::numeric_limits<double>::epsilon() *
                       products_.norm();
  Eigen::MatrixXd sketch = ProductOfTransposed(basis_, products_);
  sketch = (sketch + sketch.transpose()).eval() / 2;
  sketch.diagonal().array() += shift;
  const SymmetricEigenDecomposition of_sketch = DecomposeSymmetric(sketch);
  const Eigen::MatrixXd root =
      of_sketch.vectors *
      of_sketch.values.cwiseMax(shift).cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd columns = Product(products_ + shift * basis_, root);
  TakeModesOf(columns, shift);
}

Eigen::MatrixXd CurvatureModes::WithoutModes(
    const Eigen::MatrixXd& columns) const {
  return columns - Product(Vectors(), ProductOfTransposed(Vectors(), columns));
}

LanczosSums CurvatureModes::BesideModes(const ColumnOperator& multiply,
                                        const Eigen::MatrixXd& vectors) const {
  return {[&](const Eigen::MatrixXd& columns) {
            return WithoutModes(multiply(columns));
          },
          WithoutModes(vectors), kLanczosSteps};
}

void CurvatureModes::MeasureRest(const ColumnOperator& multiply) {
  const Eigen::Index size = basis_.rows();
  rest_.reset();
  num_accurate_ = HasWholeSpan() ? Size() : (Size() + 1) / 2;
  if (!HasWholeSpan()) {
    std::mt19937_64 generator(0);
    rest_ = BesideModes(
        multiply,
        StandardNormal(
            size, std::clamp(kProbeEntries / size, kLeastProbes, kMostProbes),
            generator));
  }
}

double CurvatureModes::LogDeterminant(double k) const {
  return (k * Values().array()).log1p().sum() +
         SumOverRest([k](double value) { return std::log1p(k * value); });
}

double CurvatureModes::EffectiveNumber(double k) const {
  return (k * Values().array() / (1 + k * Values().array())).sum() +
         SumOverRest([k](double value) { return k * value / (1 + k * value); });
}

Eigen::MatrixXd CurvatureModes::Solve(double k,
                                      const Eigen::MatrixXd& b) const {
  // (I / k + H)^-1 = k (I - U diag(k lambda / (1 + k lambda)) U^T).
  const Eigen::VectorXd share = k * values_.array() / (1 + k * values_.array());
  return k * (b - Product(vectors_, share.asDiagonal() *
                                        ProductOfTransposed(vectors_, b)));
}

Eigen::MatrixXd CurvatureModes::SolveFor(
    double k, const ColumnOperator& multiply, const Eigen::MatrixXd& b,
    const ConjugateGradientOptions& options) const {
  return SolveByConjugateGradients(
             [&](const Eigen::MatrixXd& columns) {
               return Eigen::MatrixXd(columns / k + multiply(columns));
             },
             [&](const Eigen::MatrixXd& columns) { return Solve(k, columns); },
             b, {}, options)
      .solution;
}

}  // namespace elastimate
