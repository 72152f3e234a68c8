#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_HELD_SCENE_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_HELD_SCENE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A scene whose model has one solution: the given one where its supports leave
/// no motion without strain, and otherwise the same, held in as many components
/// more as there are such motions, with its rigid motion free
/// (Scene::is_rigid_motion_free).  Loads that balance are borne by those
/// components without reactions.  WhyNotHeld tells of the result where parts of
/// the mesh hang together by less than a face, and still move.
///
/// Cost: O(num_nodes).
Scene HeldScene(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_HELD_SCENE_H_
