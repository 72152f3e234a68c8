#include "elastimate/estimators/maps/field_sensitivity.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "tests/element_kinds.h"
#include "tests/estimators/maps/map_scenes.h"
#include "tests/regions.h"

namespace elastimate::testing {
namespace {

constexpr double kNoise = 0.01;

// Numbers of no pattern that are the same in every run.
Eigen::VectorXd Scattered(Eigen::Index size) {
  return Eigen::VectorXd::LinSpaced(size, 1, double(size))
      .unaryExpr([](double i) { return std::sin(i * i); });
}

// The moduli are those of a specimen of this Young's modulus, scattered.
// Differences over a step are wrong by its square, and by rounding over the
// step.
void ExpectSensitivity(const Scene& scene, const std::string& name,
                       double youngs_modulus = 1, double step = 1e-5,
                       double tolerance = 1e-6) {
  FieldSensitivity model(scene, SolverKind::kCholesky);
  const Eigen::Index n = model.NumElements();
  const Eigen::VectorXd m =
      (0.3 * Scattered(n)).array() + std::log(youngs_modulus);
  const Eigen::VectorXd v = Scattered(n + 5).tail(n);
  const auto residual_at = [&](const Eigen::VectorXd& log_moduli, double nu) {
    EXPECT_TRUE(model.MoveTo(log_moduli, nu, kNoise)) << name;
    return Eigen::VectorXd(model.Residual());
  };
  const Eigen::VectorXd by_moduli =
      (residual_at(m - step * v, 0.25) - residual_at(m + step * v, 0.25)) /
      (2 * step);
  const Eigen::VectorXd by_ratio =
      (residual_at(m, 0.25 - step) - residual_at(m, 0.25 + step)) / (2 * step);
  residual_at(m, 0.25);
  const Eigen::VectorXd product = model.Multiply(v);
  EXPECT_LT((model.Eliminate(by_moduli) - product).norm(),
            tolerance * product.norm())
      << name;
  EXPECT_LT((model.Eliminate(by_ratio) - model.OfPoissonRatio()).norm(),
            tolerance * by_ratio.norm())
      << name;
  const Eigen::VectorXd w = model.Eliminate(Scattered(model.NumRows()));
  const double value = product.dot(w);
  EXPECT_NEAR(model.MultiplyTransposed(w).col(0).dot(v), value,
              1e-8 * product.norm() * w.norm())
      << name;
}

TEST(FieldSensitivity, IsTheDerivativeForEachKind) {
  for (const KindOfSection& kind : AllKindsOfSections()) {
    Scene scene = SceneOfKind(kind, 2);
    Measure({1, 0.3}, scene);
    ExpectSensitivity(scene, NameOf(kind));
  }
}

TEST(FieldSensitivity, TakesDisplacedSupportsResultantsAndLoadCases) {
  Scene scene = SceneOfKind({ElementKind::kHex8, SectionModel::kSolid}, 2);
  DisplaceSupports(scene);
  Measure({1, 0.3}, scene);
  scene.load_cases.push_back(scene.load_cases[0]);
  scene.load_cases[1].loads.clear();
  Resultant resultant;
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.supports.held.col(node).all()) {
      resultant.nodes.push_back(node);
    }
  }
  resultant.force = Eigen::Vector3d(0.1, 0.2, -1);
  resultant.noise_sd = Eigen::Vector3d(0.01, 0.01, 0.02);
  scene.load_cases[0].resultants = {resultant};
  ExpectSensitivity(scene, "resultants");
}

TEST(FieldSensitivity, TakesAFreeRigidMotion) {
  Scene scene = SceneOfKind({ElementKind::kQuad4, SectionModel::kPlaneStrain});
  // The camera of a specimen of small strains turns far.  Its increments are
  // those about the undeformed specimen, which is a relative error of the size
  // of the displacements, some 1e-6 here.
  constexpr double kStiff = 1e7;
  Measure({kStiff, 0.3}, scene);
  scene.is_rigid_motion_free = true;
  Eigen::MatrixXd& u = scene.load_cases[0].displacement;
  const Eigen::MatrixXd& x = scene.mesh.nodes;
  const Eigen::VectorXd middle = x.rowwise().mean();
  u = ((Eigen::Rotation2Dd(0.5).toRotationMatrix() *
        ((x + u).colwise() - middle))
           .colwise() +
       middle) -
      x;
  ExpectSensitivity(scene, "rigid motion", kStiff, 1e-3, 2e-5);
}

// The textbook's displacements of two materials leave no residual.
TEST(FieldSensitivity, HasTheDisplacementsOfTheTextbook) {
  const KindOfSection kind = {ElementKind::kTri3, SectionModel::kPlaneStress};
  Scene scene = TwoRegionScene(kind);
  MeasureByTextbook(std::vector<IsotropicElasticity>{{2, 0.3}, {5, 0.3}},
                    scene);
  FieldSensitivity model(scene, SolverKind::kCholesky);
  Eigen::VectorXd m(model.NumElements());
  for (Eigen::Index e = 0; e < m.size(); ++e) {
    m(e) = std::log(scene.mesh.regions(e) == 3 ? 2.0 : 5.0);
  }
  ASSERT_TRUE(model.MoveTo(m, 0.3, 0));
  // The norm of what was measured is 1.
  EXPECT_LT(model.Residual().norm(), 1e-10);
}

}  // namespace
}  // namespace elastimate::testing
