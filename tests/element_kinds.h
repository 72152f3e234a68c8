#ifndef ELASTIMATE_TESTS_ELEMENT_KINDS_H_
#define ELASTIMATE_TESTS_ELEMENT_KINDS_H_

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

/// An element kind with a section that it can be of.
struct KindOfSection {
  ElementKind kind;
  SectionModel model;
};

/// Each kind of three dimensions, and each planar one in plane strain and in
/// plane stress.
std::vector<KindOfSection> AllKindsOfSections();
/// Returns those whose elements have this dimension and this order.
std::vector<KindOfSection> KindsOf(int dimension, int order);

/// "quad4_plane_stress".
std::string NameOf(const KindOfSection& parameter);

/// Names the instances of a test of kinds.
inline std::string KindTestName(
    const ::testing::TestParamInfo<KindOfSection>& info) {
  return NameOf(info.param);
}

/// A distorted block, or a rectangle of thickness 0.7, of `cells` elements (or
/// pairs of triangles, or sixes of tetrahedra) along each axis.  Every other
/// element is of negative orientation.  The edges of curved elements are bent
/// as the block is.
Mesh MeshOfKind(const KindOfSection& parameter, int cells = 3);

/// The mesh held where its last coordinate is least before it is distorted,
/// with forces on all other nodes.
Scene SceneOfKind(const KindOfSection& parameter, int cells = 3);

/// Displaces the held components, each otherwise than its neighbours.
void DisplaceSupports(Scene& scene);

/// Hooke's law in Voigt notation (xx, yy, zz, xy, yz, zx or xx, yy, xy); in
/// plane stress from the compliance.
Eigen::MatrixXd HookeMatrixOf(const IsotropicElasticity& elasticity,
                              SectionModel model);

/// The textbook: sum over the elements of the integral of B^T D B, times the
/// thickness.  Shape functions are polynomials that are 1 at one node of the
/// reference element and 0 at the others, from the inverse of the matrix of
/// monomials.  Shares no code with the library.  num_dofs^2.
Eigen::MatrixXd TextbookStiffness(const Mesh& mesh, const Eigen::MatrixXd& d);

/// Sum over the elements of the integral of f(x) N_i, by the same shape
/// functions: 1 at f = 1 in sum is the volume.
Eigen::VectorXd TextbookVolumes(const Mesh& mesh);

/// Measures the scene by a dense solution with TextbookStiffness.
void MeasureByTextbook(const IsotropicElasticity& elasticity, Scene& scene);

/// Measures the scene at its nodes in a world of finer elements than those that
/// an estimator may look at: quadratic elements, divided once.
void MeasureInCutWorld(const IsotropicElasticity& elasticity, Scene& scene);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ELEMENT_KINDS_H_
