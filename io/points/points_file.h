#ifndef ELASTIMATE_IO_POINTS_POINTS_FILE_H_
#define ELASTIMATE_IO_POINTS_POINTS_FILE_H_

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace elastimate {

/// Measured points of a file, n in all.
struct PointsFile {
  Eigen::MatrixXd positions;     ///< dimension x n [length].
  Eigen::MatrixXd displacement;  ///< dimension x n; nan: not measured.
  /// dimension x n, 1 where nothing was measured; empty without such columns.
  Eigen::MatrixXd noise_sd;
  std::vector<std::size_t> lines;  ///< Of the file, one for each point.
};

/// Reads a table (ReadCsvTable) with the columns x, y, z, ux, uy, uz in any
/// order, in the plane without z and uz, and either sd_ux, sd_uy, sd_uz or none
/// of these; others are not looked at.  Displacements that are empty or nan
/// were not measured.  Throws std::invalid_argument, naming the file, the line
/// and the column, for anything else.
PointsFile ReadPointsFile(const std::filesystem::path& path, int dimension);

/// The content of a file that ReadPointsFile reads as these positions and
/// displacements, both dimension x n, to the last bit: a row for each point.
std::string PointsContent(const Eigen::MatrixXd& positions,
                          const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINTS_FILE_H_
