#ifndef ELASTIMATE_TESTS_IO_KIND_SCENES_H_
#define ELASTIMATE_TESTS_IO_KIND_SCENES_H_

#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// "tet4", ..., "tri3", "tri3_plane_strain", ...: each kind of element, planar
/// ones in plane stress and in plane strain.
std::vector<std::string> SceneNames();

inline constexpr IsotropicElasticity kMeasuredElasticity = {7e4, 0.3};

/// A held and loaded scene of that name, all of whose nodes are measured
/// without noise at kMeasuredElasticity.
Scene SceneOf(const std::string& name);

/// A legacy VTK file of a planar mesh without data: 2 x 2 quadrilaterals of the
/// rectangle from (0, 0) to (2, 1), of which the inner node is off the middle,
/// at z = 7.
std::string PlanarVtkText();

}  // namespace elastimate

#endif  // ELASTIMATE_TESTS_IO_KIND_SCENES_H_
