#include "elastimate/estimators/reduced_model/compliance_norm.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "tests/dense_reference.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

// Returns the square root of the largest eigenvalue of D A^-1 D, by dense
// algebra.
double DenseNorm(const Scene& scene, double nu,
                 const Eigen::VectorXd& weights) {
  const DegreesOfFreedom dofs(scene.supports);
  const Eigen::MatrixXd stiffness = testing::DenseStiffness<double>(
      scene.mesh, testing::DenseDH() + nu * testing::DenseDJ());
  const Eigen::MatrixXd free = stiffness(dofs.free, dofs.free);
  const Eigen::VectorXd d = weights(dofs.free);
  const Eigen::MatrixXd compliance =
      d.asDiagonal() *
      testing::SolveDensely(free, Eigen::MatrixXd(d.asDiagonal()));
  return std::sqrt(testing::SymmetricEigenvalues(compliance).maxCoeff());
}

// With few components the spectrum differs from that with all.
TEST(ComplianceNorm, IsAnUpperBoundAndNearTheLargestCompliance) {
  for (const std::string shape : {"bracket", "dome"}) {
    for (const double nu : {-0.5, 0.3, 0.499}) {
      const Scene scene = testing::ShapeScene(shape, "tension");
      StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kCholesky);
      ASSERT_TRUE(solver.Factorize(nu));
      for (const int stride : {1, 50}) {
        SCOPED_TRACE(shape + ", nu " + std::to_string(nu) + ", one of " +
                     std::to_string(stride));
        Eigen::VectorXd weights =
            Eigen::VectorXd::Zero(3 * scene.mesh.NumNodes());
        for (Eigen::Index i = weights.size() - 1; i >= 0; i -= stride) {
          weights(i) = 1 + 0.5 * std::sin(double(i));
        }
        const double exact = DenseNorm(scene, nu, weights);
        const double norm = ComplianceNorm(weights, solver);
        EXPECT_GE(norm, exact);
        EXPECT_LE(norm, 2 * exact);
      }
    }
  }
}

}  // namespace
}  // namespace elastimate
