#ifndef ELASTIMATE_IO_SCENE_ARRAY_SCENE_H_
#define ELASTIMATE_IO_SCENE_ARRAY_SCENE_H_

#include "elastimate/io/scene/file_scene.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Makes the scene of the named arrays of a mesh file: `displacement`, `force`,
/// `fixed` and so on, as ReadScene describes.  Throws std::invalid_argument,
/// naming the file and the array.
FileScene SceneFromArrays(MeshFile mesh, Measurement measurement,
                          const SectionChoice& section);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_ARRAY_SCENE_H_
