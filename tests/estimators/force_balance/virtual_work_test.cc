#include "elastimate/estimators/force_balance/virtual_work.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "elastimate/core/scene/loads.h"
#include "tests/estimators/force_balance/dense_virtual_work.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::SmallScene;
using testing::SmallSceneNames;

TEST(VirtualWork, ItsTriangleHasTheProductsOfTheDenseStiffness) {
  for (const std::string& shape : SmallSceneNames()) {
    for (const int degree : {1, 2, 3}) {
      SCOPED_TRACE(shape + ", degree " + std::to_string(degree));
      const Scene scene = SmallScene(shape);
      const VirtualWork work(scene.mesh, scene.supports, degree);
      const testing::DenseVirtualWork dense(scene, work);
      EXPECT_TRUE((dense.fields.transpose() * dense.fields).isIdentity(1e-12));
      const auto near = [](const Eigen::MatrixXd& actual,
                           const Eigen::MatrixXd& expected) {
        return (actual - expected).norm() <= 1e-12 * expected.norm();
      };
      EXPECT_TRUE(near(work.H().transpose() * work.H(),
                       dense.h_fields.transpose() * dense.h_fields));
      EXPECT_TRUE(near(work.H().transpose() * work.J(),
                       dense.h_fields.transpose() * dense.j_fields));
      EXPECT_TRUE(near(work.J().transpose() * work.J(),
                       dense.j_fields.transpose() * dense.j_fields));
      const Eigen::MatrixXd forces = AssembleLoadCases(scene);
      EXPECT_TRUE(near(work.Of(forces), dense.fields.transpose() * forces));
    }
  }
}

// Every polynomial of the degree, in the free rows, is a combination of the
// fields where the supports hold the specimen.
TEST(VirtualWork, ItsFieldsSpanThePolynomials) {
  const Scene scene = SmallScene("organ");
  for (const int degree : {1, 2, 3}) {
    const Eigen::MatrixXd fields =
        VirtualWork(scene.mesh, scene.supports, degree).Fields();
    for (int component = 0; component < 3; ++component) {
      Eigen::MatrixXd field = Eigen::MatrixXd::Zero(3, scene.mesh.NumNodes());
      const auto x = scene.mesh.nodes.row(0).array();
      const auto y = scene.mesh.nodes.row(1).array();
      field.row(component) = x.pow(degree - 1) * y - 2 * y + 1;
      field = scene.supports.held.select(0, field);
      const Eigen::VectorXd column = field.reshaped();
      const Eigen::VectorXd rest =
          column - fields * (fields.transpose() * column);
      EXPECT_LE(rest.norm(), 1e-10 * column.norm())
          << "degree " << degree << ", component " << component;
    }
  }
}

TEST(VirtualWork, MotionsWithoutStrainAreNoFields) {
  Scene scene = SmallScene("organ");
  scene.supports.held.setConstant(false);
  for (const int degree : {1, 2, 3}) {
    const VirtualWork work(scene.mesh, scene.supports, degree);
    EXPECT_EQ(work.NumFields(),
              (degree + 1) * (degree + 2) * (degree + 3) / 2 - 6);
    const Eigen::MatrixXd fields = work.Fields();
    Eigen::MatrixXd motions(fields.rows(), 6);
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      const Eigen::Vector3d x = scene.mesh.nodes.col(node);
      motions.middleRows<3>(3 * node).leftCols<3>().setIdentity();
      motions.middleRows<3>(3 * node).rightCols<3>() << 0, x.z(), -x.y(),
          -x.z(), 0, x.x(), x.y(), -x.x(), 0;
    }
    EXPECT_LE((fields.transpose() * motions).norm(), 1e-9 * motions.norm());
  }
}

TEST(VirtualWork, TellsLoadsThatMoveTheSpecimen) {
  Scene scene = SmallScene("cuboid");
  scene.supports.held.setConstant(false);
  const VirtualWork work(scene.mesh, scene.supports, 2);
  const Eigen::Index last = scene.mesh.NumNodes() - 1;
  const Eigen::Vector3d axis =
      (scene.mesh.nodes.col(last) - scene.mesh.nodes.col(0)).normalized();
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(3, scene.mesh.NumNodes());
  forces.col(last) = axis;
  EXPECT_NEAR(work.Imbalance(forces.reshaped()), 1, 1e-9);
  forces.col(0) = -axis;
  EXPECT_LE(work.Imbalance(forces.reshaped()), 1e-12);
  // A couple.
  forces.col(last) = axis.unitOrthogonal();
  forces.col(0) = -forces.col(last);
  EXPECT_GE(work.Imbalance(forces.reshaped()), 0.5);
  const Scene held = SmallScene("cuboid");
  EXPECT_EQ(
      VirtualWork(held.mesh, held.supports, 2).Imbalance(forces.reshaped()), 0);
}

}  // namespace
}  // namespace elastimate
