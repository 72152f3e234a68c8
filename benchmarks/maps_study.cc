#include "benchmarks/maps_study.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/processor_time.h"
#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/estimators/force_balance/local_map.h"
#include "elastimate/estimators/maps/estimate_map.h"
#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/field_sensitivity.h"
#include "elastimate/estimators/maps/level_fit.h"
#include "elastimate/estimators/maps/map_errors.h"
#include "elastimate/estimators/maps/region_map.h"
#include "elastimate/estimators/maps/sharpen_map.h"
#include "elastimate/estimators/maps/smooth_map.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr int kCells = 16;
constexpr int kMapTrials = 3;
constexpr double kInclusionRadius = 0.2;
constexpr double kContrast = 5;
constexpr double kPoissonRatioOfMaps = 0.3;

using LogModulus = std::function<double(const Eigen::Vector2d&)>;

struct MapSpecimen {
  Scene scene;
  Eigen::VectorXd log_moduli;
};

Eigen::VectorXd LogModuliOf(const Mesh& mesh, const LogModulus& log_modulus) {
  Eigen::VectorXd log_moduli(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    log_moduli(e) = log_modulus(ElementCentre(mesh, e));
  }
  return log_moduli;
}

// Returns E and nu of each element, one behind the other.
Eigen::VectorXd ParametersOf(const Eigen::VectorXd& log_moduli,
                             double poisson_ratio) {
  Eigen::VectorXd parameters(2 * log_moduli.size());
  for (Eigen::Index e = 0; e < log_moduli.size(); ++e) {
    parameters.segment<2>(2 * e) << std::exp(log_moduli(e)), poisson_ratio;
  }
  return parameters;
}

// Returns a rectangle that is held at x = 0 and pulled, as its own elements
// compute it, without noise.
MapSpecimen ComputedSpecimen(const RectangleOptions& options,
                             double poisson_ratio,
                             const LogModulus& log_modulus) {
  MapSpecimen specimen;
  specimen.scene = RectangleScene(options);
  specimen.log_moduli = LogModuliOf(specimen.scene.mesh, log_modulus);
  Scene truth = WithMaterialOfEachElement(specimen.scene);
  MeasureMaterials(ParametersOf(specimen.log_moduli, poisson_ratio), truth);
  specimen.scene.load_cases[0].displacement = truth.load_cases[0].displacement;
  specimen.scene.origin = Origin::kComputed;
  return specimen;
}

MapSpecimen Specimen(int cells, const LogModulus& log_modulus) {
  RectangleOptions options;
  options.cells = {cells, cells};
  options.size = {1, 1};
  options.force = {1, -0.2};
  options.section = {SectionModel::kPlaneStrain, 1};
  return ComputedSpecimen(options, kPoissonRatioOfMaps, log_modulus);
}

// Returns such a rectangle with the displacements that quadratic elements of
// half of the size compute, because a specimen is finer than its mesh.  Each of
// these has the modulus at its own centre.
MapSpecimen MeasuredSpecimen(RectangleOptions options, double poisson_ratio,
                             const LogModulus& log_modulus) {
  MapSpecimen specimen;
  specimen.scene = RectangleScene(options);
  specimen.log_moduli = LogModuliOf(specimen.scene.mesh, log_modulus);
  const Eigen::Vector2i nodes = options.cells.array() + 1;
  options.cells *= 2;
  const Scene finer = RectangleScene(options);
  Scene truth = FinerScene(WithMaterialOfEachElement(finer));
  MeasureMaterials(
      ParametersOf(LogModuliOf(finer.mesh, log_modulus), poisson_ratio), truth);
  const Eigen::MatrixXd& displacement = truth.load_cases[0].displacement;
  specimen.scene.load_cases[0].displacement.resize(2, nodes.prod());
  for (int j = 0; j < nodes.y(); ++j) {
    for (int i = 0; i < nodes.x(); ++i) {
      specimen.scene.load_cases[0].displacement.col(i + j * nodes.x()) =
          displacement.col(2 * i + 2 * j * (options.cells.x() + 1));
    }
  }
  return specimen;
}

bool IsInInclusion(const Eigen::Vector2d& point, double radius) {
  return (point - Eigen::Vector2d(0.5, 0.5)).norm() < radius;
}

LogModulus Inclusion(double radius) {
  return [radius](const Eigen::Vector2d& point) {
    return IsInInclusion(point, radius) ? std::log(kContrast) : 0;
  };
}

double Gradient(const Eigen::Vector2d& point) {
  return std::log(3.0) * (point.y() - 0.5) +
         0.3 * std::sin(2 * M_PI * point.x());
}

double ErrorOfMap(const Eigen::VectorXd& log_moduli,
                  const MapSpecimen& specimen) {
  const Eigen::VectorXd& truth = specimen.log_moduli;
  const Eigen::VectorXd deviations = log_moduli - truth;
  return (deviations.array() - deviations.mean()).matrix().norm() /
         (truth.array() - truth.mean()).matrix().norm();
}

// A smooth map of a measurement, from which the later stages go on.
class MapRun {
 public:
  explicit MapRun(const Scene&& scene) = delete;
  explicit MapRun(const Scene& scene)
      : model_(scene, SolverKind::kCholesky), prior_(scene.mesh) {
    const double start = ProcessorSeconds();
    homogeneous_ =
        FitLevels(problem_, std::vector<int>(prior_.NumElements(), 0),
                  Eigen::VectorXd::Zero(1), kPoissonRatioOfMaps);
    if (!homogeneous_) {
      throw std::runtime_error("no fit of a homogeneous square");
    }
    smooth_ = FitSmoothMap(problem_, prior_, *homogeneous_);
    seconds_ = ProcessorSeconds() - start;
  }

  const SmoothMap& Smooth() const { return *smooth_; }
  double Seconds() const { return seconds_; }
  MapState Sharpened() { return SharpenMap(problem_, prior_, *smooth_); }
  std::optional<RegionMap> Regions(const MapState& sharpened) {
    const std::vector<RegionMap> maps =
        FitRegions(problem_, prior_, sharpened, *homogeneous_);
    return maps.empty() ? std::nullopt : std::optional<RegionMap>(maps.front());
  }
  Eigen::VectorXd Lengths() const {
    return ResolutionLengths(problem_, prior_, *smooth_);
  }

 private:
  FieldSensitivity model_;
  MapProblem problem_{model_, {}, {}};
  FieldPrior prior_;
  std::optional<LevelFit> homogeneous_;
  std::optional<SmoothMap> smooth_;
  double seconds_ = 0;
};

void AddStages(const std::string& specimen_name, const MapSpecimen& specimen,
               double noise, std::int64_t seed, Table& table) {
  const Scene scene = WithNoise(specimen.scene, noise, seed);
  const auto add = [&](const std::string& stage, const Eigen::VectorXd& m,
                       const std::string& verdict) {
    table.AddRow(
        {specimen_name, noise, seed, stage, ErrorOfMap(m, specimen), verdict});
  };
  add("local",
      EstimateLocalMap(scene, {}).youngs_modulus.cwiseAbs().array().log(), "");
  MapRun run(scene);
  add("smooth", run.Smooth().state.log_moduli, "");
  const MapState sharpened = run.Sharpened();
  add("sharpened", sharpened.log_moduli, "");
  if (const std::optional<RegionMap> regions = run.Regions(sharpened)) {
    add("regions", regions->fit.state.log_moduli, "");
  }
  const MapEstimate map = EstimateMap(scene, {});
  if (map.IsUsable()) {
    add("verdict", map.youngs_modulus.array().log(),
        std::string(MapVerdictName(map.verdict)));
  }
}

Table StagesTable(bool is_quick, Progress& progress) {
  Table table("maps_stages", {"specimen", "displacement_deviation [1]",
                              "noise_seed", "stage", "error [1]", "verdict"});
  const MapSpecimen inclusion = Specimen(kCells, Inclusion(kInclusionRadius));
  const MapSpecimen gradient = Specimen(kCells, Gradient);
  const std::vector<double> noises =
      is_quick ? std::vector<double>{0.001, 0.01}
               : std::vector<double>{0.0001, 0.001, 0.01, 0.03, 0.1};
  for (const double noise : noises) {
    progress.Show("maps: stages, noise " + std::to_string(noise));
    for (std::int64_t seed = 1; seed <= (is_quick ? 1 : kMapTrials); ++seed) {
      AddStages("inclusion", inclusion, noise, seed, table);
      AddStages("gradient", gradient, noise, seed, table);
    }
  }
  return table;
}

void AddContrast(double radius, double noise, std::int64_t seed, Table& table) {
  const MapSpecimen specimen = Specimen(kCells, Inclusion(radius));
  const Scene scene = WithNoise(specimen.scene, noise, seed);
  const MapRun run(scene);
  const Eigen::VectorXd lengths = run.Lengths();
  const Eigen::VectorXd& m = run.Smooth().state.log_moduli;
  const Eigen::ArrayXd inside =
      (specimen.log_moduli.array() > 0).cast<double>();
  const double num_inside = inside.sum();
  const double of_inside = (m.array() * inside).sum() / num_inside;
  const double of_outside =
      (m.array() * (1 - inside)).sum() / (double(m.size()) - num_inside);
  const double length = (lengths.array() * inside).sum() / num_inside;
  // A disc of as many elements.
  const double diameter = std::sqrt(4 * num_inside / M_PI) / kCells;
  table.AddRow({diameter, noise, seed, length, diameter / length,
                (of_inside - of_outside) / std::log(kContrast)});
}

Table ContrastTable(bool is_quick, Progress& progress) {
  Table table("maps_contrast",
              {"diameter [1]", "displacement_deviation [1]", "noise_seed",
               "resolution_length [1]", "diameter_over_resolution_length [1]",
               "part_of_contrast [1]"});
  progress.Show("maps: contrast");
  for (const double radius : {0.07, 0.1, 0.15, 0.2, 0.3}) {
    for (const double noise : {0.001, 0.01, 0.05}) {
      for (std::int64_t seed = 1; seed <= (is_quick ? 1 : kMapTrials); ++seed) {
        AddContrast(radius, noise, seed, table);
      }
    }
  }
  return table;
}

Table TimeTable(bool is_quick, Progress& progress) {
  Table table("maps_time",
              {"elements [1]", "displacement_deviation [1]",
               "supported_parameters [1]", "modes [1]", "time [s]"});
  const std::vector<int> sizes =
      is_quick ? std::vector<int>{8, 16} : std::vector<int>{16, 32, 48};
  for (const int cells : sizes) {
    const MapSpecimen specimen = Specimen(cells, Inclusion(kInclusionRadius));
    for (const double noise : {0.001, 0.003, 0.01, 0.03, 0.1}) {
      progress.Show("maps: time, " + std::to_string(cells * cells) +
                    " elements");
      const Scene scene = WithNoise(specimen.scene, noise, 1);
      const MapRun run(scene);
      table.AddRow({std::int64_t{cells} * cells, noise,
                    run.Smooth().effective_number,
                    std::int64_t{run.Smooth().modes.Size()}, run.Seconds()});
    }
  }
  return table;
}

// The example of OpenQSEI (D. Smyl, S. Bossuyt, D. Liu, OpenQSEI: a MATLAB
// package for quasi static elasticity imaging, SoftwareX 7, 2018) with a soft
// rectangle in a plate.  One end is held and the other pulled, as the supports
// and forces of the example are not described.
MapSpecimen PlateWithSoftRectangle(double contrast) {
  RectangleOptions options;
  options.cells = {20, 20};
  options.size = {10, 10};
  options.force = {1, 0};
  options.kind = ElementKind::kTri3;
  options.section = {SectionModel::kPlaneStress, 0.05};
  return ComputedSpecimen(options, 0.35, [=](const Eigen::Vector2d& point) {
    const bool is_inside =
        (point.array() >= 2.25).all() && (point.array() <= 4.75).all();
    return is_inside ? std::log(300 / contrast) : std::log(300.0);
  });
}

// The phantoms of E. L. Madsen et al., Tissue-mimicking agar/gelatin materials
// for use in heterogeneous elastography phantoms, Phys. Med. Biol. 50, 2005:
// cubes of 9 cm with a cylinder of 2 cm in diameter.  The specimen is the
// section across its axis.
MapSpecimen PhantomWithCylinder(double contrast) {
  RectangleOptions options;
  options.cells = {27, 27};
  options.size = {90, 90};
  options.force = {-10, 0};
  options.section = {SectionModel::kPlaneStrain, 1};
  return MeasuredSpecimen(options, 0.495, [=](const Eigen::Vector2d& point) {
    return (point - Eigen::Vector2d(45, 45)).norm() < 10
               ? std::log(20 * contrast)
               : std::log(20.0);
  });
}

void AddPhantom(const std::string& specimen_name, double contrast,
                const MapSpecimen& specimen, double noise, std::int64_t seed,
                Table& table) {
  const MapEstimate map =
      EstimateMap(WithNoise(specimen.scene, noise, seed), {});
  const bool is_resolved = std::none_of(
      map.findings.begin(), map.findings.end(), [](const Finding& finding) {
        return finding.code == FindingCode::kNotResolved;
      });
  const auto unknown = std::numeric_limits<double>::quiet_NaN();
  MapRegion softest = {unknown, unknown, unknown, unknown, false};
  MapRegion stiffest = softest;
  if (map.IsUsable() && !map.regions.empty()) {
    softest = map.regions.front();
    stiffest = map.regions.back();
  }
  table.AddRow(
      {specimen_name, contrast, noise, seed,
       map.IsUsable() ? std::string(MapVerdictName(map.verdict)) : "not usable",
       std::int64_t(map.regions.size()),
       std::exp(specimen.log_moduli.minCoeff()), softest.youngs_modulus,
       softest.standard_error, softest.volume,
       std::exp(specimen.log_moduli.maxCoeff()), stiffest.youngs_modulus,
       stiffest.standard_error, stiffest.volume, std::int64_t{is_resolved}});
}

Table PhantomsTable(bool is_quick, Progress& progress) {
  Table table(
      "maps_phantoms",
      {"specimen", "contrast [1]", "displacement_deviation [1]", "noise_seed",
       "verdict", "regions [1]", "softest_true [kPa]", "softest [kPa]",
       "softest_standard_error [kPa]", "softest_volume [length^3]",
       "stiffest_true [kPa]", "stiffest [kPa]", "stiffest_standard_error [kPa]",
       "stiffest_volume [length^3]", "is_resolved [1]"});
  progress.Show("maps: phantoms");
  const auto add = [&](const std::string& name, double contrast,
                       const MapSpecimen& specimen, double noise) {
    for (std::int64_t seed = 1; seed <= (is_quick ? 1 : kMapTrials); ++seed) {
      AddPhantom(name, contrast, specimen, noise, seed, table);
    }
  };
  for (const double contrast : {3.0, 300.0}) {
    add("plate", contrast, PlateWithSoftRectangle(contrast), 0.003);
  }
  for (const double contrast : {1.5, 4.6}) {
    for (const double noise : {0.001, 0.01}) {
      add("phantom", contrast, PhantomWithCylinder(contrast), noise);
    }
  }
  return table;
}

}  // namespace

StudyResult RunMapsStudy(bool is_quick, Progress& progress) {
  return {{StagesTable(is_quick, progress), ContrastTable(is_quick, progress),
           TimeTable(is_quick, progress), PhantomsTable(is_quick, progress)},
          {{"square",
            "1 x 1 in plane strain, of 16 x 16 quadrilaterals unless the table "
            "says otherwise, held at x = 0, with the force (1, -0.2) on the "
            "other end; nu = 0.3, estimated"},
           {"inclusion",
            "E = 5 in a disc about the middle, of the radius 0.2 unless the "
            "table says otherwise, E = 1 around it"},
           {"gradient", "ln E = ln 3 (y - 0.5) + 0.3 sin 2 pi x"},
           {"plate",
            "10 x 10 x 0.05 in plane stress, of 800 triangles, held at x = 0, "
            "with the force (1, 0) on the other end; E = 300, and 300 / "
            "contrast where both coordinates are 2.25 to 4.75; nu = 0.35"},
           {"phantom",
            "90 x 90 in plane strain, of 27 x 27 quadrilaterals, held at x = "
            "0, with the force (-10, 0) on the other end; E = 20, and 20 "
            "contrast in a disc of the diameter 20 about the middle; nu = "
            "0.495; measured by quadratic elements of half of the size"},
           {"noise", "uniform, at all nodes"},
           {"noise_seeds", "1 to the number of trials; in maps_time 1"}}};
}

}  // namespace elastimate
