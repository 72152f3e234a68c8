#include "elastimate/core/mesh/finer_nodes.h"

#include <gtest/gtest.h>

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/quadratic_scene.h"
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

// All second powers of the coordinates, each as a component.  In elements whose
// map is not affine these are no functions of the elements, but their positions
// are.
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
    return scene_.mesh.Order() == 1 || !IsAffine(scene_.mesh.kind)
               ? Eigen::MatrixXd(mesh.nodes.reshaped())
               : PowersAt(mesh);
  };
  EXPECT_EQ(nodes_.NumNodes(), scene_.mesh.NumNodes());
  EXPECT_EQ(nodes_.NumMiddles(),
            finer_.mesh.NumNodes() - scene_.mesh.NumNodes());
  EXPECT_TRUE(nodes_.Interpolate(fields(scene_.mesh))
                  .isApprox(fields(finer_.mesh), 1e-13));
}

// All products of second powers of the coordinates along the axes of a block.
TEST(FinerNodes, KeepWhatIsQuadraticAlongEachAxis) {
  for (const ElementKind kind : {ElementKind::kHex8, ElementKind::kQuad4}) {
    Scene scene = testing::SceneOfKind(
        {kind, DimensionOf(kind) == 3 ? SectionModel::kSolid
                                      : SectionModel::kPlaneStress});
    const int dimension = scene.mesh.Dimension();
    // The first 4^dimension nodes are a grid before they are distorted.
    for (Eigen::Index i = 0; i < scene.mesh.NumNodes(); ++i) {
      for (int k = 0; k < dimension; ++k) {
        scene.mesh.nodes(k, i) = (i >> (2 * k)) % 4 - 0.7 * k;
      }
    }
    const Scene quadratic = QuadraticScene(scene);
    const Scene finer = FinerScene(quadratic);
    const auto field = [&](const Mesh& mesh) {
      const Eigen::RowVectorXd product =
          mesh.nodes.array().square().colwise().prod();
      return Eigen::MatrixXd(
          product.replicate(dimension, 1).reshaped(mesh.NumDofs(), 1));
    };
    EXPECT_TRUE(FinerNodes(quadratic.mesh, finer.mesh)
                    .Interpolate(field(quadratic.mesh))
                    .isApprox(field(finer.mesh), 1e-13));
  }
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
