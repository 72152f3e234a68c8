// Supports that moved by unknown amounts, resultants, and a rigid motion of
// all, in iterative-fe.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
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
      scene.mesh, testing::HookeMatrixOf(kTruth, scene.mesh.section.model));
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

// The scene without loads, and with what a load cell measured.
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

// A camera lost a node, which its neighbours tell of.
TEST_P(UnknownMotionOfKinds, OfANodeThatWasLostLeavesExactDataExact) {
  Scene scene = SceneOfMeasuredSupports(GetParam());
  const int lost = HeldNodes(scene)[1];
  for (LoadCase& load_case : scene.load_cases) {
    load_case.observed.setConstant(scene.mesh.Dimension(),
                                   scene.mesh.NumNodes(), true);
    load_case.observed.col(lost).setConstant(false);
    load_case.displacement.col(lost).setConstant(std::nan(""));
  }
  ExpectTruth(RunIterativeFe(scene), 1e-8);
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

// Turns the camera by a finite rotation in each load case.
void TurnCameraBy(double angle, Scene& scene) {
  const int dimension = scene.mesh.Dimension();
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  for (LoadCase& load_case : scene.load_cases) {
    Eigen::VectorXd motion =
        Eigen::VectorXd::Constant(NumRigidMotions(dimension), 0.02);
    motion.tail(dimension == 2 ? 1 : 3) *= angle / 0.02 / (dimension - 1);
    load_case.displacement =
        MovedRigidly(nodes + load_case.displacement, motion) - nodes;
  }
  scene.is_rigid_motion_free = true;
}

Scene SeenByACamera(const KindOfSection& kind, double angle) {
  Scene scene = testing::SceneOfKind(kind, 3);
  for (LoadCase& load_case : scene.load_cases) {
    load_case.loads = {
        BodyForce{Eigen::VectorXd::LinSpaced(scene.mesh.Dimension(), -2, 3)}};
  }
  testing::MeasureByTextbook(kTruth, scene);
  TurnCameraBy(angle, scene);
  return scene;
}

TEST_P(UnknownMotionOfKinds, OfACameraThatTurnedFarLeavesExactDataExact) {
  for (const double angle : {0.1, 0.5236, 2.0}) {
    SCOPED_TRACE(angle);
    ExpectTruth(RunIterativeFe(SeenByACamera(GetParam(), angle)), 1e-6);
  }
}

TEST_P(UnknownMotionOfKinds,
       OfACameraThatMissesComponentsLeavesExactDataExact) {
  Scene scene = SeenByACamera(GetParam(), 0.5236);
  const int dimension = scene.mesh.Dimension();
  for (LoadCase& load_case : scene.load_cases) {
    load_case.observed.setConstant(dimension, scene.mesh.NumNodes(), true);
    load_case.observed(0, scene.mesh.NumNodes() - 1) = false;
  }
  ExpectTruth(RunIterativeFe(scene), 1e-6);
  if (dimension == 3) {
    for (LoadCase& load_case : scene.load_cases) {
      load_case.observed.row(2).setConstant(false);
    }
    ExpectTruth(RunIterativeFe(scene), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(AllLong, UnknownMotionOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

// A plate under a known pull at its free end, whose other end moved as
// measured.
Scene Plate(int cells = 5) {
  return SceneOfMeasuredSupports(
      {ElementKind::kQuad4, SectionModel::kPlaneStress}, cells);
}

double RootMeanSquare(const Scene& scene) {
  const Eigen::MatrixXd& u = scene.load_cases[0].displacement;
  return u.norm() / std::sqrt(double(u.size()));
}

// Adds noise of this standard deviation at every node, supports included.
void Disturb(double noise_sd, unsigned seed, Scene& scene) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0, noise_sd);
  for (LoadCase& load_case : scene.load_cases) {
    for (double& value : load_case.displacement.reshaped()) {
      value += noise(generator);
    }
  }
}

// Gauss-Newton steps on (ln E, nu, u of the supports), with differences for
// derivatives and the textbook for u: a dense least squares of all unknowns.
struct DenseFit {
  Eigen::Vector2d parameters;  // ln E, nu
  Eigen::Matrix2d covariance;
};

DenseFit FitDensely(const Scene& measured, double noise_sd) {
  Scene scene = measured;
  std::vector<Eigen::Index> held;
  for (Eigen::Index dof = 0; dof < scene.supports.held.size(); ++dof) {
    if (scene.supports.held.reshaped()(dof)) {
      held.push_back(dof);
    }
  }
  const Eigen::VectorXd q = measured.load_cases[0].displacement.reshaped();
  const auto displacement = [&](const Eigen::VectorXd& x) {
    scene.supports.displacement.reshaped()(held) = x.tail(x.size() - 2);
    testing::MeasureByTextbook({std::exp(x(0)), x(1)}, scene);
    return Eigen::VectorXd(scene.load_cases[0].displacement.reshaped());
  };
  Eigen::VectorXd x(2 + Eigen::Index(held.size()));
  x << std::log(kTruth.youngs_modulus), kTruth.poisson_ratio, q(held);
  Eigen::MatrixXd jacobian(q.size(), x.size());
  for (int iteration = 0; iteration < 6; ++iteration) {
    const double scale = q.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double step = i < 2 ? 1e-4 : 1e-3 * scale;
      Eigen::VectorXd above = x;
      Eigen::VectorXd below = x;
      above(i) += step;
      below(i) -= step;
      jacobian.col(i) =
          (displacement(above) - displacement(below)) / (2 * step);
    }
    x += (jacobian.transpose() * jacobian)
             .ldlt()
             .solve(jacobian.transpose() * (q - displacement(x)));
  }
  const Eigen::MatrixXd covariance =
      noise_sd * noise_sd * (jacobian.transpose() * jacobian).inverse();
  return {x.head(2), covariance.topLeftCorner(2, 2)};
}

TEST(UnknownMotion, IsFittedAsByDenseLeastSquaresOfAllUnknowns) {
  Scene scene = Plate();
  const double noise_sd = 0.01 * RootMeanSquare(scene);
  Disturb(noise_sd, 1, scene);
  scene.load_cases[0].noise_sd = noise_sd;
  const DenseFit dense = FitDensely(scene, noise_sd);
  const Estimate estimate = RunIterativeFe(scene);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  const double youngs_modulus = std::exp(dense.parameters(0));
  // The fit ends where steps are below a hundredth of the errors.
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, youngs_modulus,
              0.01 * *estimate.YoungsModulusStandardError());
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, dense.parameters(1),
              0.01 * *estimate.PoissonRatioStandardError());
  const ParameterErrors& noise = estimate.error_budget.noise;
  EXPECT_NEAR(noise(0) / std::sqrt(dense.covariance(0, 0)), 1, 1e-3);
  EXPECT_NEAR(noise(1) / std::sqrt(dense.covariance(1, 1)), 1, 1e-3);
}

// A load cell that knows nothing adds nothing.
TEST(UnknownMotion, WithResultantsOfNoWeightIsTheDisplacementFit) {
  Scene scene = testing::SceneOfKind(
      {ElementKind::kQuad4, SectionModel::kPlaneStress}, 5);
  testing::MeasureByTextbook(kTruth, scene);
  Disturb(0.01 * RootMeanSquare(scene), 1, scene);
  const Estimate without = RunIterativeFe(scene);
  const std::vector<int> held = HeldNodes(scene);
  scene.load_cases[0].resultants = {
      {held, Eigen::Vector2d(1, 1), Eigen::Vector2d(1e12, 1e12)}};
  const Estimate with = RunIterativeFe(scene);
  ASSERT_EQ(with.status, Status::kOk) << with.message;
  // The fit ends where steps are below a hundredth of the errors.
  EXPECT_NEAR(with.elasticity.youngs_modulus, without.elasticity.youngs_modulus,
              0.01 * *without.YoungsModulusStandardError());
  EXPECT_NEAR(with.elasticity.poisson_ratio, without.elasticity.poisson_ratio,
              0.01 * *without.PoissonRatioStandardError());
}

// The force of the supports is that of the loads, whatever the material is.
TEST(UnknownMotion, SaysWhereResultantsContradictTheLoads) {
  Scene scene = testing::SceneOfKind(
      {ElementKind::kQuad4, SectionModel::kPlaneStress}, 5);
  testing::MeasureByTextbook(kTruth, scene);
  Resultant resultant =
      ResultantOfSupports(scene, scene.load_cases[0], HeldNodes(scene), 0);
  Disturb(0.01 * RootMeanSquare(scene), 1, scene);
  resultant.noise_sd.setConstant(0.01 * resultant.force.norm());
  scene.load_cases[0].resultants = {resultant};
  const Estimate right = RunIterativeFe(scene);
  EXPECT_FALSE(right.Has(FindingCode::kResultantsContradicted));
  scene.load_cases[0].resultants[0].force *= 1.1;
  const Estimate wrong = RunIterativeFe(scene);
  EXPECT_TRUE(wrong.Has(FindingCode::kResultantsContradicted));
  // Ten standard deviations, spread over both components.
  EXPECT_GT(*wrong.YoungsModulusStandardError(),
            0.9 * 10 / std::sqrt(2.0) * *right.YoungsModulusStandardError());
}

// So many that each is not solved for.
TEST(UnknownMotion, OfManyNodesLeavesExactDataExact) {
  Scene scene = testing::HeldAtBottom(testing::BoxMesh({12, 12, 2}, {6, 6, 1}),
                                      testing::BoxMesh({12, 12, 2}, {6, 6, 1}),
                                      {0, 0, -1});
  scene.supports.unknown = scene.supports.held;
  ASSERT_GT(scene.supports.unknown.count(), 400);
  testing::Measure(kTruth, scene);
  ExpectTruth(RunIterativeFe(scene), 1e-7);
}

// From where the estimate before it ended, be it far off.
TEST(UnknownMotion, OfOneFrameAfterAnotherIsThatOfEach) {
  for (const std::string name : {"iterative-fe", "auto"}) {
    SCOPED_TRACE(name);
    const auto estimator = MakeEstimator(name);
    const Scene exact = Plate(8);
    PreparedEstimator prepared = estimator->Prepare(exact, {});
    int saved_factorizations = 0;
    for (const double noise : {0.2, 0.01, 0.001}) {
      Scene scene = exact;
      Disturb(noise * RootMeanSquare(scene), 5, scene);
      if (noise == 0.01) {
        scene.load_cases[0].observed.setConstant(2, scene.mesh.NumNodes(),
                                                 true);
        scene.load_cases[0].observed.col(40).setConstant(false);
      }
      const Estimate alone = estimator->Run(scene, {});
      const Estimate next = prepared.RunLoadCases(scene.load_cases);
      EXPECT_EQ(next.status, alone.status);
      EXPECT_EQ(next.estimator, name);
      if (alone.IsUsable()) {
        EXPECT_NEAR(next.elasticity.youngs_modulus,
                    alone.elasticity.youngs_modulus,
                    0.02 * *alone.YoungsModulusStandardError());
        EXPECT_NEAR(next.elasticity.poisson_ratio,
                    alone.elasticity.poisson_ratio,
                    0.02 * *alone.PoissonRatioStandardError());
      }
      saved_factorizations +=
          alone.work.factorizations - next.work.factorizations;
    }
    EXPECT_GT(saved_factorizations, 0);
  }
}

// The specimen is finer than the mesh.
class ElementsOfUnknownMotion : public ::testing::TestWithParam<KindOfSection> {
 protected:
  static Scene Measured() {
    Scene scene = testing::SceneOfKind(GetParam(), 3);
    scene.load_cases[0].loads = {
        BodyForce{Eigen::VectorXd::Constant(scene.mesh.Dimension(), 30)}};
    // Bent, as a support that gives way is.
    scene.supports.displacement = 0.005 * scene.mesh.nodes.array().square();
    testing::MeasureInCutWorld(kTruth, scene);
    scene.supports.displacement.setZero();
    scene.supports.unknown = scene.supports.held;
    Disturb(1e-3 * RootMeanSquare(scene), 1, scene);
    return scene;
  }
};

TEST_P(ElementsOfUnknownMotion, HaveAMeshErrorThatIsKnown) {
  const Estimate estimate = RunIterativeFe(Measured());
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  const double error =
      std::log(estimate.elasticity.youngs_modulus / kTruth.youngs_modulus);
  EXPECT_LT(std::abs(error) * kTruth.youngs_modulus,
            3 * *estimate.YoungsModulusStandardError());
  EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - kTruth.poisson_ratio),
            3 * *estimate.PoissonRatioStandardError());
  EXPECT_GT(*estimate.discretization_error, 0);
}

INSTANTIATE_TEST_SUITE_P(LinearSolids, ElementsOfUnknownMotion,
                         ::testing::ValuesIn(testing::KindsOf(3, 1)),
                         testing::KindTestName);
INSTANTIATE_TEST_SUITE_P(QuadraticSolidsLong, ElementsOfUnknownMotion,
                         ::testing::ValuesIn(testing::KindsOf(3, 2)),
                         testing::KindTestName);
INSTANTIATE_TEST_SUITE_P(LinearPlanes, ElementsOfUnknownMotion,
                         ::testing::ValuesIn(testing::KindsOf(2, 1)),
                         testing::KindTestName);
INSTANTIATE_TEST_SUITE_P(QuadraticPlanes, ElementsOfUnknownMotion,
                         ::testing::ValuesIn(testing::KindsOf(2, 2)),
                         testing::KindTestName);

// Linear elements bend too little, and a support follows the noise of its
// nodes.
class ElementsOfMeasuredSupportsStatistics
    : public ::testing::TestWithParam<KindOfSection> {};

TEST_P(ElementsOfMeasuredSupportsStatistics, HoldTheTruthOfBentBeams) {
  const int dimension = TopologyOf(GetParam().kind).dimension;
  Scene beam = testing::SceneOfKind(GetParam(), dimension == 2 ? 12 : 3);
  beam.mesh.nodes.row(dimension - 1) *= 4;
  beam.load_cases[0].loads = {
      BodyForce{1e-3 * Eigen::VectorXd::Unit(dimension, 0)}};
  testing::MeasureInCutWorld(kTruth, beam);
  beam.supports.unknown = beam.supports.held;
  for (const unsigned seed : {1, 2, 3, 4, 5}) {
    SCOPED_TRACE(seed);
    Scene scene = beam;
    Disturb(2e-3 * RootMeanSquare(scene), seed, scene);
    const Estimate estimate = RunIterativeFe(scene);
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    const double error =
        estimate.elasticity.youngs_modulus - kTruth.youngs_modulus;
    EXPECT_LT(std::abs(error), 3 * *estimate.YoungsModulusStandardError());
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ElementsOfMeasuredSupportsStatistics,
    ::testing::Values(
        KindOfSection{ElementKind::kTri3, SectionModel::kPlaneStress},
        KindOfSection{ElementKind::kQuad4, SectionModel::kPlaneStress},
        KindOfSection{ElementKind::kHex8, SectionModel::kSolid}),
    testing::KindTestName);

TEST(UnknownMotion, LeavesOutliersOutByName) {
  Scene scene = Plate(12);
  const double noise_sd = 0.005 * RootMeanSquare(scene);
  Disturb(noise_sd, 3, scene);
  const Estimate clean = RunIterativeFe(scene);
  EXPECT_TRUE(clean.outliers.empty());
  for (const int node : {77, 125}) {
    scene.load_cases[0].displacement(0, node) += 100 * noise_sd;
  }
  const Estimate estimate = RunIterativeFe(scene);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_EQ(estimate.outliers,
            (std::vector<Outlier>{{0, 77, false}, {0, 125, false}}));
  EXPECT_TRUE(estimate.Has(FindingCode::kOutliersLeftOut));
  EXPECT_NEAR(estimate.elasticity.youngs_modulus,
              clean.elasticity.youngs_modulus,
              2 * *clean.YoungsModulusStandardError());
}

// Which the support follows, so that its neighbours seem to be.
TEST(UnknownMotion, FindsOutliersOfSupports) {
  Scene scene = Plate(12);
  const double noise_sd = 0.005 * RootMeanSquare(scene);
  Disturb(noise_sd, 3, scene);
  const int lost = HeldNodes(scene)[5];
  scene.load_cases[0].displacement.col(lost) +=
      60 * noise_sd * Eigen::Vector2d(0.6, 0.8);
  const Estimate estimate = RunIterativeFe(scene);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_EQ(estimate.outliers, (std::vector<Outlier>{{0, lost, false}}));
}

TEST(UnknownMotion, WithoutAnyForceIsRefused) {
  Scene scene = Plate();
  scene.load_cases[0].loads.clear();
  EXPECT_THROWS_WITH(RunIterativeFe(scene), "the measured force of a support");
}

TEST(UnknownMotion, ThatIsInconsistentIsRefused) {
  const Scene good = Plate();
  const std::vector<int> held = HeldNodes(good);
  const Eigen::Vector2d force(1, 1);
  const auto all = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(2, true);
  Scene scene = good;
  scene.supports.unknown.setConstant(true);
  EXPECT_THROWS_WITH(RunIterativeFe(scene), "that no support holds");
  scene = good;
  scene.load_cases[0].observed = !good.supports.held;
  EXPECT_THROWS_WITH(RunIterativeFe(scene),
                     "or give it \"displacement\": \"rigid\"");
  scene = good;
  scene.supports.rigid_faces = {{{}, all}};
  EXPECT_THROWS_WITH(RunIterativeFe(scene), "has no node");
  scene.supports.unknown.setConstant(false);
  scene.supports.rigid_faces = {{held, all}};
  EXPECT_THROWS_WITH(RunIterativeFe(scene), "held at a given displacement");
  scene = good;
  scene.load_cases[0].resultants = {{{0, 1000}, force, force}};
  EXPECT_THROWS_WITH(RunIterativeFe(scene), "node 1000 of resultant 1");
  scene.load_cases[0].resultants = {{held, force, Eigen::Vector2d(1, 0)}};
  EXPECT_THROWS_WITH(RunIterativeFe(scene), "positive standard deviation");
  EstimatorOptions robust;
  robust.loss = Loss::kHuber;
  EXPECT_THROWS_WITH(RunIterativeFe(good, robust), "leave out --loss");
}

}  // namespace
}  // namespace elastimate
