#ifndef ELASTIMATE_APPS_LAW_CHOICE_H_
#define ELASTIMATE_APPS_LAW_CHOICE_H_

#include <string>
#include <vector>

#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/material_fit/law_choice.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Throws std::invalid_argument, naming the flag, where flags, scene or options
/// do not go with the choice of a law (--material=auto), which compares fits of
/// one measurement.  Throws as well where there are fewer measured components
/// than stiffnesses of all materials.
void CheckLawChoice(const SceneReading& reading,
                    const EstimatorOptions& options);

/// Returns what there is to say before laws are compared: for several materials
/// it takes long.
std::vector<std::string> NoticesOfLawChoice(const Scene& scene);

/// Gives a scene, and the same scene at the element order that was asked for,
/// the materials of the law for which the measurement speaks.  Where laws
/// cannot be compared, a notice says why.  Throws std::invalid_argument where
/// no fit takes the scene.
ChosenLaw GiveChosenLaw(const EstimatorOptions& options,
                        const std::string& sources, Scene& modelled,
                        Scene& scene, std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_LAW_CHOICE_H_
