#ifndef ELASTIMATE_TESTS_ESTIMATORS_MAPS_MAP_SCENES_H_
#define ELASTIMATE_TESTS_ESTIMATORS_MAPS_MAP_SCENES_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

/// A body whose ln E differs between its elements, and what was measured of it.
struct MapScene {
  Scene scene;
  Eigen::VectorXd log_moduli;  ///< ln E of each element.
  double noise_sd = 0;
};

/// Returns ln E at a point of the unit square or cube, whose last coordinate is
/// the height:
///
///   hom     1 everywhere
///   incK    K times as stiff within a radius of 0.2 (in space 0.25) about
///           (0.5, 0.55), for a number K
///   two     5 times as stiff within 0.12 (0.15) about (0.5 -+ 0.17, 0.5)
///   grad    ln 3 (height - 0.5) + 0.3 sin 2 pi x
///   lay     layers of E = 1, 3, 1, 2 from the base up
///   thin    E = 1 below 0.5, 4 above 0.5625, and 2 between
double LogModulusAt(const std::string& name, const Eigen::VectorXd& point);

/// Returns the unit square (plane strain) or cube of `cells` elements along
/// each axis (pairs of triangles, sixes of tetrahedra), clamped at its base,
/// with the traction (0, -1) or (0.2, 0, -1) on its top, nu = 0.3, observed at
/// all free nodes with the elements of this mesh, and noise relative to the
/// root mean square of the displacements.
MapScene MakeMapScene(const std::string& name, ElementKind kind, int cells,
                      double relative_noise, std::uint64_t seed = 1,
                      double poisson_ratio = 0.3);

/// Returns the same body as a specimen: with displacements that quadratic
/// elements of half the size made.
MapScene MakeSpecimen(const std::string& name, ElementKind kind, int cells,
                      double relative_noise, std::uint64_t seed = 1);

/// Returns a block of 1 x 1 x 1.2 of `cells` x `cells` x `cells` + 1 boxes of
/// six tetrahedra with a box of contrast 3 off its centre, E = 2 and 6, which
/// was measured with noise at all nodes, in a
/// world of quadratic elements of half the size.
MapScene HeldOutBlock(int cells, double relative_noise);

/// Returns the same block with a ball instead of the box, which the mesh does
/// not know: elements of half of its size, with which it was measured, are in
/// the ball where their centre is.
MapScene HeldOutBall(int cells, double relative_noise);

/// Returns |estimate - truth| / |truth - mean|, both without their mean; for a
/// homogeneous truth the root mean square of the estimate without its mean.
double MapError(const Eigen::VectorXd& estimate, const Eigen::VectorXd& truth);

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ESTIMATORS_MAPS_MAP_SCENES_H_
