#include "elastimate/core/materials/material_frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

// A cosine of the angle between two axes that is at most this comes from
// rounding.
constexpr double kLargestCosine = 1e-6;

Eigen::VectorXd AxisAt(const Eigen::MatrixXd& axis, Eigen::Index element) {
  return axis.col(axis.cols() == 1 ? 0 : element);
}

// Returns the identity where an axis is zero, as it may be in elements of other
// materials.
Eigen::MatrixXd FrameOf(const std::vector<Eigen::MatrixXd>& axes,
                        Eigen::Index element, int dimension) {
  const Eigen::VectorXd first = AxisAt(axes[0], element).stableNormalized();
  if (!(first.norm() > 0.5)) {
    return Eigen::MatrixXd::Identity(dimension, dimension);
  }
  Eigen::MatrixXd frame(dimension, dimension);
  if (dimension == 2) {
    frame << first(0), -first(1), first(1), first(0);
    return frame;
  }
  Eigen::Index least = 0;
  first.cwiseAbs().minCoeff(&least);
  Eigen::Vector3d second =
      axes.size() == 2
          ? Eigen::Vector3d(AxisAt(axes[1], element).stableNormalized())
          : Eigen::Vector3d(Eigen::Vector3d::Unit(least));
  second -= second.dot(first) * first;
  const Eigen::Vector3d direction_1 = first;
  const Eigen::Vector3d direction_2 = second.normalized();
  frame << direction_1, direction_2, direction_1.cross(direction_2);
  return frame;
}

}  // namespace

MaterialFrames::MaterialFrames(const std::vector<Material>& materials,
                               int dimension) {
  for (const Material& material : materials) {
    Eigen::Index num_frames = 1;
    for (const Eigen::MatrixXd& axis : material.axes) {
      num_frames = std::max(num_frames, axis.cols());
    }
    Eigen::MatrixXd frames(dimension, dimension * num_frames);
    for (Eigen::Index e = 0; e < num_frames; ++e) {
      frames.middleCols(dimension * e, dimension) =
          material.axes.empty()
              ? Eigen::MatrixXd::Identity(dimension, dimension)
              : FrameOf(material.axes, e, dimension);
    }
    frames_.push_back(frames);
  }
  if (materials.empty()) {
    frames_.emplace_back(Eigen::MatrixXd::Identity(dimension, dimension));
  }
}

std::string WhyNotTheseAxes(const std::vector<Eigen::MatrixXd>& axes,
                            int num_axes, int dimension,
                            Eigen::Index num_elements,
                            const std::vector<Eigen::Index>& elements) {
  if (axes.empty()) {
    return num_axes == 1
               ? "has no axis; give its direction, by \"axis\" or --axis"
               : "has no axes; give two directions, by \"axes\" or --axis";
  }
  if (int(axes.size()) != num_axes) {
    return "has " + std::to_string(axes.size()) +
           (axes.size() == 1 ? " axis" : " axes") + ", and its law takes " +
           std::to_string(num_axes) + "; give as many";
  }
  for (const Eigen::MatrixXd& axis : axes) {
    if (axis.rows() != dimension ||
        (axis.cols() != 1 && axis.cols() != num_elements)) {
      return "has an axis of " + std::to_string(axis.rows()) +
             " components for " + std::to_string(axis.cols()) +
             " elements; give it " + std::to_string(dimension) +
             " components, once or for each element";
    }
  }
  for (const Eigen::Index e : elements) {
    const std::string place = " at element " + std::to_string(e);
    for (const Eigen::MatrixXd& axis : axes) {
      const Eigen::VectorXd direction = AxisAt(axis, e);
      const std::string where = axis.cols() == 1 ? "" : place;
      if (!direction.allFinite()) {
        return "has an axis that is not finite" + where + "; correct it";
      }
      if (direction.isZero(0)) {
        return "has an axis of length 0" + where + "; give it a direction";
      }
    }
    const bool are_constant = std::all_of(
        axes.begin(), axes.end(),
        [](const Eigen::MatrixXd& axis) { return axis.cols() == 1; });
    if (axes.size() == 2 &&
        !(std::abs(AxisAt(axes[0], e)
                       .stableNormalized()
                       .dot(AxisAt(axes[1], e).stableNormalized())) <=
          kLargestCosine)) {
      return "has axes that are not orthogonal" +
             (are_constant ? std::string() : place) + "; give it two that are";
    }
    if (are_constant) {
      break;
    }
  }
  return "";
}

}  // namespace elastimate
