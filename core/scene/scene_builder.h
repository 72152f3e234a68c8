#ifndef ELASTIMATE_CORE_SCENE_SCENE_BUILDER_H_
#define ELASTIMATE_CORE_SCENE_SCENE_BUILDER_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

// A scene from the arrays of another program, in a few lines:
//
//   Scene scene = UnsupportedScene(
//       MakeMesh(ElementKind::kTet4, coordinates, num_nodes, connectivity,
//                num_elements));
//   HoldInBox(Vector3d(0, 0, 0), Vector3d(1, 1, 0), scene);
//   LoadCase load_case;
//   load_case.loads = {TractionInBox(scene.mesh, Vector3d(0, 0, 1),
//                                    Vector3d(1, 1, 1), Vector3d(0, 0, -100))};
//   load_case.displacement = ...;  // dimension x num_nodes
//   scene.load_cases = {load_case};
//
// A box has a lower and an upper corner of `dimension` coordinates [length],
// which may be infinite.  Its bounds are included, to within 1e-9 of the extent
// of the mesh.  Each function below throws std::invalid_argument when a corner
// has another dimension than the mesh; those that need something in the box,
// also when a corner is not a number or the lower lies above the upper one.

/// Copies a mesh out of arrays.
///
/// coordinates    dimension numbers for each node, one node after another
///                [length]
/// connectivity   node numbers from zero on of each element, one element after
///                another, in the order of VTK (Mesh::elements)
///
/// Planar elements are a section of plane strain of thickness 1; Mesh::section
/// says otherwise.  Throws std::invalid_argument as ValidateMesh does, and when
/// a pointer is null or a number of nodes or elements is not positive.
/// Precondition: the arrays are as long as the numbers say.  O(num_elements).
[[nodiscard]] Mesh MakeMesh(ElementKind kind, const double* coordinates,
                            Eigen::Index num_nodes, const int* connectivity,
                            Eigen::Index num_elements);

/// Returns a scene of this mesh and one isotropic material, in which no node is
/// held, and without load cases.  O(num_nodes).
[[nodiscard]] Scene UnsupportedScene(Mesh mesh);

/// Returns the facets of the outer surface all of whose nodes lie in a box, as
/// BoundaryFacets has them: for a Traction, a Pressure or a SurfaceForce.  May
/// return none.  Precondition: a valid mesh.  O(num_elements).
[[nodiscard]] Eigen::MatrixXi FacetsInBox(const Mesh& mesh,
                                          const Eigen::VectorXd& lower,
                                          const Eigen::VectorXd& upper);

/// Returns a uniform traction [force / length^2], of `dimension` components, on
/// FacetsInBox.  Throws std::invalid_argument when these are none, and when the
/// traction has another dimension or is not finite.
[[nodiscard]] Traction TractionInBox(const Mesh& mesh,
                                     const Eigen::VectorXd& lower,
                                     const Eigen::VectorXd& upper,
                                     const Eigen::VectorXd& traction);

/// Holds components of the nodes in a box at displacements [length], both of
/// `dimension`, in all load cases that have no supports of their own; all
/// components at zero where they are not given.  The box stays in the supports
/// (Supports::boxes), so that it also holds the nodes that finer elements add.
///
/// Throws std::invalid_argument, and leaves the scene as it was, when the box
/// holds no node, when a size is wrong or no component is named, or when a node
/// is held already at another displacement or at one that is not known.
/// Precondition: supports of the nodes of the mesh, as UnsupportedScene has
/// them.  O(num_nodes).
void HoldInBox(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
               Scene& scene);
void HoldInBox(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
               const Eigen::Array<bool, Eigen::Dynamic, 1>& components,
               const Eigen::VectorXd& displacement, Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_SCENE_BUILDER_H_
