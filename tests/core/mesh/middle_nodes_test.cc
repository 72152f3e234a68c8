#include "elastimate/core/mesh/middle_nodes.h"

#include <gtest/gtest.h>

#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

class MiddleNodesOfKinds
    : public ::testing::TestWithParam<testing::KindOfSection> {
 protected:
  MiddleNodesOfKinds()
      : linear_(testing::SceneOfKind(GetParam()).mesh),
        quadratic_(QuadraticScene(testing::SceneOfKind(GetParam())).mesh),
        middle_nodes_(quadratic_),
        finer_nodes_(linear_, quadratic_) {}

  Mesh linear_;
  Mesh quadratic_;
  MiddleNodes middle_nodes_;
  // Which take displacements of the linear elements to all nodes.
  FinerNodes finer_nodes_;
};

TEST_P(MiddleNodesOfKinds, InterpolateLinearFields) {
  EXPECT_EQ(middle_nodes_.NumVertices(), linear_.NumNodes());
  const Eigen::VectorXd at_vertices = linear_.nodes.reshaped();
  EXPECT_TRUE(finer_nodes_.Interpolate(at_vertices)
                  .isApprox(quadratic_.nodes.reshaped(), 1e-14));
}

TEST_P(MiddleNodesOfKinds, RestrictByTheTranspose) {
  const Eigen::MatrixXd forces =
      Eigen::MatrixXd::Random(quadratic_.NumDofs(), 2);
  const Eigen::MatrixXd displacements =
      Eigen::MatrixXd::Random(linear_.NumDofs(), 2);
  const double work =
      (displacements.transpose() * middle_nodes_.Restrict(forces) -
       finer_nodes_.Interpolate(displacements).transpose() * forces)
          .norm();
  EXPECT_LT(work, 1e-12 * forces.norm() * displacements.norm());
}

TEST_P(MiddleNodesOfKinds, AreNoneOfLinearElements) {
  const MiddleNodes none(linear_);
  EXPECT_EQ(none.Vertices().Size(), 0);
  const Eigen::VectorXd forces = linear_.nodes.reshaped();
  EXPECT_EQ(none.Restrict(forces), forces);
}

INSTANTIATE_TEST_SUITE_P(
    Linear, MiddleNodesOfKinds,
    ::testing::Values(
        testing::KindOfSection{ElementKind::kTet4, SectionModel::kSolid},
        testing::KindOfSection{ElementKind::kHex8, SectionModel::kSolid},
        testing::KindOfSection{ElementKind::kTri3, SectionModel::kPlaneStress},
        testing::KindOfSection{ElementKind::kQuad4,
                               SectionModel::kPlaneStress}),
    testing::KindTestName);

}  // namespace
}  // namespace elastimate
