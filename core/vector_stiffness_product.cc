#include "elastimate/core/vector_stiffness_product.h"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/vector_stiffness_product.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <hwy/highway.h>

#ifndef ELASTIMATE_CORE_MESH_COLUMNS_
#define ELASTIMATE_CORE_MESH_COLUMNS_
namespace elastimate {
namespace {

// Linear tetrahedra and some displacement columns.
struct MeshColumns {
  const int* corners;  // Four for each element.
  std::ptrdiff_t num_elements;
  const double* nodes;         // 3 x num_nodes.
  const double* displacement;  // (3 num_nodes) x num_columns.
  std::ptrdiff_t num_rows;
  std::ptrdiff_t num_columns;
};

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_CAP_GE256 && !HWY_HAVE_SCALABLE

using Lanes = hn::CappedTag<double, 8>;
using Values = hn::Vec<Lanes>;
constexpr std::size_t kLanes = hn::MaxLanes(Lanes());

struct Vector {
  Values x, y, z;
};

HWY_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Values MultiplyAdd2(Values a, Values b, Values c, Values d) {
  return hn::MulAdd(a, b, hn::Mul(c, d));
}

HWY_INLINE Values MultiplyAdd3(Values a, Values b, Values c, Values d, Values e,
                               Values f) {
  return hn::MulAdd(a, b, MultiplyAdd2(c, d, e, f));
}

HWY_INLINE Vector Cross(const Vector& a, const Vector& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)),
          hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

struct Rows {
  Values row0, row1, row2, row3;
};

// Each group of four lanes of the rows is a row of a 4 x 4 matrix.
HWY_INLINE Rows Transpose(const Rows& in) {
  const Lanes d;
  const Values low01 = hn::InterleaveLower(d, in.row0, in.row1);
  const Values high01 = hn::InterleaveUpper(d, in.row0, in.row1);
  const Values low23 = hn::InterleaveLower(d, in.row2, in.row3);
  const Values high23 = hn::InterleaveUpper(d, in.row2, in.row3);
  return {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(low23), low01),
          hn::OddEvenBlocks(hn::SwapAdjacentBlocks(high23), high01),
          hn::OddEvenBlocks(low23, hn::SwapAdjacentBlocks(low01)),
          hn::OddEvenBlocks(high23, hn::SwapAdjacentBlocks(high01))};
}

// The three numbers at `p` and, in vectors of eight, those at `q`.
HWY_INLINE Values LoadThrees(const double* p, const double* q) {
#if HWY_CAP_GE512
  const hn::Half<Lanes> half;
  const auto three = hn::FirstN(half, 3);
  return hn::Combine(Lanes(), hn::MaskedLoad(three, half, q),
                     hn::MaskedLoad(three, half, p));
#else
  (void)q;
  const Lanes d;
  return hn::MaskedLoad(hn::FirstN(d, 3), d, p);
#endif
}

HWY_INLINE void AddFours(Values values, double* p, double* q) {
#if HWY_CAP_GE512
  const hn::Half<Lanes> half;
  hn::Store(hn::Add(hn::Load(half, p), hn::LowerHalf(half, values)), half, p);
  hn::Store(hn::Add(hn::Load(half, q), hn::UpperHalf(half, values)), half, q);
#else
  (void)q;
  const Lanes d;
  hn::Store(hn::Add(hn::Load(d, p), values), d, p);
#endif
}

// One corner of a batch of elements: where its nodes are.
struct Corner {
  std::ptrdiff_t node[kLanes];

  Corner(const int* corners, int corner) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      node[lane] = corners[4 * lane + corner];
    }
  }

  std::ptrdiff_t Second(std::size_t lane) const {
    return node[(lane + 4) % kLanes];
  }

  HWY_INLINE Vector Gather(const double* values) const {
    const auto row = [&](std::size_t lane) HWY_ATTR {
      return LoadThrees(values + 3 * node[lane], values + 3 * Second(lane));
    };
    const Rows columns = Transpose({row(0), row(1), row(2), row(3)});
    return {columns.row0, columns.row1, columns.row2};
  }

  // Elements may share nodes, so that one is added after the other.
  HWY_INLINE void Scatter(const Vector& v, double* first,
                          std::ptrdiff_t stride) const {
    const Rows rows = Transpose({v.x, v.y, v.z, hn::Zero(Lanes())});
    const auto add = [&](Values values, std::size_t lane) HWY_ATTR {
      AddFours(values, first + stride * node[lane],
               first + stride * Second(lane));
    };
    add(rows.row0, 0);
    add(rows.row1, 1);
    add(rows.row2, 2);
    add(rows.row3, 3);
  }
};

void AddBatch(const MeshColumns& mesh, const int* corners, double* sums) {
  const Lanes d;
  const std::ptrdiff_t sum_stride = 8 * mesh.num_columns;
  const Corner corner0(corners, 0);
  const Corner corner1(corners, 1);
  const Corner corner2(corners, 2);
  const Corner corner3(corners, 3);

  // As AddColumn in stiffness_product.cc.
  const Vector x0 = corner0.Gather(mesh.nodes);
  const Vector e1 = corner1.Gather(mesh.nodes) - x0;
  const Vector e2 = corner2.Gather(mesh.nodes) - x0;
  const Vector e3 = corner3.Gather(mesh.nodes) - x0;
  const Vector c1 = Cross(e2, e3);
  const Vector c2 = Cross(e3, e1);
  const Vector c3 = Cross(e1, e2);
  const Values determinant = MultiplyAdd3(e1.x, c1.x, e1.y, c1.y, e1.z, c1.z);
  const Values scale = hn::Div(hn::Set(d, 1.0 / 6), hn::Abs(determinant));
  const Values half = hn::Mul(hn::Set(d, 0.5), scale);

  for (std::ptrdiff_t column = 0; column < mesh.num_columns; ++column) {
    const double* q = mesh.displacement + column * mesh.num_rows;
    const Vector q0 = corner0.Gather(q);
    const Vector d1 = corner1.Gather(q) - q0;
    const Vector d2 = corner2.Gather(q) - q0;
    const Vector d3 = corner3.Gather(q) - q0;
    const Values xx =
        hn::Mul(scale, MultiplyAdd3(d1.x, c1.x, d2.x, c2.x, d3.x, c3.x));
    const Values yy =
        hn::Mul(scale, MultiplyAdd3(d1.y, c1.y, d2.y, c2.y, d3.y, c3.y));
    const Values zz =
        hn::Mul(scale, MultiplyAdd3(d1.z, c1.z, d2.z, c2.z, d3.z, c3.z));
    const Values xy = hn::Mul(
        half, hn::Add(MultiplyAdd3(d1.x, c1.y, d2.x, c2.y, d3.x, c3.y),
                      MultiplyAdd3(d1.y, c1.x, d2.y, c2.x, d3.y, c3.x)));
    const Values xz = hn::Mul(
        half, hn::Add(MultiplyAdd3(d1.x, c1.z, d2.x, c2.z, d3.x, c3.z),
                      MultiplyAdd3(d1.z, c1.x, d2.z, c2.x, d3.z, c3.x)));
    const Values yz = hn::Mul(
        half, hn::Add(MultiplyAdd3(d1.y, c1.z, d2.y, c2.z, d3.y, c3.z),
                      MultiplyAdd3(d1.z, c1.y, d2.z, c2.y, d3.z, c3.y)));
    const Values trace = hn::Add(hn::Add(xx, yy), zz);
    const auto traction = [&](const Vector& c) HWY_ATTR {
      return Vector{MultiplyAdd3(xx, c.x, xy, c.y, xz, c.z),
                    MultiplyAdd3(xy, c.x, yy, c.y, yz, c.z),
                    MultiplyAdd3(xz, c.x, yz, c.y, zz, c.z)};
    };
    const auto volumetric = [&](const Vector& c) HWY_ATTR {
      return Vector{hn::Mul(trace, c.x), hn::Mul(trace, c.y),
                    hn::Mul(trace, c.z)};
    };
    const Vector zero = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    double* a = sums + 8 * column;
    double* p = a + 4;
    const Vector a1 = traction(c1);
    const Vector a2 = traction(c2);
    const Vector a3 = traction(c3);
    const Vector p1 = volumetric(c1);
    const Vector p2 = volumetric(c2);
    const Vector p3 = volumetric(c3);
    corner0.Scatter(zero - (a1 + a2 + a3), a, sum_stride);
    corner0.Scatter(zero - (p1 + p2 + p3), p, sum_stride);
    corner1.Scatter(a1, a, sum_stride);
    corner1.Scatter(p1, p, sum_stride);
    corner2.Scatter(a2, a, sum_stride);
    corner2.Scatter(p2, p, sum_stride);
    corner3.Scatter(a3, a, sum_stride);
    corner3.Scatter(p3, p, sum_stride);
  }
}

// `sums` has for each node 8 num_columns values: those of a and of p of each
// column, each followed by one that is not used.  Returns the number of
// elements that were added.
std::ptrdiff_t AddBatches(const MeshColumns& mesh, double* sums) {
  const std::ptrdiff_t lanes = static_cast<std::ptrdiff_t>(kLanes);
  const std::ptrdiff_t end = mesh.num_elements / lanes * lanes;
  for (std::ptrdiff_t element = 0; element < end; element += lanes) {
    AddBatch(mesh, mesh.corners + 4 * element, sums);
  }
  return end;
}

#else

// Negative: there are no vectors of four.
std::ptrdiff_t AddBatches(const MeshColumns&, double*) { return -1; }

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(AddBatches);

// Columns that are worked on together: a compromise between geometry that is
// computed again and memory.
constexpr Eigen::Index kMostColumns = 8;

void AddUnpacked(const double* sums, Eigen::Index first_column,
                 Eigen::Index num_columns, Eigen::MatrixXd& a,
                 Eigen::MatrixXd& p) {
  for (Eigen::Index row = 0; row < a.rows(); row += 3) {
    for (Eigen::Index k = 0; k < num_columns; ++k, sums += 8) {
      for (int i = 0; i < 3; ++i) {
        a(row + i, first_column + k) += sums[i];
        p(row + i, first_column + k) += sums[4 + i];
      }
    }
  }
}

}  // namespace

Eigen::Index AddVectorStrainProducts(const Mesh& mesh,
                                     const Eigen::MatrixXd& displacement,
                                     Eigen::MatrixXd& a, Eigen::MatrixXd& p) {
  const auto add_batches = HWY_DYNAMIC_DISPATCH(AddBatches);
  if (add_batches({}, nullptr) < 0) {
    return 0;
  }
  const Eigen::Index columns = displacement.cols();
  Eigen::Index num_added = 0;
  for (Eigen::Index first = 0; first < columns; first += kMostColumns) {
    const Eigen::Index count = std::min(kMostColumns, columns - first);
    const Eigen::Index num_sums = 8 * count * mesh.NumNodes();
    const auto sums = hwy::AllocateAligned<double>(num_sums);
    std::fill_n(sums.get(), num_sums, 0.0);
    num_added = add_batches(
        {mesh.elements.data(), mesh.NumElements(), mesh.nodes.data(),
         displacement.data() + first * displacement.rows(), displacement.rows(),
         count},
        sums.get());
    AddUnpacked(sums.get(), first, count, a, p);
  }
  return num_added;
}

}  // namespace elastimate
#endif
