#include "benchmarks/material_levels.h"

#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <utility>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr int kColumns = 24;
constexpr double kLength = 2;
constexpr double kUsualNoise = 0.01;

// Returns the region, from 1 on, of an element with this centre.
using RegionAt = std::function<int(const Eigen::VectorXd& centre)>;

Scene StripUnder(const std::vector<Eigen::Vector2d>& forces) {
  RectangleOptions options;
  options.cells = {kColumns, kColumns / 2};
  options.size = {kLength, kLength / 2};
  options.section = {SectionModel::kPlaneStrain, 1};
  Scene scene = RectangleScene(options);
  const Mesh& mesh = scene.mesh;
  const Eigen::MatrixXi end = BoundaryFacetsWhere(mesh, [&](int node) {
    return mesh.nodes(0, node) > kLength * (1 - 1e-9);
  });
  scene.load_cases.resize(forces.size());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    scene.load_cases[k].loads = {SurfaceForce{end, forces[k]}};
  }
  return scene;
}

Scene Strip() { return StripUnder({Eigen::Vector2d(100, 20)}); }

Eigen::VectorXi RegionsOf(const Mesh& mesh, const RegionAt& region_at) {
  Eigen::VectorXi regions(mesh.NumElements());
  for (Eigen::Index e = 0; e < regions.size(); ++e) {
    regions(e) = region_at(ElementCentre(mesh, e));
  }
  return regions;
}

// Returns regions that are so many pieces of equal length, one behind the
// other.
RegionAt Pieces(int count) {
  return [count](const Eigen::VectorXd& centre) {
    return 1 + int(count * centre(0) / kLength);
  };
}

// Region 2 is a square in the middle, of so many columns of cells.
RegionAt InclusionOf(int columns) {
  const double half = columns * kLength / kColumns / 2;
  return [half](const Eigen::VectorXd& centre) {
    return (centre - Eigen::Vector2d(kLength / 2, kLength / 4))
                       .cwiseAbs()
                       .maxCoeff() < half
               ? 2
               : 1;
  };
}

Eigen::VectorXd ParametersFrom(
    const std::vector<IsotropicElasticity>& elasticities) {
  Eigen::VectorXd parameters(2 * Eigen::Index(elasticities.size()));
  for (std::size_t i = 0; i < elasticities.size(); ++i) {
    parameters.segment<2>(2 * Eigen::Index(i))
        << elasticities[i].youngs_modulus,
        elasticities[i].poisson_ratio;
  }
  return parameters;
}

// Returns stiff and soft materials in turn.
std::vector<IsotropicElasticity> Alternating(int count, double contrast) {
  std::vector<IsotropicElasticity> elasticities;
  elasticities.reserve(std::size_t(count));
  for (int i = 0; i < count; ++i) {
    elasticities.push_back(i % 2 == 0
                               ? IsotropicElasticity{1e4, 0.3}
                               : IsotropicElasticity{contrast * 1e4, 0.2});
  }
  return elasticities;
}

MaterialLevel Right(const std::string& factor, const std::string& level,
                    Scene specimen, const RegionAt& region_at,
                    const std::vector<IsotropicElasticity>& elasticities) {
  specimen.mesh.regions = RegionsOf(specimen.mesh, region_at);
  specimen.materials = IsotropicMaterialOfEachRegion(specimen.mesh);
  return RightLevel(factor, level, specimen, ParametersFrom(elasticities),
                    kUsualNoise, Eigen::Vector2d(1, -2));
}

// Returns the parameters of each region of the model; empty where a region
// contains more than one material of the specimen.
Eigen::VectorXd ParametersOfModel(const MaterialLevel& level) {
  std::map<int, int> region_of_specimen;
  const Eigen::VectorXi& regions = level.specimen.mesh.regions;
  for (Eigen::Index e = 0; e < regions.size(); ++e) {
    const auto [place, is_new] =
        region_of_specimen.emplace(level.regions_of_model(e), regions(e));
    if (!is_new && place->second != regions(e)) {
      return {};
    }
  }
  Eigen::VectorXd parameters(2 * Eigen::Index(region_of_specimen.size()));
  Eigen::Index i = 0;
  for (const auto& [of_model, of_specimen] : region_of_specimen) {
    parameters.segment<2>(i) =
        level.parameters.segment<2>(2 * Eigen::Index(of_specimen - 1));
    i += 2;
  }
  return parameters;
}

// The specimen stays, but the model takes it to have other regions.
MaterialLevel TakenAs(MaterialLevel level, const std::string& assumption,
                      const RegionAt& region_at) {
  Mesh model = level.specimen.mesh;
  model.regions = RegionsOf(model, region_at);
  level.assumption = assumption;
  level.regions_of_model = model.regions;
  level.materials_of_model = IsotropicMaterialOfEachRegion(model);
  level.parameters_of_model = ParametersOfModel(level);
  return level;
}

void AddSpecimens(std::vector<MaterialLevel>& levels) {
  for (const int count : {1, 2, 3, 4, 6, 12}) {
    levels.push_back(Right("regions", std::to_string(count), Strip(),
                           Pieces(count), Alternating(count, 2)));
    levels.back().is_in_quick = count <= 4;
  }
  for (const double contrast : {1, 2, 10, 100}) {
    levels.push_back(Right("contrast of E", LevelText(contrast), Strip(),
                           Pieces(2), Alternating(2, contrast)));
    levels.back().is_in_quick = contrast == 100;
  }
  for (const int columns : {2, 4, 8}) {
    levels.push_back(Right("width of an inclusion [cells]",
                           std::to_string(columns), Strip(),
                           InclusionOf(columns), Alternating(2, 2)));
  }
  for (const double nu : {0.3, 0.45, 0.49, 0.499}) {
    levels.push_back(Right("nu of one of two regions", LevelText(nu), Strip(),
                           Pieces(2), {{1e4, nu}, {2e4, 0.2}}));
    levels.back().is_in_quick = nu == 0.499;
  }
}

void AddMeasurements(std::vector<MaterialLevel>& levels) {
  for (const double percent : {0.1, 1.0, 5.0}) {
    MaterialLevel level = Right("noise [%]", LevelText(percent), Strip(),
                                Pieces(4), Alternating(4, 2));
    level.noise = percent / 100;
    levels.push_back(level);
  }
  const std::vector<Eigen::Vector2d> forces = {{100, 20}, {0, 100}, {100, 0}};
  for (std::size_t count = 1; count <= forces.size(); ++count) {
    MaterialLevel level =
        Right("load cases at 5 % noise", std::to_string(count),
              StripUnder({forces.begin(), forces.begin() + long(count)}),
              Pieces(4), Alternating(4, 2));
    level.noise = 0.05;
    levels.push_back(level);
  }
}

void AddWrongRegions(std::vector<MaterialLevel>& levels) {
  const MaterialLevel right =
      Right("wrong regions", "2", Strip(), Pieces(2), Alternating(2, 2));
  levels.push_back(right);
  levels.push_back(TakenAs(right, "one material", Pieces(1)));
  // The regions are shifted by a twelfth of the strip.  They still stand for
  // the two materials.
  levels.push_back(TakenAs(right, "shifted", [](const Eigen::VectorXd& centre) {
    return centre(0) < kLength * 7 / 12 ? 1 : 2;
  }));
  levels.back().parameters_of_model = right.parameters;
  levels.push_back(TakenAs(right, "halves along the axis",
                           [](const Eigen::VectorXd& centre) {
                             return centre(1) < kLength / 4 ? 1 : 2;
                           }));
}

void AddModels(std::vector<MaterialLevel>& levels) {
  const std::vector<IsotropicElasticity> four = {
      {1e4, 0.3}, {2e4, 0.2}, {1.5e4, 0.35}, {3e4, 0.25}};
  for (const double percent : {0.1, 1.0, 5.0}) {
    MaterialLevel right =
        Right("regions of the model", "4", Strip(), Pieces(4), four);
    right.noise = percent / 100;
    for (const int count : {1, 2, 4, 8, 12}) {
      MaterialLevel level = TakenAs(right,
                                    count < 4   ? "too few"
                                    : count > 4 ? "too many"
                                                : "right",
                                    Pieces(count));
      level.level = std::to_string(count);
      level.is_also_merged = count >= 4;
      level.is_in_quick = percent == 0.1 || (percent == 5 && count == 4);
      levels.push_back(level);
    }
  }
}

// Returns a bar of 1 x 1 x 3 with ten pieces, one on the other.  It has this
// many cells of five tetrahedra across.
MaterialLevel BarOfTenPieces(int cells) {
  constexpr int kPieces = 10;
  constexpr double kHeight = 3;
  CuboidOptions options;
  options.cells = {cells, cells, 3 * cells};
  options.size = {1, 1, kHeight};
  Scene specimen = CuboidScene(options);
  const Mesh& mesh = specimen.mesh;
  const Eigen::MatrixXi end = BoundaryFacetsWhere(mesh, [&](int node) {
    return mesh.nodes(2, node) > kHeight * (1 - 1e-9);
  });
  specimen.load_cases.resize(1);
  specimen.load_cases[0].loads = {
      SurfaceForce{end, Eigen::Vector3d(30, 20, 100)}};
  specimen.mesh.regions =
      RegionsOf(specimen.mesh, [](const Eigen::VectorXd& centre) {
        return 1 + static_cast<int>(kPieces * centre(2) / kHeight);
      });
  specimen.materials = IsotropicMaterialOfEachRegion(specimen.mesh);
  return RightLevel("tetrahedra of ten regions",
                    std::to_string(specimen.mesh.NumElements()), specimen,
                    ParametersFrom(Alternating(kPieces, 2)), kUsualNoise,
                    Eigen::Vector3d(1, -2, 1));
}

void AddSizes(std::vector<MaterialLevel>& levels) {
  for (const int cells : {5, 10, 15}) {
    levels.push_back(BarOfTenPieces(cells));
    levels.back().is_for_fits_alone = true;
    levels.back().is_in_quick = cells == 5;
  }
}

}  // namespace

MaterialLevel RightLevel(const std::string& factor, const std::string& level,
                         const Scene& specimen,
                         const Eigen::VectorXd& parameters, double noise,
                         const Eigen::VectorXd& body_force) {
  LoadCase unseen;
  unseen.loads = {BodyForce{body_force}};
  return {factor,
          level,
          "right",
          specimen,
          parameters,
          specimen.mesh.regions,
          specimen.materials,
          parameters,
          noise,
          unseen};
}

std::string LevelText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::vector<MaterialLevel> MaterialLevels() {
  std::vector<MaterialLevel> levels;
  AddSpecimens(levels);
  AddMeasurements(levels);
  AddWrongRegions(levels);
  AddModels(levels);
  AddSizes(levels);
  return levels;
}

}  // namespace elastimate
