#include "benchmarks/anisotropy_levels.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <utility>

#include "elastimate/core/materials/anisotropic_law.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/kelvin_law.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/orthotropic_law.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/plan/unit_loads.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr double kBarLength = 2;
constexpr double kAcross = 1e4;        // E_T.
constexpr double kPoissonRatio = 0.3;  // nu_LT and nu_TT.
constexpr double kUsualRatio = 3;      // E_L over E_T.
constexpr std::size_t kUsualCases = 3;
constexpr double kUsualNoiseOfBar = 0.01;

// L is the direction of the fibres, and the other is a direction across it.
const Eigen::Vector3d kAxis(1, 1, 2);
const Eigen::Vector3d kAcrossAxis(1, -1, 0);

// The bar bears forces and moments on its end, and pressures on two sides.
std::vector<std::vector<Load>> LoadsOfBar(const Mesh& mesh) {
  const auto facets_at = [&](int axis, double place) {
    return BoundaryFacetsWhere(mesh, [&mesh, axis, place](int node) {
      return std::abs(mesh.nodes(axis, node) - place) < 1e-9;
    });
  };
  const Eigen::MatrixXi end = facets_at(2, kBarLength);
  return {{SurfaceForce{end, Eigen::Vector3d(30, 20, 100)}},
          {SurfaceForce{end, Eigen::Vector3d(100, 0, 0)}},
          {SurfaceForce{end, Eigen::Vector3d(0, 100, 0)}},
          {UnitLoads(mesh, end).back().load},
          {Pressure{facets_at(0, 1), 100}},
          {Pressure{facets_at(1, 1), 100}}};
}

Scene BarUnder(std::size_t num_cases) {
  CuboidOptions options;
  options.cells = {3, 3, 5};
  options.size = {1, 1, kBarLength};
  options.kind = ElementKind::kHex8;
  Scene scene = CuboidScene(options);
  const std::vector<std::vector<Load>> loads = LoadsOfBar(scene.mesh);
  scene.load_cases.assign(num_cases, {});
  for (std::size_t k = 0; k < num_cases; ++k) {
    scene.load_cases[k].loads = loads[k];
  }
  return scene;
}

Material MaterialOf(std::string_view law,
                    const std::vector<Eigen::MatrixXd>& axes) {
  Material material;
  material.law = law;
  material.axes = axes;
  return material;
}

// Returns E_L, E_T, nu_LT, nu_TT and G_LT, which are isotropic for a ratio of
// 1.
Eigen::VectorXd FibreParameters(double ratio) {
  Eigen::VectorXd parameters(5);
  parameters << ratio * kAcross, kAcross, kPoissonRatio, kPoissonRatio,
      kAcross / (2 * (1 + kPoissonRatio));
  return parameters;
}

// Returns E_i, nu_12, nu_13, nu_23, G_12, G_13 and G_23, in the order of the
// law.
Eigen::VectorXd NineParameters(const Eigen::VectorXd& fibre) {
  const double shear_across = fibre(1) / (2 * (1 + fibre(3)));
  Eigen::VectorXd parameters(9);
  parameters << fibre(0), fibre(1), fibre(1), fibre(2), fibre(2), fibre(3),
      fibre(4), fibre(4), shear_across;
  return parameters;
}

// Returns c_11, c_12, ..., c_66 in the frame of the fibres.
Eigen::VectorXd Stiffnesses(const Eigen::VectorXd& fibre) {
  const Law& law = *FindLaw(TransverselyIsotropicLaw::kName);
  const Eigen::MatrixXd voigt = VoigtStiffness(
      law.Tangent(law.Moduli(fibre, SectionModel::kSolid),
                  Eigen::Matrix3d::Zero(), SectionModel::kSolid));
  Eigen::VectorXd stiffnesses(21);
  Eigen::Index place = 0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = i; j < 6; ++j) {
      stiffnesses(place++) = voigt(i, j);
    }
  }
  return stiffnesses;
}

// The bar is fitted by the law that it has.
MaterialLevel Bar(const std::string& factor, const std::string& level,
                  double ratio, std::size_t num_cases) {
  Scene specimen = BarUnder(num_cases);
  specimen.materials = {MaterialOf(TransverselyIsotropicLaw::kName, {kAxis})};
  return RightLevel(factor, level, specimen, FibreParameters(ratio),
                    kUsualNoiseOfBar, Eigen::Vector3d(-10, 20, 5));
}

// The bar is fitted by this law in place of the one that it has.
MaterialLevel TakenToBe(MaterialLevel level, std::string_view law) {
  const Eigen::VectorXd& fibre = level.parameters;
  if (law == IsotropicLaw::kName) {
    level.materials_of_model = {MaterialOf(law, {})};
    level.assumption = "too few";
    level.parameters_of_model.resize(0);
    if (fibre(0) == fibre(1)) {
      level.assumption = "right";
      level.parameters_of_model = Eigen::Vector2d(fibre(1), fibre(3));
    }
  } else if (law != TransverselyIsotropicLaw::kName) {
    level.materials_of_model = {MaterialOf(law, {kAxis, kAcrossAxis})};
    level.assumption = "too many";
    level.parameters_of_model = law == OrthotropicLaw::kName
                                    ? NineParameters(fibre)
                                    : Stiffnesses(fibre);
  } else if (fibre(0) == fibre(1)) {
    level.assumption = "too many";
  }
  return level;
}

void AddRatios(std::vector<MaterialLevel>& levels) {
  const std::pair<std::string, std::string_view> models[] = {
      {"E_L / E_T by five parameters", TransverselyIsotropicLaw::kName},
      {"E_L / E_T by E and nu", IsotropicLaw::kName},
      {"E_L / E_T by 21 moduli", AnisotropicLaw::kName}};
  for (const auto& [factor, law] : models) {
    for (const double ratio : {1.0, 1.05, 1.5, 3.0, 10.0, 30.0}) {
      levels.push_back(
          TakenToBe(Bar(factor, LevelText(ratio), ratio, kUsualCases), law));
      levels.back().is_in_quick = ratio == 30 && law != AnisotropicLaw::kName;
    }
  }
}

void AddWrongAxes(std::vector<MaterialLevel>& levels) {
  for (const double degrees : {0, 2, 5, 15}) {
    MaterialLevel level = Bar("axis off by [degrees]", LevelText(degrees),
                              kUsualRatio, kUsualCases);
    if (degrees != 0) {
      const Eigen::AngleAxisd turn(degrees * std::acos(-1.0) / 180,
                                   kAcrossAxis.normalized());
      level.assumption = "wrong axis";
      level.materials_of_model[0].axes = {turn * kAxis};
    }
    level.is_in_quick = degrees == 15;
    levels.push_back(level);
  }
}

void AddLoadCases(std::vector<MaterialLevel>& levels) {
  for (const std::size_t count : {1, 2, 3, 6}) {
    levels.push_back(TakenToBe(Bar("load cases of 21 moduli",
                                   std::to_string(count), kUsualRatio, count),
                               AnisotropicLaw::kName));
    levels.back().is_in_quick = false;
  }
}

void AddLaws(std::vector<MaterialLevel>& levels) {
  for (const double percent : {0.1, 1.0, 5.0}) {
    for (const std::string_view law :
         {IsotropicLaw::kName, TransverselyIsotropicLaw::kName,
          OrthotropicLaw::kName, AnisotropicLaw::kName}) {
      MaterialLevel level = TakenToBe(
          Bar("law of the model", std::string(law), kUsualRatio, kUsualCases),
          law);
      level.noise = percent / 100;
      level.is_in_quick = percent == 0.1 && law != AnisotropicLaw::kName;
      levels.push_back(level);
    }
  }
}

}  // namespace

std::vector<MaterialLevel> AnisotropyLevels() {
  std::vector<MaterialLevel> levels;
  AddRatios(levels);
  AddWrongAxes(levels);
  AddLoadCases(levels);
  AddLaws(levels);
  return levels;
}

}  // namespace elastimate
