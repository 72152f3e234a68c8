#ifndef ELASTIMATE_BENCHMARKS_MATERIAL_LEVELS_H_
#define ELASTIMATE_BENCHMARKS_MATERIAL_LEVELS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A specimen, and the materials that an estimator takes it to be of.
struct MaterialLevel {
  std::string factor;  ///< What is varied, with its unit.
  std::string level;
  /// "right", or what the model has too few, too many or wrong of.
  std::string assumption;
  Scene specimen;              ///< With its materials, without measurement.
  Eigen::VectorXd parameters;  ///< What these have.
  /// The regions that the model takes the mesh to have.
  Eigen::VectorXi regions_of_model;
  std::vector<Material> materials_of_model;
  /// The parameters of the specimen that those of the model stand for; empty
  /// where there are none.
  Eigen::VectorXd parameters_of_model;
  double noise;     ///< Standard deviation over the rms displacement.
  LoadCase unseen;  ///< Another load of the specimen than any measured.
  /// Whether regions that are not told apart are also made one.
  bool is_also_merged = false;
  /// Whether one trial of each fit is all that there is time for.
  bool is_for_fits_alone = false;
  bool is_in_quick = true;
};

/// Makes the level of a specimen which the model takes for what it is;
/// `body_force` is the load that is not measured.
MaterialLevel RightLevel(const std::string& factor, const std::string& level,
                         const Scene& specimen,
                         const Eigen::VectorXd& parameters, double noise,
                         const Eigen::VectorXd& body_force);

/// A number as a level.
std::string LevelText(double value);

/// A strip of 2 x 1 in plane strain, of 24 x 12 quadrilaterals, held at one end
/// and pulled askew at the other: of pieces of two materials, one behind the
/// other, unless the level says otherwise.  Last a bar of ten such pieces, of
/// more and more tetrahedra.
std::vector<MaterialLevel> MaterialLevels();

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MATERIAL_LEVELS_H_
