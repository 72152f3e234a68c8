#include "elastimate/core/equilibrium/hierarchical_error.h"

#include <gtest/gtest.h>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

std::vector<KindOfSection> AllSimplices() {
  std::vector<KindOfSection> simplices;
  for (const KindOfSection& kind : testing::AllKindsOfSections()) {
    if (IsSimplex(kind.kind)) {
      simplices.push_back(kind);
    }
  }
  return simplices;
}

// Two load cases, and supports that move.
Scene MovedScene(const KindOfSection& kind, int cells) {
  Scene scene = testing::SceneOfKind(kind, cells);
  scene.load_cases.push_back(scene.load_cases[0]);
  BodyForce weight;
  weight.force_density =
      Eigen::VectorXd::LinSpaced(scene.mesh.Dimension(), -0.3, 0.5);
  scene.load_cases[1].loads = {weight};
  testing::DisplaceSupports(scene);
  return scene;
}

Eigen::MatrixXd Responses(const Scene& scene, double poisson_ratio) {
  ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene));
  EXPECT_TRUE(model.SetPoissonRatio(poisson_ratio));
  return model.Responses();
}

struct Found {
  Eigen::MatrixXd error;
  int num_passes;
};

Found Find(const Scene& scene, double poisson_ratio) {
  StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kCholesky);
  EXPECT_TRUE(solver.Factorize(poisson_ratio));
  HierarchicalError error(scene);
  const std::optional<Eigen::MatrixXd> found =
      error.Find(poisson_ratio, Responses(scene, poisson_ratio), solver);
  EXPECT_TRUE(found);
  return {found.value_or(Eigen::MatrixXd()), error.NumPasses()};
}

class HierarchicalErrorOfKinds
    : public ::testing::TestWithParam<KindOfSection> {
 protected:
  // Curved tetrahedra cost three times as much as others.
  static bool IsCostly() {
    return GetParam().kind == ElementKind::kCurvedTet10;
  }
  static int NumCells() { return IsCostly() ? 2 : 4; }
};

// The displacements themselves are compared.  In the energy norm, large changes
// of little energy would be hidden by small ones of much energy.
TEST_P(HierarchicalErrorOfKinds, IsThatToFinerElements) {
  const Scene scene = MovedScene(GetParam(), NumCells());
  const Eigen::Index n = scene.mesh.NumDofs();
  for (const double nu : {-0.5, 0.3, 0.45}) {
    const Eigen::MatrixXd expected =
        Responses(FinerScene(scene), nu).topRows(n) - Responses(scene, nu);
    const Eigen::MatrixXd error = Find(scene, nu).error;
    for (Eigen::Index k = 0; k < expected.cols(); ++k) {
      EXPECT_LT((error.col(k) - expected.col(k)).norm(),
                2 * HierarchicalError::kTolerance * expected.col(k).norm())
          << "nu " << nu << ", column " << k;
    }
  }
}

TEST_P(HierarchicalErrorOfKinds, TakesNoMoreIterationsOnFinerMeshes) {
  const int coarse = Find(MovedScene(GetParam(), 3), 0.3).num_passes;
  EXPECT_LT(Find(MovedScene(GetParam(), IsCostly() ? 5 : 8), 0.3).num_passes,
            1.5 * coarse);
}

TEST_P(HierarchicalErrorOfKinds, TakesFewerIterationsFromThatOfANuNearby) {
  const Scene scene = MovedScene(GetParam(), NumCells());
  StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kCholesky);
  HierarchicalError error(scene);
  ASSERT_TRUE(solver.Factorize(0.3));
  ASSERT_TRUE(error.Find(0.3, Responses(scene, 0.3), solver));
  const int passes = error.NumPasses();
  ASSERT_TRUE(solver.Factorize(0.33));
  const auto found = error.Find(0.33, Responses(scene, 0.33), solver);
  ASSERT_TRUE(found);
  const Found alone = Find(scene, 0.33);
  EXPECT_LT(error.NumPasses() - passes, alone.num_passes);
  const Eigen::MatrixXd expected =
      Responses(FinerScene(scene), 0.33).topRows(scene.mesh.NumDofs()) -
      Responses(scene, 0.33);
  for (Eigen::Index k = 0; k < expected.cols(); ++k) {
    EXPECT_LT((found->col(k) - expected.col(k)).norm(),
              2 * HierarchicalError::kTolerance * expected.col(k).norm())
        << "column " << k;
  }
}

TEST_P(HierarchicalErrorOfKinds, IsZeroWhereTheElementsAreExact) {
  Scene scene = testing::SceneOfKind(GetParam(), 3);
  const int dimension = scene.mesh.Dimension();
  const Eigen::MatrixXd gradient =
      Eigen::VectorXd::LinSpaced(dimension * dimension, -0.02, 0.03)
          .reshaped(dimension, dimension);
  const Eigen::MatrixXd exact = gradient * scene.mesh.nodes;
  const Eigen::MatrixXi facets = BoundaryFacets(scene.mesh);
  for (const int node : facets.reshaped()) {
    scene.supports.held.col(node).setConstant(true);
  }
  scene.supports.displacement = exact;
  scene.load_cases[0].loads = {BodyForce{Eigen::VectorXd::Zero(dimension)}};
  const Eigen::MatrixXd error = Find(scene, 0.3).error;
  EXPECT_LT(error.norm(), 1e-9 * exact.norm());
}

INSTANTIATE_TEST_SUITE_P(Kinds, HierarchicalErrorOfKinds,
                         ::testing::ValuesIn(AllSimplices()),
                         [](const auto& info) {
                           return testing::NameOf(info.param);
                         });

}  // namespace
}  // namespace elastimate
