#include "elastimate/estimators/maps/field_prior.h"

#include <cmath>
#include <vector>

#include "elastimate/estimators/maps/element_factor.h"

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
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  factor_ = std::make_unique<ElementFactor>(matrix_);
}

FieldPrior::~FieldPrior() = default;

Eigen::MatrixXd FieldPrior::Apply(const Eigen::MatrixXd& y) const {
  return factor_->Solve(scale_.asDiagonal() * y);
}

Eigen::MatrixXd FieldPrior::ApplyTransposed(const Eigen::MatrixXd& x) const {
  return scale_.asDiagonal() * factor_->Solve(x);
}

Eigen::MatrixXd FieldPrior::ApplyInverse(const Eigen::MatrixXd& x) const {
  return scale_.cwiseInverse().asDiagonal() * Eigen::MatrixXd(matrix_ * x);
}

Eigen::MatrixXd FieldPrior::ApplyInverseTransposed(
    const Eigen::MatrixXd& y) const {
  return matrix_ * (scale_.cwiseInverse().asDiagonal() * y);
}

}  // namespace elastimate
