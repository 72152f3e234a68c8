#ifndef ELASTIMATE_CORE_LARGE_STRAIN_ISOCHORIC_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_ISOCHORIC_H_

#include "elastimate/core/large_strain/invariant_law.h"

namespace elastimate {

/// A = I1 J^(-2/3) - 3, which a change of volume alone leaves at zero, and its
/// derivatives by I1 and J; its second one by I1 is zero.
struct FirstIsochoric {
  double value;
  double a1;
  double aj;
  double rest;  ///< 2 A_1 + A_J.
  double a1j;
  double ajj;

  FirstIsochoric(const PointInvariants& at, int point)
      : value(at.a[point]), a1(1 / ((1 + at.q[point]) * (1 + at.q[point]))) {
    const double jacobian = 1 + at.j[point];
    const double i1 = 3 + 2 * at.t[point];
    a1j = -2 * a1 / (3 * jacobian);
    aj = a1j * i1;
    rest = -a1j * (3 * at.j[point] - 2 * at.t[point]);
    ajj = -5 * aj / (3 * jacobian);
  }
};

/// Sets W = (J - 1)^2 / 2, whose modulus is the bulk modulus.
inline void SetVolumeEnergy(const PointInvariants& at, int count,
                            PointDerivatives& w) {
  for (int p = 0; p < count; ++p) {
    w.energy[p] = at.j[p] * at.j[p] / 2;
    w.rest[p] = at.j[p];
    w.wjj[p] = 1;
  }
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_ISOCHORIC_H_
