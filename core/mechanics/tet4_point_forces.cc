#include "elastimate/core/mechanics/tet4_point_forces.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/mechanics/tet4_point_forces.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/large_strain/point_math-inl.h"
#include "elastimate/core/mechanics/vector_lanes-inl.h"

#ifndef ELASTIMATE_CORE_CORNER_ROWS_
#define ELASTIMATE_CORE_CORNER_ROWS_
namespace elastimate {
namespace {

using CornerRows = std::int64_t[4][PointMatrices::kPoints];

// The blocks of the ten pairs of corners, in the order of LocalPair.
using PairBlocks = PointValues<90>;

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

// Sets `of_corner` to the three components of the values at a corner of as many
// elements as there are lanes.
HWY_INLINE void GatherCorner(const CornerRows& rows, int corner, int p,
                             const double* values, Number (&of_corner)[3]) {
  const std::int64_t* const row = rows[corner] + p;
#if ELASTIMATE_HAS_BATCHES
  const Vector v = LoadThrees([&](int lane) { return values + row[lane]; });
  of_corner[0] = v.x;
  of_corner[1] = v.y;
  of_corner[2] = v.z;
#else
  const hn::RebindToSigned<PointLanes> integers;
  for (int i = 0; i < 3; ++i) {
    of_corner[i] =
        hn::GatherIndex(PointLanes(), values + i, hn::Load(integers, row));
  }
#endif
}

// Returns the values of the corners 1, 2 and 3 as columns, less those of corner
// 0.
HWY_INLINE Matrix3 EdgesAt(const CornerRows& rows, int p,
                           const double* values) {
  Number origin[3];
  GatherCorner(rows, 0, p, values, origin);
  Matrix3 edges;
  for (int corner = 1; corner < 4; ++corner) {
    Number of_corner[3];
    GatherCorner(rows, corner, p, values, of_corner);
    for (int i = 0; i < 3; ++i) {
      edges(i, corner - 1) = of_corner[i] - origin[i];
    }
  }
  return edges;
}

void SetShapeGradients(const CornerRows& rows, int count, const double* nodes,
                       PointMatrices& gradients, PointValues<1>& volumes) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 edges = EdgesAt(rows, p, nodes);
    const Matrix3 cofactors = Cofactors(edges);
    const Number determinant = DeterminantOf(edges, cofactors);
    StoreMatrix((Number(1) / determinant) * cofactors, p, gradients);
    StoreNumber(Number(1.0 / 6) * Number(hn::Abs(determinant.value)),
                volumes.row[0] + p);
  }
}

void SetFieldGradients(const CornerRows& rows, int count,
                       const PointMatrices& shape_gradients,
                       const double* displacement, PointMatrices& gradients) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 edges = EdgesAt(rows, p, displacement);
    const Matrix3 shape = LoadMatrix(shape_gradients, p);
    Matrix3 gradient;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        gradient(i, j) = Dot3(edges(i, 0), shape(j, 0), edges(i, 1),
                              shape(j, 1), edges(i, 2), shape(j, 2));
      }
    }
    StoreMatrix(gradient, p, gradients);
  }
}

// Adds forces to a corner of each element in the lanes, of the first `count`
// where fewer are left.  It adds one after the other, because elements may
// share nodes.
HWY_INLINE void AddToCorner(const std::int64_t* row, int count, Number x,
                            Number y, Number z, double* forces) {
#if ELASTIMATE_HAS_BATCHES
  if (count >= int(kLanes)) {
    const Rows of = Transpose({x.value, y.value, z.value, hn::Zero(Lanes())});
#if HWY_CAP_GE512
    const hn::Half<Lanes> half;
    CollectThree<false>(hn::LowerHalf(half, of.row0), forces + row[0]);
    CollectThree<false>(hn::LowerHalf(half, of.row1), forces + row[1]);
    CollectThree<false>(hn::LowerHalf(half, of.row2), forces + row[2]);
    CollectThree<false>(hn::LowerHalf(half, of.row3), forces + row[3]);
    CollectThree<false>(hn::UpperHalf(half, of.row0), forces + row[4]);
    CollectThree<false>(hn::UpperHalf(half, of.row1), forces + row[5]);
    CollectThree<false>(hn::UpperHalf(half, of.row2), forces + row[6]);
    CollectThree<false>(hn::UpperHalf(half, of.row3), forces + row[7]);
#else
    CollectThree<false>(of.row0, forces + row[0]);
    CollectThree<false>(of.row1, forces + row[1]);
    CollectThree<false>(of.row2, forces + row[2]);
    CollectThree<false>(of.row3, forces + row[3]);
#endif
    return;
  }
#endif
  constexpr int kPointLanes = int(hn::MaxLanes(PointLanes()));
  alignas(64) double of_lane[3][kPointLanes];
  StoreNumber(x, of_lane[0]);
  StoreNumber(y, of_lane[1]);
  StoreNumber(z, of_lane[2]);
  for (int lane = 0; lane < kPointLanes && lane < count; ++lane) {
    for (int i = 0; i < 3; ++i) {
      forces[row[lane] + i] += of_lane[i][lane];
    }
  }
}

void AddCornerForces(const CornerRows& rows, int count,
                     const PointMatrices& shape_gradients,
                     const PointValues<1>& volumes,
                     const PointMatrices& stresses, double* forces) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 acting =
        LoadNumber(volumes.row[0] + p) *
        Product(LoadMatrix(stresses, p), LoadMatrix(shape_gradients, p));
    Number of_origin[3];
    for (int i = 0; i < 3; ++i) {
      of_origin[i] = Number(0) - (acting(i, 0) + acting(i, 1) + acting(i, 2));
    }
    AddToCorner(rows[0] + p, count - p, of_origin[0], of_origin[1],
                of_origin[2], forces);
    for (int corner = 0; corner < 3; ++corner) {
      AddToCorner(rows[corner + 1] + p, count - p, acting(0, corner),
                  acting(1, corner), acting(2, corner), forces);
    }
  }
}

void SetPairBlocks(int count, const PointMatrices& shape_gradients,
                   const PointValues<1>& volumes, const PointTangents& tangents,
                   PairBlocks& blocks) {
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 g = LoadMatrix(shape_gradients, p);
    const Matrix3 scaled = LoadNumber(volumes.row[0] + p) * g;
    Matrix3 k[3][3];
    for (int j = 0; j < 3; ++j) {
      // A . grad(N_j): entry (a, b) with a = r + 3 c.
      Number of_column[9][3];
      for (int a = 0; a < 9; ++a) {
        for (int b = 0; b < 3; ++b) {
          const auto entry = [&](int d) HWY_ATTR {
            return LoadNumber(tangents.row[TangentRow(a, b + 3 * d)] + p);
          };
          of_column[a][b] = Dot3(entry(0), scaled(0, j), entry(1), scaled(1, j),
                                 entry(2), scaled(2, j));
        }
      }
      for (int i = j; i < 3; ++i) {
        for (int b = 0; b < 3; ++b) {
          for (int r = 0; r < 3; ++r) {
            k[i][j](r, b) =
                Dot3(g(0, i), of_column[r][b], g(1, i), of_column[r + 3][b],
                     g(2, i), of_column[r + 6][b]);
            k[j][i](b, r) = k[i][j](r, b);
          }
        }
      }
    }
    const auto store = [&](const Matrix3& block, int pair) HWY_ATTR {
      for (int entry = 0; entry < 9; ++entry) {
        StoreNumber(block.entry[entry], blocks.row[9 * pair + entry] + p);
      }
    };
    // The gradients of all corners have the sum zero.
    Matrix3 sum = Number(0) * g;
    for (int i = 0; i < 3; ++i) {
      const Matrix3 of_first = Number(-1) * (k[i][0] + k[i][1] + k[i][2]);
      AddScaled(-1, of_first, sum);
      const int first_pair = (i + 1) * (i + 2) / 2;
      store(of_first, first_pair);
      for (int j = 0; j <= i; ++j) {
        store(k[i][j], first_pair + 1 + j);
      }
    }
    store(sum, 0);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(SetShapeGradients);
HWY_EXPORT(SetFieldGradients);
HWY_EXPORT(AddCornerForces);
HWY_EXPORT(SetPairBlocks);

// Where the entries of a block are in itself, and in its transpose.
constexpr int kOwnPlace[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
constexpr int kTransposedPlace[9] = {0, 3, 6, 1, 4, 7, 2, 5, 8};

}  // namespace

Tet4Points::Tet4Points(const Mesh& mesh, const Eigen::Index* elements,
                       int count)
    : count_(count), elements_(elements) {
  for (int p = 0; p < PointMatrices::kPoints; ++p) {
    // Points beyond the last element repeat it, so that all are finite.
    const int* const nodes =
        mesh.elements.col(elements[p < count ? p : count - 1]).data();
    for (int corner = 0; corner < 4; ++corner) {
      row_[corner][p] = 3 * std::int64_t(nodes[corner]);
    }
  }
  HWY_DYNAMIC_DISPATCH(SetShapeGradients)
  (row_, count, mesh.nodes.data(), gradients_, volumes_);
}

void Tet4Points::SetGradients(const double* displacement,
                              PointMatrices& gradients) const {
  HWY_DYNAMIC_DISPATCH(SetFieldGradients)
  (row_, count_, gradients_, displacement, gradients);
}

void Tet4Points::AddForces(const PointMatrices& stresses,
                           double* forces) const {
  HWY_DYNAMIC_DISPATCH(AddCornerForces)
  (row_, count_, gradients_, volumes_, stresses, forces);
}

void Tet4Points::AddBlocks(const PointTangents& tangents,
                           const NodeGraph& graph,
                           Eigen::MatrixXd& blocks) const {
  PairBlocks of_pairs;
  HWY_DYNAMIC_DISPATCH(SetPairBlocks)
  (count_, gradients_, volumes_, tangents, of_pairs);
  for (int p = 0; p < count_; ++p) {
    const int* const pairs = graph.element_pairs.col(elements_[p]).data();
    int pair = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j, ++pair) {
        // The pair has the greater node first.
        const int* const place =
            row_[i][p] >= row_[j][p] ? kOwnPlace : kTransposedPlace;
        double* const block = blocks.data() + 9 * Eigen::Index(pairs[pair]);
        for (int entry = 0; entry < 9; ++entry) {
          block[place[entry]] += of_pairs.row[9 * pair + entry][p];
        }
      }
    }
  }
}

}  // namespace elastimate
#endif
