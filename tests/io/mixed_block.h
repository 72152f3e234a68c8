#ifndef ELASTIMATE_TESTS_IO_MIXED_BLOCK_H_
#define ELASTIMATE_TESTS_IO_MIXED_BLOCK_H_

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

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

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_MIXED_BLOCK_H_
