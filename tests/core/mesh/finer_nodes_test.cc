#include "elastimate/core/mesh/finer_nodes.h"

#include <gtest/gtest.h>

#include "elastimate/core/scene/finer_scene.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

class FinerNodesOfKinds
    : public ::testing::TestWithParam<testing::KindOfSection> {
 protected:
  FinerNodesOfKinds()
      : scene_(testing::SceneOfKind(GetParam())),
        finer_(FinerScene(scene_)),
        nodes_(scene_.mesh, finer_.mesh) {}

  Scene scene_;
  Scene finer_;
  FinerNodes nodes_;
};

// All second powers of the coordinates, each as a component.
Eigen::MatrixXd PowersAt(const Mesh& mesh) {
  const int dimension = mesh.Dimension();
  Eigen::MatrixXd powers(mesh.NumDofs(), dimension);
  for (int k = 0; k < dimension; ++k) {
    const Eigen::MatrixXd field =
        mesh.nodes * mesh.nodes.row(k).transpose().asDiagonal();
    powers.col(k) = field.reshaped();
  }
  return powers;
}

TEST_P(FinerNodesOfKinds, InterpolateWhatTheElementsCanDo) {
  const auto fields = [&](const Mesh& mesh) {
    // The places in a curved element are all of its functions that are known.
    return scene_.mesh.Order() == 1 || IsCurved(scene_.mesh.kind)
               ? Eigen::MatrixXd(mesh.nodes.reshaped())
               : PowersAt(mesh);
  };
  EXPECT_EQ(nodes_.NumNodes(), scene_.mesh.NumNodes());
  EXPECT_EQ(nodes_.NumMidEdges(),
            finer_.mesh.NumNodes() - scene_.mesh.NumNodes());
  EXPECT_TRUE(nodes_.Interpolate(fields(scene_.mesh))
                  .isApprox(fields(finer_.mesh), 1e-13));
}

TEST_P(FinerNodesOfKinds, RestrictByTheTranspose) {
  const Eigen::MatrixXd forces =
      Eigen::MatrixXd::Random(finer_.mesh.NumDofs(), 2);
  const Eigen::MatrixXd displacements =
      Eigen::MatrixXd::Random(scene_.mesh.NumDofs(), 2);
  const double work = (displacements.transpose() * nodes_.Restrict(forces) -
                       nodes_.Interpolate(displacements).transpose() * forces)
                          .norm();
  EXPECT_LT(work, 1e-12 * forces.norm() * displacements.norm());
}

INSTANTIATE_TEST_SUITE_P(Kinds, FinerNodesOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
