#ifndef ELASTIMATE_APPS_ELEMENT_ORDER_H_
#define ELASTIMATE_APPS_ELEMENT_ORDER_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Throws std::invalid_argument unless --order is an element order.
void CheckOrderFlag();

/// Returns the QuadraticScene of a scene of linear elements for --order=2, else
/// nothing.  Adds a notice of what becomes of nodal forces.  Throws
/// std::invalid_argument, naming the flag and `source`, where there are no
/// quadratic elements for the scene, and for --order=1 when it has them.
std::optional<Scene> QuadraticSceneIfAsked(const std::string& source,
                                           const Scene& scene,
                                           std::vector<std::string>& notices);

/// Tells whether all loads of the scene are nodal forces.
bool HasNodalForcesOnly(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_ELEMENT_ORDER_H_
