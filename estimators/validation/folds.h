#ifndef ELASTIMATE_ESTIMATORS_VALIDATION_FOLDS_H_
#define ELASTIMATE_ESTIMATORS_VALIDATION_FOLDS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Into what a measurement is divided.
enum class HeldOutPart {
  kAutomatic,  ///< Load cases if there are several, else points.
  kPoints,     ///< Blocks of neighbouring nodes and points.
  kLoadCases,
};

/// A measurement divided into folds.  A cross-validation fits all folds but
/// one, and predicts that one.
struct Folds {
  /// For people: "x from 0 to 0.2", "load case 2".
  std::vector<std::string> names;
  /// The fold of each node in each load case; -1 for nodes that are not
  /// measured and for those that every fit sees.
  std::vector<Eigen::VectorXi> of_nodes;
  /// The fold of each point in each load case.
  std::vector<Eigen::VectorXi> of_points;

  int Size() const { return static_cast<int>(names.size()); }
};

/// Divides the measurement of a scene into at most `num_folds` folds of nearly
/// the same size.
///
/// Points are divided by planes across the longest edge of their bounding box:
/// a model has to predict a whole part of the specimen, and not points whose
/// neighbours it has seen.  Nodes of supports that moved as they were measured
/// are seen by every fit, because nothing else tells their displacement.
///
/// Load cases are divided into groups of successive ones.
///
/// Throws std::invalid_argument, with one sentence, for fewer than two folds,
/// for a measurement that has fewer parts than that, and for load cases that
/// are not measured.  Precondition: a valid scene.
/// O(num_nodes num_load_cases log num_nodes).
[[nodiscard]] Folds DivideMeasurement(const Scene& scene, HeldOutPart part,
                                      int num_folds);

/// A scene with a part of the measurement of another one.
struct PartOfScene {
  Scene scene;
  /// The load cases of the other scene that have such a part.
  std::vector<Eigen::Index> load_cases;
};

/// Returns the scene as if `fold` had not been measured.
[[nodiscard]] PartOfScene WithoutFold(const Scene& scene, const Folds& folds,
                                      int fold);
/// Returns the scene as if nothing but `fold`, and what every fit sees, had
/// been measured, and no resultants.
[[nodiscard]] PartOfScene OnlyFold(const Scene& scene, const Folds& folds,
                                   int fold);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_VALIDATION_FOLDS_H_
