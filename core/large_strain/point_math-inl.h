// Numbers and 3 x 3 matrices at as many points as a vector register holds.
// Only sources that are compiled once for each kind of processor include this,
// after <hwy/highway.h>.

#if defined(ELASTIMATE_CORE_LARGE_STRAIN_POINT_MATH_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ELASTIMATE_CORE_LARGE_STRAIN_POINT_MATH_INL_H_
#undef ELASTIMATE_CORE_LARGE_STRAIN_POINT_MATH_INL_H_
#else
#define ELASTIMATE_CORE_LARGE_STRAIN_POINT_MATH_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <array>

#include "elastimate/core/large_strain/large_strain_law.h"

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using PointLanes = hn::CappedTag<double, 8>;

// A number at each of some points.
struct Number {
  hn::Vec<PointLanes> value;

  Number() = default;
  HWY_INLINE Number(hn::Vec<PointLanes> v) : value(v) {}  // NOLINT
  HWY_INLINE Number(double v)                             // NOLINT
      : value(hn::Set(PointLanes(), v)) {}
};

HWY_INLINE Number operator+(Number a, Number b) {
  return hn::Add(a.value, b.value);
}
HWY_INLINE Number operator-(Number a, Number b) {
  return hn::Sub(a.value, b.value);
}
HWY_INLINE Number operator*(Number a, Number b) {
  return hn::Mul(a.value, b.value);
}
HWY_INLINE Number operator/(Number a, Number b) {
  return hn::Div(a.value, b.value);
}
// Returns a b + c.
HWY_INLINE Number MulAdd(Number a, Number b, Number c) {
  return hn::MulAdd(a.value, b.value, c.value);
}
// Returns c - a b.
HWY_INLINE Number NegMulAdd(Number a, Number b, Number c) {
  return hn::NegMulAdd(a.value, b.value, c.value);
}
HWY_INLINE Number Dot3(Number a, Number b, Number c, Number d, Number e,
                       Number f) {
  return MulAdd(a, b, MulAdd(c, d, e * f));
}
HWY_INLINE Number LoadNumber(const double* from) {
  return hn::Load(PointLanes(), from);
}
HWY_INLINE void StoreNumber(Number a, double* to) {
  hn::Store(a.value, PointLanes(), to);
}
HWY_INLINE Number LogOnePlus(Number a) {
  return hn::Log1p(PointLanes(), a.value);
}
HWY_INLINE Number ExpMinusOne(Number a) {
  return hn::Expm1(PointLanes(), a.value);
}

// A matrix at each of some points, in the order of its columns.
struct Matrix3 {
  Number entry[9];

  HWY_INLINE Number& operator()(int i, int j) { return entry[i + 3 * j]; }
  HWY_INLINE const Number& operator()(int i, int j) const {
    return entry[i + 3 * j];
  }
};

template <class Values>
HWY_INLINE Matrix3 LoadMatrix(const Values& values, int point) {
  Matrix3 m;
  for (int i = 0; i < 9; ++i) {
    m.entry[i] = LoadNumber(values.row[i] + point);
  }
  return m;
}

template <class Values>
HWY_INLINE void StoreMatrix(const Matrix3& m, int point, Values& values) {
  for (int i = 0; i < 9; ++i) {
    StoreNumber(m.entry[i], values.row[i] + point);
  }
}

HWY_INLINE Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
  Matrix3 sum;
  for (int i = 0; i < 9; ++i) {
    sum.entry[i] = a.entry[i] + b.entry[i];
  }
  return sum;
}

HWY_INLINE Matrix3 operator*(Number a, const Matrix3& b) {
  Matrix3 scaled;
  for (int i = 0; i < 9; ++i) {
    scaled.entry[i] = a * b.entry[i];
  }
  return scaled;
}

// Adds a m to the sum.
HWY_INLINE void AddScaled(Number a, const Matrix3& m, Matrix3& sum) {
  for (int i = 0; i < 9; ++i) {
    sum.entry[i] = MulAdd(a, m.entry[i], sum.entry[i]);
  }
}

HWY_INLINE void AddToDiagonal(Number a, Matrix3& m) {
  for (int i = 0; i < 3; ++i) {
    m(i, i) = m(i, i) + a;
  }
}

HWY_INLINE Number Trace(const Matrix3& m) {
  return m(0, 0) + m(1, 1) + m(2, 2);
}

// Returns A : B.
HWY_INLINE Number Inner(const Matrix3& a, const Matrix3& b) {
  Number sum = a.entry[0] * b.entry[0];
  for (int i = 1; i < 9; ++i) {
    sum = MulAdd(a.entry[i], b.entry[i], sum);
  }
  return sum;
}

HWY_INLINE Matrix3 Product(const Matrix3& a, const Matrix3& b) {
  Matrix3 product;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      product(i, j) =
          Dot3(a(i, 0), b(0, j), a(i, 1), b(1, j), a(i, 2), b(2, j));
    }
  }
  return product;
}

// Returns A^T B.
HWY_INLINE Matrix3 TransposedProduct(const Matrix3& a, const Matrix3& b) {
  Matrix3 product;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      product(i, j) =
          Dot3(a(0, i), b(0, j), a(1, i), b(1, j), a(2, i), b(2, j));
    }
  }
  return product;
}

// Returns the cofactors of a matrix, det(M) M^-T.
HWY_INLINE Matrix3 Cofactors(const Matrix3& m) {
  Matrix3 cofactors;
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3;
    const int l = (j + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      const int p = (i + 1) % 3;
      const int q = (i + 2) % 3;
      cofactors(i, j) = NegMulAdd(m(p, l), m(q, k), m(p, k) * m(q, l));
    }
  }
  return cofactors;
}

HWY_INLINE Number DeterminantOf(const Matrix3& m, const Matrix3& cofactors) {
  return Dot3(m(0, 0), cofactors(0, 0), m(1, 0), cofactors(1, 0), m(2, 0),
              cofactors(2, 0));
}

// Returns Green's strain E = (H + H^T + H^T H) / 2.
HWY_INLINE Matrix3 GreenStrain(const Matrix3& h) {
  Matrix3 e;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i <= j; ++i) {
      const Number product =
          Dot3(h(0, i), h(0, j), h(1, i), h(1, j), h(2, i), h(2, j));
      e(i, j) = e(j, i) = Number(0.5) * (h(i, j) + h(j, i) + product);
    }
  }
  return e;
}

// The places of a matrix whose rows of a tangent are computed.
struct PlacesOfSolid {
  static constexpr std::array<int, 9> kPlaces = {0, 1, 2, 3, 4, 5, 6, 7, 8};
};
struct PlacesOfPlane {
  static constexpr std::array<int, 5> kPlaces = kPlacesOfPlane;
};
struct PlaceAcross {
  static constexpr std::array<int, 1> kPlaces = {kCrossPlace};
};

// Calls function(places) with the places of these entries.
template <class Function>
HWY_INLINE void WithPlaces(GradientEntries entries, const Function& function) {
  switch (entries) {
    case GradientEntries::kAll:
      return function(PlacesOfSolid());
    case GradientEntries::kOfPlane:
      return function(PlacesOfPlane());
    case GradientEntries::kAcross:
      return function(PlaceAcross());
  }
}

// A tangent at some points, of which the rows and columns at some places are
// computed.
template <class Places>
struct Tangent {
  static constexpr int kSize = int(Places::kPlaces.size());
  static constexpr int kNumEntries = kSize * (kSize + 1) / 2;

  HWY_INLINE Tangent() {
    for (Number& each : entry) {
      each = Number(0);
    }
  }
  // The n-th place against the m-th one, n >= m.
  HWY_INLINE Number& operator()(int n, int m) {
    return entry[TangentRow(n, m)];
  }

  // Adds the outer product of x and y.
  HWY_INLINE void AddOuter(const Matrix3& x, const Matrix3& y) {
    for (int n = 0; n < kSize; ++n) {
      for (int m = 0; m <= n; ++m) {
        (*this)(n, m) = MulAdd(x.entry[Places::kPlaces[n]],
                               y.entry[Places::kPlaces[m]], (*this)(n, m));
      }
    }
  }
  HWY_INLINE void AddToDiagonal(const Number& number) {
    for (int n = 0; n < kSize; ++n) {
      (*this)(n, n) = (*this)(n, n) + number;
    }
  }
  HWY_INLINE void Store(int point, PointTangents& tangents) const {
    for (int n = 0; n < kSize; ++n) {
      for (int m = 0; m <= n; ++m) {
        StoreNumber(
            entry[TangentRow(n, m)],
            tangents.row[TangentRow(Places::kPlaces[n], Places::kPlaces[m])] +
                point);
      }
    }
  }

  Number entry[kNumEntries];
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_POINT_MATH_INL_H_
