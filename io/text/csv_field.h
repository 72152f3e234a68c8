#ifndef ELASTIMATE_IO_TEXT_CSV_FIELD_H_
#define ELASTIMATE_IO_TEXT_CSV_FIELD_H_

#include <Eigen/Core>
#include <filesystem>

namespace elastimate {

/// Reads a vector per node from a comma-separated file: a header `x,y,z` or
/// `ux,uy,uz`, where the dimension is 2 also `x,y` or `ux,uy`, then one row per
/// node, so that node k is on line k + 2.  One column per node, of as many rows
/// as the header has names.  `nan` and `inf` are numbers here.  Throws
/// std::invalid_argument, naming the file, the line and the column.
Eigen::MatrixXd ReadCsvField(const std::filesystem::path& path,
                             Eigen::Index num_nodes, int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_CSV_FIELD_H_
