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
/// whether the camera lost points there, or the specimen ends.  The material
/// carries force across the one and none across the other, so that the
/// displacements around it differ: fits with and without the material (two, and
/// one more for each of the eight largest gaps where there are several) are
/// compared by their square sums.  Where these do not tell, the change of the
/// moduli becomes an error, and so does a part of it where the better fit
/// leaves more than noise (Section::thickness_relative_sd).  A scene of frames
/// is decided by the frame of the largest load.  Notices say what was found,
/// and how to say it instead.
SceneReading ReadWithGapsChosen(const ReadOutline& read);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_GAP_CHOICE_H_
