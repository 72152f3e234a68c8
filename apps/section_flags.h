#ifndef ELASTIMATE_APPS_SECTION_FLAGS_H_
#define ELASTIMATE_APPS_SECTION_FLAGS_H_

#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Returns what --model and --thickness give.  Throws std::invalid_argument,
/// naming the flag, for a wrong value.
SectionChoice SectionFromFlags();

/// Returns what --regions gives.  Throws as SectionFromFlags does.
RegionChoice RegionsFromFlag();

/// Throws std::invalid_argument where --regions asks for merging, which only
/// `estimate` does.
void CheckNoMerging();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SECTION_FLAGS_H_
