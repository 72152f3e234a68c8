// Vectors of values of elements or of columns.  Only sources that are compiled
// once for each kind of processor include this, after <hwy/highway.h>.

#if defined(ELASTIMATE_CORE_MECHANICS_VECTOR_LANES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ELASTIMATE_CORE_MECHANICS_VECTOR_LANES_INL_H_
#undef ELASTIMATE_CORE_MECHANICS_VECTOR_LANES_INL_H_
#else
#define ELASTIMATE_CORE_MECHANICS_VECTOR_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#undef ELASTIMATE_HAS_BATCHES
// Fewer than four lanes are not worth the transposition.
#if HWY_CAP_GE256 && !HWY_HAVE_SCALABLE
#define ELASTIMATE_HAS_BATCHES 1
using Lanes = hn::CappedTag<double, 8>;
#else
#define ELASTIMATE_HAS_BATCHES 0
using Lanes = hn::CappedTag<double, 1>;
#endif

using Values = hn::Vec<Lanes>;
constexpr std::ptrdiff_t kLanes = hn::MaxLanes(Lanes());

struct Vector {
  Values x, y, z;
};

HWY_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Vector operator*(Values a, const Vector& b) {
  return {hn::Mul(a, b.x), hn::Mul(a, b.y), hn::Mul(a, b.z)};
}

HWY_INLINE Values MultiplyAdd3(Values a, Values b, Values c, Values d, Values e,
                               Values f) {
  return hn::MulAdd(a, b, hn::MulAdd(c, d, hn::Mul(e, f)));
}

HWY_INLINE Vector Cross(const Vector& a, const Vector& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)),
          hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

#if ELASTIMATE_HAS_BATCHES

// Each group of four lanes of the rows is a row of a 4 x 4 matrix.
struct Rows {
  Values row0, row1, row2, row3;
};

// LowerPairs returns the first two of each four lanes of `low`, then of `high`;
// UpperPairs returns the last two.
HWY_INLINE Values LowerPairs(Values high, Values low) {
#if HWY_CAP_GE512
  return hn::OddEvenBlocks(hn::SwapAdjacentBlocks(high), low);
#else
  return hn::ConcatLowerLower(Lanes(), high, low);
#endif
}

HWY_INLINE Values UpperPairs(Values high, Values low) {
#if HWY_CAP_GE512
  return hn::OddEvenBlocks(high, hn::SwapAdjacentBlocks(low));
#else
  return hn::ConcatUpperUpper(Lanes(), high, low);
#endif
}

HWY_INLINE Rows Transpose(const Rows& in) {
  const Lanes d;
  const Values low01 = hn::InterleaveLower(d, in.row0, in.row1);
  const Values high01 = hn::InterleaveUpper(d, in.row0, in.row1);
  const Values low23 = hn::InterleaveLower(d, in.row2, in.row3);
  const Values high23 = hn::InterleaveUpper(d, in.row2, in.row3);
  return {LowerPairs(low23, low01), LowerPairs(high23, high01),
          UpperPairs(low23, low01), UpperPairs(high23, high01)};
}

// Loads three values, and a fourth on which nothing depends.
template <class D>
HWY_INLINE hn::Vec<D> LoadThree(D d, const double* p) {
  const hn::Half<D> two;
  return hn::Combine(d, hn::Set(two, p[2]), hn::LoadU(two, p));
}

// Returns the three values at place(lane) for each lane.
template <class Place>
HWY_INLINE Vector LoadThrees(const Place& place) {
  const auto row = [&](int k) HWY_ATTR {
#if HWY_CAP_GE512
    const hn::Half<Lanes> half;
    return hn::Combine(Lanes(), LoadThree(half, place(k + 4)),
                       LoadThree(half, place(k)));
#else
    return LoadThree(Lanes(), place(k));
#endif
  };
  const Rows components = Transpose({row(0), row(1), row(2), row(3)});
  return {components.row0, components.row1, components.row2};
}

// Sets three values to the first three of `v`, or adds these.
template <bool kIsFirst, class V>
HWY_INLINE void CollectThree(V v, double* p) {
  const hn::Half<hn::DFromV<V>> two;
  const auto low = hn::LowerHalf(two, v);
  const double last = hn::GetLane(hn::UpperHalf(two, v));
  hn::StoreU(kIsFirst ? low : hn::Add(hn::LoadU(two, p), low), two, p);
  p[2] = kIsFirst ? last : p[2] + last;
}

// Returns the four values at `offset` in the records of the nodes in lane `row`
// and, in vectors of eight, in lane `row` + 4.
template <class Value>
HWY_INLINE Values LoadRow(Value* const (&records)[kLanes], std::size_t row,
                          std::ptrdiff_t offset) {
#if HWY_CAP_GE512
  const hn::Half<Lanes> half;
  return hn::Combine(Lanes(), hn::LoadU(half, records[row + 4] + offset),
                     hn::LoadU(half, records[row] + offset));
#else
  return hn::LoadU(Lanes(), records[row] + offset);
#endif
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#endif  // ELASTIMATE_CORE_MECHANICS_VECTOR_LANES_INL_H_
