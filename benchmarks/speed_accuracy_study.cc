#include "benchmarks/speed_accuracy_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/linear_algebra.h"
#include "benchmarks/finer_world.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/quantile.h"
#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr double kWantedError = 0.01;  // Of E, relative.
constexpr int kLargestDegree = 3;
constexpr std::array<std::string_view, 2> kOrderMethods = {"reduced-fe",
                                                           "iterative-fe"};

struct Specimen {
  const char* name;
  Scene scene;
  IsotropicElasticity truth;
  int num_trials;
  int num_slow_trials;  // Of fits that are slow, by quadratic elements.
  // On a large scene, a fit through quadratic elements takes up to two minutes:
  // the finer world has one magnitude of noise, the same mesh has linear
  // elements only, and iterative-fe runs on the same mesh only.
  bool is_large = false;
};

struct World {
  bool is_finer;
  Scene exact;
  Eigen::Matrix2d bound;  // Cramer-Rao, for a deviation of 1.
};

std::string WorldName(bool is_finer) {
  return is_finer ? "finer world" : "same mesh";
}

struct Method {
  std::string name;
  std::string estimator;
  int order = 1;
  EstimatorOptions options;
};

struct MethodTrial {
  Trial trial;
  double processor_seconds;
};

// Holds one method on one scene, world and magnitude of noise.
struct Point {
  Method method;
  std::vector<MethodTrial> trials;
};

// A force for each volume is the same load in both worlds.  Forces on nodes are
// point loads, under which a finer world gives way at each node.
Scene UnderBodyForce(Scene scene, const Eigen::Vector3d& force_density) {
  // So small a load that small strains leave nothing out, which errors would
  // count; relative errors do not depend on its size.
  constexpr double kSmallLoad = 1e-3;
  scene.load_cases[0].loads = {BodyForce{kSmallLoad * force_density}};
  return scene;
}

Scene Cuboid(const Eigen::Vector3i& cells, const Eigen::Vector3d& size,
             const Eigen::Vector3d& force_density) {
  CuboidOptions options;
  options.cells = cells;
  options.size = size;
  return UnderBodyForce(CuboidScene(options), force_density);
}

std::vector<Specimen> Specimens(bool is_quick) {
  const Eigen::Vector3d weight(0, 0, -1e4);  // N / m^3, that of water.
  const CuboidOptions standard;
  std::vector<Specimen> specimens = {
      {"cuboid",
       Cuboid(standard.cells, standard.size, weight),
       {10e3, 0.33},
       is_quick ? 15 : 30,
       is_quick ? 2 : 10},
      {"organ",
       UnderBodyForce(OrganScene({}), weight),
       {50e3, 0.3},
       is_quick ? 1 : 10,
       is_quick ? 0 : 2},
      {"slender bar",
       Cuboid({2, 2, 20}, {0.1, 0.1, 1}, {1e4, 0, 0}),
       {10e6, 0.33},
       is_quick ? 2 : 30,
       is_quick ? 0 : 6}};
  if (!is_quick) {
    specimens.push_back({"large block",
                         Cuboid({20, 20, 25}, {0.8, 0.8, 1}, weight),
                         {50e3, 0.33},
                         3,
                         1,
                         true});
  }
  return specimens;
}

// Returns norms of the noise, relative to the norm of the displacement.
std::vector<double> Deviations(const Specimen& specimen, const World& world,
                               bool is_quick) {
  if (specimen.is_large && world.is_finer) {
    return {0.01};
  }
  return is_quick ? std::vector<double>{0.001, 0.01}
                  : std::vector<double>{0.001, 0.01, 0.05, 0.2};
}

std::array<World, 2> Worlds(const Specimen& specimen) {
  Scene same = specimen.scene;
  Measure(specimen.truth, same);
  Scene finer = specimen.scene;
  FinerWorld(finer, specimen.is_large ? 1 : 2).Measure(specimen.truth, finer);
  const Eigen::VectorXd same_noise = NoiseSd(same, 1);
  const Eigen::VectorXd finer_noise = NoiseSd(finer, 1);
  return {World{false, same,
                CramerRaoBound(same, specimen.truth.Parameters(), same_noise)},
          World{true, finer,
                CramerRaoBound(QuadraticScene(specimen.scene),
                               specimen.truth.Parameters(), finer_noise)}};
}

// Returns all estimators, with all choices that each of them has.
std::vector<Method> Methods() {
  std::vector<Method> methods;
  for (const std::string_view view : EstimatorNames()) {
    const std::string name(view);
    if (name == "virtual-fields") {
      for (int degree = 1; degree <= kLargestDegree; ++degree) {
        Method method = {
            name + " degree " + std::to_string(degree), name, 1, {}};
        method.options.virtual_field_degree = degree;
        methods.push_back(method);
      }
    } else if (std::find(kOrderMethods.begin(), kOrderMethods.end(), view) !=
               kOrderMethods.end()) {
      methods.push_back({name + " order 1", name, 1, {}});
      methods.push_back({name + " order 2", name, 2, {}});
    } else {
      methods.push_back({name, name, 1, {}});
    }
  }
  return methods;
}

int NumTrials(const Specimen& specimen, bool is_finer, const Method& method) {
  const bool is_iterative_fe = method.estimator == "iterative-fe";
  if (specimen.is_large && (is_finer ? is_iterative_fe : method.order == 2)) {
    return 0;
  }
  // Fits of order 1 go on to quadratic elements in the finer world.
  const bool is_slow =
      method.order == 2 || (is_finer && (is_iterative_fe || specimen.is_large));
  return is_slow ? specimen.num_slow_trials : specimen.num_trials;
}

Point RunTrials(const Specimen& specimen, const World& world, double deviation,
                const Method& method) {
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator(method.estimator);
  const int num_trials = NumTrials(specimen, world.is_finer, method);
  Point point = {method, {}};
  for (int seed = 1; seed <= num_trials; ++seed) {
    Scene measured = WithNoise(world.exact, deviation, seed);
    if (method.order == 2) {
      measured = QuadraticScene(measured);
    }
    const double start = ProcessorSeconds();
    EstimatorOptions options = method.options;
    // The worlds are of linear elasticity, however large displacements are.
    options.kinematics = Kinematics::kSmall;
    Estimate estimate = estimator->Run(measured, options);
    const double seconds = ProcessorSeconds() - start;
    point.trials.push_back(
        {{seed, specimen.truth, deviation * deviation * world.bound,
          std::move(estimate)},
         seconds});
  }
  return point;
}

std::string MostFrequentRung(const Point& point) {
  std::map<std::string, int> counts;
  for (const MethodTrial& trial : point.trials) {
    ++counts[ChosenRung(trial.trial.estimate)];
  }
  return std::max_element(
             counts.begin(), counts.end(),
             [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

double ProcessorSeconds(const Point& point) {
  std::vector<double> seconds;
  for (const MethodTrial& trial : point.trials) {
    seconds.push_back(trial.processor_seconds);
  }
  return Quantile(seconds, 0.5);
}

double FailureRate(const Point& point) {
  const auto failures = std::count_if(
      point.trials.begin(), point.trials.end(),
      [](const MethodTrial& t) { return !t.trial.estimate.IsUsable(); });
  return static_cast<double>(failures) /
         static_cast<double>(point.trials.size());
}

// Returns the root mean square over the usable estimates.  If there are none,
// it is over all estimates that have a number.
double RootMeanSquareError(const Point& point, double (Trial::*error)() const) {
  const bool all = FailureRate(point) == 1;
  double sum = 0;
  int count = 0;
  for (const MethodTrial& trial : point.trials) {
    const double value = (trial.trial.*error)();
    if ((all || trial.trial.estimate.IsUsable()) && !std::isnan(value)) {
      sum += value * value;
      ++count;
    }
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN()
                    : std::sqrt(sum / count);
}

double YoungsModulusError(const Point& point) {
  return RootMeanSquareError(point, &Trial::YoungsModulusError);
}

bool IsWithinOnePercent(const Point& point) {
  return FailureRate(point) == 0 && YoungsModulusError(point) <= kWantedError;
}

// Returns the share, among all trials, of those that are ok but wrong by more
// than they state.
double DishonestShare(const Point& point) {
  const auto dishonest = std::count_if(
      point.trials.begin(), point.trials.end(), [](const MethodTrial& t) {
        const Estimate& estimate = t.trial.estimate;
        return estimate.IsUsable() && IsWrong(t.trial);
      });
  return static_cast<double>(dishonest) /
         static_cast<double>(point.trials.size());
}

class Tables {
 public:
  Tables()
      : trials_("speed_accuracy", TrialTableColumns()),
        points_(
            "speed_accuracy_points",
            {"scene", "tetrahedra [1]", "world", "displacement_deviation [1]",
             "method", "estimator", "order", "trials [1]", "failure_rate [1]",
             "dishonest_share [1]", "processor_time [s]", "time [s]",
             "factorizations [1]", "youngs_modulus_rms_error [1]",
             "youngs_modulus_rms_error [Cramer-Rao]",
             "poisson_ratio_rms_error [1]",
             "poisson_ratio_rms_error [Cramer-Rao]"}),
        summary_("speed_accuracy_summary",
                 {"scene", "world", "displacement_deviation [1]",
                  "youngs_modulus_cramer_rao [1]", "cheapest_within_1_percent",
                  "cheapest_processor_time [s]",
                  "cheapest_youngs_modulus_rms_error [1]", "auto_choice",
                  "auto_processor_time [s]",
                  "auto_youngs_modulus_rms_error [1]", "auto_failure_rate [1]",
                  "auto_dishonest_share [1]", "auto_is_within_1_percent"}) {}

  void Add(const Specimen& specimen, const World& world, double deviation,
           const Point& point) {
    for (const MethodTrial& trial : point.trials) {
      trials_.AddRow(
          {specimen.name, WorldName(world.is_finer), deviation,
           point.method.name, std::int64_t{point.method.order},
           trial.processor_seconds, ChosenRung(trial.trial.estimate)},
          TrialCells(trial.trial));
    }
    const Eigen::Matrix2d bound = deviation * deviation * world.bound;
    const double youngs_modulus = YoungsModulusError(point);
    const double poisson_ratio =
        RootMeanSquareError(point, &Trial::PoissonRatioError);
    std::vector<double> seconds;
    std::vector<double> factorizations;
    for (const MethodTrial& trial : point.trials) {
      seconds.push_back(trial.trial.estimate.seconds);
      factorizations.push_back(trial.trial.estimate.work.factorizations);
    }
    points_.AddRow(
        {specimen.name, std::int64_t{specimen.scene.mesh.NumElements()},
         WorldName(world.is_finer), deviation, point.method.name,
         point.method.estimator, std::int64_t{point.method.order},
         std::int64_t(point.trials.size()), FailureRate(point),
         DishonestShare(point), ProcessorSeconds(point), Quantile(seconds, 0.5),
         Quantile(factorizations, 0.5), youngs_modulus,
         youngs_modulus * specimen.truth.youngs_modulus /
             std::sqrt(bound(0, 0)),
         poisson_ratio, poisson_ratio / std::sqrt(bound(1, 1))});
  }

  void Summarize(const Specimen& specimen, const World& world, double deviation,
                 const std::vector<Point>& points) {
    const Point* cheapest = nullptr;
    const Point* of_auto = nullptr;
    for (const Point& point : points) {
      if (point.method.estimator == "auto") {
        of_auto = &point;
      } else if (IsWithinOnePercent(point) &&
                 (cheapest == nullptr ||
                  ProcessorSeconds(point) < ProcessorSeconds(*cheapest))) {
        cheapest = &point;
      }
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    summary_.AddRow({specimen.name, WorldName(world.is_finer), deviation,
                     deviation * std::sqrt(world.bound(0, 0)) /
                         specimen.truth.youngs_modulus,
                     cheapest == nullptr ? "none" : cheapest->method.name,
                     cheapest == nullptr ? none : ProcessorSeconds(*cheapest),
                     cheapest == nullptr ? none : YoungsModulusError(*cheapest),
                     MostFrequentRung(*of_auto), ProcessorSeconds(*of_auto),
                     YoungsModulusError(*of_auto), FailureRate(*of_auto),
                     DishonestShare(*of_auto),
                     IsWithinOnePercent(*of_auto) ? "yes" : "no"});
  }

  std::vector<Table> All() const { return {trials_, points_, summary_}; }

 private:
  static std::vector<std::string> TrialTableColumns() {
    std::vector<std::string> columns = {
        "scene",      "world", "displacement_deviation [1]",
        "method",     "order", "processor_time [s]",
        "auto_choice"};
    const std::vector<std::string> more = TrialColumns();
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
  }

  Table trials_;
  Table points_;
  Table summary_;
};

/// Returns what is not run, and why.
nlohmann::ordered_json LeftOut(const std::vector<Specimen>& specimens,
                               bool is_quick) {
  nlohmann::ordered_json left_out = nlohmann::ordered_json::array();
  if (is_quick) {
    left_out.push_back(
        "large block, and noise of 5 % and more, all methods: take too long "
        "for a quick run");
  }
  for (const Specimen& specimen : specimens) {
    if (specimen.is_large) {
      left_out.push_back(std::string(specimen.name) +
                         ", finer world, noise other than 1 %, all methods: "
                         "take too long");
    }
    for (const bool is_finer : {false, true}) {
      for (const Method& method : Methods()) {
        if (NumTrials(specimen, is_finer, method) == 0) {
          left_out.push_back(std::string(specimen.name) + ", " +
                             WorldName(is_finer) + ", " + method.name +
                             ": takes too long");
        }
      }
    }
  }
  return left_out;
}

void RunMethods(const Specimen& specimen, const World& world, double deviation,
                Progress& progress, Tables& tables) {
  std::vector<Point> points;
  for (const Method& method : Methods()) {
    progress.Show(std::string("speed_accuracy: ") + specimen.name + ", " +
                  WorldName(world.is_finer) + ", " + method.name);
    Point point = RunTrials(specimen, world, deviation, method);
    if (!point.trials.empty()) {
      tables.Add(specimen, world, deviation, point);
      points.push_back(std::move(point));
    }
  }
  tables.Summarize(specimen, world, deviation, points);
}

}  // namespace

StudyResult RunSpeedAccuracyStudy(bool is_quick, Progress& progress) {
  SetThreads(1);
  Tables tables;
  nlohmann::ordered_json num_trials;
  const std::vector<Specimen> specimens = Specimens(is_quick);
  for (const Specimen& specimen : specimens) {
    num_trials[specimen.name] = {{"others", specimen.num_trials},
                                 {"slow_fits", specimen.num_slow_trials}};
    for (const World& world : Worlds(specimen)) {
      for (const double deviation : Deviations(specimen, world, is_quick)) {
        RunMethods(specimen, world, deviation, progress, tables);
      }
    }
  }
  return {
      tables.All(),
      {{"noise_law", "uniform"},
       {"noise_seeds", "1 to the number of trials; column seed"},
       {"trials", num_trials},
       {"left_out", LeftOut(specimens, is_quick)},
       {"blas_threads", 1},
       {"processor_time",
        "of all threads; fits of order 2 are given their quadratic mesh, "
        "others make it in this time"},
       {"rms_error",
        "over the usable estimates; over all where none is usable"},
       {"within_1_percent",
        "root mean square error of E at most 1 %, and no failure"},
       {"dishonest",
        "status ok, but off by more than 10 % of E or 0.03 in nu and three "
        "times the standard error"},
       {"finer_world",
        "measured in a world of quadratic elements on the mesh whose "
        "tetrahedra were each cut into 64 (large block: 8); the Cramer-Rao "
        "bound is that of quadratic elements on the mesh"},
       {"cuboid", "1 x 1 x 0.4 m, held at z = 0, E = 10 kPa"},
       {"slender_bar",
        "0.1 x 0.1 x 1 m, held at z = 0, E = 10 MPa, force along x"},
       {"large_block", "0.8 x 0.8 x 1 m, held at z = 0, E = 50 kPa"},
       {"organ", "mesh and supports of elastimate generate organ, E = 50 kPa"},
       {"load", "10 kN/m^3; along z but for the bar"}}};
}

}  // namespace elastimate
