#include "elastimate/estimators/maps/field_prior.h"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <cmath>
#include <utility>
#include <vector>

#include "elastimate/core/solvers/nested_dissection.h"

namespace elastimate {
namespace {

// The Robin coefficient of the surface is kappa over this number, which makes
// the variance of the field even.
constexpr double kRobin = 1.42;
constexpr double kPiOfPrior = 3.14159265358979323846;

// The variance of the Matern field of unit white noise.
double MaternVariance(double kappa, int dimension) {
  return dimension == 2 ? 1 / (4 * kPiOfPrior * kappa * kappa)
                        : 1 / (8 * kPiOfPrior * kappa);
}

}  // namespace

class FieldPrior::Factor {
 public:
  explicit Factor(Eigen::SparseMatrix<double> m) : matrix_(std::move(m)) {
    const Eigen::SparseMatrix<double> lower =
        matrix_.triangularView<Eigen::Lower>();
    const std::vector<std::int64_t> order = NestedDissection(
        {lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1},
        {lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros()});
    order_.resize(matrix_.rows());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order_.indices()(order[i]) = static_cast<int>(i);
    }
    inverse_.cholmod().nmethods = 1;
    inverse_.cholmod().method[0].ordering = CHOLMOD_NATURAL;
    inverse_.cholmod().postorder = 1;
    Eigen::SparseMatrix<double> permuted;
    permuted = matrix_.twistedBy(order_);
    inverse_.compute(permuted);
  }

  const Eigen::SparseMatrix<double>& Matrix() const { return matrix_; }

  // CHOLMOD prints an error where there are no columns.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& b) const {
    return b.cols() == 0 ? b
                         : order_.transpose() *
                               Eigen::MatrixXd(inverse_.solve(order_ * b));
  }

 private:
  Eigen::SparseMatrix<double> matrix_;
  Eigen::PermutationMatrix<Eigen::Dynamic> order_;  ///< From rows to places.
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> inverse_;
};

FieldPrior::FieldPrior(const Mesh& mesh, double relative_length)
    : dimension_(mesh.Dimension()),
      volumes_(ElementVolumes(mesh) / mesh.section.thickness),
      facets_(FacetsOfElements(mesh)) {
  const Eigen::Index n = mesh.NumElements();
  size_ = std::pow(volumes_.sum(), 1.0 / dimension_);
  const double kappa =
      std::sqrt(8 * (2 - dimension_ / 2.0)) / (relative_length * size_);
  scale_ = (volumes_ / MaternVariance(kappa, dimension_)).cwiseSqrt();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index e = 0; e < n; ++e) {
    entries.emplace_back(e, e, kappa * kappa * volumes_(e));
  }
  for (Eigen::Index i = 0; i < facets_.area.size(); ++i) {
    const int a = facets_.elements(0, i);
    const int b = facets_.elements(1, i);
    const double area = facets_.area(i) / mesh.section.thickness;
    if (b < 0) {
      entries.emplace_back(a, a, area * kappa / kRobin);
      continue;
    }
    const double coefficient =
        area / (ElementCentre(mesh, a) - ElementCentre(mesh, b)).norm();
    entries.emplace_back(a, a, coefficient);
    entries.emplace_back(b, b, coefficient);
    entries.emplace_back(a, b, -coefficient);
    entries.emplace_back(b, a, -coefficient);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_ = std::make_unique<Factor>(std::move(matrix));
}

FieldPrior::~FieldPrior() = default;

Eigen::MatrixXd FieldPrior::Apply(const Eigen::MatrixXd& y) const {
  return factor_->Solve(scale_.asDiagonal() * y);
}

Eigen::MatrixXd FieldPrior::ApplyTransposed(const Eigen::MatrixXd& x) const {
  return scale_.asDiagonal() * factor_->Solve(x);
}

Eigen::MatrixXd FieldPrior::ApplyInverse(const Eigen::MatrixXd& x) const {
  return scale_.cwiseInverse().asDiagonal() *
         Eigen::MatrixXd(factor_->Matrix() * x);
}

Eigen::MatrixXd FieldPrior::ApplyInverseTransposed(
    const Eigen::MatrixXd& y) const {
  return factor_->Matrix() * (scale_.cwiseInverse().asDiagonal() * y);
}

}  // namespace elastimate
