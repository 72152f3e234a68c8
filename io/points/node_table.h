#ifndef ELASTIMATE_IO_POINTS_NODE_TABLE_H_
#define ELASTIMATE_IO_POINTS_NODE_TABLE_H_

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace elastimate {

/// Displacements of nodes that are known by their numbers.
struct NodeTable {
  std::vector<std::size_t> numbers;
  Eigen::MatrixXd displacement;    ///< dimension x number of rows [length].
  std::vector<std::size_t> lines;  ///< The line of each row in the file.
  std::size_t num_states = 0;      ///< Of which the last one is returned.
  std::string state;               ///< "time 1", or empty.
};

/// Reads displacements of nodes that another program wrote: the node data
/// ux;uy;uz of a log or data file of FEBio, the displacements in a .dat file of
/// CalculiX, a report of Abaqus (.rpt), or a table with a column of node
/// numbers (node, label, Node Label, ...) and columns of displacements (ux, U1,
/// U.U1, U-U1, ...).  Other text is skipped.  Of the steps of FEBio and of
/// CalculiX, the last one is returned.
///
/// Throws std::invalid_argument, naming the file and the line, where a number
/// cannot be read, a node comes twice, or there are no displacements.
/// O(size of the file), with a factor of the logarithm.
NodeTable ReadNodeTable(const std::filesystem::path& path, int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_NODE_TABLE_H_
