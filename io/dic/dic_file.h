#ifndef ELASTIMATE_IO_DIC_DIC_FILE_H_
#define ELASTIMATE_IO_DIC_DIC_FILE_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace elastimate {

/// How a file of digital image correlation is read.
struct DicOptions {
  /// A name among DicFormatNames(), or "auto": the first whose columns it has.
  std::string format = "auto";
  /// The columns of x, y, u and v, for any other format.
  std::optional<std::array<std::string, 4>> columns;
  /// For files in pixels, which have no other unit.
  std::optional<double> length_per_pixel;
  /// Turns y and v round, where y points down.
  bool flip_y = false;
};

/// The points that a camera followed, n in all, on the plane of the specimen.
struct DicFrame {
  std::string format;
  Eigen::Matrix2Xd positions;      ///< [length]
  Eigen::Matrix2Xd displacement;   ///< [length]
  std::vector<std::size_t> lines;  ///< Of the file, one for each point.
  Eigen::Index num_invalid = 0;    ///< Points that were left out.
};

/// "matchid, vic, ...", for messages.
std::string DicFormatNames();

/// Reads a table (ReadCsvTable) with the columns of MatchID, VIC-2D or VIC-3D,
/// DICe, pyvale, ARAMIS (a node map), or x, y, ux, uy.  Points without a number
/// for position or displacement are left out, and those that the format marks
/// as not found (sigma -1 in VIC and DICe, converged 0 in pyvale).  Throws
/// std::invalid_argument, naming the file and the mend.
DicFrame ReadDicFile(const std::filesystem::path& path,
                     const DicOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_DIC_FILE_H_
