#include "elastimate/estimators/force_balance/virtual_work.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "elastimate/core/scene/loads.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::DenseDH;
using testing::DenseDJ;
using testing::DenseStiffness;
using testing::Measure;
using testing::SmallScene;
using testing::SmallSceneNames;

// The fields, and H V and J V in the free rows, by dense matrices.
struct DenseVirtualWork {
  DenseVirtualWork(const VirtualWork& work, const Scene& scene)
      : fields(work.Fields()),
        h(DenseStiffness<double>(scene.mesh, DenseDH())),
        j(DenseStiffness<double>(scene.mesh, DenseDJ())) {
    for (Eigen::Index i = 0; i < scene.supports.held.size(); ++i) {
      if (!scene.supports.held.reshaped()(i)) {
        free.push_back(i);
      }
    }
    h_fields = (h * fields)(free, Eigen::all);
    j_fields = (j * fields)(free, Eigen::all);
  }

  // S(nu): the least over t of r^T G^-1 r.
  double SquareSum(const Scene& scene, double nu) const {
    const Eigen::VectorXd q = scene.load_cases[0].displacement.reshaped();
    const Eigen::VectorXd f =
        fields.transpose() * AssembleLoadCases(scene).reshaped();
    const Eigen::VectorXd a = fields.transpose() * ((h + nu * j) * q);
    const Eigen::MatrixXd stiffened = h_fields + nu * j_fields;
    const Eigen::LLT<Eigen::MatrixXd> gram(stiffened.transpose() * stiffened);
    const double t = a.dot(gram.solve(f)) / f.dot(gram.solve(f));
    return (a - t * f).dot(gram.solve(a - t * f));
  }

  Eigen::MatrixXd fields;
  Eigen::MatrixXd h;
  Eigen::MatrixXd j;
  Eigen::MatrixXd h_fields;
  Eigen::MatrixXd j_fields;
  std::vector<Eigen::Index> free;
};

TEST(VirtualWork, ItsTriangleHasTheProductsOfTheDenseStiffness) {
  for (const std::string& shape : SmallSceneNames()) {
    for (const int degree : {1, 2, 3}) {
      SCOPED_TRACE(shape + ", degree " + std::to_string(degree));
      const Scene scene = SmallScene(shape);
      const VirtualWork work(scene.mesh, scene.supports, degree);
      const DenseVirtualWork dense(work, scene);
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
      const Eigen::MatrixXd stiffened = dense.h_fields + 0.3 * dense.j_fields;
      const Eigen::MatrixXd upper = work.FactorNoise(0.3).upper;
      EXPECT_TRUE(
          near(upper.transpose() * upper, stiffened.transpose() * stiffened));
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

TEST(VirtualWorkBalance, FindsTheLeastOfTheDenseBalance) {
  constexpr int kGrid = 400;
  for (const std::string& shape : SmallSceneNames()) {
    for (const double nu : {-0.5, 0.3, 0.45}) {
      SCOPED_TRACE(shape + ", nu " + std::to_string(nu));
      Scene scene = SmallScene(shape);
      Measure({5e4, nu}, scene);
      AddNoise(0.05, 1, scene);
      const VirtualWork work(scene.mesh, scene.supports, 2);
      const VirtualWorkBalance balance(work, scene);
      const DenseVirtualWork dense(work, scene);
      const VirtualWorkFit best = balance.Minimize({-0.99, 0.499}, {});
      double least = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= kGrid; ++i) {
        const double at = -0.99 + (0.499 + 0.99) * i / kGrid;
        least = std::min(least, dense.SquareSum(scene, at));
      }
      const double own = dense.SquareSum(scene, best.poisson_ratio);
      EXPECT_LE(own, least * (1 + 1e-9));
      EXPECT_NEAR(best.square_sum / own, 1, 1e-6);
    }
  }
}

TEST(VirtualWorkBalance, ItsSlopeIsThatOfTheSquareSum) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.1, 1, scene);
  const VirtualWork work(scene.mesh, scene.supports, 2);
  const VirtualWorkBalance balance(work, scene);
  // Free; and held by a bound on E, which moves t with nu.
  for (const Bounds& youngs_modulus :
       {Bounds{}, Bounds{6e4, std::nullopt}, Bounds{std::nullopt, 4e4}}) {
    for (const double nu : {-0.5, 0.0, 0.25, 0.45}) {
      constexpr double kStep = 1e-5;
      const double difference =
          (balance.FitAt(nu + kStep, youngs_modulus).square_sum -
           balance.FitAt(nu - kStep, youngs_modulus).square_sum) /
          (2 * kStep);
      EXPECT_NEAR(balance.FitAt(nu, youngs_modulus).slope / difference, 1, 1e-4)
          << "nu " << nu;
    }
  }
}

// To the last digit, by which an interval that reaches them is told.
TEST(VirtualWorkBalance, ItsProfileEndsAtTheLimitsOfTheRange) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const VirtualWork work(scene.mesh, scene.supports, 2);
  const VirtualWorkBalance balance(work, scene);
  const auto [lower, upper] = balance.ProfileEnds(
      balance.FitAt(0.3, {}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(lower.poisson_ratio, kSmallestPoissonRatio);
  EXPECT_EQ(upper.poisson_ratio, kLargestPoissonRatio);
}

}  // namespace
}  // namespace elastimate
