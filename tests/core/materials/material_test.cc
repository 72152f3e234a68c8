#include "elastimate/core/materials/material.h"

#include <gtest/gtest.h>

#include <utility>

#include "elastimate/core/materials/material_parameters.h"
#include "tests/regions.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

Mesh TwoRegionMesh() {
  return testing::TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid})
      .mesh;
}

TEST(Materials, OfEachRegionAreInOrder) {
  const Mesh mesh = TwoRegionMesh();
  const std::vector<Material> materials = IsotropicMaterialOfEachRegion(mesh);
  ASSERT_EQ(materials.size(), 2);
  EXPECT_EQ(materials[0].regions, std::vector<int>{3});
  EXPECT_EQ(materials[1].regions, std::vector<int>{7});
  ValidateMaterials(materials, mesh);
  const std::vector<int> of_elements = MaterialOfElements(materials, mesh);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    EXPECT_EQ(of_elements[e], mesh.regions(e) == 3 ? 0 : 1);
  }
}

TEST(Materials, ThatAreWrongAreNamed) {
  const Mesh mesh = TwoRegionMesh();
  const std::vector<std::pair<std::vector<Material>, std::string>> wrong = {
      {{{"rubber", {}, {}, {}}},
       "the laws are isotropic, transversely_isotropic"},
      {{{"isotropic", {3}, {}, {}}}, "is in region 7"},
      {{{"isotropic", {3, 7}, {}, {}}, {"isotropic", {7}, {}, {}}},
       "region 7 is given to material 1 and to material 2"},
      {{{"isotropic", {3}, {}, {}}, {"isotropic", {}, {}, {}}},
       "material 2 names no region"},
      {{{"isotropic", {3, 7, 8}, {}, {}}},
       "region 8, of which the mesh has no element; its regions are 3, 7; "
       "correct the region"},
      {{{"isotropic", {}, {{"shear_modulus", 1}}, {}}},
       "youngs_modulus, poisson_ratio only"},
      {{{"isotropic", {}, {{"poisson_ratio", 0.6}}, {}}},
       "must be between -0.9999 and"},
      {{{"isotropic", {}, {{"youngs_modulus", -1}}, {}}},
       "positive and finite"},
      {{{"isotropic",
         {},
         {{"poisson_ratio", 0.1}, {"poisson_ratio", 0.1}},
         {}}},
       "twice"},
      {{{"isotropic", {}, {}, {{"poisson_ratio", {0.4, 0.2}}}}}, "crossed"},
      {{{"transversely_isotropic",
         {},
         {{"youngs_modulus_L", 1},
          {"youngs_modulus_T", 3},
          {"poisson_ratio_LT", 0.5},
          {"poisson_ratio_TT", 0.4},
          {"shear_modulus_LT", 1}},
         {}}},
       "not positive definite"},
      {{{"transversely_isotropic",
         {},
         {{"youngs_modulus_L", 1},
          {"youngs_modulus_T", 1},
          {"poisson_ratio_LT", 0.9},
          {"poisson_ratio_TT", 0.9}},
         {}}},
       "not positive definite"},
      {{{"transversely_isotropic",
         {},
         {{"youngs_modulus_L", 1},
          {"youngs_modulus_T", 9},
          {"poisson_ratio_LT", 0.5}},
         {}}},
       "poisson_ratio_LT a value too far from zero"},
      {{{"transversely_isotropic", {}, {{"poisson_ratio_TT", 1.5}}, {}}},
       "poisson_ratio_TT = 1.5"},
      {{{"anisotropic", {}, {{"c11", 1}, {"c22", 1}, {"c12", -2}}, {}}},
       "c12 a value too far from zero"},
      {{{"isotropic", {}, {}, {{"youngs_modulus", {-1, 2}}}}},
       "gives the bound youngs_modulus = -1"},
      {{{"isotropic",
         {},
         {{"poisson_ratio", 0.1}},
         {{"poisson_ratio", {0, 0.2}}}}},
       "twice"}};
  for (const auto& [materials, why] : wrong) {
    EXPECT_THROWS_WITH(ValidateMaterials(materials, mesh), why);
  }
}

TEST(Materials, WithWrongPriorsAreNamed) {
  const Mesh mesh = TwoRegionMesh();
  const std::vector<std::pair<std::vector<Prior>, std::string>> wrong_priors = {
      {{{"poisson_ratio", 0.6, 0.1}}, "gives the prior poisson_ratio = 0.6"},
      {{{"poisson_ratio", 0.3, 0}}, "not positive and finite"},
      {{{"shear_modulus", 1, 1}}, "youngs_modulus, poisson_ratio only"},
      {{{"youngs_modulus", 1, 1}, {"youngs_modulus", 2, 1}}, "twice"}};
  for (const auto& [priors, why] : wrong_priors) {
    Material material;
    material.priors = priors;
    EXPECT_THROWS_WITH(ValidateMaterials({material}, mesh), why);
  }
  Material known;
  known.known = {{"poisson_ratio", 0.3}};
  known.priors = {{"poisson_ratio", 0.3, 0.1}};
  EXPECT_THROWS_WITH(ValidateMaterials({known}, mesh), "twice");
  Material bounded;
  bounded.bounds = {{"poisson_ratio", {0.4, 0.45}}};
  bounded.priors = {{"poisson_ratio", 0.3, 0.1}};
  EXPECT_THROWS_WITH(ValidateMaterials({bounded}, mesh), "beyond its bounds");
  Mesh without = mesh;
  without.regions.resize(0);
  EXPECT_THROWS_WITH(ValidateMaterials({{"isotropic", {3}, {}, {}}}, without),
                     "the mesh has none");
}

TEST(MaterialParameters, AreThoseOfAllMaterials) {
  const std::vector<Material> materials = {
      {"isotropic", {3}, {{"poisson_ratio", 0.25}}, {}},
      {"isotropic", {7}, {}, {}}};
  const MaterialParameters parameters(materials, SectionModel::kSolid);
  EXPECT_EQ(parameters.NumParameters(), 4);
  EXPECT_EQ(parameters.NumModuli(), 4);
  EXPECT_EQ(parameters.Free(), (std::vector<Eigen::Index>{0, 2, 3}));
  EXPECT_EQ(parameters.All()[1].known, 0.25);
  EXPECT_EQ(parameters.All()[2].material, 1);
  const Eigen::Vector4d p(2, 0.25, 3, 0.4);
  EXPECT_TRUE(parameters.ParametersOf(parameters.Moduli(p)).isApprox(p, 1e-14));
  EXPECT_EQ(parameters.Typical(10), Eigen::Vector4d(10, 0.25, 10, 0.3));
}

TEST(MaterialParameters, OfNoMaterialAreThoseOfOneIsotropic) {
  const MaterialParameters parameters({}, SectionModel::kPlaneStress);
  EXPECT_EQ(parameters.NumParameters(), 2);
  EXPECT_TRUE(IsOneIsotropicMaterial({}));
  EXPECT_FALSE(IsOneIsotropicMaterial(
      {{"isotropic", {}, {{"poisson_ratio", 0.3}}, {}}}));
}

}  // namespace
}  // namespace elastimate
