#ifndef ELASTIMATE_TESTS_IO_MIXED_BLOCK_H_
#define ELASTIMATE_TESTS_IO_MIXED_BLOCK_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/mesh/simplices.h"

namespace elastimate {

/// A block of 2 x 2 x 2 unit cells, each a hexahedron, two wedges, or six
/// pyramids around a node in its middle, with distorted inner nodes.
struct MixedBlock {
  struct Cell {
    std::string type;  ///< That of Abaqus.
    std::vector<int> nodes;
  };

  Eigen::Matrix3Xd nodes;
  std::vector<Cell> cells;

  /// `shift` numbers the nodes in another order.  Without pyramids, there are
  /// hexahedra in their place, and no inner node is distorted.
  explicit MixedBlock(int shift, bool has_pyramids = true) {
    constexpr int kGrid = 27;
    nodes.resize(3, kGrid + (has_pyramids ? 2 : 0));
    const auto number = [&](int node) {
      return (node * 7 + shift) % int(nodes.cols());
    };
    for (int i = 0; i < kGrid; ++i) {
      Eigen::Vector3d x(i % 3, (i / 3) % 3, i / 9);
      if (i == 13 && has_pyramids) {
        x += Eigen::Vector3d(0.1, -0.2, 0.15);
      }
      nodes.col(number(i)) = x;
    }
    int middle = kGrid;
    for (int c = 0; c < 8; ++c) {
      const int first = c % 2 + 3 * ((c / 2) % 2) + 9 * (c / 4);
      std::array<int, 8> corner = {0, 1, 4, 3, 9, 10, 13, 12};
      for (int& node : corner) {
        node = number(first + node);
      }
      AddCell(c, has_pyramids, corner, middle, number);
    }
  }

 private:
  template <class Number>
  void AddCell(int c, bool has_pyramids, const std::array<int, 8>& n,
               int& middle, const Number& number) {
    if (has_pyramids && (c == 1 || c == 4)) {
      const int apex = number(middle++);
      nodes.col(apex) = nodes(Eigen::all, n).rowwise().mean();
      const int faces[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                               {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
      for (const auto& f : faces) {
        cells.push_back({"C3D5", {n[f[0]], n[f[1]], n[f[2]], n[f[3]], apex}});
      }
    } else if (c == 2 || c == 6) {
      cells.push_back({"C3D6", {n[0], n[1], n[3], n[4], n[5], n[7]}});
      cells.push_back({"C3D6", {n[1], n[2], n[3], n[5], n[6], n[7]}});
    } else {
      cells.push_back({"C3D8", {n.begin(), n.end()}});
    }
  }
};

// The block without pyramids, whose cells have middles of edges; those at x = 0
// are off the straight line by `bend`.
struct QuadraticBlock {
  explicit QuadraticBlock(double bend) : linear(3, false) {
    std::map<std::pair<int, int>, int> middles;
    std::vector<Eigen::Vector3d> added;
    for (const MixedBlock::Cell& cell : linear.cells) {
      const CellShape& shape = *FindCellShape(3, int(cell.nodes.size()));
      cells.push_back({cell.type == "C3D8" ? "C3D20" : "C3D15", cell.nodes});
      for (const auto& [i, j] : shape.edges) {
        const auto [a, b] = std::minmax(cell.nodes[i], cell.nodes[j]);
        const int next = int(linear.nodes.cols()) + int(added.size());
        const auto [place, is_new] = middles.insert({{a, b}, next});
        if (is_new) {
          const Eigen::Vector3d x = linear.nodes.col(a);
          const Eigen::Vector3d y = linear.nodes.col(b);
          added.emplace_back((x + y) / 2);
          if (x(0) == 0 && y(0) == 0) {
            added.back()(0) -= bend;
          }
        }
        cells.back().nodes.push_back(place->second);
      }
    }
    nodes.resize(3, linear.nodes.cols() + Eigen::Index(added.size()));
    nodes.leftCols(linear.nodes.cols()) = linear.nodes;
    for (std::size_t i = 0; i < added.size(); ++i) {
      nodes.col(linear.nodes.cols() + Eigen::Index(i)) = added[i];
    }
  }

  std::string Text() const {
    std::ostringstream text;
    text.precision(17);
    text << "*NODE\n";
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
      text << 10 + i << ", " << nodes(0, i) << ", " << nodes(1, i) << ", "
           << nodes(2, i) << "\n";
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text << "*ELEMENT, TYPE=" << cells[i].type << ", ELSET=EALL\n" << 100 - i;
      for (std::size_t k = 0; k < cells[i].nodes.size(); ++k) {
        text << (k % 15 == 14 ? ",\n" : ", ") << 10 + cells[i].nodes[k];
      }
      text << "\n";
    }
    text << "*NSET, NSET=LEFT\n";
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
      text << (nodes(0, i) <= 0 ? std::to_string(10 + i) + "\n" : "");
    }
    return text.str();
  }

  MixedBlock linear;
  Eigen::Matrix3Xd nodes;
  std::vector<MixedBlock::Cell> cells;
};

inline double VolumeOf(const MeshFile& file) {
  Mesh mesh;
  mesh.kind = file.kind;
  mesh.nodes = file.nodes.topRows(file.Dimension());
  mesh.elements = file.elements;
  return ElementVolumes(mesh).sum();
}

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_MIXED_BLOCK_H_
