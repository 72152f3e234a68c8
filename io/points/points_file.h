#ifndef ELASTIMATE_IO_POINTS_POINTS_FILE_H_
#define ELASTIMATE_IO_POINTS_POINTS_FILE_H_

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/io/points/table_options.h"

namespace elastimate {

/// The measured points of a file, n in all.
struct PointsFile {
  std::string format;
  Eigen::MatrixXd positions;     ///< dimension x n [length].
  Eigen::MatrixXd displacement;  ///< dimension x n; nan: not measured.
  /// dimension x n, 1 where nothing was measured; empty without such columns.
  Eigen::MatrixXd noise_sd;
  std::vector<std::size_t> lines;    ///< The line of each point in the file.
  std::string unit;                  ///< The unit of lengths; empty if unknown.
  std::vector<std::string> notices;  ///< Sentences on the units of the table.
};

/// Reads the rows of a table of points (ReadTableOfPoints) in one unit of
/// length (ScalesOf), with the columns sd_ux, sd_uy, sd_uz where there are any
/// of them.  Empty cells and nan become NaN, and so does all of a point that
/// the format marks as not found (sigma -1 in VIC and DICe, converged 0 in
/// pyvale).  Throws std::invalid_argument, naming the file, the line and the
/// column.
PointsFile ReadPointRows(const std::filesystem::path& path, int dimension,
                         const TableOptions& options);

/// Reads the points at which something was measured.  Throws as ReadPointRows
/// does, and also where such a point has no position, an infinite displacement
/// or no positive standard deviation, where one is there twice, and where there
/// is none.
PointsFile ReadPointsFile(const std::filesystem::path& path, int dimension,
                          const TableOptions& options = {});

/// Returns the content of a file that ReadPointsFile reads as these positions
/// and displacements, both dimension x n, to the last bit, with a row for each
/// point.
std::string PointsContent(const Eigen::MatrixXd& positions,
                          const Eigen::MatrixXd& displacement);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINTS_FILE_H_
