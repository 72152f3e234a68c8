#ifndef ELASTIMATE_IO_SCENE_LOAD_RECORD_H_
#define ELASTIMATE_IO_SCENE_LOAD_RECORD_H_

#include <string>
#include <vector>

#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// The key "load_record" of frames: {"file", "column", "files_column",
/// "relative_sd"}.  The number in the column for each frame, not a number where
/// the cell is empty.  Rows belong to the frames that their cells in
/// `files_column` name, with or without folder and extension; without that key,
/// in the one column that names any of them; else rows are in the order of the
/// frames.  Throws std::invalid_argument, naming the file, for a row without a
/// frame and a frame without a row.
std::vector<double> ReadLoadRecord(const JsonValue& record,
                                   const std::vector<std::string>& frames);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_LOAD_RECORD_H_
