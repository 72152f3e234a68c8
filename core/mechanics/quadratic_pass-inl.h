// Records of the nodes of as many quadratic elements as there are lanes.  Only
// sources that are compiled once for each kind of processor include this, after
// <hwy/highway.h>.

#if defined(ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_INL_H_
#undef ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_INL_H_
#else
#define ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "elastimate/core/mechanics/quadratic_pass.h"
#include "elastimate/core/mechanics/vector_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {

// The records, of this size, of the first nodes of as many elements as there
// are lanes.  Lanes beyond the last element repeat it.  The first record is
// that of `first_node`.
template <int kNodes, int kNodesOfElement, class Value>
struct NodeRecords {
  static_assert(kLanes <= kMostLanes);
  Value* record[kNodes][kLanes];

  HWY_INLINE NodeRecords(const int* elements, std::ptrdiff_t count,
                         Value* records, std::ptrdiff_t first_node,
                         std::ptrdiff_t size) {
    for (std::ptrdiff_t lane = 0; lane < kLanes; ++lane) {
      const int* const nodes =
          elements + kNodesOfElement * std::min(lane, count - 1);
      for (int i = 0; i < kNodes; ++i) {
        record[i][lane] = records + size * (nodes[i] - first_node);
      }
    }
  }
};

#if ELASTIMATE_HAS_BATCHES

// Returns the first three values of the record of each lane.
template <class Value>
HWY_INLINE Vector LoadVector(Value* const (&records)[kLanes]) {
  const Rows components =
      Transpose({LoadRow(records, 0, 0), LoadRow(records, 1, 0),
                 LoadRow(records, 2, 0), LoadRow(records, 3, 0)});
  return {components.row0, components.row1, components.row2};
}

template <class V>
HWY_INLINE void AddFour(V v, double* p) {
  const hn::DFromV<V> d;
  hn::Store(hn::Add(hn::Load(d, p), v), d, p);
}

// Adds for one element after the other, because they may share nodes.
HWY_INLINE void AddToNode(const Vector& v, double* const (&records)[kLanes],
                          std::ptrdiff_t offset) {
  const Rows rows = Transpose({v.x, v.y, v.z, hn::Zero(Lanes())});
#if HWY_CAP_GE512
  const hn::Half<Lanes> half;
  AddFour(hn::LowerHalf(half, rows.row0), records[0] + offset);
  AddFour(hn::LowerHalf(half, rows.row1), records[1] + offset);
  AddFour(hn::LowerHalf(half, rows.row2), records[2] + offset);
  AddFour(hn::LowerHalf(half, rows.row3), records[3] + offset);
  AddFour(hn::UpperHalf(half, rows.row0), records[4] + offset);
  AddFour(hn::UpperHalf(half, rows.row1), records[5] + offset);
  AddFour(hn::UpperHalf(half, rows.row2), records[6] + offset);
  AddFour(hn::UpperHalf(half, rows.row3), records[7] + offset);
#else
  AddFour(rows.row0, records[0] + offset);
  AddFour(rows.row1, records[1] + offset);
  AddFour(rows.row2, records[2] + offset);
  AddFour(rows.row3, records[3] + offset);
#endif
}

#else

HWY_INLINE Vector LoadVectorAt(const double* p) {
  const Lanes d;
  return {hn::Load(d, p), hn::Load(d, p + 1), hn::Load(d, p + 2)};
}

template <class Value>
HWY_INLINE Vector LoadVector(Value* const (&records)[kLanes]) {
  return LoadVectorAt(records[0]);
}

HWY_INLINE void AddToNode(const Vector& v, double* const (&records)[kLanes],
                          std::ptrdiff_t offset) {
  const Lanes d;
  double* const p = records[0] + offset;
  const Vector sum = LoadVectorAt(p) + v;
  hn::Store(sum.x, d, p);
  hn::Store(sum.y, d, p + 1);
  hn::Store(sum.z, d, p + 2);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#endif  // ELASTIMATE_CORE_MECHANICS_QUADRATIC_PASS_INL_H_
