#include "elastimate/core/mechanics/tet10_stiffness_product.h"

#include <cassert>
#include <cstddef>

#include "elastimate/core/mechanics/quadratic_pass.h"
#include "elastimate/core/mesh/tet10.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE \
  "elastimate/core/mechanics/tet10_stiffness_product.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#include "elastimate/core/mechanics/quadratic_pass-inl.h"

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

using Corners = NodeRecords<4, 10, const double>;
using Nodes = NodeRecords<10, 10, double>;

// Returns the vectors of node i minus those of node 0.
template <class Records>
HWY_INLINE Vector FromVertex0(const Records& nodes, int i) {
  return LoadVector(nodes.record[i]) - LoadVector(nodes.record[0]);
}

// The gradients of the barycentric coordinates, and V / 20.
struct Barycentric {
  Vector g0, g1, g2, g3;
  Values mass;

  HWY_INLINE Barycentric(const Corners& nodes, std::ptrdiff_t count) {
    const Lanes d;
    const Vector e1 = FromVertex0(nodes, 1);
    const Vector e2 = FromVertex0(nodes, 2);
    const Vector e3 = FromVertex0(nodes, 3);
    const Vector c1 = Cross(e2, e3);
    const Values determinant = MultiplyAdd3(e1.x, c1.x, e1.y, c1.y, e1.z, c1.z);
    const Values inverse = hn::Div(hn::Set(d, 1.0), determinant);
    g1 = inverse * c1;
    g2 = inverse * Cross(e3, e1);
    g3 = inverse * Cross(e1, e2);
    g0 = Vector{hn::Zero(d), hn::Zero(d), hn::Zero(d)} - (g1 + g2 + g3);
    mass = hn::Mul(hn::Set(d, 1.0 / 120), hn::Abs(determinant));
    if (count < kLanes) {
      // Lanes that repeat an element add nothing.
      mass = hn::IfThenElseZero(hn::FirstN(d, count), mass);
    }
  }
};

// A symmetric matrix.
struct Symmetric {
  Values xx, yy, zz, xy, xz, yz;

  HWY_INLINE Vector Times(const Vector& g) const {
    return {MultiplyAdd3(xx, g.x, xy, g.y, xz, g.z),
            MultiplyAdd3(xy, g.x, yy, g.y, yz, g.z),
            MultiplyAdd3(xz, g.x, yz, g.y, zz, g.z)};
  }
};

HWY_INLINE Symmetric operator+(const Symmetric& a, const Symmetric& b) {
  return {hn::Add(a.xx, b.xx), hn::Add(a.yy, b.yy), hn::Add(a.zz, b.zz),
          hn::Add(a.xy, b.xy), hn::Add(a.xz, b.xz), hn::Add(a.yz, b.yz)};
}

HWY_INLINE Symmetric operator*(Values a, const Symmetric& b) {
  return {hn::Mul(a, b.xx), hn::Mul(a, b.yy), hn::Mul(a, b.zz),
          hn::Mul(a, b.xy), hn::Mul(a, b.xz), hn::Mul(a, b.yz)};
}

// A multiple of the unit matrix.
struct Scalar {
  Values value;

  HWY_INLINE Vector Times(const Vector& g) const { return value * g; }
};

HWY_INLINE Scalar operator+(const Scalar& a, const Scalar& b) {
  return {hn::Add(a.value, b.value)};
}

HWY_INLINE Scalar operator*(Values a, const Scalar& b) {
  return {hn::Mul(a, b.value)};
}

// sym(b1 g1^T + b2 g2^T + b3 g3^T).
HWY_INLINE Symmetric StrainOf(const Barycentric& g, const Vector& b1,
                              const Vector& b2, const Vector& b3) {
  const auto on = [&](Values a1, Values c1, Values a2, Values c2, Values a3,
                      Values c3, Values start) HWY_ATTR {
    return hn::MulAdd(a1, c1, hn::MulAdd(a2, c2, hn::MulAdd(a3, c3, start)));
  };
  const Values half = hn::Set(Lanes(), 0.5);
  const Vector& g1 = g.g1;
  const Vector& g2 = g.g2;
  const Vector& g3 = g.g3;
  return {MultiplyAdd3(b1.x, g1.x, b2.x, g2.x, b3.x, g3.x),
          MultiplyAdd3(b1.y, g1.y, b2.y, g2.y, b3.y, g3.y),
          MultiplyAdd3(b1.z, g1.z, b2.z, g2.z, b3.z, g3.z),
          hn::Mul(half, on(b1.x, g1.y, b2.x, g2.y, b3.x, g3.y,
                           MultiplyAdd3(b1.y, g1.x, b2.y, g2.x, b3.y, g3.x))),
          hn::Mul(half, on(b1.x, g1.z, b2.x, g2.z, b3.x, g3.z,
                           MultiplyAdd3(b1.z, g1.x, b2.z, g2.x, b3.z, g3.x))),
          hn::Mul(half, on(b1.y, g1.z, b2.y, g2.z, b3.y, g3.z,
                           MultiplyAdd3(b1.z, g1.y, b2.z, g2.y, b3.z, g3.y)))};
}

HWY_INLINE Values TraceOf(const Symmetric& e) {
  return hn::Add(hn::Add(e.xx, e.yy), e.zz);
}

// The strains at the four vertices.
struct VertexStrains {
  Symmetric e0, e1, e2, e3;

  HWY_INLINE VertexStrains(const Nodes& nodes, const Barycentric& g) {
    const Values three = hn::Set(Lanes(), 3.0);
    const Values four = hn::Set(Lanes(), 4.0);
    // Returns 4 middle - end.
    const auto bent = [&](const Vector& middle, const Vector& end) HWY_ATTR {
      return Vector{hn::MulSub(four, middle.x, end.x),
                    hn::MulSub(four, middle.y, end.y),
                    hn::MulSub(four, middle.z, end.z)};
    };
    const Vector w1 = FromVertex0(nodes, 1);
    const Vector w2 = FromVertex0(nodes, 2);
    const Vector w3 = FromVertex0(nodes, 3);
    const Vector w01 = FromVertex0(nodes, kMidEdgeNodes[0][1]);
    const Vector w02 = FromVertex0(nodes, kMidEdgeNodes[0][2]);
    const Vector w03 = FromVertex0(nodes, kMidEdgeNodes[0][3]);
    const Vector w12 = FromVertex0(nodes, kMidEdgeNodes[1][2]);
    const Vector w13 = FromVertex0(nodes, kMidEdgeNodes[1][3]);
    const Vector w23 = FromVertex0(nodes, kMidEdgeNodes[2][3]);
    // The coefficient of g0 is 4 w_v0 at vertex v and 0 at vertex 0.  Because
    // g0 = -(g1 + g2 + g3), it is subtracted from the other coefficients.
    e0 = StrainOf(g, bent(w01, w1), bent(w02, w2), bent(w03, w3));
    e1 = StrainOf(g, three * w1 - four * w01, bent(w12 - w01, w2),
                  bent(w13 - w01, w3));
    e2 = StrainOf(g, bent(w12 - w02, w1), three * w2 - four * w02,
                  bent(w23 - w02, w3));
    e3 = StrainOf(g, bent(w13 - w03, w1), bent(w23 - w03, w2),
                  three * w3 - four * w03);
  }
};

// Adds the forces of the stresses at the vertices to the records of the nodes.
template <class Stress>
HWY_INLINE void AddForces(const Nodes& nodes, std::ptrdiff_t offset,
                          const Barycentric& g, const Stress& s0,
                          const Stress& s1, const Stress& s2,
                          const Stress& s3) {
  const Stress sum = s0 + s1 + s2 + s3;
  // This is the factor of 4 tau.
  const Values mass = hn::Mul(hn::Set(Lanes(), 4.0), g.mass);
  const Stress t0 = mass * (s0 + sum);
  const Stress t1 = mass * (s1 + sum);
  const Stress t2 = mass * (s2 + sum);
  const Stress t3 = mass * (s3 + sum);
  // This is the sum of all tau: the four (s + sum) add up to five times `sum`.
  const Stress all = hn::Mul(hn::Set(Lanes(), 5.0), g.mass) * sum;
  const auto add = [&](int i, const Vector& v)
                       HWY_ATTR { AddToNode(v, nodes.record[i], offset); };
  add(0, t0.Times(g.g0) - all.Times(g.g0));
  add(1, t1.Times(g.g1) - all.Times(g.g1));
  add(2, t2.Times(g.g2) - all.Times(g.g2));
  add(3, t3.Times(g.g3) - all.Times(g.g3));
  add(kMidEdgeNodes[0][1], t0.Times(g.g1) + t1.Times(g.g0));
  add(kMidEdgeNodes[1][2], t1.Times(g.g2) + t2.Times(g.g1));
  add(kMidEdgeNodes[2][0], t2.Times(g.g0) + t0.Times(g.g2));
  add(kMidEdgeNodes[0][3], t0.Times(g.g3) + t3.Times(g.g0));
  add(kMidEdgeNodes[1][3], t1.Times(g.g3) + t3.Times(g.g1));
  add(kMidEdgeNodes[2][3], t2.Times(g.g3) + t3.Times(g.g2));
}

// Returns a e + p tr(e) I.
HWY_INLINE Symmetric StressOf(const Symmetric& e, Values a, Values p) {
  const Values pressure = hn::Mul(p, TraceOf(e));
  return {hn::MulAdd(a, e.xx, pressure),
          hn::MulAdd(a, e.yy, pressure),
          hn::MulAdd(a, e.zz, pressure),
          hn::Mul(a, e.xy),
          hn::Mul(a, e.xz),
          hn::Mul(a, e.yz)};
}

// Adds `count` elements from the first on, an element in each lane.
template <bool kIsSum>
HWY_INLINE void AddElements(const QuadraticPass& pass, std::ptrdiff_t first,
                            std::ptrdiff_t count) {
  const int* const elements = pass.elements + 10 * first;
  const Barycentric g(Corners(elements, count, pass.positions, 0, 3), count);
  const Lanes d;
  Values a = hn::Zero(d);
  Values p = hn::Zero(d);
  if (kIsSum) {
    a = hn::LoadU(d, pass.coefficients_of_a + first);
    p = hn::LoadU(d, pass.coefficients_of_p + first);
  }
  const Nodes nodes(elements, count, pass.records, pass.first_node,
                    kIsSum ? kSizeForSum : kSizeForProducts);
  const VertexStrains e(nodes, g);
  if (kIsSum) {
    AddForces(nodes, kFour, g, StressOf(e.e0, a, p), StressOf(e.e1, a, p),
              StressOf(e.e2, a, p), StressOf(e.e3, a, p));
  } else {
    AddForces(nodes, kFour, g, e.e0, e.e1, e.e2, e.e3);
    AddForces(nodes, 2 * kFour, g, Scalar{TraceOf(e.e0)}, Scalar{TraceOf(e.e1)},
              Scalar{TraceOf(e.e2)}, Scalar{TraceOf(e.e3)});
  }
}

template <bool kIsSum>
void AddAllElements(const QuadraticPass& pass) {
  std::ptrdiff_t first = 0;
  for (; first + kLanes <= pass.num_elements; first += kLanes) {
    AddElements<kIsSum>(pass, first, kLanes);
  }
  if (first < pass.num_elements) {
    AddElements<kIsSum>(pass, first, pass.num_elements - first);
  }
}

void RunQuadraticPass(const QuadraticPass& pass) {
  if (pass.coefficients_of_a != nullptr) {
    AddAllElements<true>(pass);
  } else {
    AddAllElements<false>(pass);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(RunQuadraticPass);

void RunBestPass(const QuadraticPass& pass) {
  HWY_DYNAMIC_DISPATCH(RunQuadraticPass)(pass);
}

}  // namespace

void MultiplyQuadraticTetrahedra(const QuadraticMesh& mesh,
                                 const Eigen::MatrixXd& displacement,
                                 StiffnessProducts& products) {
  assert(mesh.Kind() == ElementKind::kTet10);
  MultiplyByPass(mesh, displacement, RunBestPass, products);
}

Eigen::MatrixXd MultiplyQuadraticTetrahedra(
    const QuadraticMesh& mesh, const Eigen::Matrix2Xd& coefficients,
    const Eigen::MatrixXd& displacement) {
  assert(mesh.Kind() == ElementKind::kTet10);
  return MultiplyByPass(mesh, coefficients, displacement, RunBestPass);
}

}  // namespace elastimate
#endif
