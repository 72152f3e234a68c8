// Compares Equilibrium in nested spaces with Equilibrium that factorises the
// stiffness of the finest space.

#include "elastimate/core/equilibrium/refined_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/scene/finer_scene.h"
#include "tests/anisotropy.h"
#include "tests/core/random_values.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::RandomMatrix;

// Holds a scene, and finer ones that are made of it one after another.
class Spaces {
 public:
  Spaces(const Scene& scene, int num_finer) : scenes_{scene} {
    for (int i = 0; i < num_finer; ++i) {
      scenes_.push_back(FinerScene(scenes_.back()));
    }
    for (const Scene& space : scenes_) {
      pointers_.push_back(&space);
    }
  }
  Spaces(const Spaces&) = delete;
  Spaces& operator=(const Spaces&) = delete;

  const std::vector<const Scene*>& All() const { return pointers_; }
  const Scene& Finest() const { return scenes_.back(); }

 private:
  std::deque<Scene> scenes_;
  std::vector<const Scene*> pointers_;
};

// Columns of displacements that cancel most of each other have a larger error
// relative to themselves than in the energy norm.
constexpr double kSameDisplacement = 1e-6;

void ExpectSame(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected,
                double tolerance = kSameDisplacement) {
  ASSERT_EQ(actual.cols(), expected.cols());
  for (Eigen::Index k = 0; k < expected.cols(); ++k) {
    EXPECT_LE((actual.col(k) - expected.col(k)).norm(),
              tolerance * expected.col(k).norm())
        << "column " << k;
  }
}

struct KindAndSpaces {
  KindOfSection kind;
  int num_finer;
};

class RefinedEquilibrium : public ::testing::TestWithParam<KindAndSpaces> {
 protected:
  RefinedEquilibrium() {
    scene_.load_cases.push_back(scene_.load_cases[0]);
    BodyForce weight;
    weight.force_density =
        Eigen::VectorXd::LinSpaced(scene_.mesh.Dimension(), -0.3, 0.5);
    scene_.load_cases[1].loads = {weight};
    testing::DisplaceSupports(scene_);
  }

  Scene scene_ = testing::TwoRegionScene(GetParam().kind, 2);
  Eigen::Vector4d parameters_{2, 0.1, 5, 0.4};
};

TEST_P(RefinedEquilibrium, IsThatOfTheFactorisedStiffness) {
  const Spaces spaces(scene_, GetParam().num_finer);
  Equilibrium refined(spaces.All(), SolverKind::kCholesky);
  Equilibrium direct(spaces.Finest(), SolverKind::kCholesky);
  const MaterialParameters& chart = direct.Forces().Parameters();
  const Eigen::VectorXd moduli = chart.Moduli(parameters_);
  ASSERT_TRUE(refined.Solve(moduli));
  ASSERT_TRUE(direct.Solve(moduli));
  ExpectSame(refined.Displacement(), direct.Displacement());
  ExpectSame(refined.SupportResponse(), direct.SupportResponse());
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters_);
  ExpectSame(refined.Sensitivities(directions),
             direct.Sensitivities(directions));
  const Eigen::MatrixXd forces =
      RandomMatrix(spaces.Finest().mesh.NumDofs(), 4, 1);
  ExpectSame(refined.SolveFor(forces), direct.SolveFor(forces));
  EXPECT_EQ(refined.Graph().NumPairs(), direct.Graph().NumPairs());
  EXPECT_EQ(refined.WorkDone().factorizations, 1);
  EXPECT_EQ(refined.WorkDone().solves, 2 + 1 + 2 * 4 + 4);
}

TEST_P(RefinedEquilibrium, IsThatOfTheTextbook) {
  const Spaces spaces(scene_, 1);
  Equilibrium refined(spaces.All(), SolverKind::kCholesky);
  ASSERT_TRUE(refined.Solve(refined.Forces().Parameters().Moduli(parameters_)));
  ExpectSame(refined.Displacement(),
             testing::SolveByTextbook(spaces.Finest(), {{2, 0.1}, {5, 0.4}}));
}

TEST_P(RefinedEquilibrium, HasTheSupportsOfEachLoadCase) {
  Supports other = scene_.supports;
  const Eigen::Index last = scene_.mesh.NumNodes() - 1;
  other.held.col(last).setConstant(true);
  // The node is held in some of its components only.
  other.held(0, last) = false;
  other.displacement.col(last).setConstant(0.01);
  scene_.load_cases[1].supports = other;
  scene_.is_rigid_motion_free = true;
  const Spaces spaces(scene_, GetParam().num_finer);
  Equilibrium refined(spaces.All(), SolverKind::kCholesky);
  Equilibrium direct(spaces.Finest(), SolverKind::kCholesky);
  const MaterialParameters& chart = direct.Forces().Parameters();
  const Eigen::VectorXd moduli = chart.Moduli(parameters_);
  ASSERT_TRUE(refined.Solve(moduli));
  ASSERT_TRUE(direct.Solve(moduli));
  ExpectSame(refined.Displacement(), direct.Displacement());
  EXPECT_EQ(refined.WorkDone().factorizations, 2);
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters_);
  const Eigen::MatrixXd slopes = direct.Sensitivities(directions);
  ExpectSame(refined.Sensitivities(directions), slopes);
  const Eigen::MatrixXd values =
      RandomMatrix(spaces.Finest().mesh.NumDofs(), 4, 2);
  const Eigen::MatrixXd two = values.leftCols(2);
  const Eigen::MatrixXd held = OfHeld(spaces.Finest(), two);
  ExpectSame(refined.Extend(held), direct.Extend(held));
  ExpectSame(refined.ExtendInCase(1, held), direct.ExtendInCase(1, held));
  ExpectSame(refined.ExtendTransposed(values), direct.ExtendTransposed(values));
  // These products need no solution of a system, so they agree up to rounding.
  constexpr double kRounding = 1e-12;
  ExpectSame(refined.HeldForces(values), direct.HeldForces(values), kRounding);
  ExpectSame(refined.HeldForcesTransposed(values),
             direct.HeldForcesTransposed(values), kRounding);
  ExpectSame(refined.HeldForcesInCase(1, values),
             direct.HeldForcesInCase(1, values), kRounding);
  ExpectSame(refined.SupportForces(), direct.SupportForces());
  ExpectSame(refined.SupportForceSensitivities(directions, slopes),
             direct.SupportForceSensitivities(directions, slopes));
}

TEST_P(RefinedEquilibrium, BeginsWithTheLastSolution) {
  const Spaces spaces(scene_, GetParam().num_finer);
  Equilibrium equilibrium(spaces.All(), SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters_);
  // Counts the iterations of a solution and of its sensitivities.
  const auto iterations = [&](const Eigen::VectorXd& moduli) {
    const int before = equilibrium.WorkDone().iterations;
    EXPECT_TRUE(equilibrium.Solve(moduli));
    equilibrium.Sensitivities(directions);
    return equilibrium.WorkDone().iterations - before;
  };
  const Eigen::VectorXd moduli = chart.Moduli(parameters_);
  const int cold = iterations(moduli);
  EXPECT_GT(cold, 0);
  EXPECT_EQ(iterations(moduli), 0);
  const Eigen::VectorXd changed =
      moduli.cwiseProduct(Eigen::Vector4d(1.0001, 0.9999, 0.9999, 1.0001));
  const int warm = iterations(changed);
  EXPECT_GT(warm, 0);
  EXPECT_LT(warm, 0.8 * cold);
  const Eigen::MatrixXd displacement = equilibrium.Displacement();
  const Eigen::MatrixXd slopes = equilibrium.Sensitivities(directions);
  equilibrium.ForgetSolution();
  EXPECT_GT(iterations(changed), warm);
  ExpectSame(equilibrium.Displacement(), displacement);
  equilibrium.ForgetSolution();
  equilibrium.BeginWith(displacement, slopes);
  EXPECT_EQ(iterations(changed), 0);
}

TEST_P(RefinedEquilibrium, RefusesAStiffnessThatIsNotPositive) {
  const Spaces spaces(scene_, GetParam().num_finer);
  Equilibrium equilibrium(spaces.All(), SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  EXPECT_FALSE(
      equilibrium.Solve(chart.Moduli(Eigen::Vector4d(2, 0.1, -5, 0.4))));
  EXPECT_FALSE(equilibrium.Solve(Eigen::VectorXd::Constant(4, testing::kNan)));
  const Eigen::VectorXd moduli = chart.Moduli(parameters_);
  EXPECT_TRUE(equilibrium.Solve(moduli));
  Equilibrium other(spaces.All(), SolverKind::kCholesky);
  EXPECT_TRUE(other.Solve(moduli));
  ExpectSame(equilibrium.Displacement(), other.Displacement());
}

TEST_P(RefinedEquilibrium, EndsWellNextToIncompressibility) {
  const Spaces spaces(scene_, GetParam().num_finer);
  Equilibrium equilibrium(spaces.All(), SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  for (const double below : {1e-4, 1e-6, 1e-9, 1e-13}) {
    const bool is_solved = equilibrium.Solve(
        chart.Moduli(Eigen::Vector4d(2, 0.5 - below, 5, 0.5 - below)));
    EXPECT_TRUE(!is_solved || equilibrium.Displacement().allFinite());
  }
}

std::vector<KindAndSpaces> AllKindsAndSpaces() {
  std::vector<KindAndSpaces> all;
  for (const KindOfSection kind :
       {KindOfSection{ElementKind::kTet4, SectionModel::kSolid},
        KindOfSection{ElementKind::kHex8, SectionModel::kSolid},
        KindOfSection{ElementKind::kTri3, SectionModel::kPlaneStrain},
        KindOfSection{ElementKind::kTri3, SectionModel::kPlaneStress},
        KindOfSection{ElementKind::kQuad4, SectionModel::kPlaneStrain},
        KindOfSection{ElementKind::kQuad4, SectionModel::kPlaneStress}}) {
    for (const int num_finer : {1, 2}) {
      all.push_back({kind, num_finer});
    }
  }
  // A quadratic space may be the one that is factorised.
  all.push_back({{ElementKind::kTri6, SectionModel::kPlaneStress}, 1});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Kinds, RefinedEquilibrium,
                         ::testing::ValuesIn(AllKindsAndSpaces()),
                         [](const auto& info) {
                           return testing::NameOf(info.param.kind) + "_" +
                                  std::to_string(info.param.num_finer);
                         });

// A block that is held at its bottom, of one material.
Scene Block(int cells) {
  const Mesh mesh = testing::BoxMesh({cells, cells, cells}, {1, 1, 1});
  return testing::UnderBodyForce(testing::HeldAtBottom(
      testing::Distorted(mesh), mesh, Eigen::Vector3d(0, 0, -1)));
}

// The equilibrium of one isotropic material in nested spaces, and that by a
// factor of the finest one.
struct TwoSolutions {
  explicit TwoSolutions(const Spaces& spaces)
      : refined(spaces.All(), SolverKind::kCholesky),
        direct(spaces.Finest(), SolverKind::kCholesky),
        moduli(direct.Forces().Parameters().Moduli(Eigen::Vector2d(3, 0.3))),
        are_solved(refined.Solve(moduli) && direct.Solve(moduli)) {}

  Equilibrium refined;
  Equilibrium direct;
  Eigen::VectorXd moduli;
  bool are_solved;
};

TEST(RefinedStiffness, LeavesTheErrorThatItIsAskedFor) {
  const Spaces spaces(Block(2), 2);
  Equilibrium direct(spaces.Finest(), SolverKind::kCholesky);
  for (const double nu : {-0.5, 0.3, 0.49}) {
    const Eigen::VectorXd moduli =
        direct.Forces().Parameters().Moduli(Eigen::Vector2d(3, nu));
    ASSERT_TRUE(direct.Solve(moduli));
    for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
      Equilibrium refined(spaces.All(), SolverKind::kCholesky, tolerance);
      ASSERT_TRUE(refined.Solve(moduli));
      const Eigen::VectorXd error =
          refined.Displacement() - direct.Displacement();
      const Eigen::VectorXd force = direct.Forces().Multiply(moduli, error);
      const double energy =
          direct.Displacement().col(0).dot(direct.Load().col(0));
      EXPECT_LE(std::sqrt(error.dot(force) / energy), tolerance) << nu;
    }
  }
}

// A cycle leaves about a quarter of the error at nu = 0.3, and more next to
// 1/2.  The share is about the same on each mesh.
TEST(RefinedStiffness, IteratesAsOftenOnFinerMeshes) {
  struct Most {
    double nu, tolerance;
    int iterations;
  };
  for (const auto& [nu, tolerance, most] :
       {Most{0.3, 1e-2, 5}, Most{0.3, 1e-8, 20}, Most{0.45, 1e-2, 8},
        Most{0.45, 1e-8, 32}}) {
    std::vector<int> iterations;
    for (const int cells : {2, 4, 6}) {
      const Spaces spaces(Block(cells), 1);
      Equilibrium equilibrium(spaces.All(), SolverKind::kCholesky, tolerance);
      ASSERT_TRUE(equilibrium.Solve(
          equilibrium.Forces().Parameters().Moduli(Eigen::Vector2d(3, nu))));
      iterations.push_back(equilibrium.WorkDone().iterations);
      EXPECT_LE(iterations.back(), most) << nu << ", cells " << cells;
    }
    EXPECT_LE(iterations[2], iterations[1] + 1);
  }
}

TEST(RefinedStiffness, IsFactorisedWhereIterationsDoNotConverge) {
  const Spaces spaces(Block(3), 1);
  Equilibrium refined(spaces.All(), SolverKind::kCholesky);
  Equilibrium direct(spaces.Finest(), SolverKind::kCholesky);
  const MaterialParameters& chart = direct.Forces().Parameters();
  for (const double nu : {0.5 - 1e-7, 0.3}) {
    const Eigen::Vector2d parameters(3, nu);
    ASSERT_TRUE(refined.Solve(chart.Moduli(parameters)));
    ASSERT_TRUE(direct.Solve(chart.Moduli(parameters)));
    ExpectSame(refined.Displacement(), direct.Displacement());
    const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters);
    ExpectSame(refined.Sensitivities(directions),
               direct.Sensitivities(directions));
  }
  const Work work = refined.WorkDone();
  EXPECT_LE(work.iterations, RefinedStiffness::kMostIterations);
  EXPECT_EQ(work.factorizations, 1 + 2);
  // Iterations need no solve for the sensitivity to a modulus that scales all
  // stresses.
  EXPECT_EQ(work.solves, direct.WorkDone().solves - 2);
}

TEST(RefinedStiffness, SparesSolutionsWhereAllModuliGrowAlike) {
  Scene scene = Block(2);
  testing::DisplaceSupports(scene);
  const Spaces spaces(scene, 1);
  TwoSolutions two(spaces);
  ASSERT_TRUE(two.are_solved);
  ASSERT_GT(two.direct.SupportResponse().norm(), 0);
  const int before = two.refined.WorkDone().solves;
  ExpectSame(two.refined.Sensitivities(-0.5 * two.moduli),
             two.direct.Sensitivities(-0.5 * two.moduli));
  EXPECT_EQ(two.refined.WorkDone().solves, before);
}

// Returns the change of the displacement while the moduli of the two materials
// grow at these relative rates, by differences of dense solutions.
Eigen::MatrixXd TextbookChange(const Scene& scene, const Eigen::Vector4d& at,
                               const Eigen::Vector2d& rates) {
  constexpr double kStep = 1e-4;
  const auto solution = [&](double step) {
    return testing::SolveByTextbook(scene,
                                    {{at(0) * (1 + step * rates(0)), at(1)},
                                     {at(2) * (1 + step * rates(1)), at(3)}});
  };
  return (solution(kStep) - solution(-kStep)) / (2 * kStep);
}

TEST(RefinedStiffness, SparesSolutionsOnlyWhereTheModuliOfAllMaterialsGrow) {
  Scene scene =
      testing::TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}, 2);
  testing::DisplaceSupports(scene);
  const Spaces spaces(scene, 1);
  Equilibrium refined(spaces.All(), SolverKind::kCholesky);
  const MaterialParameters& chart = refined.Forces().Parameters();
  const Eigen::Vector4d parameters(2, 0.1, 5, 0.4);
  const Eigen::VectorXd moduli = chart.Moduli(parameters);
  ASSERT_TRUE(refined.Solve(moduli));
  ASSERT_GT(refined.SupportResponse().norm(), 0);
  const int before = refined.WorkDone().solves;
  // Moduli of isotropic materials are proportional to E.
  ExpectSame(refined.Sensitivities(-0.5 * moduli),
             TextbookChange(spaces.Finest(), parameters, {-0.5, -0.5}));
  EXPECT_EQ(refined.WorkDone().solves, before);
  const Eigen::VectorXd of_second =
      chart.ModuliJacobian(parameters).col(2) * parameters(2);
  ExpectSame(refined.Sensitivities(of_second),
             TextbookChange(spaces.Finest(), parameters, {0, 1}));
  EXPECT_EQ(refined.WorkDone().solves, before + 1);
  // Both grow, but one of them faster.
  ExpectSame(refined.Sensitivities(moduli + of_second),
             TextbookChange(spaces.Finest(), parameters, {1, 2}));
  EXPECT_EQ(refined.WorkDone().solves, before + 2);
}

TEST(RefinedStiffness, TakesMaterialsWithAnAxis) {
  Scene scene = Block(2);
  Material fibres;
  fibres.law = "transversely_isotropic";
  fibres.axes = {Eigen::Vector3d(1, 2, 0.5)};
  scene.materials = {fibres};
  const Spaces spaces(scene, 2);
  Equilibrium refined(spaces.All(), SolverKind::kCholesky);
  Equilibrium direct(spaces.Finest(), SolverKind::kCholesky);
  const Eigen::VectorXd moduli =
      direct.Forces().Parameters().Moduli(testing::ConstantsOfFibres());
  ASSERT_TRUE(refined.Solve(moduli));
  ASSERT_TRUE(direct.Solve(moduli));
  ExpectSame(refined.Displacement(), direct.Displacement());
  const Eigen::MatrixXd every =
      Eigen::MatrixXd::Identity(moduli.size(), moduli.size());
  ExpectSame(refined.Sensitivities(every), direct.Sensitivities(every));
}

TEST(RefinedStiffness, TakesMultigridForTheCoarsestSpace) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << WhyNoMultigrid();
  }
  const Spaces spaces(Block(3), 1);
  Equilibrium refined(spaces.All(), SolverKind::kMultigrid);
  Equilibrium direct(spaces.Finest(), SolverKind::kCholesky);
  for (const double nu : {0.3, 0.49}) {
    const Eigen::VectorXd moduli =
        direct.Forces().Parameters().Moduli(Eigen::Vector2d(3, nu));
    ASSERT_TRUE(refined.Solve(moduli));
    ASSERT_TRUE(direct.Solve(moduli));
    EXPECT_EQ(refined.WorkDone().factorizations, 0);
    EXPECT_GT(refined.WorkDone().multigrid_set_ups, 0);
    ExpectSame(refined.Displacement(), direct.Displacement());
  }
}

TEST(RefinedStiffness, IsForSpacesOfOneMesh) {
  const Spaces spaces(Block(2), 2);
  const Spaces others(Block(3), 1);
  EXPECT_TRUE(AreNested(spaces.All()));
  EXPECT_FALSE(AreNested({spaces.All()[0], &others.Finest()}));
  EXPECT_FALSE(AreNested({spaces.All()[1], spaces.All()[0]}));
  EXPECT_FALSE(AreNested({spaces.All()[0], spaces.All()[0]}));
}

TEST(RefinedStiffness, IsForStraightEdges) {
  for (const KindOfSection& kind : testing::AllKindsOfSections()) {
    const Spaces spaces(testing::SceneOfKind(kind, 2), 1);
    EXPECT_EQ(AreNested(spaces.All()), !IsCurved(kind.kind));
    EXPECT_FALSE(AreNested({&spaces.Finest()}));
    const TwoSolutions two(spaces);
    ASSERT_TRUE(two.are_solved);
    ExpectSame(two.refined.Displacement(), two.direct.Displacement());
  }
}

}  // namespace
}  // namespace elastimate
