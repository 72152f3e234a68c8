// Tests of every element kind in every section: the stiffness against the
// textbook, the patch test, energies and loads.

#include "tests/element_kinds.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/solvers/multigrid.h"
#include "tests/core/mechanics/strain_energy.h"
#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using testing::AllKindsOfSections;
using testing::HookeMatrixOf;
using testing::KindOfSection;
using testing::MeshOfKind;
using testing::RandomMatrix;
using testing::SceneOfKind;
using testing::StrainEnergyDensity;
using testing::TextbookStiffness;
using testing::TextbookVolumes;

class ElementKinds : public ::testing::TestWithParam<KindOfSection> {
 protected:
  ElementKinds()
      : scene_(SceneOfKind(GetParam())),
        mesh_(scene_.mesh),
        hooke_(HookeMatrixOf(elasticity_, mesh_.section.model)) {}

  double Scale() const {
    return elasticity_.StiffnessScale(mesh_.section.model);
  }

  // Returns a displacement that is linear in the position (dimension x n).
  Eigen::MatrixXd LinearField(const Eigen::MatrixXd& gradient) const {
    return gradient * mesh_.nodes;
  }

  // Returns whether each node is on the surface.
  std::vector<bool> OnSurface() const {
    std::vector<bool> on_surface(mesh_.NumNodes(), false);
    const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
    for (const int node : facets.reshaped()) {
      on_surface[node] = true;
    }
    return on_surface;
  }

  IsotropicElasticity elasticity_ = {2.5, 0.3};
  Scene scene_;
  const Mesh& mesh_;
  Eigen::MatrixXd hooke_;
};

TEST_P(ElementKinds, AreAValidScene) {
  EXPECT_NO_THROW(ValidateScene(scene_));
  EXPECT_NEAR(ElementVolumes(mesh_).sum(), TextbookVolumes(mesh_).sum(), 1e-12);
}

TEST_P(ElementKinds, MultiplyAsTheTextbook) {
  const Eigen::MatrixXd u = RandomMatrix(mesh_.NumDofs(), 3, 1);
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, u);
  const Eigen::MatrixXd expected = TextbookStiffness(mesh_, hooke_) * u;
  EXPECT_TRUE((Scale() * (products.h + elasticity_.poisson_ratio * products.j))
                  .isApprox(expected, 1e-12));
}

// H alone is the stiffness at nu = 0 and s = 1.
TEST_P(ElementKinds, SplitTheStiffnessIntoHAndJ) {
  const Eigen::MatrixXd u = RandomMatrix(mesh_.NumDofs(), 1, 2);
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, u);
  const Eigen::MatrixXd h =
      TextbookStiffness(mesh_, HookeMatrixOf({1, 0}, mesh_.section.model));
  EXPECT_TRUE(products.h.isApprox(h * u, 1e-12));
}

TEST_P(ElementKinds, AssembleAsTheTextbook) {
  const DegreesOfFreedom dofs(scene_.supports);
  const StiffnessAssembly assembly(mesh_, dofs);
  const Eigen::VectorXd values =
      Scale() * assembly.Combine(elasticity_.poisson_ratio);
  const Eigen::MatrixXd all = TextbookStiffness(mesh_, hooke_);
  const Eigen::MatrixXd free = all(dofs.free, dofs.free);
  const SymmetricPattern& pattern = assembly.Pattern();
  Eigen::MatrixXd rest = free.triangularView<Eigen::Lower>();
  for (std::int64_t j = 0; j < pattern.Size(); ++j) {
    for (std::int64_t k = pattern.column_start[j];
         k < pattern.column_start[j + 1]; ++k) {
      rest(pattern.row[k], j) -= values(k);
    }
  }
  EXPECT_LT(rest.cwiseAbs().maxCoeff(), 1e-12 * free.cwiseAbs().maxCoeff());
}

TEST_P(ElementKinds, HaveTheTracesOfTheirMatrices) {
  const DegreesOfFreedom dofs(scene_.supports);
  const StiffnessProducts all = MultiplyStiffnessBasis(
      mesh_, Eigen::MatrixXd::Identity(mesh_.NumDofs(), mesh_.NumDofs()));
  const Eigen::MatrixXd h = all.h(dofs.free, dofs.free);
  const Eigen::MatrixXd j = all.j(dofs.free, dofs.free);
  const Eigen::Matrix2d traces =
      StiffnessTraces(mesh_, InternalForces(mesh_, {}), dofs);
  EXPECT_NEAR(traces(0, 0) / h.squaredNorm(), 1, 1e-12);
  EXPECT_NEAR(traces(0, 1) / h.cwiseProduct(j).sum(), 1, 1e-12);
  EXPECT_NEAR(traces(1, 1) / j.squaredNorm(), 1, 1e-12);
}

TEST_P(ElementKinds, DoNotResistRigidMotions) {
  const Eigen::Index dimension = mesh_.Dimension();
  Eigen::MatrixXd motions(mesh_.NumDofs(), NumRigidMotions(int(dimension)));
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    motions.middleRows(dimension * node, dimension) =
        RigidMotionsAt(mesh_.nodes.col(node));
  }
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, motions);
  EXPECT_LT(products.h.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT(products.j.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(motions.cols(), dimension == 3 ? 6 : 3);
}

// The patch test: where the surface moves linearly, so does the inside.
TEST_P(ElementKinds, PassThePatchTest) {
  const Eigen::Index dimension = mesh_.Dimension();
  const Eigen::MatrixXd u = LinearField(RandomMatrix(dimension, dimension, 3));
  Supports supports;
  supports.held = ComponentMask::Constant(dimension, mesh_.NumNodes(), false);
  const std::vector<bool> on_surface = OnSurface();
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    supports.held.col(node).setConstant(on_surface[node]);
  }
  ASSERT_FALSE(supports.held.all());
  supports.displacement = u;
  const Scene scene = {mesh_, {}, supports, {LoadCase()}};
  EXPECT_TRUE(DisplacementsAt(scene, elasticity_.Parameters())
                  .isApprox(u.reshaped(), 1e-12));
}

TEST_P(ElementKinds, StoreTheWorkOfTheirForces) {
  const Eigen::MatrixXd u =
      RandomMatrix(mesh_.Dimension(), mesh_.NumNodes(), 4);
  const Eigen::VectorXd density = StrainEnergyDensity(mesh_, elasticity_, u);
  const Eigen::VectorXd all = u.reshaped();
  EXPECT_NEAR(density.dot(ElementVolumes(mesh_)) /
                  (all.dot(TextbookStiffness(mesh_, hooke_) * all) / 2),
              1, 1e-12);
}

TEST_P(ElementKinds, SpreadABodyForceAsTheTextbook) {
  const Eigen::VectorXd density = RandomMatrix(mesh_.Dimension(), 1, 6);
  const Eigen::MatrixXd force = AssembleLoads(mesh_, {BodyForce{density}});
  EXPECT_TRUE(
      force.isApprox(density * TextbookVolumes(mesh_).transpose(), 1e-12));
  const LoadResultant resultant = ResultantOf(mesh_, BodyForce{density});
  EXPECT_TRUE(resultant.force.isApprox(force.rowwise().sum(), 1e-12));
}

// By Gauss's theorem, a pressure p all around is in balance and does the work
// -p dV on any motion, here on u = A x.
TEST_P(ElementKinds, BalanceAPressureAllAround) {
  const Eigen::Index dimension = mesh_.Dimension();
  const Eigen::MatrixXd force =
      AssembleLoads(mesh_, {Pressure{BoundaryFacets(mesh_), 2}});
  EXPECT_LT(force.rowwise().sum().cwiseAbs().maxCoeff(), 1e-13);
  const Eigen::MatrixXd gradient = RandomMatrix(dimension, dimension, 7);
  // The faces of distorted hexahedra are curved.  The work is exact only if
  // their area vectors are integrated as such.
  const double volume = TextbookVolumes(mesh_).sum();
  EXPECT_NEAR(force.cwiseProduct(LinearField(gradient)).sum(),
              -2 * gradient.trace() * volume, 1e-12);
}

TEST_P(ElementKinds, SpreadATractionOverItsArea) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
  const Eigen::VectorXd traction = RandomMatrix(mesh_.Dimension(), 1, 8);
  const Eigen::MatrixXd force =
      AssembleLoads(mesh_, {Traction{facets, traction}});
  const double area = FacetArea(mesh_, facets);
  EXPECT_TRUE(force.rowwise().sum().isApprox(area * traction, 1e-12));
  const Eigen::MatrixXd of_total =
      AssembleLoads(mesh_, {SurfaceForce{facets, area * traction}});
  EXPECT_TRUE(of_total.isApprox(force, 1e-12));
}

TEST_P(ElementKinds, TellTheirFacesFromOtherNodes) {
  const Eigen::MatrixXi faces = BoundaryFacets(mesh_);
  EXPECT_EQ(FirstThatIsNoFace(mesh_, faces), std::nullopt);
  // A face with one vertex replaced by a distant node is no face.
  const int num_vertices = mesh_.Topology().NumVerticesOfFace();
  Eigen::Index farthest = 0;
  (mesh_.nodes.colwise() - mesh_.nodes.col(faces(0, 7)))
      .colwise()
      .squaredNorm()
      .maxCoeff(&farthest);
  Eigen::MatrixXi mixed = faces;
  mixed(num_vertices - 1, 7) = static_cast<int>(farthest);
  EXPECT_EQ(FirstThatIsNoFace(mesh_, mixed), Eigen::Index(7));
  if (num_vertices == 4) {
    Eigen::MatrixXi crossed = faces;
    std::swap(crossed(1, 7), crossed(2, 7));
    EXPECT_EQ(FirstThatIsNoFace(mesh_, crossed), Eigen::Index(7));
  }
  if (mesh_.Order() == 2) {
    Eigen::MatrixXi other_middle = faces;
    other_middle(num_vertices, 7) = faces(num_vertices, 0);
    EXPECT_EQ(FirstThatIsNoFace(mesh_, other_middle), Eigen::Index(7));
  }
}

TEST_P(ElementKinds, AreHeldOnlyAsAWhole) {
  EXPECT_EQ(WhyNotHeld(mesh_, scene_.supports), "");
  Supports loose = scene_.supports;
  loose.held.setConstant(false);
  loose.held.col(0).setConstant(true);
  EXPECT_NE(WhyNotHeld(mesh_, loose).find("rotate"), std::string::npos);
}

TEST_P(ElementKinds, AreSolvedByMultigridToo) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << WhyNoMultigrid();
  }
  const Eigen::Vector2d parameters(2.5, 0.3);
  Equilibrium iterative(scene_, SolverKind::kMultigrid);
  ASSERT_TRUE(
      iterative.Solve(iterative.Forces().Parameters().Moduli(parameters)));
  EXPECT_EQ(iterative.Notice(), "");
  EXPECT_TRUE(iterative.Displacement().isApprox(
      DisplacementsAt(scene_, parameters, SolverKind::kCholesky), 1e-6));
}

INSTANTIATE_TEST_SUITE_P(All, ElementKinds,
                         ::testing::ValuesIn(AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
