#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_FRAMES_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_FRAMES_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/materials/material.h"

namespace elastimate {

/// The frames of some materials in the elements of a mesh, in which their laws
/// speak.  Direction 1 is that of the first axis, direction 2 that of the
/// second axis (or any direction across the first where there is one axis), and
/// direction 3 is their cross product.
class MaterialFrames {
 public:
  /// Precondition: valid materials.  A material without axes has those of the
  /// scene.
  MaterialFrames(const std::vector<Material>& materials, int dimension);

  /// Returns the directions of the frame as columns, an orthogonal matrix; the
  /// identity for a material without axes.
  template <int kDimension>
  Eigen::Matrix<double, kDimension, kDimension> Of(int material,
                                                   Eigen::Index element) const {
    const Eigen::MatrixXd& frames = frames_[material];
    return frames.middleCols<kDimension>(
        frames.cols() == kDimension ? 0 : kDimension * element);
  }

 private:
  /// One matrix for each material: dimension x dimension blocks side by side,
  /// one block for all elements or one for each.
  std::vector<Eigen::MatrixXd> frames_;
};

/// Tells what is wrong with the axes of a material whose law has `num_axes` of
/// them, such as "has an axis of length 0 at element 3; ..."; empty when
/// nothing is.  `elements` are those of the material, among all `num_elements`.
[[nodiscard]] std::string WhyNotTheseAxes(
    const std::vector<Eigen::MatrixXd>& axes, int num_axes, int dimension,
    Eigen::Index num_elements, const std::vector<Eigen::Index>& elements);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_FRAMES_H_
