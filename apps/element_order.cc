#include "apps/element_order.h"

#include <algorithm>
#include <stdexcept>

#include "apps/flags.h"
#include "elastimate/core/scene/quadratic_scene.h"

namespace elastimate {
namespace {

bool IsNodal(const Load& load) {
  return std::holds_alternative<NodalForces>(load);
}

bool HasNodalForces(const Scene& scene) {
  return std::any_of(scene.load_cases.begin(), scene.load_cases.end(),
                     [](const LoadCase& load_case) {
                       return std::any_of(load_case.loads.begin(),
                                          load_case.loads.end(), IsNodal);
                     });
}

}  // namespace

void CheckOrderFlag() {
  if (FLAGS_order != 1 && FLAGS_order != 2) {
    throw std::invalid_argument(
        AsGiven("order") +
        "; it must be 1 for linear elements or 2 for quadratic ones");
  }
}

std::optional<Scene> QuadraticSceneIfAsked(const std::string& source,
                                           const Scene& scene,
                                           std::vector<std::string>& notices) {
  const std::string shapes(scene.mesh.Topology().shapes);
  if (scene.mesh.Order() == 2 && IsGiven("order") && FLAGS_order == 1) {
    throw std::invalid_argument(AsGiven("order") + ": " + source +
                                " has quadratic " + shapes +
                                "; leave the flag out, or give a linear mesh");
  }
  if (FLAGS_order == 1 || scene.mesh.Order() == 2) {
    return std::nullopt;
  }
  if (HasNodalForces(scene)) {
    notices.emplace_back(
        "with --order=2, nodal forces on all nodes of a face or an element are "
        "spread over it, and other nodal forces act at vertices; if they stand "
        "for a force on a surface, a traction or a pressure, give that in a "
        "scene.json");
  }
  return QuadraticScene(scene);
}

bool HasNodalForcesOnly(const Scene& scene) {
  return std::all_of(scene.load_cases.begin(), scene.load_cases.end(),
                     [](const LoadCase& load_case) {
                       return std::all_of(load_case.loads.begin(),
                                          load_case.loads.end(), IsNodal);
                     });
}

}  // namespace elastimate
