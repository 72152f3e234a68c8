#ifndef ELASTIMATE_CORE_SCENE_SCENE_H_
#define ELASTIMATE_CORE_SCENE_SCENE_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/scene/supports.h"

namespace elastimate {

/// Forces that act on nodes.
struct NodalForces {
  Eigen::MatrixXd force;  ///< dimension x num_nodes [force].
};

/// A force per volume, such as gravity, uniform or uniform in each element.
struct BodyForce {
  /// [force / length^3], dimension x 1 or dimension x num_elements.
  Eigen::MatrixXd force_density;
};

/// A force per (undeformed) area on some facets, uniform or uniform on each.
struct Traction {
  Eigen::MatrixXi facets;  ///< As those of BoundaryFacets.
  /// [force / length^2], dimension x 1 or dimension x num_facets.
  Eigen::MatrixXd traction;
};

/// A uniform pressure on some facets; positive pushes against the outward
/// normal.
struct Pressure {
  Eigen::MatrixXi facets;  ///< As those of BoundaryFacets, in their order.
  double pressure;         ///< [force / length^2].
  /// Whether it acts along the normals and on the area of the deformed surface,
  /// which needs laws of large strains, in place of the undeformed one.
  bool follows = false;
};

/// A total force that is spread uniformly over some facets: the traction
/// force / area, where area is that of all of them.
struct SurfaceForce {
  Eigen::MatrixXi facets;  ///< As those of a traction; not all without area.
  Eigen::VectorXd force;   ///< [force], of `dimension`.
};

/// Loads are kept as what they physically are, so that each discretisation can
/// assemble its own nodal forces.
using Load =
    std::variant<NodalForces, BodyForce, Traction, Pressure, SurfaceForce>;

/// Displacements that were measured at points of the specimen, which need not
/// be nodes.
struct PointDisplacements {
  MeshPoints points;
  /// The displacement, dimension x n [length]; NaN where a component was not
  /// measured.
  Eigen::MatrixXd displacement;
  /// The standard deviation of each measured component, dimension x n [length];
  /// empty where that of the load case holds for all.
  Eigen::MatrixXd noise_sd;
};

/// The total force that the supports of some nodes exert on the specimen, as a
/// load cell measured it.  With the internal forces f and the loads F it is
///
///   R_i = sum of f_i - F_i over the nodes + noise.
struct Resultant {
  std::vector<int> nodes;
  /// The force [force], of `dimension` components; NaN where it was not
  /// measured.
  Eigen::VectorXd force;
  Eigen::VectorXd noise_sd;  ///< Standard deviations [force], of `dimension`.
};

/// One experiment on the specimen: what pushed, and what was measured.
struct LoadCase {
  std::vector<Load> loads;
  Eigen::MatrixXd displacement;  ///< Measured at nodes, dimension x num_nodes
                                 ///< [length]; empty when nothing was.
  ComponentMask observed;        ///< dimension x num_nodes, or empty when every
                                 ///< component was measured.
  PointDisplacements points;     ///< Measured at points; mostly none.
  std::optional<double> noise_sd;  ///< Standard deviation of the measured
                                   ///< displacement per component [length].
  std::vector<Resultant> resultants = {};
  /// The supports of this load case, where they differ from those of the scene.
  std::optional<Supports> supports = {};
};

/// Tells whether component `i` of the displacement of `node` is measured.  In a
/// load case without points, all nodes count while no displacement has been
/// entered yet.
inline bool IsObserved(const LoadCase& load_case, int i, Eigen::Index node) {
  const bool has_nodes =
      load_case.displacement.size() != 0 || load_case.points.points.Size() == 0;
  return has_nodes &&
         (load_case.observed.size() == 0 || load_case.observed(i, node));
}

/// Tells whether the displacement of any node or point was measured.
inline bool IsMeasured(const LoadCase& load_case) {
  return load_case.displacement.size() != 0 ||
         load_case.points.points.Size() != 0;
}

/// The origin of displacements.
enum class Origin {
  kMeasured,  ///< A specimen, which its mesh describes but for a mesh error.
  /// A finite element solution with the very elements of the mesh and laws of
  /// the kind that the materials have, of small or of large strains, so that
  /// there is no mesh error, and strains and rotations of any size are exact.
  kComputed,
  /// Such a solution by LargeStrainEquilibrium, whose hexahedra and
  /// quadrilaterals have a mean dilatation; that of others is not known.
  kComputedAtLargeStrains,
};

/// Geometry, materials, supports, and one or more load cases.
struct Scene {
  Mesh mesh;
  /// The materials; an empty list means one isotropic material.
  std::vector<Material> materials;
  Supports supports;  ///< For the load cases without their own.
  std::vector<LoadCase> load_cases;
  /// Tells that displacements were measured relative to an unknown rigid motion
  /// of the camera or of the whole specimen, another one in each load case.
  bool is_rigid_motion_free = false;
  Origin origin = Origin::kMeasured;
};

/// Returns the supports in load case `k`.
inline const Supports& SupportsOf(const Scene& scene, Eigen::Index k) {
  const std::optional<Supports>& own = scene.load_cases[k].supports;
  return own ? *own : scene.supports;
}

/// Tells whether supports differ between load cases.  O(num_load_cases).
[[nodiscard]] bool HasSupportsOfCases(const Scene& scene);

/// Throws std::invalid_argument with one sentence that names the load case, the
/// array, and the node or element, unless: the mesh and its materials are
/// valid (ValidateMesh, ValidateMaterials); every array has its shape; every
/// number is finite, and no array's largest one beyond 1e-50 to 1e50 unless
/// zero (displacements only where they are observed or held); unknown
/// displacements are of held components, in rigid faces or measured at nodes;
/// resultants are of held components; every facet is a face of an element (and
/// its mid-edge nodes lie in the middle of straight edges); points lie in their
/// elements (ValidatePoints); the facets of a surface force have an area; noise
/// standard deviations are positive; there is a load case; and at least one
/// degree of freedom is free in each.  O(num_elements + num_nodes *
/// num_load_cases), and O(num_elements) for each load on facets.
void ValidateScene(const Scene& scene);

/// Validates observed components, displacements and noise as ValidateScene
/// does, for another measurement of a valid scene.  O((num_nodes + num_points)
/// num_load_cases).
void ValidateMeasurements(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SCENE_H_
