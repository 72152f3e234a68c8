#include "elastimate/core/mechanics/tet10_point_forces.h"

#include "elastimate/core/mesh/tet10.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/mechanics/tet10_point_forces.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/large_strain/point_math-inl.h"

#ifndef ELASTIMATE_CORE_TET10_ROWS_
#define ELASTIMATE_CORE_TET10_ROWS_
namespace elastimate {
namespace {

constexpr int kTet10s = Tet10Points::kElements;
using Tet10Rows = std::int64_t[10][kTet10s];
using Tet10Shape = double[10][kTet10s];

// The barycentric coordinates of a point of the integration: (1 - 3 b) for the
// vertex that is nearest, and b = (5 - sqrt(5)) / 20 for the others.
constexpr double kFarCoordinate = 0.13819660112501051518;
constexpr double kNearMinusFar = 1 - 4 * kFarCoordinate;

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

// A vector at each of some elements.
struct Triple {
  Number entry[3];
};

HWY_INLINE Triple GatherNode(const Tet10Rows& rows, int node, int e,
                             const double* values) {
  const hn::RebindToSigned<PointLanes> integers;
  const auto place = hn::Load(integers, rows[node] + e);
  Triple at;
  for (int i = 0; i < 3; ++i) {
    at.entry[i] = hn::GatherIndex(PointLanes(), values + i, place);
  }
  return at;
}

// Returns g_1, g_2 and g_3 as columns.
HWY_INLINE Matrix3 LoadShape(const Tet10Shape& shape, int e) {
  Matrix3 g;
  for (int i = 0; i < 9; ++i) {
    g.entry[i] = LoadNumber(shape[i] + e);
  }
  return g;
}

void SetTet10Shape(const Tet10Rows& rows, const double* nodes,
                   Tet10Shape& shape) {
  for (int e = 0; e < kTet10s; e += int(hn::Lanes(PointLanes()))) {
    const Triple origin = GatherNode(rows, 0, e, nodes);
    Matrix3 edges;
    for (int j = 0; j < 3; ++j) {
      const Triple corner = GatherNode(rows, j + 1, e, nodes);
      for (int i = 0; i < 3; ++i) {
        edges(i, j) = corner.entry[i] - origin.entry[i];
      }
    }
    const Matrix3 cofactors = Cofactors(edges);
    const Number determinant = DeterminantOf(edges, cofactors);
    const Matrix3 g = (Number(1) / determinant) * cofactors;
    for (int i = 0; i < 9; ++i) {
      StoreNumber(g.entry[i], shape[i] + e);
    }
    StoreNumber(Number(1.0 / 24) * Number(hn::Abs(determinant.value)),
                shape[9] + e);
  }
}

void SetTet10Gradients(const Tet10Rows& rows, const Tet10Shape& shape,
                       const double* displacement, PointMatrices& gradients) {
  for (int e = 0; e < kTet10s; e += int(hn::Lanes(PointLanes()))) {
    // Differences from node 0, so that equal displacements have no gradient.
    const Triple origin = GatherNode(rows, 0, e, displacement);
    Triple u[10];
    for (int node = 1; node < 10; ++node) {
      u[node] = GatherNode(rows, node, e, displacement);
      for (int i = 0; i < 3; ++i) {
        u[node].entry[i] = u[node].entry[i] - origin.entry[i];
      }
    }
    u[0] = {{Number(0), Number(0), Number(0)}};
    const Matrix3 g = LoadShape(shape, e);
    Matrix3 of_vertex[4];
    for (int v = 0; v < 4; ++v) {
      for (int i = 0; i < 3; ++i) {
        const auto factor = [&](int w) HWY_ATTR {
          return w == v ? Number(3) * u[v].entry[i]
                        : Number(4) * u[kMidEdgeNodes[v][w]].entry[i] -
                              u[w].entry[i];
        };
        // The sum of all g is zero.
        const Number first = factor(0);
        const Number of_1 = factor(1) - first;
        const Number of_2 = factor(2) - first;
        const Number of_3 = factor(3) - first;
        for (int j = 0; j < 3; ++j) {
          of_vertex[v](i, j) =
              Dot3(of_1, g(j, 0), of_2, g(j, 1), of_3, g(j, 2));
        }
      }
    }
    const Matrix3 common =
        Number(kFarCoordinate) *
        (of_vertex[0] + of_vertex[1] + (of_vertex[2] + of_vertex[3]));
    for (int q = 0; q < 4; ++q) {
      Matrix3 at_point = common;
      AddScaled(kNearMinusFar, of_vertex[q], at_point);
      StoreMatrix(at_point, kTet10s * q + e, gradients);
    }
  }
}

void AddTet10Forces(const Tet10Rows& rows, int count, const Tet10Shape& shape,
                    const PointMatrices& stresses, double* forces) {
  constexpr int kLanes = int(hn::MaxLanes(PointLanes()));
  alignas(64) double of_nodes[10][3][kLanes];
  for (int e = 0; e < count; e += int(hn::Lanes(PointLanes()))) {
    const Matrix3 g = LoadShape(shape, e);
    const Number volume = LoadNumber(shape[9] + e);
    // 4 S_v, and the sum of all S_v.
    Matrix3 s[4];
    for (int v = 0; v < 4; ++v) {
      s[v] = LoadMatrix(stresses, kTet10s * v + e);
    }
    const Matrix3 sum = volume * (s[0] + s[1] + (s[2] + s[3]));
    const Matrix3 common = Number(4 * kFarCoordinate) * sum;
    for (int v = 0; v < 4; ++v) {
      const Matrix3 own = Number(4 * kNearMinusFar) * volume * s[v];
      s[v] = common + own;
    }
    // acting[v](i, w) = 4 (S_v g_w)_i; g_0 is minus the sum of the others.
    Matrix3 acting[4];
    Triple on_first[4];
    for (int v = 0; v < 4; ++v) {
      acting[v] = Product(s[v], g);
      for (int i = 0; i < 3; ++i) {
        on_first[v].entry[i] =
            Number(0) - (acting[v](i, 0) + acting[v](i, 1) + acting[v](i, 2));
      }
    }
    const Matrix3 of_sum = Product(sum, g);
    for (int i = 0; i < 3; ++i) {
      const auto along = [&](int v, int w) HWY_ATTR {
        return w == 0 ? on_first[v].entry[i] : acting[v](i, w - 1);
      };
      StoreNumber(along(0, 0) + of_sum(i, 0) + of_sum(i, 1) + of_sum(i, 2),
                  of_nodes[0][i]);
      for (int v = 1; v < 4; ++v) {
        StoreNumber(along(v, v) - of_sum(i, v - 1), of_nodes[v][i]);
      }
      for (int v = 0; v < 4; ++v) {
        for (int w = v + 1; w < 4; ++w) {
          StoreNumber(along(v, w) + along(w, v),
                      of_nodes[kMidEdgeNodes[v][w]][i]);
        }
      }
    }
    for (int lane = 0; lane < kLanes && e + lane < count; ++lane) {
      for (int node = 0; node < 10; ++node) {
        double* const at = forces + rows[node][e + lane];
        for (int i = 0; i < 3; ++i) {
          at[i] += of_nodes[node][i][lane];
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

HWY_EXPORT(SetTet10Shape);
HWY_EXPORT(SetTet10Gradients);
HWY_EXPORT(AddTet10Forces);

}  // namespace

Tet10Points::Tet10Points(const Mesh& mesh, const Eigen::Index* elements,
                         int count)
    : count_(count) {
  for (int e = 0; e < kElements; ++e) {
    const int* const nodes =
        mesh.elements.col(elements[e < count ? e : count - 1]).data();
    for (int node = 0; node < 10; ++node) {
      row_[node][e] = 3 * std::int64_t(nodes[node]);
    }
  }
  HWY_DYNAMIC_DISPATCH(SetTet10Shape)(row_, mesh.nodes.data(), shape_);
}

void Tet10Points::SetGradients(const double* displacement,
                               PointMatrices& gradients) const {
  HWY_DYNAMIC_DISPATCH(SetTet10Gradients)
  (row_, shape_, displacement, gradients);
}

void Tet10Points::AddForces(const PointMatrices& stresses,
                            double* forces) const {
  HWY_DYNAMIC_DISPATCH(AddTet10Forces)
  (row_, count_, shape_, stresses, forces);
}

}  // namespace elastimate
#endif
