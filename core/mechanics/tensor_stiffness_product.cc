#include "elastimate/core/mechanics/tensor_stiffness_product.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "elastimate/core/mechanics/quadratic_pass.h"
#include "elastimate/core/mesh/shape_functions.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE \
  "elastimate/core/mechanics/tensor_stiffness_product.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/mechanics/quadratic_pass-inl.h"

#ifndef ELASTIMATE_CORE_TENSOR_PASS_
#define ELASTIMATE_CORE_TENSOR_PASS_
namespace elastimate {
namespace {

// Nodes along an axis, and Gauss points along it.
constexpr int kThree = 3;

constexpr int PowerOfThree(int exponent) {
  return exponent == 0 ? 1 : kThree * PowerOfThree(exponent - 1);
}

// What is the same for all elements.
template <int kDimension>
struct TensorTables {
  static constexpr int kPoints = PowerOfThree(kDimension);
  // The place in an element of the node i_0 + 3 i_1 + 9 i_2, with places i_k =
  // 0 to 2 along the axes.
  int node[kPoints];
  // The coordinate and the weight of each Gauss point along an axis.
  double point[kThree];
  double weight[kThree];
  // The value at Gauss point q of the quadratic function that is 1 at node i of
  // an axis.
  double value[kThree][kThree];
  // The derivative at Gauss point q of the quadratic function that is 1 at
  // Gauss point p of an axis.
  double derivative[kThree][kThree];

  TensorTables() {
    const Eigen::MatrixXd nodes = ReferenceNodes(
        kDimension == 3 ? ElementKind::kHex27 : ElementKind::kQuad9);
    for (int i = 0; i < kPoints; ++i) {
      int place = 0;
      for (int k = 0; k < kDimension; ++k) {
        place += PowerOfThree(k) * (static_cast<int>(nodes(k, i)) + 1);
      }
      node[place] = i;
    }
    const double outer = std::sqrt(0.6);
    for (int q = 0; q < kThree; ++q) {
      const double t = (q - 1) * outer;
      point[q] = t;
      weight[q] = (q == 1 ? 8.0 : 5.0) / 9;
      value[q][0] = t * (t - 1) / 2;
      value[q][1] = 1 - t * t;
      value[q][2] = t * (t + 1) / 2;
      derivative[q][0] = (q - 1.5) / outer;
      derivative[q][1] = -2 * (q - 1) / outer;
      derivative[q][2] = (q - 0.5) / outer;
    }
  }
};

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

// A value at each node or Gauss point of the elements in the lanes.
template <int kDimension>
using Field = Values[PowerOfThree(kDimension)];

// Calls visit(first, step) for each line of three points along an axis.
template <int kDimension, int kAxis, class Visitor>
HWY_INLINE void VisitLines(const Visitor& visit) {
  constexpr int kStep = PowerOfThree(kAxis);
  for (int outer = 0; outer < PowerOfThree(kDimension); outer += 3 * kStep) {
    for (int inner = 0; inner < kStep; ++inner) {
      visit(outer + inner, kStep);
    }
  }
}

// Multiplies each line along an axis by a matrix or its transpose, in place.
template <int kDimension, int kAxis, bool kIsTransposed>
HWY_INLINE void MultiplyLines(const double (&matrix)[kThree][kThree],
                              Field<kDimension>& field) {
  const Lanes d;
  const auto entry = [&](int i, int j) HWY_ATTR {
    return hn::Set(d, kIsTransposed ? matrix[j][i] : matrix[i][j]);
  };
  const Values m00 = entry(0, 0), m01 = entry(0, 1), m02 = entry(0, 2);
  const Values m10 = entry(1, 0), m11 = entry(1, 1), m12 = entry(1, 2);
  const Values m20 = entry(2, 0), m21 = entry(2, 1), m22 = entry(2, 2);
  VisitLines<kDimension, kAxis>([&](int i, int step) HWY_ATTR {
    const Values a = field[i];
    const Values b = field[i + step];
    const Values c = field[i + 2 * step];
    field[i] = MultiplyAdd3(m00, a, m01, b, m02, c);
    field[i + step] = MultiplyAdd3(m10, a, m11, b, m12, c);
    field[i + 2 * step] = MultiplyAdd3(m20, a, m21, b, m22, c);
  });
}

// Takes values at the nodes to the Gauss points, or forces back.
template <int kDimension, bool kIsTransposed>
HWY_INLINE void MultiplyByValues(const TensorTables<kDimension>& tables,
                                 Field<kDimension>& field) {
  MultiplyLines<kDimension, 0, kIsTransposed>(tables.value, field);
  MultiplyLines<kDimension, 1, kIsTransposed>(tables.value, field);
  if constexpr (kDimension == 3) {
    MultiplyLines<kDimension, 2, kIsTransposed>(tables.value, field);
  }
}

// Sets the derivative along an axis of values at the Gauss points.
template <int kDimension, int kAxis>
HWY_INLINE void Differentiate(const TensorTables<kDimension>& tables,
                              const Field<kDimension>& field,
                              Field<kDimension>& derivative) {
  for (int i = 0; i < PowerOfThree(kDimension); ++i) {
    derivative[i] = field[i];
  }
  MultiplyLines<kDimension, kAxis, false>(tables.derivative, derivative);
}

// Adds the transpose of Differentiate to the first of two fields; the second
// one is overwritten.
template <int kDimension, int kAxis>
HWY_INLINE void AddTransposed(const TensorTables<kDimension>& tables,
                              Field<kDimension>& sum,
                              Field<kDimension>& derivative) {
  MultiplyLines<kDimension, kAxis, true>(tables.derivative, derivative);
  for (int i = 0; i < PowerOfThree(kDimension); ++i) {
    sum[i] = hn::Add(sum[i], derivative[i]);
  }
}

// The tangents dx / dxi_k of the map of the vertices.  Tangent k does not
// depend on xi_k, and it is linear in the other coordinates.
template <int kDimension>
struct Tangents {
  // The coefficients of 1, of the first other coordinate, of the second, and of
  // their product.
  Vector of[kDimension][4];

  HWY_INLINE Tangents(const int* elements, std::ptrdiff_t count,
                      const double* positions) {
    constexpr int kVertices = 1 << kDimension;
    constexpr int kNodes = PowerOfThree(kDimension);
    const NodeRecords<kVertices, kNodes, const double> nodes(
        elements, count, positions, 0, kDimension);
    Vector x[kVertices];
    for (int i = 0; i < kVertices; ++i) {
      x[i] = LoadVector(nodes.record[i]);
    }
    const Values quarter = hn::Set(Lanes(), 0.25);
    const Values eighth = hn::Set(Lanes(), 0.125);
    if constexpr (kDimension == 2) {
      const Vector e01 = x[1] - x[0], e32 = x[2] - x[3];
      const Vector e03 = x[3] - x[0], e12 = x[2] - x[1];
      of[0][0] = quarter * (e01 + e32);
      of[0][1] = quarter * (e32 - e01);
      of[1][0] = quarter * (e03 + e12);
      of[1][1] = quarter * (e12 - e03);
    } else {
      // Sets the tangent by the four edges along it, at the ends (-, -), (+,
      // -),
      // (-, +) and (+, +) of the other two axes.
      const auto set = [&](Vector(&tangent)[4], const Vector& mm,
                           const Vector& pm, const Vector& mp, const Vector& pp)
                           HWY_ATTR {
                             tangent[0] = eighth * (mm + pm + mp + pp);
                             tangent[1] = eighth * (pm + pp - mm - mp);
                             tangent[2] = eighth * (mp + pp - mm - pm);
                             tangent[3] = eighth * (mm + pp - pm - mp);
                           };
      set(of[0], x[1] - x[0], x[2] - x[3], x[5] - x[4], x[6] - x[7]);
      set(of[1], x[3] - x[0], x[2] - x[1], x[7] - x[4], x[6] - x[5]);
      set(of[2], x[4] - x[0], x[5] - x[1], x[7] - x[3], x[6] - x[2]);
    }
  }

  HWY_INLINE Vector At(int k, double first, double second) const {
    const Lanes d;
    const Values a = hn::Set(d, first);
    if constexpr (kDimension == 2) {
      return of[k][0] + a * of[k][1];
    } else {
      const Values b = hn::Set(d, second);
      return of[k][0] + a * of[k][1] + b * (of[k][2] + a * of[k][3]);
    }
  }
};

// The map at a Gauss point: the rows of its adjugate, and the weight of the
// point, with the thickness, over the determinant in magnitude.
template <int kDimension>
struct PointMap {
  Vector adjugate[kDimension];
  Values scale;

  HWY_INLINE PointMap(const Tangents<kDimension>& tangents,
                      const TensorTables<kDimension>& tables, int i, int j,
                      int k, Values thickness) {
    const Lanes d;
    const double* const t = tables.point;
    double weight = tables.weight[i] * tables.weight[j];
    Values determinant;
    if constexpr (kDimension == 2) {
      const Vector a = tangents.At(0, t[j], 0);
      const Vector b = tangents.At(1, t[i], 0);
      const Values zero = hn::Zero(d);
      adjugate[0] = {b.y, hn::Neg(b.x), zero};
      adjugate[1] = {hn::Neg(a.y), a.x, zero};
      determinant = hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x));
    } else {
      weight *= tables.weight[k];
      const Vector a = tangents.At(0, t[j], t[k]);
      const Vector b = tangents.At(1, t[i], t[k]);
      const Vector c = tangents.At(2, t[i], t[j]);
      adjugate[0] = Cross(b, c);
      adjugate[1] = Cross(c, a);
      adjugate[2] = Cross(a, b);
      determinant = MultiplyAdd3(a.x, adjugate[0].x, a.y, adjugate[0].y, a.z,
                                 adjugate[0].z);
    }
    scale =
        hn::Div(hn::Mul(hn::Set(d, weight), thickness), hn::Abs(determinant));
  }
};

// A vector field of the elements: values at nodes or Gauss points.
template <int kDimension>
struct VectorField {
  Field<kDimension> of[kDimension];
};

HWY_INLINE Values ComponentOf(const Vector& v, int k) {
  return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

// Adds forces at the Gauss points to the records of the nodes.
template <int kDimension, class Nodes>
HWY_INLINE void AddTensorForces(const TensorTables<kDimension>& tables,
                                const Nodes& nodes, std::ptrdiff_t offset,
                                VectorField<kDimension> (&stress)[kDimension]) {
  for (int c = 0; c < kDimension; ++c) {
    Field<kDimension>& sum = stress[0].of[c];
    MultiplyLines<kDimension, 0, true>(tables.derivative, sum);
    AddTransposed<kDimension, 1>(tables, sum, stress[1].of[c]);
    if constexpr (kDimension == 3) {
      AddTransposed<kDimension, 2>(tables, sum, stress[2].of[c]);
    }
    MultiplyByValues<kDimension, true>(tables, sum);
  }
  const Values zero = hn::Zero(Lanes());
  for (int i = 0; i < PowerOfThree(kDimension); ++i) {
    Vector force = {stress[0].of[0][i], stress[0].of[1][i], zero};
    if constexpr (kDimension == 3) {
      force.z = stress[0].of[2][i];
    }
    AddToNode(force, nodes.record[tables.node[i]], offset);
  }
}

// Sets gradient[a] to the derivatives of the displacement along axis a of the
// reference element at the Gauss points.
template <int kDimension, class Nodes>
HWY_INLINE void SetReferenceGradient(
    const TensorTables<kDimension>& tables, const Nodes& nodes,
    VectorField<kDimension> (&gradient)[kDimension]) {
  // A translation is taken out, so that it leaves no rounding.
  const Vector origin = LoadVector(nodes.record[0]);
  VectorField<kDimension> u;
  for (int i = 0; i < PowerOfThree(kDimension); ++i) {
    const Vector v = LoadVector(nodes.record[tables.node[i]]) - origin;
    for (int c = 0; c < kDimension; ++c) {
      u.of[c][i] = ComponentOf(v, c);
    }
  }
  for (int c = 0; c < kDimension; ++c) {
    MultiplyByValues<kDimension, false>(tables, u.of[c]);
    Differentiate<kDimension, 0>(tables, u.of[c], gradient[0].of[c]);
    Differentiate<kDimension, 1>(tables, u.of[c], gradient[1].of[c]);
    if constexpr (kDimension == 3) {
      Differentiate<kDimension, 2>(tables, u.of[c], gradient[2].of[c]);
    }
  }
}

// Replaces the reference gradient at a Gauss point by the stress that works on
// it, and sets `of_trace` to that of the trace alone unless kIsSum.
template <int kDimension, bool kIsSum>
HWY_INLINE void ReplaceByStress(
    const PointMap<kDimension>& map, const Values& of_a, const Values& of_p,
    int point, VectorField<kDimension> (&gradient)[kDimension],
    VectorField<kDimension> (&of_trace)[kDimension]) {
  // The displacement gradient times the determinant.
  Values h[kDimension][kDimension];
  for (int c = 0; c < kDimension; ++c) {
    for (int x = 0; x < kDimension; ++x) {
      h[c][x] =
          hn::Mul(gradient[0].of[c][point], ComponentOf(map.adjugate[0], x));
      for (int axis = 1; axis < kDimension; ++axis) {
        h[c][x] = hn::MulAdd(gradient[axis].of[c][point],
                             ComponentOf(map.adjugate[axis], x), h[c][x]);
      }
    }
  }
  Values sum = hn::Add(h[0][0], h[1][1]);
  if constexpr (kDimension == 3) {
    sum = hn::Add(sum, h[2][2]);
  }
  sum = hn::Mul(sum, map.scale);
  const Values half = hn::Mul(hn::Set(Lanes(), 0.5), hn::Mul(of_a, map.scale));
  const Values pressure = hn::Mul(of_p, sum);
  for (int c = 0; c < kDimension; ++c) {
    Values stress[kDimension];
    for (int x = 0; x < kDimension; ++x) {
      stress[x] = hn::Mul(half, hn::Add(h[c][x], h[x][c]));
    }
    stress[c] = hn::Add(stress[c], pressure);
    for (int axis = 0; axis < kDimension; ++axis) {
      Values force = hn::Mul(stress[0], ComponentOf(map.adjugate[axis], 0));
      for (int x = 1; x < kDimension; ++x) {
        force =
            hn::MulAdd(stress[x], ComponentOf(map.adjugate[axis], x), force);
      }
      gradient[axis].of[c][point] = force;
      if (!kIsSum) {
        of_trace[axis].of[c][point] =
            hn::Mul(sum, ComponentOf(map.adjugate[axis], c));
      }
    }
  }
}

// Adds `count` elements from the first on, an element in each lane.
template <int kDimension, bool kIsSum>
HWY_INLINE void AddLanes(const QuadraticPass& pass,
                         const TensorTables<kDimension>& tables,
                         std::ptrdiff_t first, std::ptrdiff_t count) {
  constexpr int kNodes = PowerOfThree(kDimension);
  const Lanes d;
  const int* const elements = pass.elements + kNodes * first;
  const Tangents<kDimension> tangents(elements, count, pass.positions);
  const NodeRecords<kNodes, kNodes, double> nodes(
      elements, count, pass.records, pass.first_node,
      kIsSum ? kSizeForSum : kSizeForProducts);
  VectorField<kDimension> gradient[kDimension];
  SetReferenceGradient<kDimension>(tables, nodes, gradient);
  Values thickness = hn::Set(d, pass.thickness);
  if (count < kLanes) {
    // Lanes that repeat an element add nothing.
    thickness = hn::IfThenElseZero(hn::FirstN(d, count), thickness);
  }
  Values of_a = hn::Set(d, 1.0);
  Values of_p = hn::Zero(d);
  if (kIsSum) {
    of_a = hn::LoadU(d, pass.coefficients_of_a + first);
    of_p = hn::LoadU(d, pass.coefficients_of_p + first);
  }
  VectorField<kDimension> of_trace[kDimension];
  int point = 0;
  for (int k = 0; k < (kDimension == 3 ? kThree : 1); ++k) {
    for (int j = 0; j < kThree; ++j) {
      for (int i = 0; i < kThree; ++i, ++point) {
        const PointMap<kDimension> map(tangents, tables, i, j, k, thickness);
        ReplaceByStress<kDimension, kIsSum>(map, of_a, of_p, point, gradient,
                                            of_trace);
      }
    }
  }
  AddTensorForces<kDimension>(tables, nodes, kFour, gradient);
  if (!kIsSum) {
    AddTensorForces<kDimension>(tables, nodes, 2 * kFour, of_trace);
  }
}

template <int kDimension, bool kIsSum>
void AddAllLanes(const QuadraticPass& pass) {
  static const TensorTables<kDimension> tables;
  std::ptrdiff_t first = 0;
  for (; first < pass.num_elements; first += kLanes) {
    AddLanes<kDimension, kIsSum>(
        pass, tables, first,
        std::min<std::ptrdiff_t>(kLanes, pass.num_elements - first));
  }
}

template <int kDimension>
void RunPassOf(const QuadraticPass& pass) {
  if (pass.coefficients_of_a != nullptr) {
    AddAllLanes<kDimension, true>(pass);
  } else {
    AddAllLanes<kDimension, false>(pass);
  }
}

void RunHexahedra(const QuadraticPass& pass) { RunPassOf<3>(pass); }
void RunQuadrilaterals(const QuadraticPass& pass) { RunPassOf<2>(pass); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(RunHexahedra);
HWY_EXPORT(RunQuadrilaterals);

RunPass BestPass(ElementKind kind) {
  assert(kind == ElementKind::kHex27 || kind == ElementKind::kQuad9);
  if (kind == ElementKind::kHex27) {
    return [](const QuadraticPass& pass) {
      HWY_DYNAMIC_DISPATCH(RunHexahedra)(pass);
    };
  }
  return [](const QuadraticPass& pass) {
    HWY_DYNAMIC_DISPATCH(RunQuadrilaterals)(pass);
  };
}

}  // namespace

void MultiplyTensorElements(const QuadraticMesh& mesh,
                            const Eigen::MatrixXd& displacement,
                            StiffnessProducts& products) {
  MultiplyByPass(mesh, displacement, BestPass(mesh.Kind()), products);
}

Eigen::MatrixXd MultiplyTensorElements(const QuadraticMesh& mesh,
                                       const Eigen::Matrix2Xd& coefficients,
                                       const Eigen::MatrixXd& displacement) {
  return MultiplyByPass(mesh, coefficients, displacement,
                        BestPass(mesh.Kind()));
}

}  // namespace elastimate
#endif
