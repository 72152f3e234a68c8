#ifndef ELASTIMATE_APPS_GAP_CHOICE_H_
#define ELASTIMATE_APPS_GAP_CHOICE_H_

#include <functional>
#include <vector>

#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Reads a scene with some of its gaps filled.
using ReadOutline =
    std::function<SceneReading(const std::vector<bool>& is_filled)>;

/// Decides for each gap between the points of a camera (SceneReading::gaps)
/// whether the camera lost points there, or the specimen ends.  Material in the
/// gap carries force and a hole does not, so the displacements around it
/// differ.  Fits with and without this material are compared by their square
/// sums: two fits, and one more for each of the eight largest gaps where there
/// are several.  Where these do not decide, the change of the moduli becomes an
/// error (Section::thickness_relative_sd).  A part of the change becomes one
/// where the better fit leaves more than noise.  A scene of frames is decided
/// by the frame of the largest load.  Notices say what was decided, and which
/// key decides otherwise.
SceneReading ReadWithGapsChosen(const ReadOutline& read);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_GAP_CHOICE_H_
