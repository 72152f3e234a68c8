#include "elastimate/core/mesh/mesh_points.h"

#include <algorithm>
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

using UnitDistribution = std::uniform_real_distribution<double>;

// Draws a point evenly in the reference element.
template <ElementKind kKind>
auto DrawReferencePoint(std::mt19937_64& generator) {
  UnitDistribution unit(0, 1);
  Eigen::Matrix<double, ElementSizes<kKind>::kDimension, 1> xi;
  do {
    std::generate(xi.begin(), xi.end(), [&] { return unit(generator); });
  } while (IsSimplex(kKind) && xi.sum() > 1);
  return IsSimplex(kKind) ? xi : decltype(xi)(2 * xi.array() - 1);
}

// Draws a point evenly in the element: a reference point is kept with a
// probability in proportion to the volume that it stands for.  The columns of
// the Jacobian matrix are means of those at the vertices, so that the product
// of their largest lengths bounds its determinant (Hadamard).
template <ElementKind kKind>
auto DrawLocalPoint(const Mesh& mesh, Eigen::Index element,
                    std::mt19937_64& generator) {
  if (IsAffine(kKind)) {
    return DrawReferencePoint<kKind>(generator);
  }
  const auto nodes = GatherMapNodes<kKind>(mesh, element);
  Eigen::Matrix<double, 1, ElementSizes<kKind>::kDimension> longest;
  longest.setZero();
  for (const ShapeFunctions<kKind>& at : VertexRule<kKind>()) {
    longest = longest.cwiseMax(
        (nodes * at.MapGradient().transpose()).colwise().norm());
  }
  UnitDistribution share(0, 1);
  while (true) {
    auto xi = DrawReferencePoint<kKind>(generator);
    const auto at = ShapeFunctionsAt<kKind>(xi, 1);
    if (ElementMap<kKind>(nodes, at, 1).volume_ratio >=
        share(generator) * longest.prod()) {
      return xi;
    }
  }
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

MeshPoints DrawPoints(const Mesh& mesh, Eigen::Index count,
                      std::mt19937_64& generator) {
  const Eigen::VectorXd volumes = ElementVolumes(mesh);
  std::discrete_distribution<int> element(volumes.begin(), volumes.end());
  MeshPoints points = {Eigen::VectorXi(count),
                       Eigen::MatrixXd(mesh.Dimension(), count)};
  VisitElementKind(mesh.kind, [&](auto kind) {
    for (Eigen::Index point = 0; point < count; ++point) {
      points.elements(point) = element(generator);
      points.local.col(point) =
          DrawLocalPoint<kind>(mesh, points.elements(point), generator);
    }
  });
  return points;
}

}  // namespace elastimate
