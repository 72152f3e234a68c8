#include "tests/core/mechanics/strain_energy.h"

#include <gtest/gtest.h>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mesh/tet10.h"
#include "elastimate/core/mesh/tet4.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::DenseStiffness;
using testing::Distorted;
using testing::HookeMatrix;
using testing::RandomMatrix;
using testing::SmallScene;
using testing::StrainEnergyDensity;
using testing::WithBothOrientations;

class StrainEnergy : public ::testing::TestWithParam<double> {
 protected:
  StrainEnergy()
      : mesh_(
            WithBothOrientations(Distorted(BoxMesh({2, 3, 2}, {1, 0.8, 1.2})))),
        elasticity_{2.5, GetParam()} {}

  // Under u = gradient * x every element has the density `expected`.  Strains
  // lose one or two digits to the differences of node positions.
  void ExpectDensity(const Eigen::Matrix3d& gradient, double expected) const {
    const Eigen::VectorXd density =
        StrainEnergyDensity(mesh_, elasticity_, gradient * mesh_.nodes);
    ASSERT_EQ(density.size(), mesh_.NumElements());
    const double scale = elasticity_.StiffnessScale(SectionModel::kSolid) *
                         gradient.squaredNorm();
    EXPECT_LT((density.array() - expected).abs().maxCoeff(), 1e-13 * scale);
  }

  Mesh mesh_;
  IsotropicElasticity elasticity_;
};

// Where nothing holds the sides, the density is E / 2 times the square of the
// strain.
TEST_P(StrainEnergy, OfUniaxialStress) {
  const Eigen::Vector3d strain(-GetParam(), -GetParam(), 1);
  ExpectDensity((0.01 * strain).asDiagonal(),
                elasticity_.youngs_modulus / 2 * 1e-4);
}

TEST_P(StrainEnergy, OfSimpleShear) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient(0, 2) = 0.01;
  ExpectDensity(gradient, elasticity_.ShearModulus() / 2 * 1e-4);
}

TEST_P(StrainEnergy, OfSwelling) {
  // The volume grows by 3 percent.
  ExpectDensity(0.01 * Eigen::Matrix3d::Identity(),
                elasticity_.BulkModulus() / 2 * 9e-4);
}

TEST_P(StrainEnergy, OfAnInfinitesimalRotationIsZero) {
  Eigen::Matrix3d gradient;
  gradient << 0, -3, 2, 3, 0, -1, -2, 1, 0;
  ExpectDensity(gradient, 0);
}

TEST_P(StrainEnergy, SumsUpToHalfOfDisplacementTimesStiffness) {
  const Eigen::MatrixXd u = RandomMatrix(3, mesh_.NumNodes(), 4);
  const Eigen::Matrix<double, 6, 6> hooke =
      HookeMatrix<double>(elasticity_.youngs_modulus, GetParam());
  const double expected =
      0.5 *
      u.reshaped().dot(DenseStiffness<double>(mesh_, hooke) * u.reshaped());
  const double energy =
      ElementVolumes(mesh_).dot(StrainEnergyDensity(mesh_, elasticity_, u));
  EXPECT_NEAR(energy / expected, 1, 1e-12);
}

// By Clapeyron's theorem, the energy at equilibrium is half the work of the
// loads.
TEST_P(StrainEnergy, IsHalfTheWorkOfTheLoads) {
  const Scene scene = SmallScene("organ");
  const Eigen::MatrixXd force = AssembleLoadCases(scene);
  const Eigen::VectorXd u = DisplacementsAt(scene, elasticity_.Parameters());
  const double energy =
      ElementVolumes(scene.mesh)
          .dot(StrainEnergyDensity(scene.mesh, elasticity_,
                                   u.reshaped(3, scene.mesh.NumNodes())));
  // The tolerance allows for a condition number of 1e3 / (1 - 2 nu), which is
  // on the safe side.
  EXPECT_NEAR(energy / (0.5 * force.col(0).dot(u)), 1,
              1e-12 / (1 - 2 * GetParam()));
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, StrainEnergy,
                         ::testing::Values(-0.5, 0.0, 0.3, 0.49));

}  // namespace
}  // namespace elastimate
