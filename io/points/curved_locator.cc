#include "elastimate/io/points/curved_locator.h"

#include <vtkCell.h>
#include <vtkIdList.h>
#include <vtkPoints.h>
#include <vtkTetra.h>
#include <vtkTriangle.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "elastimate/core/mesh/linear_mesh.h"
#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/io/points/point_grid.h"

namespace elastimate {
namespace {

// Returns the place in one element that is nearest to a point, beginning at
// `local`.
template <ElementKind kKind>
CurvedPlace NearestIn(const Mesh& mesh, Eigen::Index element,
                      const Eigen::Vector3d& x, const Eigen::VectorXd& local) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  constexpr int kMostSteps = 50;
  constexpr double kConverged = 1e-14;
  using Vector = Eigen::Matrix<double, kDimension, 1>;
  const auto nodes = GatherMapNodes<kKind>(mesh, element);
  const Eigen::MatrixXd reference = ReferenceNodes(kKind);
  vtkNew<std::conditional_t<kDimension == 3, vtkTetra, vtkTriangle>> tangent;
  Vector xi = local;
  Vector position;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto at = ShapeFunctionsAt<kKind>(xi, 1);
    const Eigen::Matrix<double, kDimension, kDimension> jacobian =
        nodes * at.MapGradient().transpose();
    position = nodes * at.value;
    for (int i = 0; i <= kDimension; ++i) {
      tangent->GetPoints()->SetPoint(
          i, ToSpace(position + jacobian * (reference.col(i) - xi)).data());
    }
    Eigen::Vector3d closest;
    Eigen::Vector3d parametric;
    int part = 0;
    double squared_distance = 0;
    std::array<double, 4> weights;
    const int status = tangent->EvaluatePosition(
        x.data(), closest.data(), part, parametric.data(), squared_distance,
        weights.data());
    if (status < 0) {
      break;
    }
    if (status == 1) {
      closest = x;  // Which VTK leaves out of account inside of a triangle.
    }
    const Vector last = xi;
    xi += jacobian.inverse() * (closest.template head<kDimension>() - position);
    xi = xi.cwiseMax(0.0);
    xi /= std::max(1.0, xi.sum());
    if (!((xi - last).norm() > kConverged)) {
      break;
    }
  }
  position = nodes * ShapeFunctionsAt<kKind>(xi, 1).value;
  return {element, xi, (x.head<kDimension>() - position).norm()};
}

}  // namespace

CurvedLocator::CurvedLocator(const Mesh& mesh) : mesh_(mesh) {
  const LinearMesh cuts(mesh_);
  const Mesh& simplices = cuts.Parts();
  num_cuts_ = simplices.NumElements() / mesh.NumElements();
  SetCells(simplices, simplices_);
  locator_->SetDataSet(simplices_);
  locator_->BuildLocator();
  rounding_ = kRoundingOfPlaces * simplices_->GetLength();

  const Eigen::MatrixXd reference = ReferenceNodes(mesh.kind);
  starts_.setZero(mesh.Dimension(), simplices.NumElements());
  for (Eigen::Index i = 0; i < simplices.NumElements(); ++i) {
    const auto nodes = mesh.elements.col(i / num_cuts_);
    for (const int node : simplices.elements.col(i)) {
      starts_.col(i) +=
          reference.col(std::find(nodes.begin(), nodes.end(), node) -
                        nodes.begin()) /
          double(simplices.elements.rows());
    }
  }
  // The sum over the edges of 4 lambda_a lambda_b is 3 / 2 at most.
  const ElementTopology& topology = mesh.Topology();
  for (const auto& nodes : mesh.elements.colwise()) {
    for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
      const auto [a, b] = topology.edges[i - topology.num_vertices];
      margin_ = std::max(margin_, 1.5 * (mesh.nodes.col(nodes(i)) -
                                         0.5 * (mesh.nodes.col(nodes(a)) +
                                                mesh.nodes.col(nodes(b))))
                                            .norm());
    }
  }
}

CurvedPlace CurvedLocator::NearestWithin(Eigen::Vector3d x,
                                         double reach) const {
  double box[6] = {x(0) - reach, x(0) + reach, x(1) - reach,
                   x(1) + reach, x(2) - reach, x(2) + reach};
  vtkNew<vtkIdList> candidates;
  locator_->FindCellsWithinBounds(box, candidates);
  CurvedPlace best;
  for (vtkIdType i = 0; i < candidates->GetNumberOfIds(); ++i) {
    const Eigen::Index simplex = candidates->GetId(i);
    const Eigen::Index element = simplex / num_cuts_;
    const CurvedPlace place =
        mesh_.Dimension() == 3 ? NearestIn<ElementKind::kCurvedTet10>(
                                     mesh_, element, x, starts_.col(simplex))
                               : NearestIn<ElementKind::kCurvedTri6>(
                                     mesh_, element, x, starts_.col(simplex));
    if (place.distance < best.distance) {
      best = place;
    }
    if (best.distance <= rounding_) {
      break;
    }
  }
  return best;
}

CurvedPlace CurvedLocator::Find(Eigen::Vector3d x) const {
  // A point mostly lies in the element of the simplex in which it lies.
  CurvedPlace place = NearestWithin(x, rounding_);
  if (!(place.distance <= rounding_)) {
    place = NearestWithin(x, margin_ + rounding_);
  }
  if (!(place.distance <= rounding_)) {
    vtkNew<vtkGenericCell> cell;
    Eigen::Vector3d closest;
    vtkIdType simplex = -1;
    int part = 0;
    double squared_distance = 0;
    locator_->FindClosestPoint(x.data(), closest.data(), cell, simplex, part,
                               squared_distance);
    // The nearest place is at most one margin further away than the nearest
    // place of the simplices, and its own simplex another margin.
    place =
        NearestWithin(x, std::sqrt(squared_distance) + 2 * margin_ + rounding_);
  }
  if (place.distance <= rounding_) {
    place.distance = 0;
  }
  return place;
}

}  // namespace elastimate
