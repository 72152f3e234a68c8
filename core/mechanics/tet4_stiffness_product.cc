#include "elastimate/core/mechanics/tet4_stiffness_product.h"

#include <hwy/aligned_allocator.h>
#include <hwy/cache_control.h>
#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>

#include "elastimate/core/algebra/large_pages.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/mechanics/tet4_stiffness_product.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/mechanics/vector_lanes-inl.h"

#ifndef ELASTIMATE_CORE_NODE_RECORDS_
#define ELASTIMATE_CORE_NODE_RECORDS_
namespace elastimate {
namespace {

// Columns of the same 3 num_nodes rows.
struct Columns {
  const double* displacement;
  double* h;
  double* j;
  std::ptrdiff_t num_rows;
  std::ptrdiff_t num_columns;
};

struct NumberedMesh {
  const int* corners;   // 4 x num_elements.
  const double* nodes;  // 3 x num_nodes.
  const int* places;    // Null: node i has the rows 3 i and on.

  std::ptrdiff_t Row(std::ptrdiff_t node) const {
    return 3 * (places == nullptr ? node : places[node]);
  }
};

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Where the values of a node are in its record, counted in doubles: position,
// displacement, and the sums of a and of p.  Component i of column k of these
// three is kColumns i + k after their first.
struct OneColumn {
  // Each is a group of four, which is loaded whole.
  static constexpr std::ptrdiff_t kDisplacement = 4;
  static constexpr std::ptrdiff_t kA = 8;
  static constexpr std::ptrdiff_t kP = 12;
  static constexpr std::ptrdiff_t kSize = 16;
  static constexpr std::ptrdiff_t kColumns = 1;
};

struct SeveralColumns {
  static constexpr std::ptrdiff_t kDisplacement = kLanes < 4 ? 4 : kLanes;
  static constexpr std::ptrdiff_t kA = kDisplacement + 3 * kLanes;
  static constexpr std::ptrdiff_t kP = kA + 3 * kLanes;
  static constexpr std::ptrdiff_t kSize = kP + 3 * kLanes;
  static constexpr std::ptrdiff_t kColumns = kLanes;
};

struct Geometry {
  Vector c1, c2, c3;
  Values scale;
};

HWY_INLINE Geometry MakeGeometry(const Vector& e1, const Vector& e2,
                                 const Vector& e3) {
  const Lanes d;
  Geometry g;
  g.c1 = Cross(e2, e3);
  g.c2 = Cross(e3, e1);
  g.c3 = Cross(e1, e2);
  const Values determinant =
      MultiplyAdd3(e1.x, g.c1.x, e1.y, g.c1.y, e1.z, g.c1.z);
  g.scale = hn::Div(hn::Set(d, 1.0 / 6), hn::Abs(determinant));
  return g;
}

struct Stress {
  Values xx, yy, zz, xy, xz, yz, trace;

  HWY_INLINE Vector Traction(const Vector& c) const {
    return {MultiplyAdd3(xx, c.x, xy, c.y, xz, c.z),
            MultiplyAdd3(xy, c.x, yy, c.y, yz, c.z),
            MultiplyAdd3(xz, c.x, yz, c.y, zz, c.z)};
  }
};

// Returns S for the differences d_i = q_i - q_0.
HWY_INLINE Stress MakeStress(const Geometry& g, const Vector& d1,
                             const Vector& d2, const Vector& d3) {
  const auto sum =
      [&](Values a1, Values b1, Values a2, Values b2, Values a3, Values b3)
          HWY_ATTR { return MultiplyAdd3(a1, b1, a2, b2, a3, b3); };
  const auto sum_on = [&](Values a1, Values b1, Values a2, Values b2, Values a3,
                          Values b3, Values start) HWY_ATTR {
    return hn::MulAdd(a1, b1, hn::MulAdd(a2, b2, hn::MulAdd(a3, b3, start)));
  };
  const Values half = hn::Mul(hn::Set(Lanes(), 0.5), g.scale);
  const Vector& c1 = g.c1;
  const Vector& c2 = g.c2;
  const Vector& c3 = g.c3;
  Stress s;
  s.xx = hn::Mul(g.scale, sum(d1.x, c1.x, d2.x, c2.x, d3.x, c3.x));
  s.yy = hn::Mul(g.scale, sum(d1.y, c1.y, d2.y, c2.y, d3.y, c3.y));
  s.zz = hn::Mul(g.scale, sum(d1.z, c1.z, d2.z, c2.z, d3.z, c3.z));
  s.xy = hn::Mul(half, sum_on(d1.x, c1.y, d2.x, c2.y, d3.x, c3.y,
                              sum(d1.y, c1.x, d2.y, c2.x, d3.y, c3.x)));
  s.xz = hn::Mul(half, sum_on(d1.x, c1.z, d2.x, c2.z, d3.x, c3.z,
                              sum(d1.z, c1.x, d2.z, c2.x, d3.z, c3.x)));
  s.yz = hn::Mul(half, sum_on(d1.y, c1.z, d2.y, c2.z, d3.y, c3.z,
                              sum(d1.z, c1.y, d2.z, c2.y, d3.z, c3.y)));
  s.trace = hn::Add(hn::Add(s.xx, s.yy), s.zz);
  return s;
}

// The records of the corners of as many elements as there are lanes.  Lanes
// beyond the last element repeat it.
struct Corners {
  double* record[4][kLanes];

  // `origin` is where the record of node 0 would be, as an integer, since the
  // records may begin with a later node.
  HWY_INLINE Corners(const int* corners, std::uintptr_t origin,
                     std::ptrdiff_t record_size, std::ptrdiff_t count) {
    for (std::ptrdiff_t lane = 0; lane < kLanes; ++lane) {
      const int* const nodes = corners + 4 * std::min(lane, count - 1);
      for (int i = 0; i < 4; ++i) {
        record[i][lane] = reinterpret_cast<double*>(
            origin + std::uintptr_t(nodes[i]) * sizeof(double) *
                         std::uintptr_t(record_size));
      }
    }
  }
};

inline std::uintptr_t OriginOf(const double* records, std::ptrdiff_t first_node,
                               std::ptrdiff_t record_size) {
  return reinterpret_cast<std::uintptr_t>(records) -
         std::uintptr_t(first_node * record_size) * sizeof(double);
}

#if ELASTIMATE_HAS_BATCHES

// Returns the vectors at `offset` in the records of corner i minus those of
// corner 0, an element in each lane.
HWY_INLINE Vector Difference(const Corners& corners, int i,
                             std::ptrdiff_t offset) {
  const auto row = [&](std::size_t k) HWY_ATTR {
    return hn::Sub(LoadRow(corners.record[i], k, offset),
                   LoadRow(corners.record[0], k, offset));
  };
  const Rows components = Transpose({row(0), row(1), row(2), row(3)});
  return {components.row0, components.row1, components.row2};
}

// Adds the four values in `v1` to the values at `offset` in the record of
// corner 1, and so on, and subtracts the sum of all from those of corner 0.
template <class V>
HWY_INLINE void AddFours(const Corners& corners, std::size_t lane,
                         std::ptrdiff_t offset, V v1, V v2, V v3) {
  const hn::DFromV<V> d;
  double* const p0 = corners.record[0][lane] + offset;
  double* const p1 = corners.record[1][lane] + offset;
  double* const p2 = corners.record[2][lane] + offset;
  double* const p3 = corners.record[3][lane] + offset;
  hn::Store(hn::Sub(hn::Load(d, p0), hn::Add(hn::Add(v1, v2), v3)), d, p0);
  hn::Store(hn::Add(hn::Load(d, p1), v1), d, p1);
  hn::Store(hn::Add(hn::Load(d, p2), v2), d, p2);
  hn::Store(hn::Add(hn::Load(d, p3), v3), d, p3);
}

// Does what AddFours does for vectors with an element in each lane, for one
// element after the other, because they may share nodes.
HWY_INLINE void AddToCorners(const Corners& corners, std::ptrdiff_t offset,
                             const Vector& v1, const Vector& v2,
                             const Vector& v3) {
  const Values zero = hn::Zero(Lanes());
  const Rows r1 = Transpose({v1.x, v1.y, v1.z, zero});
  const Rows r2 = Transpose({v2.x, v2.y, v2.z, zero});
  const Rows r3 = Transpose({v3.x, v3.y, v3.z, zero});
#if HWY_CAP_GE512
  const hn::Half<Lanes> half;
  const auto low = [&](std::size_t lane, Values a, Values b,
                       Values c) HWY_ATTR {
    AddFours(corners, lane, offset, hn::LowerHalf(half, a),
             hn::LowerHalf(half, b), hn::LowerHalf(half, c));
  };
  const auto high = [&](std::size_t lane, Values a, Values b,
                        Values c) HWY_ATTR {
    AddFours(corners, lane, offset, hn::UpperHalf(half, a),
             hn::UpperHalf(half, b), hn::UpperHalf(half, c));
  };
  low(0, r1.row0, r2.row0, r3.row0);
  low(1, r1.row1, r2.row1, r3.row1);
  low(2, r1.row2, r2.row2, r3.row2);
  low(3, r1.row3, r2.row3, r3.row3);
  high(4, r1.row0, r2.row0, r3.row0);
  high(5, r1.row1, r2.row1, r3.row1);
  high(6, r1.row2, r2.row2, r3.row2);
  high(7, r1.row3, r2.row3, r3.row3);
#else
  AddFours(corners, 0, offset, r1.row0, r2.row0, r3.row0);
  AddFours(corners, 1, offset, r1.row1, r2.row1, r3.row1);
  AddFours(corners, 2, offset, r1.row2, r2.row2, r3.row2);
  AddFours(corners, 3, offset, r1.row3, r2.row3, r3.row3);
#endif
}

HWY_INLINE Geometry GeometryOf(const Corners& corners, std::ptrdiff_t count) {
  Geometry g =
      MakeGeometry(Difference(corners, 1, 0), Difference(corners, 2, 0),
                   Difference(corners, 3, 0));
  if (count < kLanes) {
    // Lanes that repeat an element add nothing.
    g.scale = hn::IfThenElseZero(hn::FirstN(Lanes(), count), g.scale);
  }
  return g;
}

// Adds a batch with an element in each lane.
HWY_INLINE void AddBatch(const Corners& corners, std::ptrdiff_t count,
                         OneColumn layout) {
  const Geometry g = GeometryOf(corners, count);
  const Stress s = MakeStress(g, Difference(corners, 1, layout.kDisplacement),
                              Difference(corners, 2, layout.kDisplacement),
                              Difference(corners, 3, layout.kDisplacement));
  AddToCorners(corners, layout.kA, s.Traction(g.c1), s.Traction(g.c2),
               s.Traction(g.c3));
  AddToCorners(corners, layout.kP, s.trace * g.c1, s.trace * g.c2,
               s.trace * g.c3);
}

// The geometry of a batch of elements, to be read one by one.
class GeometryOfEach {
 public:
  HWY_INLINE GeometryOfEach(const Corners& corners, std::ptrdiff_t count) {
    const Geometry g = GeometryOf(corners, count);
    const Lanes d;
    const Values values[10] = {g.c1.x, g.c1.y, g.c1.z, g.c2.x, g.c2.y,
                               g.c2.z, g.c3.x, g.c3.y, g.c3.z, g.scale};
    for (int i = 0; i < 10; ++i) {
      hn::Store(values[i], d, values_[i]);
    }
  }

  HWY_INLINE Geometry operator[](std::ptrdiff_t lane) const {
    const auto value = [&](int i) HWY_ATTR {
      return hn::Set(Lanes(), values_[i][lane]);
    };
    return {{value(0), value(1), value(2)},
            {value(3), value(4), value(5)},
            {value(6), value(7), value(8)},
            value(9)};
  }

 private:
  alignas(64) double values_[10][kLanes];
};

#else

HWY_INLINE Vector LoadVector(const double* p) {
  const Lanes d;
  return {hn::Load(d, p), hn::Load(d, p + 1), hn::Load(d, p + 2)};
}

class GeometryOfEach {
 public:
  HWY_INLINE GeometryOfEach(const Corners& corners, std::ptrdiff_t) {
    const Vector x0 = LoadVector(corners.record[0][0]);
    geometry_ = MakeGeometry(LoadVector(corners.record[1][0]) - x0,
                             LoadVector(corners.record[2][0]) - x0,
                             LoadVector(corners.record[3][0]) - x0);
  }

  HWY_INLINE const Geometry& operator[](std::ptrdiff_t) const {
    return geometry_;
  }

 private:
  Geometry geometry_;
};

#endif

HWY_INLINE Vector LoadColumns(const double* p) {
  const Lanes d;
  return {hn::Load(d, p), hn::Load(d, p + kLanes), hn::Load(d, p + 2 * kLanes)};
}

HWY_INLINE void StoreColumns(const Vector& v, double* p) {
  const Lanes d;
  hn::Store(v.x, d, p);
  hn::Store(v.y, d, p + kLanes);
  hn::Store(v.z, d, p + 2 * kLanes);
}

HWY_INLINE void AddColumns(const Vector& v1, const Vector& v2, const Vector& v3,
                           double* p0, double* p1, double* p2, double* p3) {
  StoreColumns(LoadColumns(p0) - (v1 + v2 + v3), p0);
  StoreColumns(LoadColumns(p1) + v1, p1);
  StoreColumns(LoadColumns(p2) + v2, p2);
  StoreColumns(LoadColumns(p3) + v3, p3);
}

// Adds one element after the other, with a column in each lane.
HWY_INLINE void AddBatch(const Corners& corners, std::ptrdiff_t count,
                         SeveralColumns layout) {
  const GeometryOfEach geometry(corners, count);
  for (std::ptrdiff_t lane = 0; lane < count; ++lane) {
    double* const node0 = corners.record[0][lane];
    double* const node1 = corners.record[1][lane];
    double* const node2 = corners.record[2][lane];
    double* const node3 = corners.record[3][lane];
    const Geometry g = geometry[lane];
    const Vector q0 = LoadColumns(node0 + layout.kDisplacement);
    const Stress s =
        MakeStress(g, LoadColumns(node1 + layout.kDisplacement) - q0,
                   LoadColumns(node2 + layout.kDisplacement) - q0,
                   LoadColumns(node3 + layout.kDisplacement) - q0);
    AddColumns(s.Traction(g.c1), s.Traction(g.c2), s.Traction(g.c3),
               node0 + layout.kA, node1 + layout.kA, node2 + layout.kA,
               node3 + layout.kA);
    AddColumns(s.trace * g.c1, s.trace * g.c2, s.trace * g.c3,
               node0 + layout.kP, node1 + layout.kP, node2 + layout.kP,
               node3 + layout.kP);
  }
}

// Asks for the values of a later node.  Nodes of a mesh that was numbered again
// are scattered over the columns; this keeps as many values on their way at a
// time as a processor can wait for.
template <class Layout>
HWY_INLINE void Prefetch(const NumberedMesh& mesh, const ElementBlock& block,
                         std::ptrdiff_t node, const double* values,
                         const Columns& columns) {
  constexpr std::ptrdiff_t kNodesAhead = Layout::kColumns == 1 ? 64 : 16;
  if (mesh.places == nullptr || node + kNodesAhead >= block.nodes.end) {
    return;
  }
  values += mesh.Row(node + kNodesAhead);
  for (std::ptrdiff_t k = 0; k < columns.num_columns;
       ++k, values += columns.num_rows) {
    hwy::Prefetch(values);
    hwy::Prefetch(values + 2);
  }
}

// Sets the values of a record to zero from the displacement on.  With
// std::fill_n this becomes a string instruction, which takes a third of a pass
// of several columns.
template <class Layout>
HWY_INLINE void ClearValues(double* record) {
  const hn::CappedTag<double, std::min<std::ptrdiff_t>(kLanes, 4)> d;
  for (std::ptrdiff_t i = Layout::kDisplacement; i < Layout::kSize;
       i += hn::Lanes(d)) {
    hn::Store(hn::Zero(d), d, record + i);
  }
}

// Sets the displacements of a record to those of a node, whose values in the
// first column begin at `q`.
template <class Layout>
HWY_INLINE void FillDisplacement(const double* q, const Columns&,
                                 double* record, Layout layout) {
  for (int i = 0; i < 3; ++i) {
    record[layout.kDisplacement + i] = q[i];
  }
}

// Sets the products at a node to a and b = p - 2 a of its record, or adds these
// to them.
template <bool kIsFirst, class Layout>
HWY_INLINE void CollectNode(const double* record, const Columns&, double* h,
                            double* j, Layout layout) {
  for (int i = 0; i < 3; ++i) {
    const double a = record[layout.kA + i];
    const double b = record[layout.kP + i] - 2 * a;
    h[i] = kIsFirst ? a : h[i] + a;
    j[i] = kIsFirst ? b : j[i] + b;
  }
}

#if ELASTIMATE_HAS_BATCHES

// Fills a column in each lane; lanes beyond the last column repeat it.
HWY_INLINE void FillDisplacement(const double* q, const Columns& columns,
                                 double* record, SeveralColumns layout) {
  StoreColumns(LoadThrees([&](std::ptrdiff_t k) {
                 return q +
                        std::min(k, columns.num_columns - 1) * columns.num_rows;
               }),
               record + layout.kDisplacement);
}

// The first four lanes of row k belong to column k, the next to column k + 4.
template <bool kIsFirst>
HWY_INLINE void CollectRows(const Rows& rows, const Columns& columns,
                            double* p) {
  const Values of[4] = {rows.row0, rows.row1, rows.row2, rows.row3};
  for (std::ptrdiff_t k = 0;
       k < std::min<std::ptrdiff_t>(columns.num_columns, 4); ++k) {
#if HWY_CAP_GE512
    const hn::Half<Lanes> half;
    CollectThree<kIsFirst>(hn::LowerHalf(half, of[k]),
                           p + k * columns.num_rows);
    if (k + 4 < columns.num_columns) {
      CollectThree<kIsFirst>(hn::UpperHalf(half, of[k]),
                             p + (k + 4) * columns.num_rows);
    }
#else
    CollectThree<kIsFirst>(of[k], p + k * columns.num_rows);
#endif
  }
}

template <bool kIsFirst>
HWY_INLINE void CollectNode(const double* record, const Columns& columns,
                            double* h, double* j, SeveralColumns layout) {
  const Values zero = hn::Zero(Lanes());
  const Values minus_two = hn::Set(Lanes(), -2.0);
  const Vector a = LoadColumns(record + layout.kA);
  const Vector p = LoadColumns(record + layout.kP);
  CollectRows<kIsFirst>(Transpose({a.x, a.y, a.z, zero}), columns, h);
  CollectRows<kIsFirst>(Transpose({hn::MulAdd(minus_two, a.x, p.x),
                                   hn::MulAdd(minus_two, a.y, p.y),
                                   hn::MulAdd(minus_two, a.z, p.z), zero}),
                        columns, j);
}

#endif

template <class Layout>
void FillRecords(const NumberedMesh& mesh, const Columns& columns,
                 const ElementBlock& block, double* records) {
  double* record = records;
  for (std::ptrdiff_t node = block.nodes.first; node < block.nodes.end;
       ++node, record += Layout::kSize) {
    Prefetch<Layout>(mesh, block, node, columns.displacement, columns);
    ClearValues<Layout>(record);
    for (int i = 0; i < 3; ++i) {
      record[i] = mesh.nodes[3 * node + i];
    }
    record[3] = 0;
    const std::ptrdiff_t row = mesh.Row(node);
    FillDisplacement(columns.displacement + row, columns, record, Layout());
  }
}

template <class Layout, bool kIsFirst>
void CollectSums(const NumberedMesh& mesh, const Columns& columns,
                 const ElementBlock& block, const double* records) {
  const double* record = records;
  for (std::ptrdiff_t node = block.nodes.first; node < block.nodes.end;
       ++node, record += Layout::kSize) {
    Prefetch<Layout>(mesh, block, node, columns.h, columns);
    Prefetch<Layout>(mesh, block, node, columns.j, columns);
    CollectNode<kIsFirst>(record, columns, columns.h + mesh.Row(node),
                          columns.j + mesh.Row(node), Layout());
  }
}

template <class Layout>
void MultiplyElements(const NumberedMesh& mesh, const Columns& columns,
                      const ElementBlock& block, bool is_first,
                      double* records) {
  FillRecords<Layout>(mesh, columns, block, records);
  const std::uintptr_t origin =
      OriginOf(records, block.nodes.first, Layout::kSize);
  const int* corners = mesh.corners + 4 * block.first;
  std::ptrdiff_t remaining = block.end - block.first;
  for (; remaining >= kLanes; remaining -= kLanes, corners += 4 * kLanes) {
    AddBatch(Corners(corners, origin, Layout::kSize, kLanes), kLanes, Layout());
  }
  if (remaining > 0) {
    AddBatch(Corners(corners, origin, Layout::kSize, remaining), remaining,
             Layout());
  }
  if (is_first) {
    CollectSums<Layout, true>(mesh, columns, block, records);
  } else {
    CollectSums<Layout, false>(mesh, columns, block, records);
  }
}

// Sets the products at the nodes of a block to what its elements contribute, or
// adds that where the block is not the first there.  `records` has room for
// RecordSize() doubles per node.
void MultiplyBlock(const NumberedMesh& mesh, const Columns& columns,
                   const ElementBlock& block, bool is_first, double* records) {
#if ELASTIMATE_HAS_BATCHES
  // Columns are worked on one after the other where most lanes would be idle.
  if (4 * columns.num_columns <= kLanes) {
    for (std::ptrdiff_t k = 0; k < columns.num_columns; ++k) {
      const std::ptrdiff_t first = k * columns.num_rows;
      MultiplyElements<OneColumn>(
          mesh,
          {columns.displacement + first, columns.h + first, columns.j + first,
           columns.num_rows, 1},
          block, is_first, records);
    }
    return;
  }
#endif
  MultiplyElements<SeveralColumns>(mesh, columns, block, is_first, records);
}

std::ptrdiff_t ColumnsAtATime() { return kLanes; }

std::ptrdiff_t RecordSize(std::ptrdiff_t num_columns) {
  return num_columns == 1 ? OneColumn::kSize
                          : std::max(OneColumn::kSize, SeveralColumns::kSize);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(MultiplyBlock);
HWY_EXPORT(ColumnsAtATime);
HWY_EXPORT(RecordSize);

void SetZero(const NumberedMesh& mesh, const std::vector<NodeRange>& nodes,
             const Columns& columns) {
  for (const NodeRange& range : nodes) {
    for (std::ptrdiff_t node = range.first; node < range.end; ++node) {
      for (std::ptrdiff_t k = 0; k < columns.num_columns; ++k) {
        const std::ptrdiff_t value = mesh.Row(node) + k * columns.num_rows;
        std::fill_n(columns.h + value, 3, 0.0);
        std::fill_n(columns.j + value, 3, 0.0);
      }
    }
  }
}

// The memory in which a thread works.
using Records = hwy::AlignedFreeUniquePtr<double[]>;

std::vector<Records> AllocateRecords(std::size_t num_values, int num_threads) {
  std::vector<Records> records(num_threads);
  for (Records& of_thread : records) {
    of_thread = hwy::AllocateAligned<double>(num_values);
    if (!of_thread) {
      throw std::bad_alloc();
    }
  }
  return records;
}

}  // namespace

void MultiplyLinearTetrahedra(const Mesh& mesh, const ElementBlocks& blocks,
                              const std::vector<int>& places,
                              const Eigen::MatrixXd& displacement,
                              int num_threads, StiffnessProducts& products) {
  const NumberedMesh numbered = {mesh.elements.data(), mesh.nodes.data(),
                                 places.empty() ? nullptr : places.data()};
  const std::ptrdiff_t num_blocks = std::ptrdiff_t(blocks.blocks.size());
  // A thread needs so many elements, because waiting for it may take longer
  // than a fraction of a millisecond of work.
  constexpr std::ptrdiff_t kElementsPerThread = 16384;
  const int threads = static_cast<int>(std::clamp<std::ptrdiff_t>(
      std::min(mesh.NumElements() / kElementsPerThread, (num_blocks + 1) / 2),
      1, num_threads));
  const std::vector<Records> records = AllocateRecords(
      blocks.most_nodes * HWY_DYNAMIC_DISPATCH(RecordSize)(displacement.cols()),
      threads);
  const auto multiply_block = HWY_DYNAMIC_DISPATCH(MultiplyBlock);
  const std::ptrdiff_t columns_at_a_time =
      HWY_DYNAMIC_DISPATCH(ColumnsAtATime)();
  const std::ptrdiff_t num_rows = displacement.rows();
  ResizeInLargePages(num_rows, displacement.cols(), products.h);
  ResizeInLargePages(num_rows, displacement.cols(), products.j);
  for (Eigen::Index first = 0; first < displacement.cols();
       first += columns_at_a_time) {
    const Columns columns = {
        displacement.data() + first * num_rows,
        products.h.data() + first * num_rows,
        products.j.data() + first * num_rows, num_rows,
        std::min(columns_at_a_time, displacement.cols() - first)};
    SetZero(numbered, blocks.gaps, columns);
    for (const std::ptrdiff_t parity : {0, 1}) {
#pragma omp parallel for num_threads(threads) schedule(static) if (threads > 1)
      for (std::ptrdiff_t i = parity; i < num_blocks; i += 2) {
        multiply_block(numbered, columns, blocks.blocks[i], parity == 0,
                       records[omp_get_thread_num()].get());
      }
    }
  }
}

}  // namespace elastimate
#endif
