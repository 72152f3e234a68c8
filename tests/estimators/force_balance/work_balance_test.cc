#include "elastimate/estimators/force_balance/work_balance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <string>

#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/virtual_work_regression.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "tests/estimators/force_balance/dense_virtual_work.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

Scene NoisyScene(const std::string& shape, double nu, double noise) {
  Scene scene = SmallScene(shape);
  Measure({5e4, nu}, scene);
  AddNoise(noise, 1, scene);
  return scene;
}

// The measurement of a scene in fields of degree 2.
struct Balance {
  explicit Balance(const Scene& scene)
      : work(scene.mesh, scene.supports, 2),
        prepared(scene),
        forces(prepared, scene),
        free(scene, {}),
        balance(work, forces) {}

  double SquareSum(const Eigen::VectorXd& variables) {
    Eigen::VectorXd residual;
    EXPECT_TRUE(
        balance.Evaluate(free.ModuliAt(variables), {}, &residual, nullptr));
    return residual.squaredNorm();
  }

  VirtualWork work;
  ForceScene prepared;
  ForceResidual forces;
  FreeParameters free;
  WorkBalance balance;
};

struct DenseBalance : testing::DenseVirtualWork {
  using DenseVirtualWork::DenseVirtualWork;

  Eigen::MatrixXd Gram(double nu) const {
    const Eigen::MatrixXd stiffened = h_fields + nu * j_fields;
    return stiffened.transpose() * stiffened;
  }

  // Returns the least value over t of r^T G^-1 r at this nu.
  double SquareSum(const Scene& scene, double nu) const {
    const Eigen::VectorXd q = scene.load_cases[0].displacement.reshaped();
    const Eigen::VectorXd f =
        fields.transpose() * AssembleLoadCases(scene).reshaped();
    const Eigen::VectorXd a = fields.transpose() * ((h + nu * j) * q);
    const Eigen::LLT<Eigen::MatrixXd> gram(Gram(nu));
    const double t = a.dot(gram.solve(f)) / f.dot(gram.solve(f));
    return (a - t * f).dot(gram.solve(a - t * f));
  }
};

TEST(WorkBalance, ItsMinimumIsTheLeastOfTheDenseBalance) {
  constexpr int kGrid = 400;
  for (const std::string& shape : testing::SmallSceneNames()) {
    for (const double nu : {-0.5, 0.3, 0.45}) {
      SCOPED_TRACE(shape + ", nu " + std::to_string(nu));
      const Scene scene = NoisyScene(shape, nu, 0.05);
      Balance sparse(scene);
      const DenseBalance dense(scene, sparse.work);
      const std::optional<BoundedMinimum> best =
          MinimizeWorkBalance(sparse.free, 50, sparse.forces, sparse.balance);
      ASSERT_TRUE(best.has_value());
      double least = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= kGrid; ++i) {
        least =
            std::min(least, dense.SquareSum(scene, -0.99 + 1.489 * i / kGrid));
      }
      const double own = dense.SquareSum(scene, best->variables(1));
      EXPECT_LE(own, least * (1 + 1e-9));
      EXPECT_NEAR(sparse.SquareSum(best->variables) / own, 1, 1e-6);
    }
  }
}

TEST(WorkBalance, ItsDerivativeIsThatOfTheSquareSum) {
  Balance sparse(NoisyScene("organ", 0.3, 0.1));
  for (const double nu : {-0.5, 0.0, 0.25, 0.45}) {
    const Eigen::Vector2d x(std::log(5e4), nu);
    Eigen::VectorXd residual;
    Eigen::MatrixXd jacobian;
    ASSERT_TRUE(sparse.balance.Evaluate(sparse.free.ModuliAt(x),
                                        sparse.free.ModuliJacobian(x),
                                        &residual, &jacobian));
    const Eigen::Vector2d slope = 2 * jacobian.transpose() * residual;
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Eigen::Vector2d step = 1e-5 * Eigen::Vector2d::Unit(i);
      const double difference =
          (sparse.SquareSum(x + step) - sparse.SquareSum(x - step)) / 2e-5;
      EXPECT_NEAR(slope(i) / difference, 1, 1e-4) << "nu " << nu << ", " << i;
    }
  }
}

// Two regions of equal materials have the balance of one material, though
// several materials take other passes over the elements.
TEST(WorkBalance, OfOneMaterialIsThatOfTwoAlike) {
  Scene scene = NoisyScene("organ", 0.3, 0.05);
  Balance one(scene);
  scene.mesh.regions.resize(scene.mesh.NumElements());
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    scene.mesh.regions(e) = e % 2 == 0 ? 1 : 2;
  }
  scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
  Balance two(scene);
  const Eigen::Vector2d x(std::log(4e4), 0.2);
  Eigen::MatrixXd same(4, 2);
  same << 1, 0, 0, 1, 1, 0, 0, 1;
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  ASSERT_TRUE(one.balance.Evaluate(
      one.free.ModuliAt(x), one.free.ModuliJacobian(x), &residual, &jacobian));
  const Eigen::MatrixXd of_noise =
      one.balance.NoiseOfInformation(one.free.ModuliJacobian(x));
  Eigen::VectorXd residual_of_two;
  Eigen::MatrixXd jacobian_of_two;
  const Eigen::MatrixXd directions = two.free.ModuliJacobian(same * x) * same;
  ASSERT_TRUE(two.balance.Evaluate(two.free.ModuliAt(same * x), directions,
                                   &residual_of_two, &jacobian_of_two));
  EXPECT_NEAR(residual_of_two.norm() / residual.norm(), 1, 1e-9);
  EXPECT_TRUE((jacobian_of_two.transpose() * jacobian_of_two)
                  .isApprox(jacobian.transpose() * jacobian, 1e-8));
  // The probes are random: with 24 fields and 16 probes the relative standard
  // error is about 7 %.
  const Eigen::MatrixXd by_probes = two.balance.NoiseOfInformation(directions);
  EXPECT_NEAR(by_probes(1, 1) / of_noise(1, 1), 1, 4 * 0.07);
}

// The noise of (I - P) J V L^-T, by dense matrices.
TEST(WorkBalance, ItsInformationOfNoiseIsThatOfDenseMatrices) {
  const Scene scene = NoisyScene("cuboid", 0.3, 0.05);
  Balance sparse(scene);
  const DenseBalance dense(scene, sparse.work);
  Eigen::VectorXd residual;
  ASSERT_TRUE(
      sparse.balance.Evaluate(Eigen::Vector2d(1, 0.3), {}, &residual, nullptr));
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(dense.Gram(0.3)).inverse();
  const Eigen::MatrixXd cross =
      (dense.h_fields + 0.3 * dense.j_fields).transpose() * dense.j_fields;
  const double expected =
      (inverse * (dense.j_fields.transpose() * dense.j_fields)).trace() -
      (inverse * cross.transpose() * inverse * cross).trace();
  EXPECT_NEAR(
      sparse.balance.NoiseOfInformation(Eigen::Vector2d(0, 1))(0, 0) / expected,
      1, 1e-6);
}

}  // namespace
}  // namespace elastimate
