#include "benchmarks/unseen_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "apps/linear_algebra.h"
#include "benchmarks/finer_world.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/trial.h"
#include "benchmarks/unseen_shapes.h"
#include "benchmarks/unseen_summary.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr double kYoungsModulus = 5e6;  // At small strains.
constexpr std::array<double, 4> kPoissonRatios = {0, 0.3, 0.45, 0.49};
constexpr std::array<double, 5> kDeviations = {0, 0.001, 0.01, 0.03, 0.1};
constexpr int kReplicates = 2;      // On the same mesh, of each size of noise.
constexpr int kMaxReplicates = 4;   // That have seeds.
constexpr int kMaxExperiments = 2;  // On one shape.
constexpr double kOutliers = 0.03;  // Of the nodes, 20 to 100 sd of the noise.
constexpr int kDivisions = 2;       // Of the finer world.

// Trilinear hexahedra lock at larger nu.  At 0.45 hexahedra of this size are
// 0.5 to 1 % too stiff; up to this nu they are less than half of that.
constexpr double kMaxPoissonRatioOfHexahedra = 0.3;

enum World { kSameMesh, kFinerWorld, kHexahedra, kNumWorlds };
constexpr const char* kWorldNames[kNumWorlds] = {"same mesh", "finer world",
                                                 "hexahedra"};

struct Method {
  std::string name;
  std::shared_ptr<const Estimator> estimator;
  /// Whether it is run on the same mesh alone, because in other worlds it takes
  /// five to twelve times as long as reduced-fe.
  bool is_of_same_mesh = false;
  Loss loss = Loss::kNone;
  bool sees_outliers = false;
};

std::vector<Method> Methods() {
  std::vector<Method> methods;
  for (const char* name : {"virtual-fields", "reduced-fe"}) {
    methods.push_back({name, MakeEstimator(name)});
  }
  methods.push_back({"iterative-fe", MakeEstimator("iterative-fe"), true});
  methods.push_back({"auto", MakeEstimator("auto"), false, Loss::kNone, true});
  for (const char* name : {"reduced-fe", "auto"}) {
    methods.push_back({std::string(name) + " huber", MakeEstimator(name), true,
                       Loss::kHuber, true});
  }
  return methods;
}

// Selects a part of the full study, by places in UnseenShapes, kPoissonRatios
// and kDeviations.
struct Extent {
  std::vector<int> shapes;
  std::vector<int> poisson_ratios;
  std::vector<int> deviations;
};

Extent QuickExtent() { return {{3, 6}, {1, 2}, {0, 2}}; }

Extent FullExtent() {
  Extent extent = {{}, {0, 1, 2, 3}, {0, 1, 2, 3, 4}};
  for (std::size_t i = 0; i < UnseenShapes().size(); ++i) {
    extent.shapes.push_back(static_cast<int>(i));
  }
  return extent;
}

// Holds which measurement of one experiment in one world is made.
struct Setting {
  int shape;
  int experiment;
  int world;
  int poisson_ratio;
  int deviation;
  int replicate;
  bool has_outliers = false;

  std::string World() const {
    return kWorldNames[world] +
           std::string(has_outliers ? " with outliers" : "");
  }

  /// Returns a seed that no other setting has.  It is the same in the quick
  /// study and in the full one.
  std::int64_t Seed() const {
    constexpr std::int64_t kOfOutliers = 1'000'000;
    std::int64_t seed = shape;
    seed = seed * kMaxExperiments + experiment;
    seed = seed * kNumWorlds + world;
    seed = seed * std::int64_t(kPoissonRatios.size()) + poisson_ratio;
    seed = seed * std::int64_t(kDeviations.size()) + deviation;
    seed = seed * kMaxReplicates + replicate + 1;
    return has_outliers ? kOfOutliers + seed : seed;
  }
};

// Holds a shape with the meshes that the worlds need.
struct Specimen {
  UnseenShape shape;
  Scene scene;
  FinerWorld finer;
  std::optional<Scene> hexahedra;
};

Specimen MakeSpecimen(const UnseenShape& shape) {
  const Scene scene = UnmeasuredScene(shape, TetrahedralMesh(shape.body));
  Specimen specimen = {shape, scene, {scene, kDivisions}, {}};
  if (shape.hexahedra_per_edge > 0) {
    specimen.hexahedra = UnmeasuredScene(
        shape, HexahedralMesh(shape.body, shape.hexahedra_per_edge));
  }
  return specimen;
}

bool Has(const Specimen& specimen, int world, double poisson_ratio) {
  return world != kHexahedra ||
         (specimen.hexahedra && poisson_ratio <= kMaxPoissonRatioOfHexahedra);
}

// Each experiment is done at every other Poisson's ratio.  The other experiment
// of the shape, and the next shape of the half, have the ones between.
bool IsDone(const Setting& setting) {
  return (setting.shape / 2 + setting.experiment + setting.poisson_ratio) % 2 ==
         0;
}

// Returns all experiments, measured without noise at the nodes of the mesh.
Scene Measured(const Specimen& specimen, int world,
               const IsotropicElasticity& truth) {
  Scene scene = specimen.scene;
  if (world == kFinerWorld) {
    specimen.finer.Measure(truth, scene);
    return scene;
  }
  if (world == kSameMesh) {
    Measure(truth, scene);
    return scene;
  }
  // The nodes of the mesh are the first ones of the hexahedra.
  Scene hexahedra = *specimen.hexahedra;
  Measure(truth, hexahedra);
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        hexahedra.load_cases[k].displacement.leftCols(scene.mesh.NumNodes());
  }
  scene.origin = Origin::kMeasured;
  return scene;
}

Scene WithOneCase(Scene scene, int load_case) {
  scene.load_cases = {scene.load_cases[load_case]};
  return scene;
}

// Returns the bound for a deviation of 1.  In a finer world it is that of
// quadratic elements.
Eigen::Matrix2d Bound(const Scene& exact, int world,
                      const IsotropicElasticity& truth) {
  const Eigen::VectorXd noise_sd = NoiseSd(exact, 1);
  return CramerRaoBound(world == kSameMesh ? exact : QuadraticScene(exact),
                        truth.Parameters(), noise_sd);
}

Scene Noisy(const Scene& exact, const Setting& setting) {
  const double deviation = kDeviations[setting.deviation];
  if (!setting.has_outliers) {
    return WithNoise(exact, deviation, setting.Seed());
  }
  MeasurementErrors errors;
  errors.relative_noise = deviation;
  errors.outliers = kOutliers;
  std::mt19937_64 generator(setting.Seed());
  Scene noisy = exact;
  AddErrors(errors, noisy.mesh.nodes, noisy.supports.held, generator,
            noisy.load_cases[0].displacement);
  return noisy;
}

// The members of the error budget, each for E and nu.
struct BudgetPart {
  const char* name;
  ParameterErrors ErrorBudget::*errors;
};
constexpr BudgetPart kBudgetParts[] = {
    {"noise", &ErrorBudget::noise},
    {"bias", &ErrorBudget::bias},
    {"model", &ErrorBudget::model},
    {"outliers", &ErrorBudget::outliers},
    {"discretization", &ErrorBudget::discretization},
    {"curvature", &ErrorBudget::curvature},
    {"law", &ErrorBudget::law},
};

class TrialsTable {
 public:
  TrialsTable() : table_("unseen", Columns()) {}

  void Add(const Specimen& specimen, const Setting& setting, const Trial& trial,
           double processor_seconds) {
    const Estimate& estimate = trial.estimate;
    std::vector<Value> cells = {
        specimen.shape.name,
        specimen.shape.experiments[setting.experiment].name,
        std::string(HalfName(specimen.shape.half)),
        setting.World(),
        kDeviations[setting.deviation],
        processor_seconds,
        std::int64_t{estimate.work.solves},
        std::int64_t{estimate.element_order},
        ChosenRung(estimate),
        std::int64_t(estimate.Sentences(Severity::kWarning).size()),
        estimate.residual_correlation.value_or(Estimate::kUnknown),
        estimate.displacement_residual.value_or(Estimate::kUnknown)};
    const Coverage coverage = CoverageOf(trial);
    AddInterval(IntervalOf(estimate, "youngs_modulus"),
                trial.truth.youngs_modulus, coverage.youngs_modulus, cells);
    AddInterval(IntervalOf(estimate, "poisson_ratio"), 1,
                coverage.poisson_ratio, cells);
    for (const BudgetPart& part : kBudgetParts) {
      const ParameterErrors& errors = estimate.error_budget.*part.errors;
      for (Eigen::Index i = 0; i < 2; ++i) {
        cells.emplace_back(i < errors.size() ? errors(i) : Estimate::kUnknown);
      }
    }
    table_.AddRow(cells, TrialCells(trial));
  }

  const Table& Get() const { return table_; }

 private:
  static std::vector<std::string> Columns() {
    std::vector<std::string> columns = {"shape",
                                        "load",
                                        "half",
                                        "world",
                                        "displacement_deviation [1]",
                                        "processor_time [s]",
                                        "solves [1]",
                                        "element_order [1]",
                                        "auto_choice",
                                        "warnings [1]",
                                        "residual_correlation [1]",
                                        "displacement_residual [1]"};
    for (const std::string parameter : {"youngs_modulus", "poisson_ratio"}) {
      for (const char* column :
           {"_lower [1]", "_upper [1]", "_is_covered [1]"}) {
        columns.push_back(parameter + column);
      }
    }
    for (const BudgetPart& part : kBudgetParts) {
      for (const std::string parameter : {"youngs_modulus", "poisson_ratio"}) {
        columns.push_back(parameter + "_budget_" + part.name + " [1]");
      }
    }
    const std::vector<std::string> more = TrialColumns();
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
  }

  static void AddInterval(const std::optional<Interval>& interval, double unit,
                          const std::optional<bool>& covered,
                          std::vector<Value>& cells) {
    cells.emplace_back(interval ? interval->lower / unit : Estimate::kUnknown);
    cells.emplace_back(interval ? interval->upper / unit : Estimate::kUnknown);
    cells.emplace_back(covered ? static_cast<double>(*covered)
                               : Estimate::kUnknown);
  }

  Table table_;
};

std::optional<bool> IsShearModulusHeld(const Trial& trial) {
  const std::optional<ModulusEstimate>& estimate = trial.estimate.shear_modulus;
  if (!estimate) {
    return std::nullopt;
  }
  return std::abs(estimate->value - trial.truth.ShearModulus()) <=
         kTwoSidedErrors * estimate->standard_error;
}

UnseenOutcome OutcomeOf(const Specimen& specimen, const Setting& setting,
                        const Trial& trial, double processor_seconds) {
  const Estimate& estimate = trial.estimate;
  return {setting.World(),
          std::string(HalfName(specimen.shape.half)),
          kDeviations[setting.deviation],
          estimate.estimator,
          trial.seed,
          estimate.IsUsable(),
          estimate.DeterminesAll(),
          estimate.IsUsable() && IsWrong(trial),
          CoverageOf(trial),
          IsShearModulusHeld(trial),
          trial.YoungsModulusError(),
          trial.PoissonRatioError(),
          estimate.YoungsModulusStandardError().value_or(Estimate::kUnknown) /
              trial.truth.youngs_modulus,
          estimate.PoissonRatioStandardError().value_or(Estimate::kUnknown),
          processor_seconds};
}

class UnseenStudy {
 public:
  explicit UnseenStudy(Extent extent) : extent_(std::move(extent)) {}

  void Run(Progress& progress) {
    const std::vector<UnseenShape> shapes = UnseenShapes();
    for (const int shape : extent_.shapes) {
      const Specimen specimen = MakeSpecimen(shapes[shape]);
      for (int world = 0; world < kNumWorlds; ++world) {
        progress.Show("unseen: " + specimen.shape.name + ", " +
                      kWorldNames[world]);
        for (const int poisson_ratio : extent_.poisson_ratios) {
          if (Has(specimen, world, kPoissonRatios[poisson_ratio])) {
            RunExperiments(specimen, {shape, 0, world, poisson_ratio, 0, 0});
          }
        }
      }
    }
  }

  std::vector<Table> Tables() const {
    return {trials_.Get(), UnseenCells(outcomes_), UnseenRegret(outcomes_)};
  }

 private:
  void RunExperiments(const Specimen& specimen, Setting setting) {
    const IsotropicElasticity truth = {kYoungsModulus,
                                       kPoissonRatios[setting.poisson_ratio]};
    const Scene all = Measured(specimen, setting.world, truth);
    for (std::size_t k = 0; k < all.load_cases.size(); ++k) {
      setting.experiment = static_cast<int>(k);
      if (IsDone(setting)) {
        RunDeviations(specimen, setting, WithOneCase(all, setting.experiment),
                      truth);
      }
    }
  }

  void RunDeviations(const Specimen& specimen, Setting setting,
                     const Scene& exact, const IsotropicElasticity& truth) {
    const Eigen::Matrix2d bound = Bound(exact, setting.world, truth);
    for (const int deviation : extent_.deviations) {
      setting.deviation = deviation;
      const double size = kDeviations[deviation];
      const Trial trial = {0, truth, size * size * bound, {}};
      const bool is_once = size == 0 || setting.world != kSameMesh;
      for (int i = 0; i < (is_once ? 1 : kReplicates); ++i) {
        setting.replicate = i;
        RunMethods(specimen, setting, exact, trial);
      }
      if (size > 0 && setting.world != kHexahedra) {
        Setting of_outliers = setting;
        of_outliers.replicate = 0;
        of_outliers.has_outliers = true;
        RunMethods(specimen, of_outliers, exact, trial);
      }
    }
  }

  bool IsRun(const Method& method, const Setting& setting) const {
    if (method.is_of_same_mesh && setting.world != kSameMesh) {
      return false;
    }
    return setting.has_outliers ? method.sees_outliers
                                : method.loss == Loss::kNone;
  }

  void RunMethods(const Specimen& specimen, const Setting& setting,
                  const Scene& exact, Trial trial) {
    const Scene measured = Noisy(exact, setting);
    trial.seed = setting.Seed();
    for (const Method& method : methods_) {
      if (!IsRun(method, setting)) {
        continue;
      }
      const double start = ProcessorSeconds();
      EstimatorOptions options;
      options.loss = method.loss;
      // The worlds are of linear elasticity, however large displacements are.
      options.kinematics = Kinematics::kSmall;
      trial.estimate = method.estimator->Run(measured, options);
      const double seconds = ProcessorSeconds() - start;
      trial.estimate.estimator = method.name;
      trials_.Add(specimen, setting, trial, seconds);
      outcomes_.push_back(OutcomeOf(specimen, setting, trial, seconds));
    }
  }

  Extent extent_;
  std::vector<Method> methods_ = Methods();
  TrialsTable trials_;
  std::vector<UnseenOutcome> outcomes_;
};

}  // namespace

StudyResult RunUnseenStudy(bool is_quick, Progress& progress) {
  SetThreads(1);
  UnseenStudy study(is_quick ? QuickExtent() : FullExtent());
  study.Run(progress);
  return {study.Tables(),
          {{"youngs_modulus [Pa]", kYoungsModulus},
           {"noise_law", "uniform"},
           {"outliers",
            "3 % of the nodes, by 20 to 100 standard deviations of the noise; "
            "seen by auto without a loss, and with Huber's"},
           {"noise_seeds", "another for each measurement; column seed"},
           {"blas_threads", 1},
           {"intervals", "95 %; those of E over the true E"},
           {"finer_world",
            "each tetrahedron cut into 64, with quadratic elements, measured "
            "at the nodes of the mesh"},
           {"hexahedra",
            "each voxel cut into 125 trilinear hexahedra, likewise; nu up to "
            "0.3"},
           {"processor_time", "of all threads"},
           {"dishonest_standard_errors", kWrongStandardErrors},
           {"dishonest_youngs_modulus_error", kWrongYoungsModulus},
           {"dishonest_poisson_ratio_error", kWrongPoissonRatio},
           {"would_have_done",
            "status ok, and off by no more than 1 % of E and 0.01 in nu, or "
            "two standard errors"}}};
}

}  // namespace elastimate
