#ifndef ELASTIMATE_IO_SCENE_CSV_FIELD_H_
#define ELASTIMATE_IO_SCENE_CSV_FIELD_H_

#include <Eigen/Core>
#include <filesystem>

namespace elastimate {

/// Reads three components per node from a comma-separated file: a header
/// `x,y,z` or `ux,uy,uz`, then one row per node, so that node k is on line
/// k + 2.  `nan` and `inf` are numbers here.  Throws std::invalid_argument,
/// naming the file, the line and the column.
Eigen::MatrixXd ReadCsvField(const std::filesystem::path& path,
                              Eigen::Index num_nodes);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_CSV_FIELD_H_
