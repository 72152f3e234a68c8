#include "elastimate/io/dic/dic_file.h"

#include <utility>

#include "elastimate/io/points/points_file.h"

namespace elastimate {

DicFrame ReadDicFile(const std::filesystem::path& path,
                     const TableOptions& options) {
  const PointsFile file = ReadPointRows(path, 2, options);
  DicFrame frame;
  std::vector<Eigen::Index> found;
  for (Eigen::Index point = 0; point < file.positions.cols(); ++point) {
    if (file.positions.col(point).allFinite() &&
        file.displacement.col(point).allFinite()) {
      found.push_back(point);
      frame.lines.push_back(file.lines[point]);
    }
  }
  frame.format = file.format;
  frame.positions = file.positions(Eigen::all, found);
  frame.displacement = file.displacement(Eigen::all, found);
  frame.num_invalid = file.positions.cols() - frame.positions.cols();
  frame.notices = file.notices;
  return frame;
}

}  // namespace elastimate
