#ifndef ELASTIMATE_TESTS_SHAPES_H_
#define ELASTIMATE_TESTS_SHAPES_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

/// Shapes that are neither block, bar nor organ, of 400 to 2500 tetrahedra:
/// "bracket", "dome", "dumbbell", "frame", "lattice", "ring", "spring", "tree",
/// "wedge".
std::vector<std::string> ShapeNames();
Mesh ShapeMesh(const std::string& shape);

/// "tension", "torsion", "bending" (nodal forces on the upper tenth), "gravity"
/// and "swelling" (nodal forces on every node).
std::vector<std::string> ShapeLoads();

/// The mesh, held in its lower eighth, with one load case.
Scene LoadedScene(const Mesh& mesh, const std::string& load);
Scene ShapeScene(const std::string& shape, const std::string& load);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_SHAPES_H_
