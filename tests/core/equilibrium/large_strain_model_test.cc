// Tests of the forward model of large strains against differences of its own
// equilibria, which other tests compare with published values.

#include "elastimate/core/equilibrium/large_strain_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/scene_builder.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

// The differences are of second order, and their step is this part of a value.
constexpr double kStep = 3e-4;
constexpr double kOfDifferences = 1e-6;

class LargeStrainModelOfKinds : public ::testing::TestWithParam<KindOfSection> {
 protected:
  LargeStrainModelOfKinds() : scene_(testing::SceneOfKind(GetParam(), 2)) {
    scene_.supports.unknown = scene_.supports.held;
    scene_.materials.resize(1);
    scene_.materials[0].law = "neo_hookean";
    scene_.load_cases.push_back(scene_.load_cases[0]);
    const Eigen::MatrixXd load =
        AssembleLoads(scene_.mesh, scene_.load_cases[0].loads);
    scene_.load_cases[1].loads = {NodalForces{-0.7 * load}};
    // Moduli at which small strains would move nodes by a tenth of the height.
    LargeStrainModel of_loads(scene_);
    const double stiff = 1e6 * load.norm();
    const Eigen::VectorXd unit =
        of_loads.Parameters().Moduli(Eigen::Vector2d(1, 0.3));
    EXPECT_TRUE(of_loads.Solve(stiff * unit));
    const double height = scene_.mesh.nodes.bottomRows(1).maxCoeff();
    moduli_ = unit * stiff * of_loads.Displacement().cwiseAbs().maxCoeff() /
              (0.1 * height);
    testing::DisplaceSupports(scene_);
  }

  Eigen::MatrixXd Nodal(const Eigen::VectorXd& values) const {
    return values.reshaped(scene_.mesh.Dimension(), scene_.mesh.NumNodes());
  }
  Eigen::MatrixXd RandomColumns(Eigen::Index n) const {
    std::mt19937_64 generator(7);
    std::normal_distribution<double> gaussian;
    Eigen::MatrixXd columns(scene_.mesh.NumDofs(), n);
    for (double& value : columns.reshaped()) {
      value = gaussian(generator);
    }
    return columns;
  }
  Eigen::MatrixXd RandomMotion() const {
    return 0.02 * OfHeld(scene_, RandomColumns(2));
  }

  Scene scene_;
  Eigen::VectorXd moduli_;
};

TEST_P(LargeStrainModelOfKinds, HasTheSensitivitiesOfItsSolutions) {
  LargeStrainModel model(scene_);
  ASSERT_TRUE(model.SolveMoved(moduli_, RandomMotion()));
  const Eigen::MatrixXd directions = moduli_.asDiagonal();
  const Eigen::MatrixXd sensitivities = model.Sensitivities(directions);
  const Eigen::MatrixXd of_supports =
      model.SupportForceSensitivities(directions, sensitivities);
  for (Eigen::Index i = 0; i < 2; ++i) {
    Eigen::MatrixXd u[2];
    Eigen::MatrixXd forces[2];
    for (const int side : {0, 1}) {
      Eigen::VectorXd moved = moduli_;
      moved(i) *= 1 + (2 * side - 1) * kStep;
      ASSERT_TRUE(model.SolveMoved(moved, RandomMotion()));
      u[side] = model.Displacement();
      forces[side] = model.SupportForces();
    }
    for (Eigen::Index k = 0; k < 2; ++k) {
      const Eigen::VectorXd slope = (u[1] - u[0]).col(k) / (2 * kStep);
      EXPECT_LT((sensitivities.col(2 * k + i) - slope).norm(),
                kOfDifferences * slope.norm());
      const Eigen::VectorXd of_force =
          (forces[1] - forces[0]).col(k) / (2 * kStep);
      EXPECT_LT((of_supports.col(2 * k + i) - of_force).norm(),
                kOfDifferences * of_supports.norm());
    }
  }
}

TEST_P(LargeStrainModelOfKinds, ExtendsMotionsOfSupportsToFirstOrder) {
  LargeStrainModel model(scene_);
  ASSERT_TRUE(model.SolveMoved(moduli_, RandomMotion()));
  const Eigen::MatrixXd motion = RandomMotion();
  const Eigen::MatrixXd extended = model.Extend(motion);
  const Eigen::MatrixXd of_supports = model.HeldForces(extended);
  for (Eigen::Index k = 0; k < 2; ++k) {
    EXPECT_EQ(model.ExtendInCase(k, motion.col(k)), extended.col(k));
    EXPECT_EQ(model.HeldForcesInCase(k, extended.col(k)), of_supports.col(k));
  }
  ASSERT_TRUE(model.MoveSupports(-kStep * motion));
  const Eigen::MatrixXd u = model.Displacement();
  const Eigen::MatrixXd forces = model.SupportForces();
  ASSERT_TRUE(model.MoveSupports(2 * kStep * motion));
  const Eigen::MatrixXd slope = (model.Displacement() - u) / (2 * kStep);
  EXPECT_LT((extended - slope).norm(), kOfDifferences * slope.norm());
  const Eigen::MatrixXd of_force =
      (model.SupportForces() - forces) / (2 * kStep);
  EXPECT_LT((of_supports - of_force).norm(), kOfDifferences * of_force.norm());
}

TEST_P(LargeStrainModelOfKinds, HasTransposes) {
  LargeStrainModel model(scene_);
  ASSERT_TRUE(model.Solve(moduli_));
  const Eigen::MatrixXd values = RandomColumns(4);
  const Eigen::MatrixXd held =
      OfHeld(scene_, RandomColumns(2))(Eigen::all, {0, 1, 0, 1});
  const auto product = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return a.cwiseProduct(b).sum();
  };
  const double extended = product(model.Extend(held), values);
  EXPECT_NEAR(product(held, model.ExtendTransposed(values)), extended,
              1e-9 * std::abs(extended));
  const double forces = product(model.HeldForces(values), held);
  EXPECT_NEAR(product(values, model.HeldForcesTransposed(held)), forces,
              1e-9 * std::abs(forces));
}

TEST_P(LargeStrainModelOfKinds, BalancesLoadsBySupports) {
  LargeStrainModel model(scene_);
  ASSERT_TRUE(model.SolveMoved(moduli_, RandomMotion()));
  const Eigen::MatrixXd forces = model.SupportForces();
  for (Eigen::Index k = 0; k < 2; ++k) {
    EXPECT_LT(Nodal((forces + model.Load()).col(k)).rowwise().sum().norm(),
              1e-8 * model.Load().col(k).norm());
  }
}

INSTANTIATE_TEST_SUITE_P(All, LargeStrainModelOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

Scene CorotatedHexahedra() {
  Scene scene =
      testing::SceneOfKind({ElementKind::kHex8, SectionModel::kSolid});
  scene.materials.resize(1);
  scene.materials[0].law = "corotated";
  return scene;
}

// Returns Lame moduli at which the load of the scene makes moderate strains.
Eigen::Vector2d ModerateModuli(const Scene& scene) {
  return Eigen::Vector2d::Constant(
      AssembleLoads(scene.mesh, scene.load_cases[0].loads).norm());
}

TEST(LargeStrainModel, GoesOnAfterModuliWithoutEquilibrium) {
  const Scene scene = CorotatedHexahedra();
  LargeStrainModel model(scene);
  const Eigen::Vector2d moduli = ModerateModuli(scene);
  ASSERT_TRUE(model.Solve(moduli));
  const Eigen::MatrixXd u = model.Displacement();
  EXPECT_FALSE(model.Solve(1e-9 * moduli));
  EXPECT_NE(model.WhyNotSolved(), "");
  ASSERT_TRUE(model.Solve(moduli));
  EXPECT_EQ(model.WhyNotSolved(), "");
  EXPECT_LT((model.Displacement() - u).norm(), 1e-9 * u.norm());
}

TEST(LargeStrainModel, LosesLittleByModuliWithoutEquilibrium) {
  const Scene scene = CorotatedHexahedra();
  LargeStrainModel model(scene);
  const Eigen::Vector2d moduli = ModerateModuli(scene);
  ASSERT_TRUE(model.Solve(moduli));
  const int before = model.WorkDone().factorizations;
  EXPECT_FALSE(model.Solve(1e-9 * moduli));
  const int after = model.WorkDone().factorizations;
  EXPECT_LE(after - before, 60);
  // Moduli that failed before are not tried again.
  EXPECT_FALSE(model.Solve(1e-9 * moduli));
  EXPECT_EQ(model.WorkDone().factorizations, after);
}

// A block that is pulled a little, and then by a traction of five times E.
TEST(LargeStrainModel, FollowsModuliThatChangeFar) {
  const Mesh mesh = BoxGrid(Eigen::Vector3i(1, 1, 1), Eigen::Vector3d::Ones());
  Scene scene = UnsupportedScene(mesh);
  scene.load_cases.resize(1);
  for (int axis = 0; axis < 3; ++axis) {
    testing::HoldPlane(axis, 0, 0, scene);
  }
  scene.materials.resize(1);
  scene.materials[0].law = "neo_hookean";
  scene.load_cases[0].loads = {TractionInBox(mesh, Eigen::Vector3d(0, 0, 1),
                                             Eigen::Vector3d::Ones(),
                                             Eigen::Vector3d(0, 0, 0.5))};
  LargeStrainModel model(scene);
  const auto moduli = [&](double youngs_modulus) {
    return model.Parameters().Moduli(Eigen::Vector2d(youngs_modulus, 0.45));
  };
  ASSERT_TRUE(model.Solve(moduli(2))) << model.WhyNotSolved();
  EXPECT_LT(model.Displacement().maxCoeff(), 0.5);
  ASSERT_TRUE(model.Solve(moduli(0.1))) << model.WhyNotSolved();
  EXPECT_GT(model.Displacement().maxCoeff(), 3);
}

TEST(LargeStrainModel, BeginsWithDisplacementsThatAreNear) {
  const Mesh mesh = BoxGrid(Eigen::Vector3i(2, 2, 6), Eigen::Vector3d(1, 1, 6));
  Scene scene = UnsupportedScene(mesh);
  scene.load_cases.resize(1);
  HoldInBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 0), scene);
  scene.materials.resize(1);
  scene.materials[0].law = "neo_hookean";
  scene.load_cases[0].loads = {TractionInBox(mesh, Eigen::Vector3d(0, 0, 6),
                                             Eigen::Vector3d(1, 1, 6),
                                             Eigen::Vector3d(0.005, 0, 0))};
  LargeStrainModel from_rest(scene);
  const Eigen::VectorXd moduli =
      from_rest.Parameters().Moduli(Eigen::Vector2d(1, 0.3));
  ASSERT_TRUE(from_rest.Solve(moduli));
  EXPECT_GT(from_rest.WorkDone().factorizations, 5);
  LargeStrainModel from_nearby(scene);
  from_nearby.BeginWith(from_rest.Displacement());
  ASSERT_TRUE(from_nearby.Solve(moduli));
  EXPECT_EQ(from_nearby.WorkDone().factorizations, 1);
  // What is far leads to steps of the load.
  LargeStrainModel from_afar(scene);
  from_afar.BeginWith(-5 * from_rest.Displacement());
  ASSERT_TRUE(from_afar.Solve(moduli));
  EXPECT_LT((from_afar.Displacement() - from_rest.Displacement()).norm(),
            1e-8 * from_rest.Displacement().norm());
}

}  // namespace
}  // namespace elastimate
