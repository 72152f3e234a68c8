#ifndef ELASTIMATE_IO_ABAQUS_ABAQUS_ELEMENTS_H_
#define ELASTIMATE_IO_ABAQUS_ABAQUS_ELEMENTS_H_

#include <string>
#include <vector>

#include "elastimate/io/mesh/numbered_mesh.h"

namespace elastimate {

/// Returns what an element type of Abaqus or CalculiX, in capital letters, is
/// as a part of a mesh.
NumberedType AbaqusType(const std::string& name);

/// Returns the type without reduced integration, incompatible modes, a hybrid
/// pressure and so on, "C3D8" for "C3D8RH".
std::string FullAbaqusType(const std::string& name);

/// Returns the vertices of face `label` ("S3"; of planar elements an edge) of
/// an element that a scene may have, as places in it; empty where there is no
/// such face.
std::vector<int> AbaqusFace(const NumberedType& type, const std::string& label);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_ABAQUS_ABAQUS_ELEMENTS_H_
