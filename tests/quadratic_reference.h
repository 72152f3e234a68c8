#ifndef ELASTIMATE_TESTS_QUADRATIC_REFERENCE_H_
#define ELASTIMATE_TESTS_QUADRATIC_REFERENCE_H_

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate::testing {

/// The mesh with a node in the middle of each edge, in VTK's order; the
/// mid-edge nodes are numbered as the elements come by.
Mesh WithMidEdgeNodes(const Mesh& mesh);

/// The quadratic shape functions of an element: polynomials of degree 2 that
/// are 1 at one of the ten nodes and 0 at the others, from the inverse of the
/// matrix of monomials at the nodes.  Shares no code with the library.
class QuadraticShapeFunctions {
 public:
  QuadraticShapeFunctions(const Mesh& mesh, Eigen::Index element);

  double Volume() const { return volume_; }
  /// The position of a point given in barycentric coordinates.
  Eigen::Vector3d Position(const Eigen::Vector4d& barycentric) const {
    return nodes_.leftCols<4>() * barycentric;
  }
  Eigen::Matrix<double, 10, 1> Values(const Eigen::Vector3d& x) const {
    return (Monomials(Local(x)) * coefficients_).transpose();
  }
  /// 10 x 3.
  Eigen::Matrix<double, 10, 3> Gradients(const Eigen::Vector3d& x) const;
  /// Strain-displacement matrix, engineering shear strains xy, yz, zx.
  Eigen::Matrix<double, 6, 30> StrainDisplacement(
      const Eigen::Vector3d& x) const;

 private:
  Eigen::Vector3d Local(const Eigen::Vector3d& x) const {
    return (x - origin_) / size_;
  }
  static Eigen::Matrix<double, 1, 10> Monomials(const Eigen::Vector3d& y) {
    Eigen::Matrix<double, 1, 10> monomials;
    monomials << 1, y.transpose(), y.cwiseAbs2().transpose(), y(0) * y(1),
        y(1) * y(2), y(2) * y(0);
    return monomials;
  }

  Eigen::Matrix<double, 3, 10> nodes_;
  Eigen::Vector3d origin_;
  double size_;
  Eigen::Matrix<double, 10, 10> coefficients_;
  double volume_;
};

/// Four points of the interval from 0 to 1 and their weights; exact for
/// polynomials of degree 7.
struct GaussPoints {
  std::array<double, 4> point;
  std::array<double, 4> weight;

  GaussPoints() {
    const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(6.0 / 5));
    const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(6.0 / 5));
    point = {(1 - outer) / 2, (1 - inner) / 2, (1 + inner) / 2,
             (1 + outer) / 2};
    const double small = (18 - std::sqrt(30.0)) / 72;
    const double large = (18 + std::sqrt(30.0)) / 72;
    weight = {small, large, large, small};
  }
};

/// Calls visit(barycentric coordinates, weight) at 4 x 4 x 4 Gauss points of
/// the cube collapsed onto the tetrahedron; exact for polynomials of degree 5.
/// The weights add up to 1.
template <typename Visitor>
void ForEachGaussPoint(const Visitor& visit) {
  const auto [point, weight] = GaussPoints();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) {
        const double a = point[i];
        const double b = (1 - a) * point[j];
        const double c = (1 - a) * (1 - point[j]) * point[k];
        visit(Eigen::Vector4d(1 - a - b - c, a, b, c),
              6 * weight[i] * weight[j] * weight[k] * (1 - a) * (1 - a) *
                  (1 - point[j]));
      }
    }
  }
}

/// u_i = x . A_i x / 2 + g_i . x + c_i: what quadratic elements represent
/// exactly, under a uniform body force.
struct QuadraticField {
  Eigen::Matrix3d curvature[3];  ///< A_i, symmetric.
  Eigen::Matrix3d gradient;      ///< Row i is g_i.
  Eigen::Vector3d shift;

  QuadraticField() : shift(0.1, -0.2, 0.3) {
    curvature[0] << 0.3, -0.1, 0.2, -0.1, 0.4, 0.1, 0.2, 0.1, -0.2;
    curvature[1] << -0.2, 0.3, 0.1, 0.3, 0.1, -0.4, 0.1, -0.4, 0.5;
    curvature[2] << 0.1, 0.2, -0.3, 0.2, -0.5, 0.2, -0.3, 0.2, 0.4;
    gradient << 0.1, 0.2, -0.3, 0.4, -0.5, 0.6, 0.7, 0.8, 0.9;
  }

  Eigen::Vector3d Displacement(const Eigen::Vector3d& x) const {
    Eigen::Vector3d u = gradient * x + shift;
    for (int i = 0; i < 3; ++i) {
      u(i) += x.dot(curvature[i] * x) / 2;
    }
    return u;
  }
  Eigen::MatrixXd Displacements(const Eigen::MatrixXd& nodes) const {
    Eigen::MatrixXd u(3, nodes.cols());
    for (Eigen::Index node = 0; node < nodes.cols(); ++node) {
      u.col(node) = Displacement(nodes.col(node));
    }
    return u;
  }
  /// -div sigma = -mu Laplacian(u) - (lambda + mu) grad(div u).
  Eigen::Vector3d BodyForce(double lambda, double mu) const {
    Eigen::Vector3d laplacian;
    Eigen::Vector3d gradient_of_divergence = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      laplacian(i) = curvature[i].trace();
      gradient_of_divergence += curvature[i].col(i);
    }
    return -mu * laplacian - (lambda + mu) * gradient_of_divergence;
  }
};

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_QUADRATIC_REFERENCE_H_
