#include "elastimate/io/mesh/simplices.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>

#include "elastimate/core/mesh/element_kind.h"

namespace elastimate {
namespace {

CellShape ShapeOfKind(ElementKind kind) {
  const ElementTopology& topology = TopologyOf(kind);
  return {topology.shape,        topology.shapes, topology.dimension,
          topology.num_vertices, topology.faces,  topology.edges};
}

const std::array<CellShape, 6>& CellShapes() {
  static const std::array<CellShape, 6> shapes = {
      ShapeOfKind(ElementKind::kTri3),
      ShapeOfKind(ElementKind::kQuad4),
      ShapeOfKind(ElementKind::kTet4),
      CellShape{
          "pyramid",
          "pyramids",
          3,
          5,
          {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}},
          {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
      CellShape{
          "wedge",
          "wedges",
          3,
          6,
          {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
          {{0, 1},
           {1, 2},
           {2, 0},
           {3, 4},
           {4, 5},
           {5, 3},
           {0, 3},
           {1, 4},
           {2, 5}}},
      ShapeOfKind(ElementKind::kHex8)};
  return shapes;
}

/// The volume of a simplex (in the plane the area of a triangle), with its
/// sign, times a positive number.
double SignedVolume(const Eigen::Matrix3Xd& corners) {
  const Eigen::Vector3d a = corners.col(1) - corners.col(0);
  const Eigen::Vector3d b = corners.col(2) - corners.col(0);
  return corners.cols() == 3 ? a.cross(b).z()
                             : a.cross(b).dot(corners.col(3) - corners.col(0));
}

}  // namespace

const CellShape* FindCellShape(int dimension, int num_vertices) {
  const auto& shapes = CellShapes();
  const auto* const found =
      std::find_if(shapes.begin(), shapes.end(), [&](const CellShape& shape) {
        return shape.dimension == dimension &&
               shape.num_vertices == num_vertices;
      });
  return found == shapes.end() ? nullptr : found;
}

template <typename Node>
std::vector<std::vector<Node>> CutFace(const std::vector<Node>& face) {
  if (face.size() == 2) {
    return face[0] == face[1] ? std::vector<std::vector<Node>>()
                              : std::vector<std::vector<Node>>{face};
  }
  std::vector<Node> pulled = face;
  std::rotate(pulled.begin(), std::min_element(pulled.begin(), pulled.end()),
              pulled.end());
  std::vector<std::vector<Node>> triangles;
  for (std::size_t i = 1; i + 1 < pulled.size(); ++i) {
    const Node a = pulled[i];
    const Node b = pulled[i + 1];
    if (a != b && a != pulled[0] && b != pulled[0]) {
      triangles.push_back({pulled[0], a, b});
    }
  }
  return triangles;
}

template std::vector<std::vector<int>> CutFace(const std::vector<int>&);
template std::vector<std::vector<std::size_t>> CutFace(
    const std::vector<std::size_t>&);

std::size_t Simplices::Add(const CellShape& shape,
                           const std::vector<int>& nodes) {
  const int apex = *std::min_element(nodes.begin(), nodes.end());
  const std::size_t before = cells_.size();
  for (const std::vector<int>& places : shape.faces) {
    std::vector<int> face;
    face.reserve(places.size());
    for (const int place : places) {
      face.push_back(nodes[place]);
    }
    if (std::find(face.begin(), face.end(), apex) != face.end()) {
      continue;
    }
    for (const std::vector<int>& base : CutFace(face)) {
      nodes_.push_back(apex);
      nodes_.insert(nodes_.end(), base.begin(), base.end());
      cells_.push_back(shapes_.size());
    }
  }
  shapes_.push_back(&shape);
  std::vector<int> sorted = nodes;
  std::sort(sorted.begin(), sorted.end());
  const bool is_collapsed =
      std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  are_collapsed_.push_back(is_collapsed ? 1 : 0);
  return cells_.size() - before;
}

Eigen::MatrixXi Simplices::Elements() const {
  return Eigen::Map<const Eigen::MatrixXi>(nodes_.data(), dimension_ + 1,
                                           Eigen::Index(cells_.size()));
}

std::optional<std::size_t> Simplices::FirstFolded(
    const Eigen::Matrix3Xd& positions) const {
  const Eigen::MatrixXi elements = Elements();
  std::vector<double> sign(shapes_.size(), 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const double volume =
        SignedVolume(positions(Eigen::all, elements.col(Eigen::Index(i))));
    double& of_cell = sign[cells_[i]];
    if (volume * of_cell < 0) {
      return cells_[i];
    }
    of_cell = volume < 0 ? -1 : 1;
  }
  const auto none = std::find(sign.begin(), sign.end(), 0);
  return none == sign.end() ? std::nullopt
                            : std::optional<std::size_t>(none - sign.begin());
}

std::string Simplices::Notice() const {
  std::map<int, std::size_t> counts;
  std::map<int, std::size_t> collapsed;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    ++counts[-shapes_[i]->num_vertices];
    collapsed[-shapes_[i]->num_vertices] += are_collapsed_[i] != 0 ? 1 : 0;
  }
  std::string cells;
  std::size_t left = counts.size();
  for (const auto& [vertices, count] : counts) {
    const CellShape& shape = *FindCellShape(dimension_, -vertices);
    const bool is_last = --left == 0;
    cells += (cells.empty() ? ""
              : is_last     ? " and "
                            : ", ") +
             std::to_string(count) + " " +
             std::string(count == 1 ? shape.name : shape.plural);
    if (const std::size_t some = collapsed[vertices]; some > 0) {
      cells += (count == 1 ? " (" : " (" + std::to_string(some) + " of them ") +
               std::string("with collapsed edges)");
    }
  }
  return cells + (shapes_.size() == 1 ? " is" : " are") + " read as " +
         std::to_string(cells_.size()) + " " +
         (dimension_ == 3 ? "tetrahedra" : "triangles") +
         " with the same nodes";
}

}  // namespace elastimate
