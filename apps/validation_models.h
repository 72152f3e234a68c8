#ifndef ELASTIMATE_APPS_VALIDATION_MODELS_H_
#define ELASTIMATE_APPS_VALIDATION_MODELS_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// A model of a specimen that predictions are made with.
struct ValidationModel {
  std::string name;  ///< "as given", or a word of --compare.
  Scene scene;
  EstimatorOptions options;
};

/// Returns the scene as it is and, behind it, the models of --compare:
/// `one_material` and `each_region` for isotropic materials, `linear` and
/// `quadratic` for the elements, else the law of all materials, which keep what
/// is known of the parameters that both laws have.  Throws
/// std::invalid_argument, naming the flag, for any other word.
std::vector<ValidationModel> ModelsToCompare(const Scene& scene,
                                             const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_VALIDATION_MODELS_H_
