#ifndef ELASTIMATE_BENCHMARKS_UNSEEN_SHAPES_H_
#define ELASTIMATE_BENCHMARKS_UNSEEN_SHAPES_H_

#include <Eigen/Core>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/voxel_mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// What a shape is for: error bars may be calibrated on one half, and are
/// reported on the other.
enum class Half { kCalibration, kReport };

/// "calibration" or "report".
std::string_view HalfName(Half half);

/// A part of a surface, as a condition on points of the grid.
using Region = std::function<bool(const Eigen::Vector3d&)>;

/// An experiment on a shape.
struct LoadedShape {
  std::string name;
  std::function<std::vector<Load>(const VoxelMesh&)> loads;
};

/// A specimen that is neither block, bar nor organ, of 800 to 1100 tetrahedra
/// and below 1 m, for E = 5 kPa.
struct UnseenShape {
  std::string name;
  Half half;
  VoxelBody body;
  Region clamped;
  std::vector<LoadedShape> experiments;
  /// Hexahedra along the edge of a voxel that stand for this body as well; 0
  /// where they are not asked for.
  int hexahedra_per_edge = 0;
};

/// All shapes, the halves by turns.
std::vector<UnseenShape> UnseenShapes();

/// The shape on this mesh of its body, with one load case for each experiment,
/// not measured.  O(num_elements) for each experiment.
Scene UnmeasuredScene(const UnseenShape& shape, const VoxelMesh& voxels);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_UNSEEN_SHAPES_H_
