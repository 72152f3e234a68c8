#include "elastimate/core/large_strain/corotated_law.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/large_strain/corotated_law.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/large_strain/point_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

// F = R (I + v).
struct Polar {
  Matrix3 rotation;
  Matrix3 v;
};

HWY_INLINE Matrix3 RotationOf(const Matrix3& f) {
  // The error after a step is at most the square of the change that it makes.
  constexpr double kSmallChange = 1e-9;
  constexpr int kMostSteps = 40;
  Matrix3 rotation = f;
  for (int step = 0; step < kMostSteps; ++step) {
    const Matrix3 cofactors = Cofactors(rotation);
    const Number half_inverse =
        Number(0.5) / DeterminantOf(rotation, cofactors);
    Matrix3 next = half_inverse * cofactors;
    AddScaled(0.5, rotation, next);
    Matrix3 change = next;
    AddScaled(-1, rotation, change);
    rotation = next;
    if (hn::AllTrue(PointLanes(),
                    hn::Le(Inner(change, change).value,
                           Number(kSmallChange * kSmallChange).value))) {
      break;
    }
  }
  return rotation;
}

HWY_INLINE Polar PolarOf(const Matrix3& h) {
  Matrix3 f = h;
  AddToDiagonal(1, f);
  Polar polar;
  polar.rotation = RotationOf(f);
  Matrix3 sum = TransposedProduct(polar.rotation, f);  // U + I.
  AddToDiagonal(1, sum);
  const Matrix3 cofactors = Cofactors(sum);
  polar.v = Number(2) / DeterminantOf(sum, cofactors) *
            Product(GreenStrain(h), cofactors);
  return polar;
}

void SetCorotatedStresses(const PointMatrices& gradients, int count,
                          PointMatrices* columns) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Polar polar = PolarOf(LoadMatrix(gradients, p));
    StoreMatrix(Number(2) * Product(polar.rotation, polar.v), p, columns[0]);
    StoreMatrix(Trace(polar.v) * polar.rotation, p, columns[1]);
  }
}

// With dR = R [w] and K = tr(U) I - U,
//
//   w = K^-1 (T_1 : dF, T_2 : dF, T_3 : dF),   T_a = R [e_a],
//
// where [e] is the matrix of the cross product with e.
template <class Places>
HWY_INLINE void SetTangentsOfRotation(double mu, double lambda,
                                      const PointMatrices& gradients, int count,
                                      PointTangents& tangents,
                                      PointMatrices* stresses) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Polar polar = PolarOf(LoadMatrix(gradients, p));
    const Matrix3& r = polar.rotation;
    const Number stretch = Trace(polar.v);
    if (stresses != nullptr) {
      Matrix3 stress = Number(2 * mu) * Product(r, polar.v);
      AddScaled(Number(lambda) * stretch, r, stress);
      StoreMatrix(stress, p, *stresses);
    }
    Matrix3 k = Number(-1) * polar.v;
    AddToDiagonal(Number(2) + stretch, k);
    const Matrix3 cofactors = Cofactors(k);
    const Number weight = (Number(lambda) * stretch - Number(2 * mu)) /
                          DeterminantOf(k, cofactors);
    Matrix3 turned[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3;
      const int last = (axis + 2) % 3;
      for (int i = 0; i < 3; ++i) {
        turned[axis](i, axis) = Number(0);
        turned[axis](i, next) = r(i, last);
        turned[axis](i, last) = Number(0) - r(i, next);
      }
    }
    Tangent<Places> a;
    a.AddOuter(Number(lambda) * r, r);
    for (int axis = 0; axis < 3; ++axis) {
      Matrix3 turn = (weight * cofactors(axis, 0)) * turned[0];
      AddScaled(weight * cofactors(axis, 1), turned[1], turn);
      AddScaled(weight * cofactors(axis, 2), turned[2], turn);
      a.AddOuter(turned[axis], turn);
    }
    a.AddToDiagonal(Number(2 * mu));
    a.Store(p, tangents);
  }
}

void SetCorotatedTangents(double mu, double lambda,
                          const PointMatrices& gradients,
                          GradientEntries entries, int count,
                          PointTangents& tangents, PointMatrices* stresses) {
  WithPlaces(entries, [&](auto places) HWY_ATTR {
    SetTangentsOfRotation<decltype(places)>(mu, lambda, gradients, count,
                                            tangents, stresses);
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(SetCorotatedStresses);
HWY_EXPORT(SetCorotatedTangents);

}  // namespace

std::string_view CorotatedLaw::Description() const {
  return "large rotations: Hooke's law in the frame that turns with the "
         "material";
}

Eigen::VectorXd CorotatedLaw::Energies(const Eigen::MatrixXd& gradient,
                                       SectionModel model) const {
  // P_mu = 2 (F - R), |F - R| = |U - I|, and R : R = 3.
  const Eigen::MatrixXd stresses = Stresses(gradient, model);
  return Eigen::Vector2d(stresses.col(0).squaredNorm() / 4,
                         stresses.col(1).squaredNorm() / 6);
}

void CorotatedLaw::StressesAtPoints(const PointMatrices& gradients,
                                    GradientEntries /*entries*/, int count,
                                    PointMatrices* columns) const {
  HWY_DYNAMIC_DISPATCH(SetCorotatedStresses)(gradients, count, columns);
}

void CorotatedLaw::TangentsAtPoints(const Eigen::VectorXd& moduli,
                                    const PointMatrices& gradients,
                                    GradientEntries entries, int count,
                                    PointTangents& tangents,
                                    PointMatrices* stresses) const {
  HWY_DYNAMIC_DISPATCH(SetCorotatedTangents)
  (moduli(0), moduli(1), gradients, entries, count, tangents, stresses);
}

}  // namespace elastimate
#endif
