#include "elastimate/core/large_strain/invariant_law.h"

#include <vector>

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/large_strain/invariant_law.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/large_strain/point_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

void SetInvariants(const PointMatrices& gradients, int count,
                   PointInvariants& at) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 h = LoadMatrix(gradients, p);
    const Matrix3 e = GreenStrain(h);
    const Number t = Trace(e);
    const Number s = t * t - Inner(e, e);
    const Number trace = Trace(h);
    // The second invariant of H, and its determinant.
    Number second = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0);
    second = second + h(0, 0) * h(2, 2) - h(0, 2) * h(2, 0);
    second = second + h(1, 1) * h(2, 2) - h(1, 2) * h(2, 1);
    const Number third = DeterminantOf(h, Cofactors(h));
    const Number j = trace + second + third;
    const Number log_j = LogOnePlus(j);
    const Number q = ExpMinusOne(Number(1.0 / 3) * log_j);
    // With 3 q + 3 q^2 + q^3 = j, the terms of first order of
    // I1 - 3 J^(2/3) = 2 t - 6 q - 3 q^2 cancel:
    //   2 t - 6 q = c,  c = H : H - 2 (j - tr H) + 6 q^2 + 2 q^3.
    const Number q2 = q * q;
    const Number c = Inner(h, h) - Number(2) * (second + third) +
                     q2 * (Number(6) + Number(2) * q);
    const Number u = Number(1) / (Number(1) + q);
    const Number u2 = u * u;
    const Number b = Number(2) * (c + s) -
                     q2 * (Number(18) + q * (Number(12) + Number(3) * q));
    StoreNumber(t, at.t + p);
    StoreNumber(s, at.s + p);
    StoreNumber(j, at.j + p);
    StoreNumber(log_j, at.log_j + p);
    StoreNumber(q, at.q + p);
    StoreNumber(u2 * (c - Number(3) * q2), at.a + p);
    StoreNumber(u2 * u2 * b, at.b + p);
  }
}

template <class Places>
HWY_INLINE void SetStressesAt(const PointMatrices& gradients, int count,
                              const PointDerivatives* of_moduli, int num_moduli,
                              PointMatrices* columns) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 h = LoadMatrix(gradients, p);
    const Matrix3 e = GreenStrain(h);
    const Number t = Trace(e);
    const Number trace = Trace(h);
    Matrix3 f = h;
    AddToDiagonal(1, f);
    // d = H + t F - F E,  g = cof F - I.
    Matrix3 d = h;
    AddScaled(t, f, d);
    AddScaled(-1, Product(f, e), d);
    Matrix3 g = Cofactors(h);
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        g(i, j) = g(i, j) - h(j, i);
      }
    }
    AddToDiagonal(trace, g);
    for (int k = 0; k < num_moduli; ++k) {
      const PointDerivatives& w = of_moduli[k];
      const Number w1 = Number(2) * LoadNumber(w.w1 + p);
      const Number w2 = Number(4) * LoadNumber(w.w2 + p);
      const Number rest = LoadNumber(w.rest + p);
      for (const int place : Places::kPlaces) {
        Number stress = w1 * h.entry[place];
        stress = MulAdd(w2, d.entry[place], stress);
        stress = MulAdd(rest - w1 - w2, g.entry[place], stress);
        if (place % 4 == 0) {
          stress = stress + rest;
        }
        StoreNumber(stress, columns[k].row[place] + p);
      }
    }
  }
}

void SetStresses(const PointMatrices& gradients, GradientEntries entries,
                 int count, const PointDerivatives* of_moduli, int num_moduli,
                 PointMatrices* columns) {
  WithPlaces(entries, [&](auto places) HWY_ATTR {
    SetStressesAt<decltype(places)>(gradients, count, of_moduli, num_moduli,
                                    columns);
  });
}

// Adds w times the derivative of cof F: a permutation of the entries of F.
template <class Places>
HWY_INLINE void AddCofactorSlope(Number w, const Matrix3& f,
                                 Tangent<Places>& a) {
  const Matrix3 wf = w * f;
  for (int n = 0; n < Tangent<Places>::kSize; ++n) {
    const int i = Places::kPlaces[n] % 3;
    const int j = Places::kPlaces[n] / 3;
    // d cof(i, j) / d F(k, l) is F(m, n) for k != i and l != j, with the sign
    // of both permutations.
    for (int m = 0; m <= n; ++m) {
      const int k = Places::kPlaces[m] % 3;
      const int l = Places::kPlaces[m] / 3;
      if (k == i || l == j) {
        continue;
      }
      const Number& entry = wf(3 - i - k, 3 - j - l);
      const bool is_even = ((k - i + 3) % 3 == 1) == ((l - j + 3) % 3 == 1);
      a(n, m) = is_even ? a(n, m) + entry : a(n, m) - entry;
    }
  }
}

// Adds w times the derivative of 2 (I1 F - F C), but for its part
// 4 w F (x) F, which belongs to the products of first derivatives.
template <class Places>
HWY_INLINE void AddSecondSlope(Number w, const Matrix3& f, Number i1,
                               Tangent<Places>& a) {
  Matrix3 c = TransposedProduct(f, f);
  const Number twice = Number(2) * w;
  for (int n = 0; n < Tangent<Places>::kSize; ++n) {
    const int i = Places::kPlaces[n] % 3;
    const int j = Places::kPlaces[n] / 3;
    for (int m = 0; m <= n; ++m) {
      const int k = Places::kPlaces[m] % 3;
      const int l = Places::kPlaces[m] / 3;
      Number sum = f(i, l) * f(k, j);
      if (i == k) {
        sum = sum + c(l, j);
      }
      if (j == l) {
        sum = sum + Dot3(f(i, 0), f(k, 0), f(i, 1), f(k, 1), f(i, 2), f(k, 2));
      }
      if (n == m) {
        sum = sum - i1;
      }
      a(n, m) = NegMulAdd(twice, sum, a(n, m));
    }
  }
}

template <class Places>
HWY_INLINE void SetTangentsAt(const PointMatrices& gradients, int count,
                              const PointDerivatives& w, bool has_second,
                              PointTangents& tangents) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const auto load = [p](const PointDerivatives::Row& row)
                          HWY_ATTR { return LoadNumber(row + p); };
    Matrix3 f = LoadMatrix(gradients, p);
    AddToDiagonal(1, f);
    const Matrix3 cofactors = Cofactors(f);
    const Number w1 = load(w.w1);
    const Number w2 = load(w.w2);
    const Number wj = load(w.rest) - Number(2) * w1 - Number(4) * w2;
    Tangent<Places> a;
    // The products of first derivatives of I1 and J, 2 F and cof F.
    Matrix3 of_f = Number(4) * (load(w.w11) + w2) * f;
    AddScaled(Number(2) * load(w.w1j), cofactors, of_f);
    a.AddOuter(of_f, f);
    Matrix3 of_cofactors = Number(2) * load(w.w1j) * f;
    AddScaled(load(w.wjj), cofactors, of_cofactors);
    if (has_second) {
      // d I2 / dF = 2 (I1 F - F C).
      const Number i1 = Inner(f, f);
      Matrix3 x2 = Product(f, TransposedProduct(f, f));
      for (int i = 0; i < 9; ++i) {
        x2.entry[i] = Number(2) * (i1 * f.entry[i] - x2.entry[i]);
      }
      Matrix3 of_x2 = load(w.w22) * x2;
      AddScaled(load(w.w2j), cofactors, of_x2);
      a.AddOuter(of_x2, x2);
      AddScaled(load(w.w2j), x2, of_cofactors);
      AddSecondSlope(w2, f, i1, a);
    }
    a.AddOuter(of_cofactors, cofactors);
    AddCofactorSlope(wj, f, a);
    a.AddToDiagonal(Number(2) * w1);
    a.Store(p, tangents);
  }
}

void SetTangents(const PointMatrices& gradients, GradientEntries entries,
                 int count, const PointDerivatives& w, bool has_second,
                 PointTangents& tangents) {
  WithPlaces(entries, [&](auto places) HWY_ATTR {
    SetTangentsAt<decltype(places)>(gradients, count, w, has_second, tangents);
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(SetInvariants);
HWY_EXPORT(SetStresses);
HWY_EXPORT(SetTangents);

// Returns the derivatives of all W_k.
std::vector<PointDerivatives> DerivativesOf(const InvariantLaw& law,
                                            const PointMatrices& gradients,
                                            int count) {
  PointInvariants at;
  HWY_DYNAMIC_DISPATCH(SetInvariants)(gradients, count, at);
  std::vector<PointDerivatives> of_moduli(law.NumModuli());
  law.DerivativesAtPoints(at, count, of_moduli.data());
  return of_moduli;
}

}  // namespace

Eigen::VectorXd InvariantLaw::Energies(const Eigen::MatrixXd& gradient,
                                       SectionModel /*model*/) const {
  PointMatrices at = {};
  for (int i = 0; i < 9; ++i) {
    at.row[i][0] = gradient(i);
  }
  Eigen::VectorXd energies(NumModuli());
  const std::vector<PointDerivatives> of_moduli = DerivativesOf(*this, at, 1);
  for (int k = 0; k < NumModuli(); ++k) {
    energies(k) = of_moduli[k].energy[0];
  }
  return energies;
}

void InvariantLaw::StressesAtPoints(const PointMatrices& gradients,
                                    GradientEntries entries, int count,
                                    PointMatrices* columns) const {
  const std::vector<PointDerivatives> of_moduli =
      DerivativesOf(*this, gradients, count);
  HWY_DYNAMIC_DISPATCH(SetStresses)
  (gradients, entries, count, of_moduli.data(), NumModuli(), columns);
}

void InvariantLaw::TangentsAtPoints(const Eigen::VectorXd& moduli,
                                    const PointMatrices& gradients,
                                    GradientEntries entries, int count,
                                    PointTangents& tangents,
                                    PointMatrices* stresses) const {
  const std::vector<PointDerivatives> of_moduli =
      DerivativesOf(*this, gradients, count);
  // W = sum_k theta_k W_k; its derivatives are sums as well.
  constexpr Eigen::Index kSize =
      Eigen::Index(sizeof(PointDerivatives) / sizeof(double));
  using Values = Eigen::Array<double, kSize, 1>;
  PointDerivatives sum = {};
  Eigen::Map<Values> values(sum.energy);
  for (int k = 0; k < NumModuli(); ++k) {
    values += moduli(k) * Eigen::Map<const Values>(of_moduli[k].energy);
  }
  const bool has_second =
      Eigen::Map<const Eigen::ArrayXd>(sum.w2, count).any() ||
      Eigen::Map<const Eigen::ArrayXd>(sum.w22, count).any();
  HWY_DYNAMIC_DISPATCH(SetTangents)
  (gradients, entries, count, sum, has_second, tangents);
  if (stresses != nullptr) {
    HWY_DYNAMIC_DISPATCH(SetStresses)
    (gradients, entries, count, &sum, 1, stresses);
  }
}

}  // namespace elastimate
#endif
