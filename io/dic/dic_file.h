#ifndef ELASTIMATE_IO_DIC_DIC_FILE_H_
#define ELASTIMATE_IO_DIC_DIC_FILE_H_

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/io/points/table_options.h"

namespace elastimate {

/// The points that a camera followed, n in all, on the plane of the specimen.
struct DicFrame {
  std::string format;
  Eigen::Matrix2Xd positions;        ///< [length]
  Eigen::Matrix2Xd displacement;     ///< [length]
  std::vector<std::size_t> lines;    ///< The line of each point in the file.
  Eigen::Index num_invalid = 0;      ///< Points that were left out.
  std::vector<std::string> notices;  ///< Sentences on the units of the table.
};

/// Reads the points of a table (ReadPointRows), without those that have no
/// finite position or displacement.  Throws std::invalid_argument, naming the
/// file and the mend.
DicFrame ReadDicFile(const std::filesystem::path& path,
                     const TableOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_DIC_FILE_H_
