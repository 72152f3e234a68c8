#ifndef ELASTIMATE_IO_SCENE_FRAMES_H_
#define ELASTIMATE_IO_SCENE_FRAMES_H_

#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/frame_series.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// Reads the key "frames" of a scene of one load case: {"files",
/// "load_record"}. `files` is a list, or a pattern with * and ?, whose files
/// are taken in the order of SortByNumbers.  The files are camera files where
/// the mesh is one of points (the points of a frame are known by their
/// positions), else what the load case's "displacement" is, a table of points
/// or a vector per node, and points without that key.  The numbers of
/// `load_record` (ReadLoadRecord) multiply all loads and resultants of the load
/// case.
///
/// `file_scene` is complete but for its frames.  Throws std::invalid_argument,
/// naming the file and the place in it, also where a pattern finds no file.
FrameSeries ReadFrames(const JsonValue& document, const FileScene& file_scene);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_FRAMES_H_
