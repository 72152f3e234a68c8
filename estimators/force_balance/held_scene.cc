#include "elastimate/estimators/force_balance/held_scene.h"

#include <Eigen/QR>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {

Scene HeldScene(const Scene& scene) {
  if (WhyNotHeld(scene).empty()) {
    return scene;
  }
  Scene held = scene;
  held.is_rigid_motion_free = true;
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  const Eigen::VectorXd centre = nodes.rowwise().mean();
  const double size = (nodes.colwise() - centre).colwise().norm().maxCoeff();
  const Eigen::MatrixXd motions =
      RigidMotionsOf((nodes.colwise() - centre) / size);
  const auto is_held = scene.supports.held.reshaped();
  Eigen::MatrixXd of_held = motions;
  for (Eigen::Index i = 0; i < of_held.rows(); ++i) {
    if (!is_held(i)) {
      of_held.row(i).setZero();
    }
  }
  constexpr double kFree = 1e-10;
  const SymmetricEigenDecomposition holding =
      DecomposeSymmetric(of_held.transpose() * of_held);
  const Eigen::Index num_free =
      (holding.values.array() < kFree * double(nodes.size())).count();
  const Eigen::MatrixXd free = motions * holding.vectors.leftCols(num_free);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivoted(free.transpose());
  for (Eigen::Index i = 0; i < num_free; ++i) {
    const Eigen::Index row = pivoted.colsPermutation().indices()(i);
    held.supports.held.reshaped()(row) = true;
    held.supports.displacement.reshaped()(row) = 0;
  }
  return held;
}

}  // namespace elastimate
