// Supports that moved by unknown amounts, resultants, and a rigid motion of
// all, in iterative-fe.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

const IsotropicElasticity kTruth = {3e3, 0.3};

Estimate RunIterativeFe(const Scene& scene,
                        const EstimatorOptions& options = {}) {
  return MakeEstimator("iterative-fe")->Run(scene, options);
}

std::vector<int> HeldNodes(const Scene& scene) {
  std::vector<int> nodes;
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.supports.held.col(node).any()) {
      nodes.push_back(node);
    }
  }
  return nodes;
}

// The forces that the textbook's supports exert, with the standard deviation.
Resultant ResultantOfSupports(const Scene& scene, const LoadCase& load_case,
                              const std::vector<int>& nodes, double noise_sd) {
  const int dimension = scene.mesh.Dimension();
  const Eigen::MatrixXd stiffness = testing::TextbookStiffness(
      scene.mesh,
      testing::HookeMatrixOf(kTruth, scene.mesh.section.model));
  const Eigen::MatrixXd force =
      (stiffness * load_case.displacement.reshaped())
          .reshaped(dimension, scene.mesh.NumNodes()) -
      AssembleLoads(scene.mesh, load_case.loads);
  return {nodes, force(Eigen::all, nodes).rowwise().sum(),
          Eigen::VectorXd::Constant(dimension, noise_sd)};
}

// Displaced supports, whose displacement is forgotten once it is measured.
Scene SceneOfMeasuredSupports(const KindOfSection& kind, int cells = 3) {
  Scene scene = testing::SceneOfKind(kind, cells);
  testing::DisplaceSupports(scene);
  testing::MeasureByTextbook(kTruth, scene);
  scene.supports.displacement.setZero();
  scene.supports.unknown = scene.supports.held;
  return scene;
}

// The same without loads, and with what a load cell measured.
Scene SceneOfResultants(const KindOfSection& kind) {
  Scene scene = testing::SceneOfKind(kind);
  for (LoadCase& load_case : scene.load_cases) {
    load_case.loads.clear();
  }
  // The far side is held too, and moved.
  const int last = scene.mesh.Dimension() - 1;
  const double far = scene.mesh.nodes.row(last).maxCoeff();
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(last, node) > 0.9 * far) {
      scene.supports.held.col(node).setConstant(true);
    }
  }
  const std::vector<int> held = HeldNodes(scene);
  testing::DisplaceSupports(scene);
  std::vector<int> moved;
  for (const int node : held) {
    if (scene.mesh.nodes(last, node) > 0.5 * far) {
      scene.supports.displacement(last, node) += 0.02;
      moved.push_back(node);
    }
  }
  testing::MeasureByTextbook(kTruth, scene);
  for (LoadCase& load_case : scene.load_cases) {
    load_case.resultants = {ResultantOfSupports(scene, load_case, moved, 1e-3)};
  }
  scene.supports.displacement.setZero();
  scene.supports.unknown = scene.supports.held;
  return scene;
}

void ExpectTruth(const Estimate& estimate, double tolerance) {
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kTruth.youngs_modulus, 1,
              tolerance);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kTruth.poisson_ratio,
              tolerance);
}

class UnknownMotionOfKinds : public ::testing::TestWithParam<KindOfSection> {};

TEST_P(UnknownMotionOfKinds, OfMeasuredSupportsLeavesExactDataExact) {
  ExpectTruth(RunIterativeFe(SceneOfMeasuredSupports(GetParam())), 1e-8);
}

TEST_P(UnknownMotionOfKinds, ResultantsTakeThePlaceOfLoads) {
  ExpectTruth(RunIterativeFe(SceneOfResultants(GetParam())), 1e-8);
}

TEST_P(UnknownMotionOfKinds, OfRigidFacesLeavesExactDataExact) {
  Scene scene = testing::SceneOfKind(GetParam());
  const std::vector<int> held = HeldNodes(scene);
  const int dimension = scene.mesh.Dimension();
  const Eigen::VectorXd motion =
      Eigen::VectorXd::LinSpaced(NumRigidMotions(dimension), 0.01, 0.03);
  for (const int node : held) {
    scene.supports.displacement.col(node) =
        RigidMotionsAt(scene.mesh.nodes.col(node)) * motion;
  }
  scene.supports.held(Eigen::all, held).setConstant(true);
  testing::MeasureByTextbook(kTruth, scene);
  scene.supports.displacement.setZero();
  scene.supports.unknown = scene.supports.held;
  scene.supports.rigid_faces = {
      {held, Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(dimension, true)}};
  // Nothing is known of the face but that it is rigid.
  for (LoadCase& load_case : scene.load_cases) {
    load_case.observed = !scene.supports.held;
  }
  ExpectTruth(RunIterativeFe(scene), 1e-8);
}

TEST_P(UnknownMotionOfKinds, OfTheCameraLeavesExactDataExact) {
  Scene scene = testing::SceneOfKind(GetParam());
  testing::MeasureByTextbook(kTruth, scene);
  const Eigen::VectorXd motion = Eigen::VectorXd::LinSpaced(
      NumRigidMotions(scene.mesh.Dimension()), 0.01, 0.03);
  for (LoadCase& load_case : scene.load_cases) {
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      load_case.displacement.col(node) +=
          RigidMotionsAt(scene.mesh.nodes.col(node)) * motion;
    }
  }
  scene.is_rigid_motion_free = true;
  ExpectTruth(RunIterativeFe(scene), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(
    All, UnknownMotionOfKinds,
    ::testing::ValuesIn(testing::AllKindsOfSections()),
    [](const auto& info) { return testing::NameOf(info.param); });

}  // namespace
}  // namespace elastimate
