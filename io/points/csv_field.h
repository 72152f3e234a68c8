#ifndef ELASTIMATE_IO_POINTS_CSV_FIELD_H_
#define ELASTIMATE_IO_POINTS_CSV_FIELD_H_

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <vector>

namespace elastimate {

/// A vector per node.
struct CsvField {
  Eigen::MatrixXd values;          ///< A column for each node.
  std::vector<std::size_t> lines;  ///< The line of each node in the file.
};

/// Reads a table (ReadCsvTable) with a row for each node and no other columns
/// than the components: x, y, z, or titles of displacements
/// (DisplacementColumns), or only two of either where the dimension is 2.
/// `nan` and `inf` are numbers here.  Throws std::invalid_argument, naming the
/// file, the line and the column, also where components differ in their units,
/// or have a unit that only displacements have, since the unit of the mesh is
/// not known.
CsvField ReadCsvField(const std::filesystem::path& path, Eigen::Index num_nodes,
                      int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_CSV_FIELD_H_
