#include "elastimate/core/mechanics/internal_forces.h"

#include <gtest/gtest.h>

#include "elastimate/core/mechanics/law_products.h"
#include "tests/core/random_values.h"
#include "tests/regions.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::RandomMatrix;

class InternalForcesOfKinds : public ::testing::TestWithParam<KindOfSection> {
 protected:
  Scene scene_ = testing::TwoRegionScene(GetParam());
  std::vector<IsotropicElasticity> elasticities_ = {{2, 0.1}, {5, 0.4}};
  Eigen::Vector4d parameters_{2, 0.1, 5, 0.4};
  Eigen::MatrixXd stiffness_ =
      testing::TextbookStiffness(scene_, elasticities_);
  InternalForces forces_{scene_.mesh, scene_.materials};
  Eigen::VectorXd moduli_ = forces_.Parameters().Moduli(parameters_);
  Eigen::MatrixXd u_ = RandomMatrix(scene_.mesh.NumDofs(), 2, 1);
};

TEST_P(InternalForcesOfKinds, AreThoseOfTheTextbook) {
  const Eigen::MatrixXd expected = stiffness_ * u_;
  EXPECT_LT((forces_.Multiply(moduli_, u_) - expected).norm(),
            1e-12 * expected.norm());
  const Eigen::VectorXd of_columns = forces_.Columns(u_.col(0)) * moduli_;
  EXPECT_LT((of_columns - expected.col(0)).norm(), 1e-12 * expected.norm());
}

TEST_P(InternalForcesOfKinds, OfAMaterialAreZeroOutsideIt) {
  const Eigen::MatrixXd columns = forces_.Columns(u_.col(0));
  Eigen::ArrayXd is_inside = Eigen::ArrayXd::Zero(scene_.mesh.NumDofs());
  for (Eigen::Index e = 0; e < scene_.mesh.NumElements(); ++e) {
    for (const int node : scene_.mesh.elements.col(e)) {
      is_inside.segment(scene_.mesh.Dimension() * node,
                        scene_.mesh.Dimension()) += scene_.mesh.regions(e) == 3;
    }
  }
  for (Eigen::Index dof = 0; dof < columns.rows(); ++dof) {
    if (is_inside(dof) == 0) {
      EXPECT_TRUE(columns.row(dof).head<2>().isZero(0)) << dof;
    }
  }
}

TEST_P(InternalForcesOfKinds, HaveTheBlocksOfTheTextbook) {
  const NodeGraph graph(scene_.mesh);
  const Eigen::MatrixXd blocks = forces_.Blocks(moduli_, graph);
  const Eigen::MatrixXd diagonal = forces_.DiagonalBlocks(moduli_);
  const Eigen::Index d = scene_.mesh.Dimension();
  for (Eigen::Index node = 0; node < scene_.mesh.NumNodes(); ++node) {
    EXPECT_LT((diagonal.middleCols(d * node, d) -
               stiffness_.block(d * node, d * node, d, d))
                  .norm(),
              1e-12 * stiffness_.norm());
    for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
      EXPECT_LT((blocks.middleCols(d * k, d) -
                 stiffness_.block(d * graph.row[k], d * node, d, d))
                    .norm(),
                1e-12 * stiffness_.norm());
    }
  }
}

// The pass that serves any law, with the moduli of the isotropic one.
TEST_P(InternalForcesOfKinds, OfAnyLawAreThoseOfTheIsotropicPass) {
  const Mesh& mesh = scene_.mesh;
  const Law& law = forces_.Parameters().LawOf(0);
  const Eigen::MatrixXd rest =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.Dimension());
  const std::vector<std::vector<Eigen::MatrixXd>> tangents = {
      {law.Tangent(Eigen::Vector2d(1, 0), rest, mesh.section.model),
       law.Tangent(Eigen::Vector2d(0, 1), rest, mesh.section.model)}};
  std::vector<Eigen::MatrixXd> products(
      2, Eigen::MatrixXd::Zero(u_.rows(), u_.cols()));
  AddLawProducts(mesh, std::vector<int>(mesh.NumElements(), 0),
                 MaterialFrames({}, mesh.Dimension()), tangents, u_, products);
  const StiffnessProducts expected = MultiplyStiffnessBasis(mesh, u_);
  EXPECT_LT((products[0] - expected.h).norm(), 1e-12 * expected.h.norm());
  EXPECT_LT((products[1] - expected.j).norm(), 1e-12 * expected.j.norm());
}

TEST_P(InternalForcesOfKinds, StoreTheWorkOfTheForces) {
  const Eigen::VectorXd density = forces_.EnergyDensity(moduli_, u_.col(0));
  const double work = u_.col(0).dot(stiffness_ * u_.col(0)) / 2;
  EXPECT_NEAR(density.dot(ElementVolumes(scene_.mesh)) / work, 1, 1e-12);
}

TEST_P(InternalForcesOfKinds, OfOneMaterialAreThoseOfTheBasis) {
  const InternalForces one(scene_.mesh, {});
  const StiffnessProducts expected =
      MultiplyStiffnessBasis(scene_.mesh, u_.col(0));
  const Eigen::MatrixXd columns = one.Columns(u_.col(0));
  EXPECT_LT((columns.col(0) - expected.h).norm(), 1e-13 * expected.h.norm());
  EXPECT_LT((columns.col(1) - expected.j).norm(), 1e-13 * expected.j.norm());
}

INSTANTIATE_TEST_SUITE_P(Kinds, InternalForcesOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
