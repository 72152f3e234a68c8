#ifndef ELASTIMATE_IO_SCENE_LOAD_RECORD_H_
#define ELASTIMATE_IO_SCENE_LOAD_RECORD_H_

#include <string>
#include <vector>

#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Reads the key "load_record" of frames: {"file", "column", "files_column",
/// "relative_sd"}.  Returns the number in the column for each frame, NaN where
/// the cell is empty.  A row belongs to the frame that its cell in
/// `files_column` names, with or without folder and extension.  Without that
/// key, the one column that names any frames is taken; without such a column,
/// rows are in the order of the frames.  Throws std::invalid_argument, naming
/// the file, for a row without a frame and a frame without a row.
std::vector<double> ReadLoadRecord(const JsonValue& record,
                                   const std::vector<std::string>& frames);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_LOAD_RECORD_H_
