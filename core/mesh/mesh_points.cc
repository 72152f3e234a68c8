#include "elastimate/core/mesh/mesh_points.h"

#include <stdexcept>
#include <string>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

constexpr double kOutside = 1e-6;

bool IsInReferenceElement(ElementKind kind,
                          const Eigen::Ref<const Eigen::VectorXd>& xi) {
  if (!xi.allFinite()) {
    return false;
  }
  return IsSimplex(kind)
             ? xi.minCoeff() >= -kOutside && xi.sum() <= 1 + kOutside
             : xi.cwiseAbs().maxCoeff() <= 1 + kOutside;
}

}  // namespace

void ValidatePoints(const Mesh& mesh, const MeshPoints& points) {
  if (points.local.rows() != mesh.Dimension() ||
      points.local.cols() != points.Size()) {
    throw std::invalid_argument(
        "the local coordinates of " + std::to_string(points.Size()) +
        " points are " + std::to_string(points.local.rows()) + " x " +
        std::to_string(points.local.cols()) + "; make them dimension x points");
  }
  for (Eigen::Index point = 0; point < points.Size(); ++point) {
    const int element = points.elements(point);
    if (element < 0 || element >= mesh.NumElements()) {
      throw std::invalid_argument(
          "point " + std::to_string(point) + " is in element " +
          std::to_string(element) + ", which does not exist; the mesh has " +
          std::to_string(mesh.NumElements()) + " elements");
    }
    if (!IsInReferenceElement(mesh.kind, points.local.col(point))) {
      throw std::invalid_argument(
          "point " + std::to_string(point) + " does not lie in element " +
          std::to_string(element) + "; correct its local coordinates");
    }
  }
}

Eigen::MatrixXd ShapeFunctionsOf(const Mesh& mesh, const MeshPoints& points) {
  return VisitElementKind(mesh.kind, [&](auto kind) {
    Eigen::MatrixXd values(mesh.elements.rows(), points.Size());
    for (Eigen::Index point = 0; point < points.Size(); ++point) {
      values.col(point) =
          ShapeFunctionsAt<kind>(points.local.col(point), 1).value;
    }
    return values;
  });
}

Eigen::MatrixXd Interpolate(const Mesh& mesh, const MeshPoints& points,
                            const Eigen::MatrixXd& field) {
  const Eigen::MatrixXd values = ShapeFunctionsOf(mesh, points);
  Eigen::MatrixXd interpolated =
      Eigen::MatrixXd::Zero(field.rows(), points.Size());
  for (Eigen::Index point = 0; point < points.Size(); ++point) {
    const auto nodes = mesh.elements.col(points.elements(point));
    for (Eigen::Index i = 0; i < nodes.size(); ++i) {
      interpolated.col(point) += values(i, point) * field.col(nodes(i));
    }
  }
  return interpolated;
}

}  // namespace elastimate
