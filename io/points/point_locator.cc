#include "elastimate/io/points/point_locator.h"

#include <vtkCell.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/io/points/curved_locator.h"
#include "elastimate/io/points/point_grid.h"

namespace elastimate {
namespace {

// How far parametric coordinates of VTK, 0 to 1 in every element, are outside.
double Excess(ElementKind kind, const Eigen::Vector3d& parametric) {
  const auto p = parametric.head(DimensionOf(kind));
  const double beyond = IsSimplex(kind) ? p.sum() - 1 : p.maxCoeff() - 1;
  return std::max({0.0, -p.minCoeff(), beyond});
}

Eigen::VectorXd ToLocal(ElementKind kind, const Eigen::Vector3d& parametric) {
  const Eigen::VectorXd p =
      parametric.head(DimensionOf(kind)).cwiseMax(0.0).cwiseMin(1.0);
  if (!IsSimplex(kind)) {
    return 2 * p.array() - 1;
  }
  return p / std::max(1.0, p.sum());
}

}  // namespace

// VTK's own FindCell takes elements that a point is a thousandth outside of.
struct PointLocator::Grid {
  struct Place {
    vtkIdType element = -1;
    Eigen::Vector3d parametric = Eigen::Vector3d::Zero();
    double excess = std::numeric_limits<double>::infinity();
  };

  ElementKind kind;
  vtkNew<vtkUnstructuredGrid> cells;
  vtkNew<vtkStaticCellLocator> locator;
  std::optional<CurvedLocator> curved;  // Which needs none of these two.

  // Among the elements around it the one that a point is least outside of.
  Place PlaceOf(Eigen::Vector3d x, vtkGenericCell* cell) const {
    const double margin = kRoundingOfPlaces * cells->GetLength();
    double box[6] = {x(0) - margin, x(0) + margin, x(1) - margin,
                     x(1) + margin, x(2) - margin, x(2) + margin};
    vtkNew<vtkIdList> candidates;
    locator->FindCellsWithinBounds(box, candidates);
    std::vector<double> weights(TopologyOf(kind).num_nodes);
    Place best;
    for (vtkIdType i = 0; i < candidates->GetNumberOfIds(); ++i) {
      Place place;
      place.element = candidates->GetId(i);
      cells->GetCell(place.element, cell);
      Eigen::Vector3d closest;
      int part = 0;
      double squared_distance = 0;
      if (cell->EvaluatePosition(x.data(), closest.data(), part,
                                 place.parametric.data(), squared_distance,
                                 weights.data()) < 0) {
        continue;
      }
      place.excess = Excess(kind, place.parametric);
      if (place.excess < best.excess) {
        best = place;
      }
    }
    return best;
  }
};

PointLocator::PointLocator(const Mesh& mesh) : grid_(new Grid) {
  grid_->kind = mesh.kind;
  if (IsCurved(mesh.kind)) {
    grid_->curved.emplace(mesh);
    return;
  }
  SetCells(mesh, grid_->cells);
  grid_->locator->SetDataSet(grid_->cells);
  grid_->locator->BuildLocator();
}

PointLocator::~PointLocator() = default;
PointLocator::PointLocator(PointLocator&&) noexcept = default;
PointLocator& PointLocator::operator=(PointLocator&&) noexcept = default;

LocatedPoints PointLocator::Locate(const Eigen::MatrixXd& positions) const {
  const Eigen::Index n = positions.cols();
  LocatedPoints located = {
      {Eigen::VectorXi(n), Eigen::MatrixXd(positions.rows(), n)},
      Eigen::VectorXd::Zero(n)};
  if (grid_->curved) {
    for (Eigen::Index point = 0; point < n; ++point) {
      const CurvedPlace place =
          grid_->curved->Find(ToSpace(positions.col(point)));
      located.points.elements(point) = static_cast<int>(place.element);
      located.points.local.col(point) = place.local;
      located.distance(point) = place.distance;
    }
    return located;
  }
  vtkNew<vtkGenericCell> cell;
  for (Eigen::Index point = 0; point < n; ++point) {
    Eigen::Vector3d x = ToSpace(positions.col(point));
    Grid::Place place = grid_->PlaceOf(x, cell);
    if (!(place.excess < kRoundingOfPlaces)) {
      Eigen::Vector3d closest;
      vtkIdType element = -1;
      int part = 0;
      double squared_distance = 0;
      grid_->locator->FindClosestPoint(x.data(), closest.data(), cell, element,
                                       part, squared_distance);
      located.distance(point) = std::sqrt(squared_distance);
      place = grid_->PlaceOf(closest, cell);
    }
    located.points.elements(point) = static_cast<int>(place.element);
    located.points.local.col(point) = ToLocal(grid_->kind, place.parametric);
  }
  return located;
}

}  // namespace elastimate
