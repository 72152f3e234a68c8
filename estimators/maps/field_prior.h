#ifndef ELASTIMATE_ESTIMATORS_MAPS_FIELD_PRIOR_H_
#define ELASTIMATE_ESTIMATORS_MAPS_FIELD_PRIOR_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

class ElementFactor;

/// What is believed of a field of one value per element before anything is
/// measured: it is smooth over a length rho, and deviates from its level by a
/// standard deviation tau,
///
///   x = A y,   y ~ N(0, tau^2 I),   A = M^-1 diag(V_e / v)^(1/2),
///   M = kappa^2 diag(V_e) + T,   kappa = (8 (2 - d / 2))^(1/2) / rho.
///
/// T is the two-point Laplacian of the elements: a facet of the area a between
/// elements whose centres are h apart has the coefficient a / h, and a facet of
/// the surface kappa a / 1.42 (a Robin condition, without which the field would
/// be stiff or loose at the surface).  V_e are volumes without the thickness of
/// a section.  v is the variance of the Matern field in unbounded space, so
/// that x_e has about the variance tau^2 in every element [Lindgren, Rue &
/// Lindstroem, J. R. Stat. Soc. B 73 (2011) 423; Roininen, Huttunen & Lasanen,
/// Inverse Probl. Imaging 8 (2014) 561].  rho is relative to the size of the
/// body, which is the d-th root of its volume.
class FieldPrior {
 public:
  /// The length of a body with inclusions, and of one with a gradient, in which
  /// ln E changes from one end to the other.
  static constexpr double kInclusions = 0.4;
  static constexpr double kGradient = 2;

  /// Precondition: a valid mesh.  A sparse factorisation of the size
  /// num_elements.
  explicit FieldPrior(const Mesh& mesh, double relative_length = kInclusions);
  ~FieldPrior();

  Eigen::Index NumElements() const { return scale_.size(); }
  int Dimension() const { return dimension_; }
  /// Returns the size of the body [length].
  double Size() const { return size_; }
  /// Returns the volume of each element, without the thickness of a section
  /// [length^d].
  const Eigen::VectorXd& Volumes() const { return volumes_; }
  const ElementFacets& Facets() const { return facets_; }

  // All functions below take and return num_elements x n; Apply and
  // ApplyTransposed solve with M.

  /// Returns A Y.
  Eigen::MatrixXd Apply(const Eigen::MatrixXd& y) const;
  /// Returns A^T X.
  Eigen::MatrixXd ApplyTransposed(const Eigen::MatrixXd& x) const;
  /// Returns A^-1 X.
  Eigen::MatrixXd ApplyInverse(const Eigen::MatrixXd& x) const;
  /// Returns A^-T Y.
  Eigen::MatrixXd ApplyInverseTransposed(const Eigen::MatrixXd& y) const;

 private:
  int dimension_;
  double size_;
  Eigen::VectorXd volumes_;
  ElementFacets facets_;
  Eigen::VectorXd scale_;               ///< (V_e / v)^(1/2).
  Eigen::SparseMatrix<double> matrix_;  ///< M.
  std::unique_ptr<ElementFactor> factor_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_FIELD_PRIOR_H_
