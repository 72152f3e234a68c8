#ifndef ELASTIMATE_APPS_MATERIAL_FLAGS_H_
#define ELASTIMATE_APPS_MATERIAL_FLAGS_H_

#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// What --material and --axis give.  Throws std::invalid_argument, naming the
/// flag, for a value that is none.
LawChoice LawFromFlags();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_MATERIAL_FLAGS_H_
