#ifndef ELASTIMATE_APPS_MATERIAL_FLAGS_H_
#define ELASTIMATE_APPS_MATERIAL_FLAGS_H_

#include <string>

#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Returns what --material and --axis give.  Throws std::invalid_argument,
/// naming the flag, for a wrong value.
LawChoice LawFromFlags();

/// Tells whether --material=auto has the measurement choose the law.
bool ChoosesLaw();

/// Returns the axes that --axis gives for --material=auto; they are for laws
/// that take as many.
LawChoice AxesOfLawsToChoose();

/// Returns the parameter of which --map asks for a map; empty where it asks for
/// none.  Throws std::invalid_argument for another one than Young's modulus,
/// and beside flags that ask for other materials.
std::string FieldFromFlag();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_MATERIAL_FLAGS_H_
