// A class that keeps a reference to an argument of its constructor must not
// take a temporary object.

#include <gtest/gtest.h>

#include <type_traits>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/linear_mesh.h"

namespace elastimate {
namespace {

template <class Object, class Argument, class... Others>
constexpr bool TakesLastingOnesOnly() {
  return std::is_constructible_v<Object, Argument&, Others...> &&
         std::is_constructible_v<Object, const Argument&, Others...> &&
         !std::is_constructible_v<Object, Argument, Others...> &&
         !std::is_constructible_v<Object, const Argument, Others...>;
}

TEST(Lifetimes, TemporariesAreNotReferredTo) {
  EXPECT_TRUE((TakesLastingOnesOnly<Equilibrium, Scene, SolverKind>()));
  EXPECT_TRUE((TakesLastingOnesOnly<InternalForces, Mesh,
                                    const std::vector<Material>&>()));
  EXPECT_TRUE((TakesLastingOnesOnly<StiffnessOperator, Mesh>()));
  EXPECT_TRUE((TakesLastingOnesOnly<StiffnessOperator, Mesh, int>()));
  EXPECT_TRUE((TakesLastingOnesOnly<LinearMesh, Mesh>()));
}

}  // namespace
}  // namespace elastimate
