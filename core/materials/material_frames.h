#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_FRAMES_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_FRAMES_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/materials/material.h"

namespace elastimate {

/// The frames of some materials in the elements of a mesh, in which their laws
/// speak: direction 1 is that of the first axis, 2 that of the second, or any
/// across the first where there is one axis, and 3 their cross product.
class MaterialFrames {
 public:
  /// Precondition: valid materials; those without axes have those of the scene.
  MaterialFrames(const std::vector<Material>& materials, int dimension);

  /// Its directions as columns, an orthogonal matrix; of a material without
  /// axes the identity.
  template <int kDimension>
  Eigen::Matrix<double, kDimension, kDimension> Of(int material,
                                                   Eigen::Index element) const {
    const Eigen::MatrixXd& frames = frames_[material];
    return frames.middleCols<kDimension>(
        frames.cols() == kDimension ? 0 : kDimension * element);
  }

 private:
  /// Each material has blocks of dimension x dimension side by side: one, or
  /// one for each element.
  std::vector<Eigen::MatrixXd> frames_;
};

/// What is wrong with the axes of a material of a law that has `num_axes` of
/// them: "has an axis of length 0 at element 3; ..."; empty when nothing is.
/// `elements` are those of the material, of all `num_elements`.
[[nodiscard]] std::string WhyNotTheseAxes(
    const std::vector<Eigen::MatrixXd>& axes, int num_axes, int dimension,
    Eigen::Index num_elements, const std::vector<Eigen::Index>& elements);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_FRAMES_H_
