#ifndef ELASTIMATE_IO_SCENE_SECTION_H_
#define ELASTIMATE_IO_SCENE_SECTION_H_

#include <optional>
#include <string_view>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Returns the model of that SectionModelName, if there is one.
std::optional<SectionModel> SectionModelOfName(std::string_view name);

/// Lists the names of the models, for error messages.
inline constexpr char kSectionModels[] = "3d, plane_stress or plane_strain";

/// Returns what is given, and what `otherwise` has where nothing is.
SectionChoice Choose(const SectionChoice& given,
                     const SectionChoice& otherwise);

/// Returns the section of the mesh: what is given, and what its field data have
/// where nothing is.  Throws std::invalid_argument, naming the file and the
/// mend, for planar elements without a plane model or a thickness, and for
/// solid ones with either.
Section SectionOf(const MeshFile& mesh, const SectionChoice& given);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_SECTION_H_
