#include "elastimate/core/stiffness_product.h"

#include <cassert>
#include <cmath>

#include "elastimate/core/quadratic_stiffness_product.h"
#include "elastimate/core/vector_stiffness_product.h"

namespace elastimate {
namespace {

struct Vector {
  double x, y, z;
};

inline Vector Load(const double* p) { return {p[0], p[1], p[2]}; }

inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Vector Cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double Dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline void Add(const Vector& v, double* p) {
  p[0] += v.x;
  p[1] += v.y;
  p[2] += v.z;
}

// Adds -(a + b + c).
inline void AddNegativeSum(const Vector& a, const Vector& b, const Vector& c,
                           double* p) {
  p[0] -= a.x + b.x + c.x;
  p[1] -= a.y + b.y + c.y;
  p[2] -= a.z + b.z + c.z;
}

// What all columns share of one tetrahedron: the cofactors c_i of its edge
// matrix, with grad(N_i) = c_i / det J for i = 1..3 and
// grad(N_0) = -(c_1 + c_2 + c_3) / det J, and V / (det J)^2.
struct ElementGeometry {
  Vector c1, c2, c3;
  double scale;
};

inline ElementGeometry MakeGeometry(const double* nodes, const int* corners) {
  const Vector x0 = Load(nodes + 3 * Eigen::Index(corners[0]));
  const Vector e1 = Load(nodes + 3 * Eigen::Index(corners[1])) - x0;
  const Vector e2 = Load(nodes + 3 * Eigen::Index(corners[2])) - x0;
  const Vector e3 = Load(nodes + 3 * Eigen::Index(corners[3])) - x0;
  ElementGeometry geometry;
  geometry.c1 = Cross(e2, e3);
  geometry.c2 = Cross(e3, e1);
  geometry.c3 = Cross(e1, e2);
  geometry.scale = 1 / (6 * std::abs(Dot(e1, geometry.c1)));
  return geometry;
}

// Adds V e grad(N_i) to `a` and V tr(e) grad(N_i) to `p`.
inline void AddColumn(const ElementGeometry& g, const int* corners,
                      const double* q, double* a, double* p) {
  const Eigen::Index n0 = 3 * Eigen::Index(corners[0]);
  const Eigen::Index n1 = 3 * Eigen::Index(corners[1]);
  const Eigen::Index n2 = 3 * Eigen::Index(corners[2]);
  const Eigen::Index n3 = 3 * Eigen::Index(corners[3]);
  const Vector q0 = Load(q + n0);
  const Vector d1 = Load(q + n1) - q0;
  const Vector d2 = Load(q + n2) - q0;
  const Vector d3 = Load(q + n3) - q0;

  // det J times the strain, shear entries as tensor components.
  const double xx = d1.x * g.c1.x + d2.x * g.c2.x + d3.x * g.c3.x;
  const double yy = d1.y * g.c1.y + d2.y * g.c2.y + d3.y * g.c3.y;
  const double zz = d1.z * g.c1.z + d2.z * g.c2.z + d3.z * g.c3.z;
  const double half = 0.5 * g.scale;
  const double xy = half * (d1.x * g.c1.y + d2.x * g.c2.y + d3.x * g.c3.y +
                            d1.y * g.c1.x + d2.y * g.c2.x + d3.y * g.c3.x);
  const double xz = half * (d1.x * g.c1.z + d2.x * g.c2.z + d3.x * g.c3.z +
                            d1.z * g.c1.x + d2.z * g.c2.x + d3.z * g.c3.x);
  const double yz = half * (d1.y * g.c1.z + d2.y * g.c2.z + d3.y * g.c3.z +
                            d1.z * g.c1.y + d2.z * g.c2.y + d3.z * g.c3.y);
  const double sxx = g.scale * xx;
  const double syy = g.scale * yy;
  const double szz = g.scale * zz;
  const double trace = sxx + syy + szz;

  const auto traction = [&](const Vector& c) {
    return Vector{sxx * c.x + xy * c.y + xz * c.z,
                  xy * c.x + syy * c.y + yz * c.z,
                  xz * c.x + yz * c.y + szz * c.z};
  };
  const auto volumetric = [&](const Vector& c) {
    return Vector{trace * c.x, trace * c.y, trace * c.z};
  };
  const Vector a1 = traction(g.c1);
  const Vector a2 = traction(g.c2);
  const Vector a3 = traction(g.c3);
  AddNegativeSum(a1, a2, a3, a + n0);
  Add(a1, a + n1);
  Add(a2, a + n2);
  Add(a3, a + n3);
  const Vector p1 = volumetric(g.c1);
  const Vector p2 = volumetric(g.c2);
  const Vector p3 = volumetric(g.c3);
  AddNegativeSum(p1, p2, p3, p + n0);
  Add(p1, p + n1);
  Add(p2, p + n2);
  Add(p3, p + n3);
}

void AddLinearStrainProducts(const Mesh& mesh,
                             const Eigen::MatrixXd& displacement,
                             Eigen::MatrixXd& a, Eigen::MatrixXd& p) {
  const Eigen::Index rows = displacement.rows();
  const Eigen::Index columns = displacement.cols();
  const Eigen::Index first =
      AddVectorStrainProducts(mesh, displacement, a, p);
  const int* corners = mesh.elements.data() + 4 * first;
  for (Eigen::Index element = first; element < mesh.NumElements();
       ++element, corners += 4) {
    const ElementGeometry geometry = MakeGeometry(mesh.nodes.data(), corners);
    for (Eigen::Index column = 0; column < columns; ++column) {
      const Eigen::Index offset = column * rows;
      AddColumn(geometry, corners, displacement.data() + offset,
                a.data() + offset, p.data() + offset);
    }
  }
}

}  // namespace

StiffnessProducts MultiplyStiffnessBasis(const Mesh& mesh,
                                         const Eigen::MatrixXd& displacement) {
  assert(displacement.rows() == 3 * mesh.NumNodes());
  StiffnessProducts products;
  products.h = Eigen::MatrixXd::Zero(displacement.rows(), displacement.cols());
  products.j = products.h;
  if (mesh.Order() == 1) {
    AddLinearStrainProducts(mesh, displacement, products.h, products.j);
  } else {
    AddQuadraticStrainProducts(mesh, displacement, products.h, products.j);
  }
  products.j -= 2 * products.h;
  return products;
}

}  // namespace elastimate
