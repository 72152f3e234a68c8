// Tests of iterative-fe for laws of large strains, on bars that
// LargeStrainEquilibrium bent.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/scene_builder.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/random_points.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

constexpr KindOfSection kBarOfHex8 = {ElementKind::kHex8, SectionModel::kSolid};
constexpr KindOfSection kBarOfTet4 = {ElementKind::kTet4, SectionModel::kSolid};
const Eigen::Vector2d kBentTruth(2000, 0.3);

Eigen::VectorXd BarParameters(const std::string& law) {
  if (law == "mooney_rivlin") {
    return Eigen::Vector3d(300, 80, 1500);
  }
  if (law == "yeoh") {
    return Eigen::Vector4d(350, -40, 60, 1500);
  }
  return kBentTruth;
}

// A bar six times as long as it is thick, of one material, that is clamped at
// its bottom.  A force on its top bends it, so much that small strains of the
// true E would make it turn there by `rotation`.
Scene Cantilever(const KindOfSection& kind, const std::string& law,
                 double rotation, int cells = 2) {
  Scene scene = testing::SceneOfKind(kind, cells);
  const int last = scene.mesh.Dimension() - 1;
  scene.mesh.nodes.row(last) *= 6;
  scene.materials.resize(1);
  scene.materials[0].law = law;
  const double length = scene.mesh.nodes.row(last).maxCoeff();
  const Eigen::VectorXd size = scene.mesh.nodes.rowwise().maxCoeff() -
                               scene.mesh.nodes.rowwise().minCoeff();
  const double width = last == 2 ? size(1) : scene.mesh.section.thickness;
  const double stiffness = kBentTruth(0) * width * std::pow(size(0), 3) / 12;
  const double force = 2 * rotation * stiffness / (length * length);
  Eigen::MatrixXd forces =
      Eigen::MatrixXd::Zero(scene.mesh.Dimension(), scene.mesh.NumNodes());
  int num_loaded = 0;
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(last, node) > 0.9 * length) {
      forces(0, node) = force;
      ++num_loaded;
    }
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {NodalForces{forces / num_loaded}};
  return scene;
}

void MeasureBar(const Eigen::VectorXd& parameters, Scene& scene,
                Dilatation dilatation = Dilatation::kMeanOfElement) {
  LargeStrainEquilibrium model(scene, dilatation);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(parameters);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LargeStrainState state = model.Solve(moduli, Eigen::Index(k));
    ASSERT_EQ(state.status, EquilibriumStatus::kDone)
        << WhyNotInEquilibrium(state);
    scene.load_cases[k].displacement = state.displacement.reshaped(
        scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
  scene.origin = Origin::kComputedAtLargeStrains;
}

// Adds noise of this part of the largest displacement where nothing is held.
double AddNoiseOfBar(double part, std::uint64_t seed, Scene& scene) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> gaussian;
  const double sd =
      part * scene.load_cases[0].displacement.cwiseAbs().maxCoeff();
  for (LoadCase& load_case : scene.load_cases) {
    for (Eigen::Index i = 0; i < load_case.displacement.size(); ++i) {
      if (!scene.supports.held(i)) {
        load_case.displacement(i) += sd * gaussian(generator);
      }
    }
  }
  return sd;
}

void AddNoiseOfAllNodes(double sd, unsigned seed, Scene& scene) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> gaussian;
  for (LoadCase& load_case : scene.load_cases) {
    load_case.noise_sd = sd;
    for (double& value : load_case.displacement.reshaped()) {
      value += sd * gaussian(generator);
    }
  }
}

Estimate FitBar(const Scene& scene) {
  return MakeEstimator("iterative-fe")->Run(scene, {});
}

void ExpectBarParameters(const Estimate& estimate,
                         const Eigen::VectorXd& expected, double tolerance) {
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.parameters.size(), std::size_t(expected.size()));
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(estimate.parameters[i].value / expected(i), 1, tolerance)
        << estimate.parameters[i].name;
  }
}

class IterativeFeOfKinds : public ::testing::TestWithParam<KindOfSection> {};

TEST_P(IterativeFeOfKinds, FindsTheMaterialOfABentBar) {
  Scene scene = Cantilever(GetParam(), "neo_hookean", 0.5);
  MeasureBar(kBentTruth, scene);
  ExpectBarParameters(FitBar(scene), kBentTruth, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(All, IterativeFeOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

class IterativeFeOfLaws : public ::testing::TestWithParam<std::string> {};

TEST_P(IterativeFeOfLaws, FindsTheParametersFromLoadSteps) {
  for (const KindOfSection& kind : {kBarOfHex8, kBarOfTet4}) {
    Scene scene = Cantilever(kind, GetParam(), 0.5);
    scene.load_cases.resize(3, scene.load_cases[0]);
    const Eigen::MatrixXd bending =
        std::get<NodalForces>(scene.load_cases[0].loads[0]).force;
    Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(3, scene.mesh.NumNodes());
    pull.row(2) = 8 * bending.row(0);
    scene.load_cases[1].loads = {NodalForces{2 * bending}};
    scene.load_cases[2].loads = {NodalForces{pull}};
    MeasureBar(BarParameters(GetParam()), scene);
    // The last steps of a fit change what the highest powers of the strain,
    // which are small, have as factors.
    ExpectBarParameters(FitBar(scene), BarParameters(GetParam()), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(All, IterativeFeOfLaws,
                         ::testing::Values("corotated", "st_venant_kirchhoff",
                                           "neo_hookean", "mooney_rivlin",
                                           "yeoh"));

TEST(IterativeFeOfLargeStrains, StartsFarFromAStronglyBentBar) {
  for (const double rotation : {1.0, 2.5, 8.0}) {
    Scene scene = Cantilever(kBarOfHex8, "corotated", rotation);
    MeasureBar(kBentTruth, scene);
    ExpectBarParameters(FitBar(scene), kBentTruth, 1e-6);
  }
}

TEST(IterativeFeOfLargeStrains, IsAtTheCramerRaoBound) {
  // The mean square of 20 errors of two parameters over the stated ones has a
  // standard deviation of about 1 / sqrt(20).
  constexpr int kSeeds = 20;
  for (const double noise : {0.01, 0.03}) {
    double of_modulus = 0;
    double of_ratio = 0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      Scene scene = Cantilever(kBarOfTet4, "neo_hookean", 0.5);
      MeasureBar(kBentTruth, scene);
      scene.load_cases[0].noise_sd = AddNoiseOfBar(noise, seed, scene);
      const Estimate estimate = FitBar(scene);
      ASSERT_EQ(estimate.parameters.size(), 2u);
      const Eigen::VectorXd& bound = estimate.error_budget.noise;
      ASSERT_EQ(bound.size(), 2) << estimate.message;
      of_modulus += std::pow(
          std::log(estimate.parameters[0].value / kBentTruth(0)) / bound(0), 2);
      of_ratio += std::pow(
          (estimate.parameters[1].value - kBentTruth(1)) / bound(1), 2);
    }
    EXPECT_LT(of_modulus / kSeeds, 2);
    EXPECT_LT(of_ratio / kSeeds, 2);
    EXPECT_GT(of_modulus / kSeeds, 0.4);
    EXPECT_GT(of_ratio / kSeeds, 0.4);
  }
}

TEST(IterativeFeOfLargeStrains, TakesPointsRegionsAndKnownParameters) {
  Scene scene = Cantilever(kBarOfHex8, "neo_hookean", 0.5);
  scene.mesh.regions.resize(scene.mesh.NumElements());
  const Eigen::VectorXd heights = scene.mesh.nodes.row(2);
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    const bool is_upper =
        heights(scene.mesh.elements.col(e)).mean() > heights.maxCoeff() / 2;
    scene.mesh.regions[e] = is_upper ? 2 : 1;
  }
  scene.materials = {{"neo_hookean", {1}, {}, {}},
                     {"corotated", {2}, {{"poisson_ratio", 0.4}}, {}}};
  const Eigen::Vector4d truth(2000, 0.3, 1200, 0.4);
  MeasureBar(truth, scene);
  testing::MeasureAtPoints(60, 3, scene);
  ExpectBarParameters(FitBar(scene), truth, 1e-6);
}

TEST(IterativeFeOfLargeStrains, TakesMeasuredSupportsAndResultants) {
  Scene scene = Cantilever(kBarOfHex8, "neo_hookean", 0.5);
  // The top is held where the force moved it to, and a load cell measures.
  MeasureBar(kBentTruth, scene);
  const Eigen::MatrixXd bent = scene.load_cases[0].displacement;
  const Eigen::MatrixXd force =
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force;
  Resultant resultant;
  resultant.force = force.rowwise().sum();
  resultant.noise_sd = Eigen::Vector3d::Constant(1e-3 * resultant.force.norm());
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (force(0, node) != 0) {
      resultant.nodes.push_back(node);
      scene.supports.held.col(node).setConstant(true);
    }
  }
  scene.load_cases[0].loads.clear();
  scene.load_cases[0].resultants = {resultant};
  scene.supports.displacement.setZero(3, scene.mesh.NumNodes());
  scene.supports.unknown = scene.supports.held;
  const Estimate estimate = FitBar(scene);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.parameters[0].value / kBentTruth(0), 1, 1e-6);
  EXPECT_NEAR(estimate.parameters[1].value / kBentTruth(1), 1, 1e-6);
}

// Bending alone hardly depends on Poisson's ratio.
Scene BentAndPulled(ElementKind kind, SectionModel model, int cells) {
  Scene scene = Cantilever({kind, model}, "neo_hookean", 0.5, cells);
  const int last = scene.mesh.Dimension() - 1;
  scene.load_cases.push_back(scene.load_cases[0]);
  const Eigen::MatrixXd bending =
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force;
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(bending.rows(), bending.cols());
  pull.row(last) = 8 * bending.row(0);
  scene.load_cases[1].loads = {NodalForces{pull}};
  return scene;
}

// A turn by this angle that carries the axis of a bar towards x, with a
// translation, as MovedRigidly takes it.
Eigen::VectorXd TurnOfBar(int dimension, double angle) {
  if (dimension == 2) {
    return Eigen::Vector3d(0.3, -0.2, -angle);
  }
  Eigen::VectorXd turn(6);
  turn << 0.3, -0.2, 0.1, 0, angle, 0;
  return turn;
}

constexpr double kThirtyDegrees = 0.5236;

// Moves what was measured as a camera sees it that turned by 30 degrees, and
// more in each further load case.
void TurnCamera(Scene& scene) {
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  double angle = kThirtyDegrees;
  for (LoadCase& load_case : scene.load_cases) {
    load_case.displacement =
        MovedRigidly(nodes + load_case.displacement,
                     TurnOfBar(scene.mesh.Dimension(), angle)) -
        nodes;
    angle += 0.2;
  }
  scene.is_rigid_motion_free = true;
}

// A grip at the top of a bar that holds it rigid, and turns it by 30 degrees as
// far as pure bending goes, or in a second load case by 15 degrees.  It was not
// measured how the grip moved, only the force on it.
Scene GrippedBar(const KindOfSection& kind) {
  Scene scene = Cantilever(kind, "neo_hookean", 0);
  const int dimension = scene.mesh.Dimension();
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  const double length = nodes.row(dimension - 1).maxCoeff();
  std::vector<int> grip;
  for (int node = 0; node < nodes.cols(); ++node) {
    if (nodes(dimension - 1, node) > 0.99 * length) {
      grip.push_back(node);
      scene.supports.held.col(node).setConstant(true);
    }
  }
  scene.load_cases[0].loads.clear();
  scene.load_cases.push_back(scene.load_cases[0]);
  double angle = kThirtyDegrees;
  for (LoadCase& load_case : scene.load_cases) {
    const Eigen::MatrixXd face = nodes(Eigen::all, grip);
    const Eigen::VectorXd middle = face.rowwise().mean();
    Eigen::VectorXd turn = TurnOfBar(dimension, angle);
    turn.head(dimension).setZero();
    Eigen::MatrixXd turned =
        MovedRigidly(face.colwise() - middle, turn).colwise() + middle;
    turned.row(0).array() += length * (1 - std::cos(angle)) / angle;
    // It is pulled a little as well, on which Poisson's ratio depends.
    turned.row(dimension - 1).array() +=
        length * (std::sin(angle) / angle - 1 + 0.02);
    load_case.supports = scene.supports;
    load_case.supports->displacement.setZero(dimension, nodes.cols());
    load_case.supports->displacement(Eigen::all, grip) = turned - face;
    angle /= 2;
  }
  MeasureBar(kBentTruth, scene);
  const LargeStrainForces forces(scene.mesh, scene.materials);
  scene.supports.displacement.setZero(dimension, nodes.cols());
  scene.supports.unknown.setConstant(dimension, nodes.cols(), false);
  scene.supports.unknown(Eigen::all, grip).setConstant(true);
  scene.supports.rigid_faces = {
      {grip, Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(dimension, true)}};
  for (LoadCase& load_case : scene.load_cases) {
    const Eigen::MatrixXd f =
        forces
            .Forces(forces.Parameters().Moduli(kBentTruth),
                    load_case.displacement.reshaped())
            .reshaped(dimension, nodes.cols());
    Resultant resultant;
    resultant.nodes = grip;
    resultant.force = f(Eigen::all, grip).rowwise().sum();
    resultant.noise_sd =
        Eigen::VectorXd::Constant(dimension, 1e-3 * resultant.force.norm());
    load_case.resultants = {resultant};
    load_case.supports.reset();
    load_case.observed = !scene.supports.held;
  }
  return scene;
}

TEST_P(IterativeFeOfKinds, FindsTheMaterialThroughACameraThatTurned) {
  Scene scene = Cantilever(GetParam(), "neo_hookean", 0.5);
  MeasureBar(kBentTruth, scene);
  TurnCamera(scene);
  ExpectBarParameters(FitBar(scene), kBentTruth, 1e-7);
  // No turn can be seen beforehand where a component was not measured.
  scene.load_cases[0].observed.setConstant(scene.mesh.Dimension(),
                                           scene.mesh.NumNodes(), true);
  scene.load_cases[0].observed(0, scene.mesh.NumNodes() - 1) = false;
  ExpectBarParameters(FitBar(scene), kBentTruth, 1e-7);
}

TEST_P(IterativeFeOfKinds, FindsTheMaterialBelowAGripThatTurned) {
  ExpectBarParameters(FitBar(GrippedBar(GetParam())), kBentTruth, 1e-7);
}

// Bending hardly depends on Poisson's ratio, of which noise leaves nothing.
// That is said of the law of large strains, and not that small strains leave
// a residual.
TEST(IterativeFeOfLargeStrains,
     TellsAutoWhyItsEstimateOfComputedDataIsRefused) {
  Scene scene = Cantilever({ElementKind::kHex8, SectionModel::kSolid},
                           "neo_hookean", 1.5);
  MeasureBar(kBentTruth, scene);
  AddNoiseOfBar(0.05, 1, scene);
  scene.materials[0].law = "isotropic";
  scene.origin = Origin::kComputed;
  const Estimate estimate = MakeEstimator("auto")->Run(scene, {});
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersUndetermined))
      << estimate.message;
  EXPECT_FALSE(estimate.large_strain_law.empty());
}

// The root mean square of errors over stated ones, of E and of nu.
template <class MakeScene>
Eigen::Vector2d ErrorsOverStated(const MakeScene& make_scene) {
  constexpr int kSeeds = 20;
  Eigen::Vector2d sum(0, 0);
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const Scene scene = make_scene(seed);
    const Estimate estimate = FitBar(scene);
    const Eigen::VectorXd& stated = estimate.error_budget.noise;
    if (estimate.parameters.size() != 2 || stated.size() != 2) {
      ADD_FAILURE() << estimate.message;
      continue;
    }
    sum(0) += std::pow(
        std::log(estimate.parameters[0].value / kBentTruth(0)) / stated(0), 2);
    sum(1) +=
        std::pow((estimate.parameters[1].value - kBentTruth(1)) / stated(1), 2);
  }
  return (sum / kSeeds).cwiseSqrt();
}

void ExpectNearOne(const Eigen::Vector2d& ratios) {
  // The root of the mean square of 20 has a standard deviation of .16.
  for (const double ratio : ratios) {
    EXPECT_NEAR(ratio, 1, 0.4);
  }
}

TEST(IterativeFeOfLargeStrains, StatesItsErrorsThroughACameraThatTurned) {
  ExpectNearOne(ErrorsOverStated([](unsigned seed) {
    Scene scene = BentAndPulled(ElementKind::kTet4, SectionModel::kSolid, 2);
    MeasureBar(kBentTruth, scene);
    const double sd = 0.01 * scene.load_cases[0].displacement.maxCoeff();
    TurnCamera(scene);
    AddNoiseOfAllNodes(sd, seed, scene);
    return scene;
  }));
}

TEST(IterativeFeOfLargeStrains, StatesItsErrorsBelowAGripThatTurned) {
  std::normal_distribution<double> gaussian;
  ExpectNearOne(ErrorsOverStated([&](unsigned seed) {
    Scene scene = GrippedBar(kBarOfTet4);
    std::mt19937_64 generator(seed);
    for (LoadCase& load_case : scene.load_cases) {
      Resultant& resultant = load_case.resultants[0];
      resultant.noise_sd.setConstant(0.01 * resultant.force.norm());
      for (double& force : resultant.force) {
        force += resultant.noise_sd(0) * gaussian(generator);
      }
    }
    AddNoiseOfAllNodes(0.01 * scene.load_cases[0].displacement.maxCoeff(),
                       100 + seed, scene);
    return scene;
  }));
}

TEST(IterativeFeOfLargeStrains, KeepsThreeErrorsInAFinerWorld) {
  for (const ElementKind kind : {ElementKind::kTri3, ElementKind::kQuad4}) {
    Scene scene = BentAndPulled(kind, SectionModel::kPlaneStrain, 5);
    Scene finer = FinerScene(FinerScene(FinerScene(scene)));
    MeasureBar(kBentTruth, finer);
    for (std::size_t k = 0; k < 2; ++k) {
      scene.load_cases[k].displacement =
          finer.load_cases[k].displacement.leftCols(scene.mesh.NumNodes());
    }
    AddNoiseOfBar(0.005, 5, scene);
    const Estimate estimate = FitBar(scene);
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    for (Eigen::Index i = 0; i < 2; ++i) {
      EXPECT_NEAR(estimate.parameters[i].value, kBentTruth(i),
                  3 * *estimate.parameters[i].standard_error);
    }
    EXPECT_LT(*estimate.parameters[0].standard_error, 0.1 * kBentTruth(0));
  }
}

TEST(IterativeFeOfLargeStrains, TakesEitherDilatationOfOtherCodes) {
  for (const Dilatation dilatation :
       {Dilatation::kOfPoints, Dilatation::kMeanOfElement}) {
    Scene scene = BentAndPulled(ElementKind::kHex8, SectionModel::kSolid, 2);
    MeasureBar(kBentTruth, scene, dilatation);
    scene.origin = Origin::kComputed;
    ExpectBarParameters(FitBar(scene), kBentTruth, 1e-7);
    AddNoiseOfBar(0.02, 7, scene);
    const Estimate estimate = FitBar(scene);
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    for (Eigen::Index i = 0; i < 2; ++i) {
      EXPECT_NEAR(estimate.parameters[i].value, kBentTruth(i),
                  3 * *estimate.parameters[i].standard_error);
    }
  }
}

TEST(IterativeFeOfLargeStrains, FactorisesFewTangents) {
  for (const KindOfSection& kind : {kBarOfTet4, kBarOfHex8}) {
    // Pulled at a slant, so that Poisson's ratio is determined as well.
    Scene scene = BentAndPulled(kind.kind, kind.model, 2);
    auto& force = std::get<NodalForces>(scene.load_cases[0].loads[0]).force;
    force += std::get<NodalForces>(scene.load_cases[1].loads[0]).force;
    scene.load_cases.resize(1);
    MeasureBar(kBentTruth, scene);
    AddNoiseOfBar(0.02, 3, scene);
    // Ten of these look at the curvature of the misfit.
    EXPECT_LE(FitBar(scene).work.factorizations, 25 + 10);
  }
}

TEST(IterativeFeOfLargeStrains, NamesAnElementThatIsInsideOut) {
  Scene scene = Cantilever(kBarOfTet4, "neo_hookean", 0.5, 3);
  MeasureBar(kBentTruth, scene);
  EXPECT_FALSE(FitBar(scene).Has(FindingCode::kInvertedElements));
  // One node was taken for another one, far beyond its neighbours.
  const int node = scene.mesh.elements(0, 40);
  scene.load_cases[0].displacement.col(node).array() +=
      2 * scene.mesh.nodes.row(0).maxCoeff();
  const Estimate estimate = FitBar(scene);
  std::string text;
  for (const Finding& finding : estimate.findings) {
    text += finding.code == FindingCode::kInvertedElements ? finding.text : "";
  }
  const std::string before = "turn element ";
  const std::size_t place = text.find(before);
  ASSERT_NE(place, std::string::npos) << text;
  const int element = std::stoi(text.substr(place + before.size()));
  EXPECT_TRUE((scene.mesh.elements.col(element).array() == node).any()) << text;
  // It is not looked at where the node was not measured.
  scene.load_cases[0].observed.setConstant(3, scene.mesh.NumNodes(), true);
  scene.load_cases[0].observed.col(node).setConstant(false);
  EXPECT_FALSE(FitBar(scene).Has(FindingCode::kInvertedElements));
}

TEST(IterativeFeOfLargeStrains, SaysWhyThereIsNoEquilibrium) {
  // Displacements that oppose the load.
  Scene scene = Cantilever(kBarOfTet4, "neo_hookean", 0.5);
  MeasureBar(kBentTruth, scene);
  scene.load_cases[0].displacement *= -1;
  const Estimate estimate = FitBar(scene);
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_NE(estimate.message, "");
}

TEST(AutoOfLargeStrains, SaysWhatIsWrongBesideLargeStrains) {
  Scene scene = Cantilever(kBarOfTet4, "neo_hookean", 0.5);
  MeasureBar(kBentTruth, scene);
  scene.load_cases[0].displacement *= -1;
  scene.materials.clear();
  scene.origin = Origin::kMeasured;
  const Estimate estimate = MakeEstimator("auto")->Run(scene, {});
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_TRUE(estimate.Has(FindingCode::kUnphysical));
  EXPECT_FALSE(estimate.IsRefusedFor(FindingCode::kLargeDeformation));
}

}  // namespace
}  // namespace elastimate
