#ifndef ELASTIMATE_TESTS_SCENES_H_
#define ELASTIMATE_TESTS_SCENES_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A box of nx x ny x nz cubes, each cut into six tetrahedra, one corner at
/// the origin.
Mesh BoxMesh(const Eigen::Vector3i& cells, const Eigen::Vector3d& size);

/// Moves the nodes of a mesh by a smooth map: bent, twisted and tapered.
Mesh Distorted(Mesh mesh);

/// A scene of this mesh, held where z = 0 before any distortion (pass
/// `reference`), with one load case of nodal forces on every free node.
Scene HeldAtBottom(const Mesh& mesh, const Mesh& reference,
                   const Eigen::Vector3d& force_per_node);

/// A small scene by name: "cuboid", "bar" (slender), "organ" (distorted).
Scene SmallScene(const std::string& shape);
std::vector<std::string> SmallSceneNames();

using elastimate::Measure;
using elastimate::MeasureInFinerWorld;
/// Takes the displacements of a finer scene, whose first nodes are those of
/// this one.
void TakeDisplacements(const Scene& finer, Scene& scene);
/// At the nodes, in a world of quadratic elements of half the size.
void MeasureInRefinedWorld(const IsotropicElasticity& elasticity, Scene& scene);

/// Adds independent Gaussian noise to the free components; its standard
/// deviation is `relative` times the root mean square of the free displacement
/// of each load case.  Returns that of the first.
double AddNoise(double relative, std::uint64_t seed, Scene& scene);

/// The load cases of a scene under forces along x, y and z in turn.
Scene WithThreeForces(const Scene& scene);

/// The scene with one load case of a force per volume, which is the same load
/// for linear and for quadratic elements.
Scene UnderBodyForce(Scene scene);

/// A block with E = 5e4, nu = 0.3 in simple shear, u = (0.01 y, 0, 0), under
/// exact forces: without change of volume, so that the shear modulus alone
/// acts.  Statically determinate supports.
Scene ShearedBlock();

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_SCENES_H_
