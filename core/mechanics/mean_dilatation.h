#ifndef ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_
#define ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_

#include <Eigen/Core>

#include "elastimate/core/large_strain/large_strain_law.h"

namespace elastimate {

/// A number at some points.
using PointNumbers = PointValues<1>;

/// The points of some elements: those of the first element, then those of the
/// second, and so on, as many for each.
struct ElementPoints {
  PointNumbers volumes = {};  ///< v; zero behind the points.
  /// The polynomials that smooth the dilatation: 1, and further ones.
  PointValues<4> polynomials = {};
  int num_polynomials = 1;
  int dimension;  ///< In the plane, only F_33 = 1 and entries in the plane.
  int num_points;
  int per_element;
};

/// The smoothed dilatation of some elements (LargeStrainForces): Fbar = s F
/// with s = (Theta / J)^(1/3) at their points.  In each element, Theta is the
/// least-squares fit of J by some polynomials; the fit by the constant 1 alone
/// is the mean of J.
///
/// With the stress Pbar of a law at Fbar, an energy W(Fbar) has
///
///   dW = (s Pbar - pi / 3 F^-T) : dF + pi / (3 Theta) dTheta,
///   pi = s Pbar : F,
///
/// and dTheta is the fit of cof F : dF, so that the pressure p, the fit of
/// pi / (3 Theta), acts on cof F at each point.
///
/// All loops go over rows of points, so that compilers use vector instructions.
class MeanDilatation {
 public:
  /// Takes the gradients H = F - I at the points; zero behind the points.
  MeanDilatation(const ElementPoints& points, const PointMatrices& gradients);

  /// Returns Fbar - I.
  const PointMatrices& Gradients() const { return gradients_; }

  /// Replaces the stresses Pbar of the law by those that do work on dF.
  void ReplaceStresses(PointMatrices& stresses) const;

  /// The second derivative of the energy of an element, the sum over its points
  /// of
  ///
  ///   v (dF : local : dF + 2 coupling : dF dTheta + dilatation dTheta^2).
  struct Curvature {
    PointTangents local;
    PointMatrices coupling;
    PointNumbers dilatation;
  };
  /// Sets this second derivative, for Pbar and dPbar / dFbar.  In the plane,
  /// only the entries in the plane.
  void SetCurvature(const PointMatrices& stresses,
                    const PointTangents& tangents, Curvature& curvature) const;

  /// Returns orthonormal polynomials phi_a, with which dTheta = sum_a phi_a
  /// dTheta_a, and dTheta_a is the sum of v phi_a cof F : dF over the points of
  /// the element.
  const PointValues<4>& Polynomials() const { return points_.polynomials; }
  int NumPolynomials() const { return points_.num_polynomials; }
  /// Returns cof F.
  const PointMatrices& Cofactors() const { return cofactors_; }

 private:
  /// The entries of F that are not zero, and those in the plane of them.
  struct Entries {
    int size;
    int in_plane;
    int places[9];
  };
  static Entries EntriesOf(int dimension);
  void MakeOrthonormal();
  void SetDeformation(const PointMatrices& gradients);
  /// Returns pi at each point.
  PointNumbers Work(const PointMatrices& stresses) const;
  /// The tangent T of the law, applied to F.
  struct StretchedTangent {
    PointMatrices g;          ///< G = F^-T.
    PointMatrices pulled;     ///< s^2 T F + s Pbar.
    PointNumbers of_stretch;  ///< s^2 F : T F.
  };
  StretchedTangent Stretch(const PointMatrices& stresses,
                           const PointTangents& tangents) const;
  /// Returns the fit of these values in each element.
  PointNumbers Fit(const PointNumbers& values) const;
  /// Returns p at each point, for `work` pi.
  PointNumbers Pressures(const PointNumbers& work) const;

  ElementPoints points_;
  Entries entries_;
  PointNumbers theta_;       ///< Theta.
  PointNumbers jacobian_;    ///< J.
  PointNumbers scale_;       ///< s.
  PointMatrices f_;          ///< F.
  PointMatrices cofactors_;  ///< cof F.
  PointMatrices gradients_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_
