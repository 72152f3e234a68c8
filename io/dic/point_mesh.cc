#include "elastimate/io/dic/point_mesh.h"

#include <vtkCellArray.h>
#include <vtkDelaunay2D.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace elastimate {
namespace {

using Elements = std::vector<std::vector<int>>;

// A point farther than this share of the spacing from its place is off the
// grid.
constexpr double kOffGrid = 0.02;
// The least height of a triangle of the rim, over its longest edge.
constexpr double kLeastHeight = 0.2;
// Below this height over its longest edge, a triangle is of points on a line.
constexpr double kFlat = 1e-6;
// An edge bridges a gap if it is longer than kGap times the length below which
// kMost of the edges are.
constexpr double kMost = 0.9;
constexpr double kGap = 1.5;

/// Coordinates along one axis as multiples of a spacing.
struct GridAxis {
  double first;
  double spacing;

  double Place(double x) const { return (x - first) / spacing; }
  bool Has(double x) const {
    return std::abs(Place(x) - std::round(Place(x))) < kOffGrid;
  }
};

// The spacing is the least difference of coordinates that are not the same.
GridAxis AxisOf(const Eigen::RowVectorXd& coordinates) {
  std::vector<double> sorted(coordinates.begin(), coordinates.end());
  std::sort(sorted.begin(), sorted.end());
  const double range = sorted.back() - sorted.front();
  const double same = kOffGrid * range / static_cast<double>(sorted.size());
  double spacing = range;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double difference = sorted[i] - sorted[i - 1];
    if (difference > same) {
      spacing = std::min(spacing, difference);
    }
  }
  return {sorted.front(), spacing};
}

using GridPlace = std::array<long long, 2>;

/// Points at places of a grid along the axes.
struct PointGrid {
  std::array<GridAxis, 2> axes;
  std::map<GridPlace, int> point_at;

  Eigen::Matrix2Xd Positions(const std::vector<GridPlace>& places) const {
    Eigen::Matrix2Xd positions(2, Eigen::Index(places.size()));
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (int i = 0; i < 2; ++i) {
        positions(i, Eigen::Index(k)) =
            axes[i].first + axes[i].spacing * static_cast<double>(places[k][i]);
      }
    }
    return positions;
  }
};

// Returns nothing when a point is off the grid.
std::optional<PointGrid> GridOf(const Eigen::Matrix2Xd& positions) {
  if (positions.cols() == 0) {
    return std::nullopt;
  }
  PointGrid grid = {{AxisOf(positions.row(0)), AxisOf(positions.row(1))}, {}};
  for (Eigen::Index point = 0; point < positions.cols(); ++point) {
    GridPlace place = {};
    for (int i = 0; i < 2; ++i) {
      if (!(grid.axes[i].spacing > 0) ||
          !grid.axes[i].Has(positions(i, point))) {
        return std::nullopt;
      }
      place[i] = std::llround(grid.axes[i].Place(positions(i, point)));
    }
    if (!grid.point_at.emplace(place, static_cast<int>(point)).second) {
      return std::nullopt;
    }
  }
  return grid;
}

// Returns a quadrilateral wherever four points are the corners of a cell, and
// none when a point is off the grid.
Elements QuadrilateralsOf(const Eigen::Matrix2Xd& positions) {
  const std::optional<PointGrid> grid = GridOf(positions);
  if (!grid) {
    return {};
  }
  Elements elements;
  for (const auto& [place, point] : grid->point_at) {
    const auto [i, j] = place;
    std::vector<int> corners;
    for (const GridPlace& corner :
         {place, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
      const auto found = grid->point_at.find(corner);
      if (found != grid->point_at.end()) {
        corners.push_back(found->second);
      }
    }
    if (corners.size() == 4) {
      elements.push_back(corners);
    }
  }
  return elements;
}

// Returns the places without a point in the box of the grid; none where points
// are too few for a box.
std::set<GridPlace> EmptyPlaces(const PointGrid& grid) {
  // Points have to fill at least one place in so many of the box of the grid.
  constexpr long long kSparsest = 8;
  GridPlace end = {0, 0};
  for (const auto& [place, point] : grid.point_at) {
    end = {std::max(end[0], place[0]), std::max(end[1], place[1])};
  }
  std::set<GridPlace> empty;
  const auto num_points = static_cast<long long>(grid.point_at.size());
  if (end[0] + 1 > kSparsest * num_points / (end[1] + 1)) {
    return empty;
  }
  for (long long i = 0; i <= end[0]; ++i) {
    for (long long j = 0; j <= end[1]; ++j) {
      if (grid.point_at.count({i, j}) == 0) {
        empty.insert({i, j});
      }
    }
  }
  return empty;
}

// Returns the places without a point that are connected to `first` and lie
// within the box of the grid, and removes them from `empty`.
std::vector<GridPlace> TakeGap(const GridPlace& first,
                               std::set<GridPlace>& empty) {
  std::vector<GridPlace> gap = {first};
  empty.erase(first);
  for (std::size_t k = 0; k < gap.size(); ++k) {
    const auto [i, j] = gap[k];
    for (const GridPlace& next : std::array<GridPlace, 4>{
             {{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}}}) {
      if (empty.erase(next) > 0) {
        gap.push_back(next);
      }
    }
  }
  return gap;
}

// Returns the places of `empty` that lie between two points of the same column
// (axis 1) or row (axis 0), in gaps of at most `most` places.
std::set<GridPlace> BetweenPoints(const PointGrid& grid,
                                  const std::set<GridPlace>& empty,
                                  std::size_t axis, long long most) {
  std::set<GridPlace> between;
  for (const GridPlace& place : empty) {
    std::array<long long, 2> distance = {1, 1};
    for (const int side : {0, 1}) {
      GridPlace next = place;
      const long long step = side == 0 ? -1 : 1;
      next[axis] += step;
      while (distance[side] <= most && grid.point_at.count(next) == 0) {
        ++distance[side];
        next[axis] += step;
      }
    }
    if (distance[0] + distance[1] - 1 <= most) {
      between.insert(place);
    }
  }
  return between;
}

// Returns rows or columns that were lost over the whole width of the points,
// and removes them from `empty`.  A slot, which ends at points, is a hole
// instead.
std::vector<GridPlace> TakeLostLines(const PointGrid& grid, long long most,
                                     std::set<GridPlace>& empty) {
  std::vector<GridPlace> lost;
  for (const std::size_t across : {0U, 1U}) {
    std::set<GridPlace> between = BetweenPoints(grid, empty, across, most);
    while (!between.empty()) {
      const std::vector<GridPlace> line = TakeGap(*between.begin(), between);
      const bool ends_at_points =
          std::any_of(line.begin(), line.end(), [&](GridPlace place) {
            --place[1 - across];
            const bool before = grid.point_at.count(place) > 0;
            place[1 - across] += 2;
            return before || grid.point_at.count(place) > 0;
          });
      if (!ends_at_points) {
        lost.insert(lost.end(), line.begin(), line.end());
        for (const GridPlace& place : line) {
          empty.erase(place);
        }
      }
    }
  }
  return lost;
}

double EdgeLength(const Eigen::Matrix2Xd& positions, int a, int b) {
  return (positions.col(a) - positions.col(b)).norm();
}

double LongestEdge(const Eigen::Matrix2Xd& positions,
                   const std::vector<int>& triangle) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    longest = std::max(
        longest, EdgeLength(positions, triangle[i], triangle[(i + 1) % 3]));
  }
  return longest;
}

double TwiceArea(const Eigen::Matrix2Xd& positions,
                 const std::vector<int>& triangle) {
  const Eigen::Vector2d a =
      positions.col(triangle[1]) - positions.col(triangle[0]);
  const Eigen::Vector2d b =
      positions.col(triangle[2]) - positions.col(triangle[0]);
  return a(0) * b(1) - a(1) * b(0);
}

Elements DelaunayTriangles(const Eigen::Matrix2Xd& positions) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& position : positions.colwise()) {
    points->InsertNextPoint(position(0), position(1), 0);
  }
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  vtkNew<vtkDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();
  Elements triangles;
  vtkCellArray* const cells = delaunay->GetOutput()->GetPolys();
  vtkNew<vtkIdList> nodes;
  for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell) {
    cells->GetCellAtId(cell, nodes);
    std::vector<int> triangle = {static_cast<int>(nodes->GetId(0)),
                                 static_cast<int>(nodes->GetId(1)),
                                 static_cast<int>(nodes->GetId(2))};
    if (TwiceArea(positions, triangle) < 0) {
      std::swap(triangle[1], triangle[2]);
    }
    const double longest = LongestEdge(positions, triangle);
    if (TwiceArea(positions, triangle) > kFlat * longest * longest) {
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

// Returns the elements of each edge.
std::map<std::pair<int, int>, std::vector<std::size_t>> ElementsOfEdges(
    const Elements& elements) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> of_edges;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::vector<int>& nodes = elements[e];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      of_edges[std::minmax({nodes[i], nodes[(i + 1) % nodes.size()]})]
          .push_back(e);
    }
  }
  return of_edges;
}

// Returns the triangles without the slivers that Delaunay's hull adds where the
// rim of the points is not convex.
Elements WithoutSlivers(const Eigen::Matrix2Xd& positions, Elements triangles) {
  for (bool has_slivers = true; has_slivers;) {
    std::vector<bool> is_sliver(triangles.size(), false);
    for (const auto& [edge, of_edge] : ElementsOfEdges(triangles)) {
      const std::vector<int>& triangle = triangles[of_edge.front()];
      const double longest = LongestEdge(positions, triangle);
      is_sliver[of_edge.front()] =
          is_sliver[of_edge.front()] ||
          (of_edge.size() == 1 &&
           TwiceArea(positions, triangle) < kLeastHeight * longest * longest);
    }
    Elements others;
    for (std::size_t e = 0; e < triangles.size(); ++e) {
      if (!is_sliver[e]) {
        others.push_back(triangles[e]);
      }
    }
    has_slivers = others.size() < triangles.size();
    triangles = std::move(others);
  }
  return triangles;
}

// Returns the largest set of elements that are connected by edges.
Elements LargestPart(const Elements& elements) {
  boost::disjoint_sets_with_storage<> parts(elements.size());
  for (const auto& [edge, of_edge] : ElementsOfEdges(elements)) {
    for (const std::size_t e : of_edge) {
      parts.union_set(e, of_edge.front());
    }
  }
  std::vector<std::size_t> size(elements.size(), 0);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    ++size[parts.find_set(e)];
  }
  const std::size_t largest = static_cast<std::size_t>(
      std::max_element(size.begin(), size.end()) - size.begin());
  Elements part;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (parts.find_set(e) == largest) {
      part.push_back(elements[e]);
    }
  }
  return part;
}

double DefaultMaxEdge(const Eigen::Matrix2Xd& positions,
                      const Elements& triangles) {
  std::vector<double> lengths;
  for (const auto& [edge, of_edge] : ElementsOfEdges(triangles)) {
    lengths.push_back(EdgeLength(positions, edge.first, edge.second));
  }
  if (lengths.empty()) {
    return 0;
  }
  const auto most =
      lengths.begin() +
      static_cast<std::ptrdiff_t>(kMost * static_cast<double>(lengths.size()));
  std::nth_element(lengths.begin(), most, lengths.end());
  return kGap * *most;
}

bool AreOnALine(const Eigen::Matrix2Xd& positions) {
  const Eigen::Matrix2Xd centred =
      positions.colwise() - positions.rowwise().mean();
  const Eigen::Matrix2d moments = centred * centred.transpose();
  constexpr double kRounding = 1e-12;
  return !(moments.determinant() >
           kRounding * moments.trace() * moments.trace());
}

// Numbers the nodes that elements use.
PointMesh Number(ElementKind kind, const Elements& elements) {
  PointMesh mesh;
  mesh.kind = kind;
  for (const std::vector<int>& element : elements) {
    mesh.points.insert(mesh.points.end(), element.begin(), element.end());
  }
  std::sort(mesh.points.begin(), mesh.points.end());
  mesh.points.erase(std::unique(mesh.points.begin(), mesh.points.end()),
                    mesh.points.end());
  mesh.elements.resize(TopologyOf(kind).num_nodes,
                       Eigen::Index(elements.size()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t i = 0; i < elements[e].size(); ++i) {
      mesh.elements(Eigen::Index(i), Eigen::Index(e)) =
          static_cast<int>(std::lower_bound(mesh.points.begin(),
                                            mesh.points.end(), elements[e][i]) -
                           mesh.points.begin());
    }
  }
  return mesh;
}

}  // namespace

GridGaps GapsOf(const Eigen::Matrix2Xd& positions) {
  // A hole of more places would change E by more than a few per cent.
  constexpr std::size_t kMostLost = 2;
  constexpr long long kMostLines = 4;
  const std::optional<PointGrid> grid = GridOf(positions);
  GridGaps gaps;
  gaps.lost.resize(2, 0);
  if (!grid) {
    return gaps;
  }
  std::set<GridPlace> empty = EmptyPlaces(*grid);
  std::vector<GridPlace> lost = TakeLostLines(*grid, kMostLines, empty);
  while (!empty.empty()) {
    const std::vector<GridPlace> gap = TakeGap(*empty.begin(), empty);
    if (gap.size() <= kMostLost) {
      lost.insert(lost.end(), gap.begin(), gap.end());
    } else if (2 * Eigen::Index(gap.size()) < positions.cols()) {
      gaps.doubtful.push_back(grid->Positions(gap));
    }
  }
  gaps.lost = grid->Positions(lost);
  std::stable_sort(
      gaps.doubtful.begin(), gaps.doubtful.end(),
      [](const auto& a, const auto& b) { return a.cols() > b.cols(); });
  return gaps;
}

PointMesh MeshOfPoints(const Eigen::Matrix2Xd& positions,
                       std::optional<double> max_edge) {
  if (positions.cols() < 3) {
    throw std::invalid_argument(
        "there are fewer than three points, too few for a mesh; give more");
  }
  if (AreOnALine(positions)) {
    throw std::invalid_argument(
        "all points lie on one line, which makes no mesh; check the "
        "columns of the positions");
  }
  const Elements quadrilaterals = QuadrilateralsOf(positions);
  if (!quadrilaterals.empty()) {
    return Number(ElementKind::kQuad4, LargestPart(quadrilaterals));
  }
  Elements triangles = DelaunayTriangles(positions);
  const double longest =
      max_edge.value_or(DefaultMaxEdge(positions, triangles));
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(),
                                 [&](const std::vector<int>& triangle) {
                                   return LongestEdge(positions, triangle) >
                                          longest;
                                 }),
                  triangles.end());
  triangles = WithoutSlivers(positions, std::move(triangles));
  if (triangles.empty()) {
    throw std::invalid_argument("no triangle of points has edges up to " +
                                std::to_string(longest) +
                                "; give a larger \"max_edge\"");
  }
  PointMesh mesh = Number(ElementKind::kTri3, LargestPart(triangles));
  mesh.max_edge = longest;
  return mesh;
}

}  // namespace elastimate
