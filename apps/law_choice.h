#ifndef ELASTIMATE_APPS_LAW_CHOICE_H_
#define ELASTIMATE_APPS_LAW_CHOICE_H_

#include <string>
#include <vector>

#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/material_fit/law_choice.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Choosing a law (--material=auto) compares fits, and is of one measurement:
/// throws std::invalid_argument, naming the flag, where flags, scene or options
/// do not go with it.
void CheckLawChoice(const SceneReading& reading,
                    const EstimatorOptions& options);

/// Gives a scene, and the same at the element order that was asked for, the
/// materials of the law that the measurement asks for; where laws cannot be
/// compared, a notice says why.  Throws std::invalid_argument where no fit
/// takes the scene.
ChosenLaw GiveChosenLaw(const EstimatorOptions& options,
                        const std::string& sources, Scene& modelled,
                        Scene& scene, std::vector<std::string>& notices);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_LAW_CHOICE_H_
