#ifndef ELASTIMATE_APPS_SECTION_FLAGS_H_
#define ELASTIMATE_APPS_SECTION_FLAGS_H_

#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// What --model and --thickness give.  Throws std::invalid_argument, naming the
/// flag, for a value that is none.
SectionChoice SectionFromFlags();

/// What --regions gives; likewise.
RegionChoice RegionsFromFlag();

/// Throws std::invalid_argument where it asks for merging, which is of
/// `estimate` alone.
void CheckNoMerging();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SECTION_FLAGS_H_
