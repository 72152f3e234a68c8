#include "apps/section_flags.h"

#include <stdexcept>
#include <string>

#include "apps/flags.h"
#include "elastimate/io/scene/section.h"

namespace elastimate {

SectionChoice SectionFromFlags() {
  SectionChoice section;
  if (IsGiven("model")) {
    section.model = SectionModelOfName(FLAGS_model);
    if (!section.model) {
      throw std::invalid_argument(AsGiven("model") + "; it must be " +
                                  kSectionModels);
    }
  }
  if (IsGiven("thickness")) {
    section.thickness = FLAGS_thickness;
    if (!(FLAGS_thickness > 0)) {
      throw std::invalid_argument(AsGiven("thickness") +
                                  "; it must be positive");
    }
  }
  return section;
}

RegionChoice RegionsFromFlag() {
  if (!IsGiven("regions")) {
    return RegionChoice::kAsGiven;
  }
  if (FLAGS_regions == "each") {
    return RegionChoice::kEach;
  }
  if (FLAGS_regions == "merge") {
    return RegionChoice::kGivenOrEach;
  }
  if (FLAGS_regions != "one") {
    throw std::invalid_argument(AsGiven("regions") +
                                "; it must be one, each or merge");
  }
  return RegionChoice::kOne;
}

void CheckNoMerging() {
  if (FLAGS_regions == "merge") {
    throw std::invalid_argument(
        AsGiven("regions") +
        " is for the command estimate only; give one or each here");
  }
}

}  // namespace elastimate
