#ifndef ELASTIMATE_BENCHMARKS_MATERIAL_LEVELS_H_
#define ELASTIMATE_BENCHMARKS_MATERIAL_LEVELS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Holds a specimen, and the materials that the model of it has.
struct MaterialLevel {
  std::string factor;  ///< What is varied, with its unit.
  std::string level;
  /// The assumption is "right", or tells what the model has too few, too many
  /// or wrong of.
  std::string assumption;
  Scene specimen;              ///< It has materials, but no measurement.
  Eigen::VectorXd parameters;  ///< The true ones.
  /// The regions of the model are on the mesh of the specimen.
  Eigen::VectorXi regions_of_model;
  std::vector<Material> materials_of_model;
  /// These are the true parameters of the model; empty where there are none.
  Eigen::VectorXd parameters_of_model;
  double noise;     ///< Standard deviation over the rms displacement.
  LoadCase unseen;  ///< Another load of the specimen than any measured.
  /// Whether the level is also run with merging of regions that the data do not
  /// tell apart.
  bool is_also_merged = false;
  /// Whether there is time for only one trial of each fit.
  bool is_for_fits_alone = false;
  bool is_in_quick = true;
};

/// Returns a level whose model has the materials of the specimen.  `body_force`
/// is the load that is not measured.
MaterialLevel RightLevel(const std::string& factor, const std::string& level,
                         const Scene& specimen,
                         const Eigen::VectorXd& parameters, double noise,
                         const Eigen::VectorXd& body_force);

/// Returns a number as the text of a level.
std::string LevelText(double value);

/// Returns the levels of a strip of 2 x 1 in plane strain, with 24 x 12
/// quadrilaterals.  It is held at one end and pulled askew at the other, and
/// consists of pieces of two materials, one behind the other, unless the level
/// says otherwise.  The last levels are a bar of ten such pieces, with more and
/// more tetrahedra.
std::vector<MaterialLevel> MaterialLevels();

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MATERIAL_LEVELS_H_
