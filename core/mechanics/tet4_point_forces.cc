#include "elastimate/core/mechanics/tet4_point_forces.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/mechanics/tet4_point_forces.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/large_strain/point_math-inl.h"

#ifndef ELASTIMATE_CORE_CORNER_ROWS_
#define ELASTIMATE_CORE_CORNER_ROWS_
namespace elastimate {
namespace {

using CornerRows = std::int64_t[4][PointMatrices::kPoints];

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

// Returns the values of the corners 1, 2 and 3 as columns, less those of corner
// 0.
HWY_INLINE Matrix3 EdgesAt(const CornerRows& rows, int p,
                           const double* values) {
  const hn::RebindToSigned<PointLanes> integers;
  const auto gather = [&](int corner, int component) HWY_ATTR {
    return Number(hn::GatherIndex(PointLanes(), values + component,
                                  hn::Load(integers, rows[corner] + p)));
  };
  Matrix3 edges;
  for (int i = 0; i < 3; ++i) {
    const Number origin = gather(0, i);
    for (int corner = 1; corner < 4; ++corner) {
      edges(i, corner - 1) = gather(corner, i) - origin;
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

void AddCornerForces(const CornerRows& rows, int count,
                     const PointMatrices& shape_gradients,
                     const PointValues<1>& volumes,
                     const PointMatrices& stresses, double* forces) {
  constexpr int kLanes = int(hn::MaxLanes(PointLanes()));
  alignas(64) double of_corners[9][kLanes];
  for (int p = 0; p < count; p += int(hn::Lanes(PointLanes()))) {
    const Matrix3 acting =
        LoadNumber(volumes.row[0] + p) *
        Product(LoadMatrix(stresses, p), LoadMatrix(shape_gradients, p));
    for (int i = 0; i < 9; ++i) {
      StoreNumber(acting.entry[i], of_corners[i]);
    }
    for (int lane = 0; lane < kLanes && p + lane < count; ++lane) {
      double* const origin = forces + rows[0][p + lane];
      for (int corner = 0; corner < 3; ++corner) {
        double* const at = forces + rows[corner + 1][p + lane];
        for (int i = 0; i < 3; ++i) {
          const double force = of_corners[3 * corner + i][lane];
          at[i] += force;
          origin[i] -= force;
        }
      }
    }
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

}  // namespace

Tet4Points::Tet4Points(const Mesh& mesh, const Eigen::Index* elements,
                       int count)
    : count_(count) {
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

}  // namespace elastimate
#endif
