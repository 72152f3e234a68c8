#include "benchmarks/large_deformation_study.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/linear_algebra.h"
#include "benchmarks/deformed_bar.h"
#include "benchmarks/large_deformation_limits.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/quantile.h"
#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr int kBarTrials = 20;
constexpr int kQuickBarTrials = 2;
constexpr const char* kTrueLaw = "neo_hookean";
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::vector<double> Rotations(bool is_quick) {
  return is_quick ? std::vector<double>{10, 40}
                  : std::vector<double>{5, 10, 20, 40, 80};
}

std::vector<double> Noises(bool is_quick) {
  return is_quick ? std::vector<double>{0.01}
                  : std::vector<double>{0.0001, 0.01, 0.03, 0.05};
}

// A method is an estimator, and what it is told of the law.
struct BarMethod {
  std::string name;
  std::string estimator;
  std::string law;  // Empty where it is the true one.
};

// The first one is what the times of the others are compared with.
const std::vector<BarMethod>& BarMethods() {
  static const std::vector<BarMethod> methods = {
      {"small strains", "iterative-fe", "isotropic"},
      {"closed-form", "closed-form", ""},
      {"bounded", "bounded", ""},
      {"iterative-fe", "iterative-fe", ""},
      {"auto", "auto", "isotropic"},
  };
  return methods;
}

Scene SceneFor(const BarMethod& method, Scene scene) {
  scene.origin = Origin::kComputed;
  if (!method.law.empty()) {
    scene.materials[0].law = method.law;
  }
  return scene;
}

// ---------------------------------------------------------------------------
// Bias without noise.

// Adds what an estimator makes of a scene.
void AddBias(const std::string& name, const std::string& estimator,
             const Scene& scene, const EstimatorOptions& options,
             const std::vector<Value>& bar, Table& table) {
  const Estimate estimate = MakeEstimator(estimator)->Run(scene, options);
  const Eigen::VectorXd values = estimate.ParameterValues();
  std::vector<Value> cells = bar;
  cells.insert(cells.end(), {name, estimate.large_strain_law});
  table.AddRow(cells, {std::log(values(0) / kBarParameters(0)),
                       values(1) - kBarParameters(1),
                       std::string(StatusName(estimate.status)),
                       std::int64_t{estimate.work.factorizations}});
}

void AddBiasOfBar(BarLoad load, const std::string& law, double size,
                  Table& table) {
  Scene scene = DeformedBar(load, law, size);
  const std::vector<Value> bar = {BarLoadName(load), law, size};
  scene.origin = Origin::kComputed;
  AddBias("large strains", "iterative-fe", scene, {}, bar, table);
  scene.materials[0].law = "isotropic";
  AddBias("small strains", "iterative-fe", scene, {}, bar, table);
  AddBias("auto of computed", "auto", scene, {}, bar, table);
  scene.origin = Origin::kMeasured;
  EstimatorOptions options;
  // These elements are right, and dividing them takes minutes.
  options.refinement = Refine::kNever;
  AddBias("auto of measured", "auto", scene, options, bar, table);
}

Table MakeBiasTable(bool is_quick, Progress& progress) {
  Table table("large_deformation_bias",
              {"deformation", "law", "size [degrees or %]", "fit", "law_chosen",
               "ln_youngs_modulus_error [1]", "poisson_ratio_error [1]",
               "status", "factorizations [1]"});
  const std::vector<double> angles =
      is_quick ? std::vector<double>{5, 20}
               : std::vector<double>{1, 2, 3, 5, 7, 10, 15, 20, 30, 40};
  const std::vector<double> stretches =
      is_quick ? std::vector<double>{2, 10}
               : std::vector<double>{1, 2, 3, 5, 7, 10, 15, 20};
  for (const double angle : angles) {
    progress.Show("large_deformation: bias of bending");
    AddBiasOfBar(BarLoad::kBending, kTrueLaw, angle, table);
  }
  for (const std::string law : {kTrueLaw, "st_venant_kirchhoff"}) {
    for (const double stretch : stretches) {
      progress.Show("large_deformation: bias of stretch, " + law);
      AddBiasOfBar(BarLoad::kStretch, law, stretch, table);
    }
  }
  return table;
}

// ---------------------------------------------------------------------------
// Errors and intervals with noise.

// Adds up the trials of a method at one bending and one noise.
class BarCell {
 public:
  explicit BarCell(const Eigen::Matrix2d& cramer_rao)
      : cramer_rao_(cramer_rao) {}

  void Add(int seed, const Estimate& estimate, double seconds) {
    ++num_trials_;
    num_usable_ += estimate.IsUsable();
    factorizations_.push_back(estimate.work.factorizations);
    seconds_.push_back(seconds);
    if (!estimate.large_strain_law.empty()) {
      ++num_of_law_[estimate.large_strain_law];
    }
    Trial trial{
        seed, {kBarParameters(0), kBarParameters(1)}, cramer_rao_, estimate};
    const Eigen::VectorXd values = estimate.ParameterValues();
    if (values.size() == 2) {
      trial.estimate.elasticity = {values(0), values(1)};
    }
    num_dishonest_ += estimate.IsUsable() && IsWrong(trial);
    AddErrors(trial);
  }

  // `reference` is the median time of small strains, in seconds.
  void AddTo(double rotation, double noise, const std::string& method,
             double reference, Table& table) const {
    const double num_errors = num_errors_;
    const Eigen::Array2d mean_square = square_sum_ / num_errors;
    const Eigen::Array2d bound = cramer_rao_.diagonal().array();
    std::string laws;
    for (const auto& [law, count] : num_of_law_) {
      laws += (laws.empty() ? "" : " ") + law + " " + std::to_string(count);
    }
    table.AddRow(
        {rotation, noise, method, std::int64_t{num_trials_},
         double(num_usable_) / num_trials_, RightLawShare(), laws,
         double(num_dishonest_) / num_trials_,
         std::sqrt((mean_square / bound).mean()),
         double(num_covered_) / num_intervals_, std::sqrt(mean_square(0)),
         std::sqrt(bound(0)), std::sqrt(mean_square(1)), std::sqrt(bound(1))},
        {Quantile(factorizations_, 0.5), Seconds(), Seconds() / reference});
  }

  double Seconds() const { return Quantile(seconds_, 0.5); }

  static Table MakeTable() {
    return {"large_deformation_cells",
            {"rotation [degrees]", "noise [1]", "estimator", "trials [1]",
             "usable_share [1]", "right_law_share [1]", "laws",
             "dishonest_share [1]", "error_over_cramer_rao [1]", "coverage [1]",
             "youngs_modulus_root_mean_square_error [1]",
             "youngs_modulus_cramer_rao [1]",
             "poisson_ratio_root_mean_square_error [1]",
             "poisson_ratio_cramer_rao [1]", "factorizations [1]", "time [s]",
             "time_over_small_strains [1]"}};
  }

 private:
  double RightLawShare() const {
    const auto right = num_of_law_.find(kTrueLaw);
    return num_of_law_.empty()          ? kNotANumber
           : right == num_of_law_.end() ? 0
                                        : double(right->second) / num_trials_;
  }

  void AddErrors(const Trial& trial) {
    const Eigen::Array2d errors(trial.YoungsModulusError(),
                                trial.PoissonRatioError());
    if (errors.isFinite().all()) {
      square_sum_ += errors.square();
      ++num_errors_;
    }
    for (std::size_t i = 0;
         trial.estimate.IsUsable() && i < trial.estimate.parameters.size();
         ++i) {
      const std::optional<Interval>& interval =
          trial.estimate.parameters[i].interval;
      const double truth = kBarParameters(Eigen::Index(i));
      num_covered_ +=
          interval && interval->lower <= truth && truth <= interval->upper;
      ++num_intervals_;
    }
  }

  Eigen::Matrix2d cramer_rao_;
  int num_trials_ = 0;
  int num_usable_ = 0;
  int num_dishonest_ = 0;
  int num_errors_ = 0;
  int num_covered_ = 0;
  int num_intervals_ = 0;
  Eigen::Array2d square_sum_ = Eigen::Array2d::Zero();
  std::map<std::string, int> num_of_law_;
  std::vector<double> factorizations_;
  std::vector<double> seconds_;
};

Scene MeasuredBar(Scene bar, double noise_sd, int seed) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  MeasurementErrors errors;
  errors.noise_sd = noise_sd;
  AddErrors(errors, bar.mesh.nodes, bar.supports.held, generator,
            bar.load_cases[0].displacement);
  return bar;
}

// Noise may turn elements inside out, which estimators from forces refuse as a
// wrong input.  Such a trial has no number.
Estimate RunOnNoise(const Estimator& estimator, const Scene& scene) {
  try {
    return estimator.Run(scene, {});
  } catch (const std::invalid_argument&) {
    return {};
  }
}

Table MakeCellTable(bool is_quick, Progress& progress) {
  Table table = BarCell::MakeTable();
  const int num_trials = is_quick ? kQuickBarTrials : kBarTrials;
  for (const double rotation : Rotations(is_quick)) {
    const Scene bar = DeformedBar(BarLoad::kBending, kTrueLaw, rotation);
    const Eigen::Matrix2d unit_bound = UnitCramerRao(bar);
    const Eigen::VectorXd free =
        DegreesOfFreedom(bar.supports)
            .Restrict(bar.load_cases[0].displacement.reshaped());
    for (const double noise : Noises(is_quick)) {
      const double sd = noise * free.norm() / std::sqrt(double(free.size()));
      double reference = kNotANumber;
      for (const BarMethod& method : BarMethods()) {
        progress.Show(
            "large_deformation: " + std::to_string(std::lround(rotation)) +
            " degrees, " + method.name);
        BarCell cell(sd * sd * unit_bound);
        const std::shared_ptr<const Estimator> estimator =
            MakeEstimator(method.estimator);
        for (int seed = 1; seed <= num_trials; ++seed) {
          const Scene scene = SceneFor(method, MeasuredBar(bar, sd, seed));
          const double start = ProcessorSeconds();
          const Estimate estimate = RunOnNoise(*estimator, scene);
          cell.Add(seed, estimate, ProcessorSeconds() - start);
        }
        if (std::isnan(reference)) {
          reference = cell.Seconds();
        }
        cell.AddTo(rotation, noise, method.name, reference, table);
      }
    }
  }
  return table;
}

}  // namespace

StudyResult RunLargeDeformationStudy(bool is_quick, Progress& progress) {
  SetThreads(1);
  progress.Show("large_deformation: limits");
  const Table limits = LargeDeformationLimits();
  const Table bias = MakeBiasTable(is_quick, progress);
  const Table cells = MakeCellTable(is_quick, progress);
  return {
      {bias, cells, limits},
      {{"bar",
        "1 x 1 x 6, of 120 quadratic tetrahedra, clamped at one end; a dead "
        "force "
        "across or along at the other; E = 10 000 and nu = 0.3"},
       {"law", "neo_hookean unless said otherwise"},
       {"rotation", "of the end of the bar"},
       {"noise",
        "Gaussian, over the rms displacement, at all nodes; estimators are not "
        "told its size"},
       {"origin", "displacements of the very elements of the fit (computed)"},
       {"small strains", "iterative-fe of the isotropic law of small strains"},
       {"law_of_estimators",
        "given, but for `auto`, which chooses one, and for small strains"},
       {"errors", "of all trials with a number; intervals of usable ones"},
       {"auto of computed",
        "told that displacements are computed, not by which law"},
       {"auto of measured",
        "told that they are measured, and not to divide the mesh"},
       {"time", "of the processor, median"},
       {"limits",
        "column of 1 x 1 x 6 of 2 x 2 x 12 hexahedra, nu = 0.3, Euler's load; "
        "blocks of 2 x 2 x 2 hexahedra with nu = 0 that keep their "
        "cross-section"},
       {"noise_seeds", "1 to the number of trials"},
       {"blas_threads", 1},
       {"dishonest_standard_errors", kWrongStandardErrors},
       {"dishonest_youngs_modulus_error", kWrongYoungsModulus},
       {"dishonest_poisson_ratio_error", kWrongPoissonRatio}}};
}

}  // namespace elastimate
