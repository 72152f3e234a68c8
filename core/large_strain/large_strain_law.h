#ifndef ELASTIMATE_CORE_LARGE_STRAIN_LARGE_STRAIN_LAW_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_LARGE_STRAIN_LAW_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// Numbers at some points, a row of `kPoints` for each of `kRows` entries, so
/// that the entries of neighbouring points fill vector registers.
template <int kRows>
struct PointValues {
  static constexpr int kPoints = 64;  ///< A multiple of all vector lengths.
  alignas(64) double row[kRows][kPoints];
};

/// 3 x 3 matrices at some points; entry (i, j) is in row i + 3 j.
using PointMatrices = PointValues<9>;

/// The 9 x 9 symmetric tangents dP / dH at some points; entry (a, b), a >= b,
/// is in row TangentRow(a, b).
using PointTangents = PointValues<45>;

constexpr int TangentRow(int a, int b) {
  return a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a;
}

/// Which entries of stresses and tangents at some points are asked for.
enum class GradientEntries {
  kAll,
  kOfPlane,  ///< Those of a mesh in the plane: kPlacesOfPlane.
  kAcross,   ///< That across a plate alone: kCrossPlace.
};

/// The places of H_11, H_21, H_12, H_22 and H_33 in a matrix of nine.
inline constexpr std::array<int, 5> kPlacesOfPlane = {0, 1, 3, 4, 8};
/// The place of H_33.
inline constexpr int kCrossPlace = 8;

/// A law for deformations of any size.  It is objective: for a rotation Q and
/// F = I + H,
///
///   P(Q F) = Q P(F),
///
/// so that P F^T is symmetric.  P is the first Piola-Kirchhoff stress, the
/// force per undeformed area.  Near rest it is the law of small strains of the
/// same parameters, and keeps its digits: the relative error of P stays near
/// that of double precision however small H is.
///
/// The gradient H is that of the solid, 3 x 3, in every section, since the
/// stretch across a plate depends on the moduli; CrossGradient finds it.  The
/// section therefore changes neither stresses nor moduli.
///
/// Numbers at points where det F <= 0 mean nothing.
class LargeStrainLaw : public Law {
 public:
  const LargeStrainLaw* ForLargeStrains() const override { return this; }
  bool Takes(SectionModel /*model*/) const override { return true; }

  Eigen::MatrixXd Stresses(const Eigen::MatrixXd& gradient,
                           SectionModel model) const override;
  Eigen::MatrixXd Tangent(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& gradient,
                          SectionModel model) const override;

  /// Sets columns[k] to P_k at the first `count` points, at most
  /// PointMatrices::kPoints; at least the entries that are asked for.  Unless
  /// these are all, H_13, H_23, H_31 and H_32 are zero.  The gradients of other
  /// points are finite.
  virtual void StressesAtPoints(const PointMatrices& gradients,
                                GradientEntries entries, int count,
                                PointMatrices* columns) const = 0;
  /// Sets `tangents` to dP / dH for these moduli at these points, with such
  /// entries, and `stresses`, unless it is null, to P = sum_k theta_k P_k.
  virtual void TangentsAtPoints(const Eigen::VectorXd& moduli,
                                const PointMatrices& gradients,
                                GradientEntries entries, int count,
                                PointTangents& tangents,
                                PointMatrices* stresses) const = 0;
};

/// Returns (mu, lambda) of the small strains that a law of large strains has at
/// rest; of transversely isotropic and other materials those along its axes 1
/// and 2.
[[nodiscard]] Eigen::Vector2d LameModuliAtRest(const Law& law,
                                               const Eigen::VectorXd& moduli);

/// Returns det F - 1 of F = I + H without forming F, so that it keeps its
/// digits near rest.
[[nodiscard]] double VolumeChange(const Eigen::Matrix3d& gradient);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_LARGE_STRAIN_LAW_H_
