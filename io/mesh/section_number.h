#ifndef ELASTIMATE_IO_MESH_SECTION_NUMBER_H_
#define ELASTIMATE_IO_MESH_SECTION_NUMBER_H_

#include <array>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The field data `model` is the place in this list.
inline constexpr std::array<SectionModel, 3> kNumberedModels = {
    SectionModel::kSolid, SectionModel::kPlaneStress,
    SectionModel::kPlaneStrain};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_SECTION_NUMBER_H_
