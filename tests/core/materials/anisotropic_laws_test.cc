// Tests of the laws whose stiffness depends on the direction.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/materials/kelvin_law.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/material_frames.h"
#include "elastimate/core/materials/stiffness_factors.h"
#include "tests/anisotropy.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/regions.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

std::vector<std::pair<const Law*, SectionModel>> LawsWithFactors() {
  std::vector<std::pair<const Law*, SectionModel>> all;
  for (const Law* const law : Laws()) {
    if (!law->BlockEntries().empty() && law->ForLargeStrains() == nullptr) {
      all.emplace_back(law, law->Takes(SectionModel::kSolid)
                                ? SectionModel::kSolid
                                : SectionModel::kPlaneStress);
    }
  }
  return all;
}

Eigen::MatrixXd StiffnessAt(const Law& law, const Eigen::VectorXd& moduli,
                            SectionModel model) {
  const int dimension = model == SectionModel::kSolid ? 3 : 2;
  return VoigtStiffness(
      law.Tangent(moduli, Eigen::MatrixXd::Zero(dimension, dimension), model));
}

TEST(AnisotropicLaws, HaveTheStiffnessOfTheTextbook) {
  ASSERT_EQ(LawsWithFactors().size(), 4);
  for (const auto& [law, model] : LawsWithFactors()) {
    const Eigen::VectorXd parameters = testing::UnlikeTypical(*law, 70);
    const Eigen::MatrixXd expected =
        testing::TextbookStiffnessOf(*law, parameters);
    const Eigen::MatrixXd actual =
        StiffnessAt(*law, law->Moduli(parameters, model), model);
    EXPECT_LT((actual - expected).norm(), 1e-13 * expected.norm())
        << law->Name();
  }
}

// With the parameters of an isotropic material, every law has its stiffness.
TEST(AnisotropicLaws, HoldTheIsotropicOne) {
  for (const auto& [law, model] : LawsWithFactors()) {
    Eigen::VectorXd parameters(Eigen::Index(law->Parameters().size()));
    for (Eigen::Index i = 0; i < parameters.size(); ++i) {
      parameters(i) = law->Parameters()[i].typical;
    }
    const Law& isotropic = *FindLaw("isotropic");
    const Eigen::MatrixXd expected = StiffnessAt(
        isotropic, isotropic.Moduli(Eigen::Vector2d(1, 0.3), model), model);
    EXPECT_LT(
        (StiffnessAt(*law, law->Moduli(parameters, model), model) - expected)
            .norm(),
        1e-14 * expected.norm())
        << law->Name();
  }
}

TEST(StiffnessFactors, MakeAnyStiffnessPositiveDefinite) {
  for (const auto& [law, model] : LawsWithFactors()) {
    for (int seed = 1; seed <= 20; ++seed) {
      const Eigen::VectorXd x = 3 * RandomMatrix(law->NumModuli(), 1, seed);
      const Eigen::VectorXd moduli = ModuliOfFactors(law->BlockEntries(), x);
      const Eigen::VectorXd values =
          testing::SymmetricEigenvalues(StiffnessAt(*law, moduli, model));
      EXPECT_GT(values(0), -1e-13 * values(values.size() - 1));
      const Eigen::VectorXd back = FactorsOfModuli(law->BlockEntries(), moduli);
      EXPECT_LT((back - x).norm(), 1e-6 * x.norm()) << law->Name();
    }
  }
}

TEST(StiffnessFactors, HaveTheirJacobian) {
  constexpr double kStep = 1e-6;
  for (const auto& [law, model] : LawsWithFactors()) {
    const Eigen::VectorXd x = RandomMatrix(law->NumModuli(), 1, 5);
    const Eigen::MatrixXd jacobian =
        ModuliOfFactorsJacobian(law->BlockEntries(), x);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(x.size(), i);
      const Eigen::VectorXd slope =
          (ModuliOfFactors(law->BlockEntries(), x + step) -
           ModuliOfFactors(law->BlockEntries(), x - step)) /
          (2 * kStep);
      EXPECT_LT((slope - jacobian.col(i)).norm(), 1e-8 * jacobian.norm());
    }
  }
}

TEST(StiffnessFactors, AreNoneOfAStiffnessThatIsNotPositiveDefinite) {
  const Law& law = *FindLaw("orthotropic");
  Eigen::VectorXd parameters = testing::UnlikeTypical(law, 1);
  parameters(3) = 3;
  EXPECT_TRUE(FactorsOfModuli(law.BlockEntries(),
                              law.Moduli(parameters, SectionModel::kSolid))
                  .array()
                  .isNaN()
                  .all());
}

// The unit of pressure changes the logarithms ln D alone.
TEST(StiffnessFactors, AreWithoutUnitOffTheDiagonal) {
  for (const auto& [law, model] : LawsWithFactors()) {
    const Eigen::VectorXd moduli =
        law->Moduli(testing::UnlikeTypical(*law, 1), model);
    const Eigen::VectorXd x = FactorsOfModuli(law->BlockEntries(), moduli);
    const Eigen::VectorXd scaled =
        FactorsOfModuli(law->BlockEntries(), 1e9 * moduli);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const BlockEntry& entry = law->BlockEntries()[i];
      EXPECT_NEAR(scaled(i) - x(i),
                  entry.row == entry.column ? std::log(1e9) : 0, 1e-12);
    }
  }
}

TEST(MaterialFrames, AreOrthogonalAndHaveTheAxes) {
  const Eigen::Vector3d axis(0.1, -3, 0.4);
  const MaterialFrames one({{"transversely_isotropic", {}, {}, {}, {axis}}}, 3);
  const Eigen::Matrix3d frame = one.Of<3>(0, 5);
  EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(),
            1e-15);
  EXPECT_LT((frame.col(0) - axis.normalized()).norm(), 1e-15);
  EXPECT_GT(frame.determinant(), 0);
  Eigen::MatrixXd first(3, 2);
  first << 0, 1, 2, 0, 0, 0;
  const Eigen::Vector3d second(0, 0, 5);
  const MaterialFrames each({{"orthotropic", {}, {}, {}, {first, second}}}, 3);
  EXPECT_EQ(each.Of<3>(0, 0).col(0), Eigen::Vector3d::UnitY());
  EXPECT_EQ(each.Of<3>(0, 1).col(0), Eigen::Vector3d::UnitX());
  EXPECT_EQ(each.Of<3>(0, 0).col(1), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(each.Of<3>(0, 0).col(2), Eigen::Vector3d::UnitX());
}

TEST(MaterialAxes, ThatAreWrongAreNamed) {
  const Mesh mesh =
      testing::TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}).mesh;
  const Eigen::Vector3d x(1, 0, 0);
  Eigen::MatrixXd each = x.replicate(1, mesh.NumElements());
  each.col(4).setZero();
  const std::vector<std::pair<Material, std::string>> wrong = {
      {{"transversely_isotropic", {}, {}, {}},
       "has no axis; give its direction, by \"axis\" or --axis"},
      {{"orthotropic", {}, {}, {}}, "has no axes"},
      {{"orthotropic", {}, {}, {}, {x}}, "has 1 axis, and its law takes 2"},
      {{"isotropic", {}, {}, {}, {x}}, "alike in all directions"},
      {{"transversely_isotropic", {}, {}, {}, {Eigen::Vector3d::Zero()}},
       "an axis of length 0;"},
      {{"transversely_isotropic", {}, {}, {}, {each}},
       "an axis of length 0 at element 4"},
      {{"transversely_isotropic", {}, {}, {}, {NAN * x}}, "not finite"},
      {{"orthotropic", {}, {}, {}, {x, 2 * x}}, "not orthogonal"},
      {{"orthotropic", {}, {}, {}, {x, Eigen::Vector3d(1e-5, 1, 0)}},
       "not orthogonal"},
      {{"transversely_isotropic", {}, {}, {}, {Eigen::Vector2d(1, 0)}},
       "2 components"},
      {{"transversely_isotropic", {}, {}, {}, {each.leftCols(3)}},
       "for 3 elements"},
      {{"anisotropic", {}, {}, {{"c12", {1, 2}}}}, "gives bounds of c12"}};
  for (const auto& each_wrong : wrong) {
    EXPECT_THROWS_WITH(ValidateMaterials({each_wrong.first}, mesh),
                       each_wrong.second);
  }
  ValidateMaterials(
      {{"orthotropic", {}, {}, {}, {x, Eigen::Vector3d(0, 9, 0)}}}, mesh);
  ValidateMaterials({{"anisotropic", {}, {}, {}}}, mesh);
  Mesh sheet =
      testing::TwoRegionScene({ElementKind::kTri3, SectionModel::kPlaneStress})
          .mesh;
  EXPECT_THROWS_WITH(
      ValidateMaterials({{"anisotropic", {}, {}, {}}}, sheet),
      "not exist for the model plane_stress; its laws are isotropic, "
      "orthotropic");
  ValidateMaterials({{"orthotropic", {}, {}, {}, {Eigen::Vector2d(1, 1)}}},
                    sheet);
}

// Elements of another material need no axis.
TEST(MaterialAxes, CountInTheirElementsOnly) {
  const Mesh mesh =
      testing::TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}).mesh;
  Eigen::MatrixXd each = Eigen::MatrixXd::Zero(3, mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    each(0, e) = mesh.regions(e) == 3;
  }
  ValidateMaterials({{"transversely_isotropic", {3}, {}, {}, {each}},
                     {"isotropic", {7}, {}, {}}},
                    mesh);
  EXPECT_THROWS_WITH(
      ValidateMaterials({{"transversely_isotropic", {7}, {}, {}, {each}},
                         {"isotropic", {3}, {}, {}}},
                        mesh),
      "has an axis of length 0 at element");
}

}  // namespace
}  // namespace elastimate
