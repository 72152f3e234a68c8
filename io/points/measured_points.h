#ifndef ELASTIMATE_IO_POINTS_MEASURED_POINTS_H_
#define ELASTIMATE_IO_POINTS_MEASURED_POINTS_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/io/points/point_locator.h"
#include "elastimate/io/text/file_lines.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Reads the measured points of a load case.  `displacement` has the key
/// `points`, a file (ReadPointsFile) or a list of files, with paths relative to
/// its own.  It may have keys that say how they are read (ReadTableOptions),
/// and `tolerance`, which is how far a point may lie outside the mesh [length];
/// without it, that is a thousandth of the diagonal of the mesh's bounding box.
/// `unit` is the unit of files that were read before, or empty, and becomes
/// that of these files if their titles have one.  `lines` gets the lines of the
/// points, file by file.
///
/// Throws std::invalid_argument, naming the file, the line and the distance,
/// for a point farther outside, and for files of different units.  Adds a
/// notice of points that are outside but nearer.
PointDisplacements ReadMeasuredPoints(const JsonValue& displacement,
                                      const Mesh& mesh,
                                      const PointLocator& locator,
                                      std::string& unit,
                                      std::vector<std::string>& notices,
                                      std::vector<FileLines>& lines);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_MEASURED_POINTS_H_
