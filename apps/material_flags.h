#ifndef ELASTIMATE_APPS_MATERIAL_FLAGS_H_
#define ELASTIMATE_APPS_MATERIAL_FLAGS_H_

#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// What --material and --axis give.  Throws std::invalid_argument, naming the
/// flag, for a value that is none.
LawChoice LawFromFlags();

/// Whether --material=auto has the measurement choose the law.
bool ChoosesLaw();

/// What --axis gives then: axes are those of a law that takes as many.
LawChoice AxesOfLawsToChoose();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_MATERIAL_FLAGS_H_
