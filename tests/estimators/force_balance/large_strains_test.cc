// Tests of closed-form, bounded and virtual-fields for laws of large strains,
// on bars that were bent by LargeStrainEquilibrium.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/force_regression.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRightAngle = kPi / 2;
constexpr double kBending = 80.0 / 90 * kRightAngle;
constexpr KindOfSection kHexahedra = {ElementKind::kHex8, SectionModel::kSolid};
constexpr KindOfSection kTetrahedra = {ElementKind::kTet4,
                                       SectionModel::kSolid};

Eigen::VectorXd ParametersOfLaw(const std::string& law) {
  if (law == "mooney_rivlin") {
    return Eigen::Vector3d(300, 80, 3000);
  }
  if (law == "yeoh") {
    return Eigen::Vector4d(350, -40, 60, 3000);
  }
  return Eigen::Vector2d(2000, 0.3);
}

// Returns where a bar along its last axis has its nodes after it was bent to an
// arc of this angle in the plane of its first and last axes, as displacements.
Eigen::MatrixXd ArcDisplacement(const Mesh& mesh, double angle) {
  const int last = mesh.Dimension() - 1;
  const double radius = mesh.nodes.row(last).maxCoeff() / angle;
  const double middle = mesh.nodes.row(0).mean();
  Eigen::MatrixXd displacement =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const double x = mesh.nodes(0, node);
    const double z = mesh.nodes(last, node);
    const double own_radius = radius - (x - middle);
    displacement(0, node) =
        radius + middle - own_radius * std::cos(z / radius) - x;
    displacement(last, node) = own_radius * std::sin(z / radius) - z;
  }
  return displacement;
}

// Returns a bar of distorted elements, five times as long as it is thick, whose
// ends are held where an arc of this angle has them, with forces on all nodes.
// Its load cases are load steps of one specimen.
Scene BarOnArc(const KindOfSection& kind, const std::string& law,
               double angle = kBending) {
  Scene scene = testing::SceneOfKind(kind);
  const int last = scene.mesh.Dimension() - 1;
  scene.mesh.nodes.row(last) *= 5;
  const double length = scene.mesh.nodes.row(last).maxCoeff();
  const Eigen::MatrixXd arc = ArcDisplacement(scene.mesh, angle);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(last, node) > 0.8 * length) {
      scene.supports.held.col(node).setConstant(true);
    }
  }
  scene.supports.displacement = scene.supports.held.select(arc, 0.0);
  scene.materials.resize(1);
  scene.materials[0].law = law;
  scene.load_cases.push_back(scene.load_cases[0]);
  scene.load_cases[1].loads = {NodalForces{
      -0.5 * AssembleLoads(scene.mesh, scene.load_cases[0].loads)
                 .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes())}};
  return scene;
}

// Measures the states of equilibrium near an arc of this angle.
void MeasureBent(const Eigen::VectorXd& parameters, Scene& scene,
                 double angle = kBending) {
  LargeStrainEquilibrium model(scene);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(parameters);
  const Eigen::VectorXd arc = ArcDisplacement(scene.mesh, angle).reshaped();
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LargeStrainState state =
        model.SolveFrom(arc, moduli, Eigen::Index(k));
    ASSERT_EQ(state.status, EquilibriumStatus::kDone);
    scene.load_cases[k].displacement = state.displacement.reshaped(
        scene.mesh.Dimension(), scene.mesh.NumNodes());
  }
}

void ExpectValues(const Estimate& estimate, const Eigen::VectorXd& expected,
                  double tolerance) {
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.parameters.size(), expected.size());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(estimate.parameters[i].value / expected(i), 1, tolerance)
        << estimate.parameters[i].name;
  }
}

std::vector<std::string> ForceEstimators() {
  return {"closed-form", "bounded"};
}

struct KindAndLaw {
  KindOfSection kind;
  std::string law;
};

std::vector<KindAndLaw> KindsAndLaws() {
  std::vector<KindAndLaw> all;
  for (const std::string law : {"corotated", "st_venant_kirchhoff",
                                "neo_hookean", "mooney_rivlin", "yeoh"}) {
    all.push_back({kTetrahedra, law});
    all.push_back({kHexahedra, law});
  }
  for (const std::string law :
       {"corotated", "st_venant_kirchhoff", "mooney_rivlin"}) {
    all.push_back({{ElementKind::kTri3, SectionModel::kPlaneStress}, law});
  }
  for (const KindOfSection& kind : testing::AllKindsOfSections()) {
    if (kind.kind != ElementKind::kTet4 && kind.kind != ElementKind::kHex8) {
      all.push_back({kind, "neo_hookean"});
    }
  }
  return all;
}

class LargeStrainsOfForces : public ::testing::TestWithParam<KindAndLaw> {};

TEST_P(LargeStrainsOfForces, AreExactWhereABarIsBentBy80Degrees) {
  const auto& [kind, law] = GetParam();
  const Eigen::VectorXd parameters = ParametersOfLaw(law);
  Scene scene = BarOnArc(kind, law);
  MeasureBent(parameters, scene);
  for (const std::string& estimator : ForceEstimators()) {
    const Estimate estimate = MakeEstimator(estimator)->Run(scene, {});
    ExpectValues(estimate, parameters, 1e-8);
    EXPECT_FALSE(estimate.Has(FindingCode::kLargeDeformation));
    EXPECT_GT(estimate.deformation.rotation, 0.3);
  }
  const auto virtual_fields = MakeEstimator("virtual-fields");
  if (kind.model == SectionModel::kPlaneStress) {
    EXPECT_THROWS_WITH(virtual_fields->Run(scene, {}),
                       "not linear in the moduli");
  } else {
    ExpectValues(virtual_fields->Run(scene, {}), parameters, 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LargeStrainsOfForces,
                         ::testing::ValuesIn(KindsAndLaws()),
                         [](const auto& info) {
                           return testing::NameOf(info.param.kind) + "_" +
                                  info.param.law;
                         });

// A cantilever that its dead end load bends by 80 degrees.
TEST(LargeStrainForceBalance, IsExactWhereAnEndLoadBendsABar) {
  const Mesh mesh = testing::BoxMesh({2, 1, 10}, {1, 0.5, 10});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.materials.resize(1);
  scene.materials[0].law = "corotated";
  NodalForces end{Eigen::MatrixXd::Zero(3, mesh.NumNodes())};
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    end.force(0, node) = mesh.nodes(2, node) == 10 ? 2.5 : 0;
  }
  scene.load_cases[0].loads = {end};
  const Eigen::Vector2d parameters(2000, 0.3);
  LargeStrainEquilibrium model(scene);
  const LargeStrainState state =
      model.Solve(model.Forces().Parameters().Moduli(parameters), 0);
  ASSERT_EQ(state.status, EquilibriumStatus::kDone);
  scene.load_cases[0].displacement =
      state.displacement.reshaped(3, mesh.NumNodes());
  // The end turns with the edge along the bar at its end.
  const Eigen::MatrixXd at = mesh.nodes + scene.load_cases[0].displacement;
  const Eigen::Index num_nodes = mesh.NumNodes();
  const Eigen::Vector3d edge =
      at.col(num_nodes - 1) - at.col(num_nodes - 1 - num_nodes / 11);
  const double angle = std::atan2(edge(0), edge(2)) * 90 / kRightAngle;
  EXPECT_GT(angle, 75);
  EXPECT_LT(angle, 89);
  ExpectValues(MakeEstimator("closed-form")->Run(scene, {}), parameters, 1e-8);
}

// A pressure on the whole surface pushes against the bent one.
TEST(LargeStrainForceBalance, IsExactUnderPressureThatFollowsTheSurface) {
  const Eigen::Vector2d parameters(2000, 0.3);
  Scene scene = BarOnArc(kHexahedra, "neo_hookean");
  scene.load_cases[0].loads = {
      Pressure{BoundaryFacets(scene.mesh), 40, /*follows=*/true}};
  scene.load_cases[0].noise_sd = 1e-3;
  scene.load_cases[1].noise_sd = 1e-4;
  MeasureBent(parameters, scene);
  for (const std::string name : {"closed-form", "virtual-fields"}) {
    const Estimate estimate = MakeEstimator(name)->Run(scene, {});
    ExpectValues(estimate, parameters, 1e-8);
    EXPECT_LT(estimate.force_residual.value(), 1e-8);
  }
}

// The spread over draws of noise is what the standard errors say.
TEST(LargeStrainVirtualFields, KnowTheirErrors) {
  constexpr int kDraws = 40;
  const Eigen::Vector2d parameters(2000, 0.3);
  Scene exact = BarOnArc(kHexahedra, "neo_hookean");
  MeasureBent(parameters, exact);
  Eigen::Array2d square_sum = Eigen::Array2d::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Scene scene = exact;
    testing::AddNoise(1e-3, unsigned(draw), scene);
    const Estimate estimate = MakeEstimator("virtual-fields")->Run(scene, {});
    ASSERT_TRUE(estimate.parameters[0].standard_error) << estimate.message;
    for (int i = 0; i < 2; ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      square_sum(i) += std::pow(
          (parameter.value - parameters(i)) / *parameter.standard_error, 2);
    }
  }
  // The standard deviation of the mean square is sqrt(2 / 40) = 0.22.
  EXPECT_NEAR(square_sum(0) / kDraws, 1, 0.67);
  EXPECT_NEAR(square_sum(1) / kDraws, 1, 0.67);
}

// Gives the lower half of a bar region 1, and the upper half region 2.
void DivideBar(Scene& scene) {
  Mesh& mesh = scene.mesh;
  const int last = mesh.Dimension() - 1;
  const double middle = mesh.nodes.row(last).maxCoeff() / 2;
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const double z = mesh.nodes(last, mesh.elements.col(e)).mean();
    mesh.regions(e) = z < middle ? 1 : 2;
  }
  scene.materials.resize(2);
  scene.materials[0].regions = {1};
  scene.materials[1].regions = {2};
}

TEST(LargeStrainForceBalance, TakesRegionsOfDifferentLaws) {
  Scene scene = BarOnArc(kHexahedra, "corotated");
  DivideBar(scene);
  scene.materials[1].law = "mooney_rivlin";
  Eigen::VectorXd parameters(5);
  parameters << 2000, 0.3, 150, 30, 2000;
  MeasureBent(parameters, scene);
  // Load cases are weighted by their noise.
  scene.load_cases[0].noise_sd = 1e-4;
  scene.load_cases[1].noise_sd = 3e-4;
  for (const std::string& estimator : ForceEstimators()) {
    ExpectValues(MakeEstimator(estimator)->Run(scene, {}), parameters, 1e-8);
  }
  scene.materials[0].known = {{"poisson_ratio", 0.3}};
  scene.materials[1].known = {{"bulk_modulus", 2000}};
  for (const std::string& estimator : ForceEstimators()) {
    const Estimate estimate = MakeEstimator(estimator)->Run(scene, {});
    ExpectValues(estimate, parameters, 1e-8);
    EXPECT_TRUE(estimate.parameters[4].is_known);
    EXPECT_TRUE(estimate.parameters[3].standard_error.has_value());
  }
}

// The second invariant alone leaves nothing for the first modulus.
TEST(LargeStrainForceBalance, FindsAModulusThatIsLargerThanTheFirst) {
  const Eigen::Vector3d parameters(40, 300, 2000);
  Scene scene = BarOnArc(kHexahedra, "mooney_rivlin");
  MeasureBent(parameters, scene);
  for (const std::string& estimator : ForceEstimators()) {
    ExpectValues(MakeEstimator(estimator)->Run(scene, {}), parameters, 1e-8);
  }
}

TEST(LargeStrainForceBalance, KeepsBounds) {
  Scene scene = BarOnArc(kTetrahedra, "neo_hookean");
  MeasureBent(Eigen::Vector2d(2000, 0.3), scene);
  scene.materials[0].bounds = {{"poisson_ratio", {0.1, 0.28}}};
  const Estimate estimate = MakeEstimator("bounded")->Run(scene, {});
  ASSERT_EQ(estimate.parameters.size(), 2U);
  EXPECT_NEAR(estimate.parameters[1].value, 0.28, 1e-12);
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersOnBounds));
  EXPECT_THROWS_WITH(MakeEstimator("closed-form")->Run(scene, {}),
                     "bounds of a material");
}

TEST(LargeStrainForceBalance, PreparedGivesWhatItGives) {
  Scene scene = BarOnArc(kHexahedra, "neo_hookean");
  MeasureBent(Eigen::Vector2d(2000, 0.3), scene);
  testing::AddNoise(1e-4, 1, scene);
  const auto estimator = MakeEstimator("closed-form");
  const Estimate expected = estimator->Run(scene, {});
  PreparedEstimator prepared = estimator->Prepare(scene, {});
  // Nothing of an earlier measurement is left.
  prepared.Run({0.5 * scene.load_cases[0].displacement,
                0.5 * scene.load_cases[1].displacement});
  const Estimate actual = prepared.Run(
      {scene.load_cases[0].displacement, scene.load_cases[1].displacement});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(actual.parameters[i].value, expected.parameters[i].value);
    EXPECT_EQ(actual.parameters[i].standard_error,
              expected.parameters[i].standard_error);
  }
}

// The derivatives of the force columns by the free displacements, by central
// differences: num_free x num_free for each modulus.
std::vector<Eigen::MatrixXd> ColumnDerivatives(const LargeStrainForces& forces,
                                               const DegreesOfFreedom& dofs,
                                               const Eigen::VectorXd& q) {
  constexpr double kStep = 1e-5;
  const Eigen::Index m = forces.Parameters().NumModuli();
  const Eigen::VectorXd any = Eigen::VectorXd::Ones(m);
  std::vector<Eigen::MatrixXd> derivatives(
      m, Eigen::MatrixXd(dofs.NumFree(), dofs.NumFree()));
  for (Eigen::Index j = 0; j < dofs.NumFree(); ++j) {
    const Eigen::VectorXd step =
        kStep * Eigen::VectorXd::Unit(q.size(), dofs.free[j]);
    const Eigen::MatrixXd change =
        (forces.Columns(any, q + step) - forces.Columns(any, q - step)) /
        (2 * kStep);
    for (Eigen::Index k = 0; k < m; ++k) {
      derivatives[k].col(j) = dofs.Restrict(change.col(k));
    }
  }
  return derivatives;
}

// Noise n in q changes F by its derivatives K_k n, each load case with its own.
TEST(LargeStrainForceBalance, KnowsWhatNoiseMakesOfItsResidual) {
  const Eigen::Vector2d parameters(2000, 0.3);
  Scene scene = BarOnArc(kHexahedra, "neo_hookean");
  MeasureBent(parameters, scene);
  scene.load_cases[1].displacement =
      scene.supports.held.select(scene.load_cases[1].displacement,
                                 1.01 * scene.load_cases[1].displacement);
  scene.load_cases[0].noise_sd = 1e-3;
  scene.load_cases[1].noise_sd = 2e-3;
  const ForceScene prepared(scene);
  ForceResidual residual(prepared, scene);
  const LargeStrainForces& forces = *prepared.LargeForces();
  const Eigen::VectorXd moduli = forces.Parameters().Moduli(parameters);
  // The second combination is the residual itself.
  Eigen::MatrixXd combinations = Eigen::MatrixXd::Zero(3, 2);
  combinations(0, 0) = 1;
  combinations.col(1) << moduli, -1;
  Eigen::Matrix2d traces = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < 2; ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const Eigen::VectorXd q = load_case.displacement.reshaped();
    const std::vector<Eigen::MatrixXd> derivatives =
        ColumnDerivatives(forces, prepared.Dofs(), q);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        traces(i, j) += derivatives[i].cwiseProduct(derivatives[j]).sum();
      }
    }
    Eigen::MatrixXd columns(q.size(), 3);
    columns << forces.Columns(moduli, q),
        AssembleLoads(scene.mesh, load_case.loads).reshaped();
    const Eigen::MatrixXd stiffened =
        (moduli(0) * derivatives[0] + moduli(1) * derivatives[1]) *
        prepared.Dofs().Restrict(columns * combinations) /
        load_case.noise_sd.value();
    gram += stiffened.transpose() * stiffened;
  }
  EXPECT_TRUE(residual.Traces().isApprox(traces, 1e-7));
  EXPECT_TRUE(
      residual.StiffenedGram(moduli, combinations).isApprox(gram, 1e-7));
}

// Probes with random signs estimate the traces of large meshes, to a relative
// standard error of about 1 / sqrt(num_free) = 0.7 %.
TEST(LargeStrainForceBalance, EstimatesTracesOfLargeMeshes) {
  Scene scene = testing::SceneOfKind(
      {ElementKind::kQuad4, SectionModel::kPlaneStrain}, 101);
  ASSERT_GT(scene.mesh.NumElements(), 10000);
  scene.materials.resize(1);
  scene.materials[0].law = "neo_hookean";
  scene.load_cases[0].displacement = ArcDisplacement(scene.mesh, 0.3);
  const ForceScene prepared(scene);
  const ForceResidual residual(prepared, scene);
  const NodeGraph graph(scene.mesh);
  std::vector<Eigen::MatrixXd> blocks;
  for (int k = 0; k < 2; ++k) {
    blocks.push_back(prepared.LargeForces()->TangentBlocks(
        Eigen::Vector2d::Unit(k), scene.load_cases[0].displacement.reshaped(),
        graph));
  }
  const Eigen::Matrix2d traces =
      StiffnessTraces(graph, prepared.Dofs(), blocks);
  EXPECT_LT((residual.Traces() - traces).norm(), 0.028 * traces.norm());
  EXPECT_FALSE(residual.Traces().isApprox(traces, 1e-6));
}

class LargeStrainNoise : public ::testing::TestWithParam<KindAndLaw> {};

TEST_P(LargeStrainNoise, IsAsLargeAsStated) {
  constexpr int kSeeds = 20;
  const auto& [kind, law] = GetParam();
  const Eigen::VectorXd parameters = ParametersOfLaw(law);
  Scene exact = BarOnArc(kind, law);
  MeasureBent(parameters, exact);
  const FreeParameters free(exact, {});
  const Eigen::VectorXd truth = free.VariablesOf(parameters);
  const Eigen::Index size = truth.size();
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(size);
  Eigen::ArrayXd score_sum = Eigen::ArrayXd::Zero(size);
  double variance_ratio_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    const double sd = testing::AddNoise(1e-4, seed, scene);
    const ForceScene prepared(scene);
    ForceResidual forces(prepared, scene, free.ModuliAt(truth));
    const UnbiasedFit fit = FitWithoutBias(free, truth, forces);
    const Eigen::ArrayXd errors =
        CovarianceOf(fit, free, forces).value().diagonal().array().sqrt();
    const Eigen::ArrayXd scores = (fit.variables - truth).array() / errors;
    sum += scores;
    score_sum += scores.square();
    // Noise has nearly the same size in both load cases.
    variance_ratio_sum += fit.noise_variance.value() / (sd * sd);
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    // The mean of scores of variance 1 has a standard deviation of 1 / sqrt(n),
    // and their root mean square one of 1 / sqrt(2 n).
    EXPECT_NEAR(sum(i) / kSeeds, 0, 4 / std::sqrt(kSeeds)) << i;
    EXPECT_NEAR(std::sqrt(score_sum(i) / kSeeds), 1,
                4 / std::sqrt(2.0 * kSeeds))
        << i;
  }
  // For white residuals of so many free components, the variance has a
  // relative standard deviation of sqrt(2 / n), and up to twice that where a
  // stiffness matrix colours them.
  const double num_equations =
      2.0 * double(DegreesOfFreedom(exact.supports).NumFree());
  EXPECT_NEAR(variance_ratio_sum / kSeeds, 1,
              4 * 2 * std::sqrt(2 / num_equations / kSeeds) + 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    Laws, LargeStrainNoise,
    ::testing::Values(KindAndLaw{kHexahedra, "corotated"},
                      KindAndLaw{kHexahedra, "neo_hookean"},
                      KindAndLaw{kHexahedra, "mooney_rivlin"},
                      KindAndLaw{
                          {ElementKind::kQuad4, SectionModel::kPlaneStress},
                          "neo_hookean"}),
    [](const auto& info) {
      return testing::NameOf(info.param.kind) + "_" + info.param.law;
    });

// Virtual work tells a wrong law from noise, which leaves as much of the load.
TEST(LargeStrainForceBalance, TellsAWrongLawFromNoise) {
  const Eigen::Vector2d parameters(2000, 0.3);
  Scene exact = BarOnArc(kHexahedra, "neo_hookean");
  MeasureBent(parameters, exact);
  Scene wrong = exact;
  wrong.materials[0].law = "mooney_rivlin";
  const Estimate of_wrong = MakeEstimator("closed-form")->Run(wrong, {});
  EXPECT_GT(of_wrong.force_residual.value(), 0.1);
  EXPECT_TRUE(of_wrong.Has(FindingCode::kResidualAboveNoise));
  EXPECT_TRUE(of_wrong.is_model_in_doubt);
  EXPECT_GT(of_wrong.error_budget.model(0), 0.5);
  EXPECT_EQ(of_wrong.status, Status::kNotIdentifiable);
  for (int seed = 1; seed <= 10; ++seed) {
    Scene scene = exact;
    testing::AddNoise(2e-4, seed, scene);
    const Estimate estimate = MakeEstimator("closed-form")->Run(scene, {});
    EXPECT_GT(estimate.force_residual.value(), 0.1);
    EXPECT_FALSE(estimate.is_model_in_doubt) << seed;
    EXPECT_TRUE(estimate.error_budget.model.isZero(0)) << seed;
  }
}

TEST(LargeStrainForceBalance, NamesAnElementThatIsInsideOut) {
  Scene scene = BarOnArc(kTetrahedra, "corotated");
  MeasureBent(Eigen::Vector2d(2000, 0.3), scene);
  // The first node of the middle layer moves beyond its neighbours.
  const Eigen::Index node = 18;
  ASSERT_FALSE(scene.supports.held(0, node));
  scene.load_cases[1].displacement(0, node) += 3;
  for (const std::string& estimator : ForceEstimators()) {
    EXPECT_THROWS_WITH(MakeEstimator(estimator)->Run(scene, {}),
                       "load case 2 turn element [0-9]+ inside out .*correct "
                       "the displacements");
  }
}

// The stretch across a plate follows the ratios of the moduli.
TEST(LargeStrainForceBalance, IsExactInPlaneStress) {
  const KindOfSection kind = {ElementKind::kQuad4, SectionModel::kPlaneStress};
  for (const double ratio : {-0.2, 0.0, 0.3, 0.49}) {
    const Eigen::Vector2d parameters(2000, ratio);
    Scene scene = BarOnArc(kind, "neo_hookean");
    MeasureBent(parameters, scene);
    for (const std::string& estimator : ForceEstimators()) {
      const Estimate estimate = MakeEstimator(estimator)->Run(scene, {});
      ASSERT_EQ(estimate.status, Status::kOk) << ratio << estimate.message;
      EXPECT_NEAR(estimate.parameters[0].value / 2000, 1, 1e-8);
      EXPECT_NEAR(estimate.parameters[1].value, ratio, 1e-8);
    }
  }
}

TEST(LargeStrainForceBalance, RefusesLawsOfBothKindsInOneScene) {
  Scene scene = BarOnArc(kHexahedra, "corotated");
  MeasureBent(Eigen::Vector2d(2000, 0.3), scene);
  DivideBar(scene);
  scene.materials[1].law = "isotropic";
  EXPECT_THROWS_WITH(MakeEstimator("closed-form")->Run(scene, {}),
                     "give all materials laws of large strains");
}

TEST(LargeStrainForceBalance, IsNotForReducedFe) {
  Scene scene = BarOnArc(kHexahedra, "corotated");
  MeasureBent(Eigen::Vector2d(2000, 0.3), scene);
  EXPECT_THROWS_WITH(MakeEstimator("reduced-fe")->Run(scene, {}),
                     "law corotated is for large strains.*iterative-fe");
}

}  // namespace
}  // namespace elastimate
