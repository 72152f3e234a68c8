#ifndef ELASTIMATE_APPS_ELEMENT_ORDER_H_
#define ELASTIMATE_APPS_ELEMENT_ORDER_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Throws std::invalid_argument unless --order is an element order.
void CheckOrderFlag();

/// QuadraticScene with --order=2, nothing with --order=1.  Adds a notice of
/// what becomes of nodal forces.
std::optional<Scene> QuadraticSceneIfAsked(const Scene& scene,
                                           std::vector<std::string>& notices);

/// Whether every load of the scene is one of nodal forces.
bool HasNodalForcesOnly(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_ELEMENT_ORDER_H_
