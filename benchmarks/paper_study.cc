#include "benchmarks/paper_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "benchmarks/paper_findings.h"
#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kCuboidElasticity = {10e3, 0.33};
constexpr IsotropicElasticity kOrganElasticity = {50e3, 0.3};
constexpr double kLargestOrganPoissonRatio = 0.3;

// The norm of the noise is relative to the norm of the displacement.
constexpr std::array<double, 13> kDeviations = {
    0, 0.002, 0.005, 0.01, 0.02, 0.03, 0.04, 0.05, 0.07, 0.09, 0.12, 0.15, 0.2};
constexpr double kSpatialNoiseDeviation = 0.10;
constexpr double kSeveralCasesDeviation = 0.09;
constexpr int kNumCases = 20;
constexpr std::uint64_t kForceSeed = 2007;

struct NumTrials {
  int noise;
  int spatial_noise;
  int several_cases;
  int organ;
  int cuboid_choice;
};

constexpr NumTrials kFull = {200, 500, 100, 100, 50};
constexpr NumTrials kQuick = {200, 50, 20, 40, 10};

// Runs the paper's method and reduced-fe on measurements of one scene.
class Comparison {
 public:
  Comparison(const Scene& exact, const IsotropicElasticity& truth,
             std::string_view paper_method,
             const EstimatorOptions& options = {})
      : truth_(truth),
        options_(options),
        paper_method_(MakeEstimator(paper_method)),
        prepared_(reduced_fe_.Prepare(exact, options)),
        bound_(CramerRaoBound(exact, truth.Parameters(), NoiseSd(exact, 1))) {
    if (options.poisson_ratio.upper == truth.poisson_ratio) {
      // Where its bound holds nu at the truth, the bound of E is that for a
      // known nu.
      bound_(0, 0) -= bound_(0, 1) * bound_(1, 0) / bound_(1, 1);
      bound_(0, 1) = bound_(1, 0) = bound_(1, 1) = 0;
    }
  }

  std::array<Trial, 2> Run(const Scene& measured, double deviation, int seed) {
    std::vector<Eigen::MatrixXd> displacements;
    for (const LoadCase& load_case : measured.load_cases) {
      displacements.push_back(load_case.displacement);
    }
    const Eigen::Matrix2d bound = deviation * deviation * bound_;
    return {Trial{seed, truth_, bound, paper_method_->Run(measured, options_)},
            Trial{seed, truth_, bound, prepared_.Run(displacements)}};
  }

 private:
  IsotropicElasticity truth_;
  EstimatorOptions options_;
  std::shared_ptr<const Estimator> paper_method_;
  ReducedFe reduced_fe_;
  PreparedEstimator prepared_;
  Eigen::Matrix2d bound_;  // For a deviation of 1.
};

Scene MeasuredCuboid() {
  Scene scene = CuboidScene({});
  Measure(kCuboidElasticity, scene);
  return scene;
}

template <typename Deviations>
PaperTrials UnderNoise(const Scene& exact, const Deviations& deviations,
                       int num_trials, Comparison comparison) {
  PaperTrials trials;
  for (const double deviation : deviations) {
    for (int seed = 1; seed <= num_trials; ++seed) {
      const Scene measured = WithNoise(exact, deviation, seed);
      for (Trial& trial : comparison.Run(measured, deviation, seed)) {
        trials.push_back({deviation, std::move(trial)});
      }
    }
  }
  return trials;
}

// The bias of the closed form: E[nu] = nu + rho (nu_noise - nu), with the share
// rho of noise in b = J q, and the E that goes with this nu.
Table NoisePrediction(const Scene& exact) {
  Table table("paper_noise_prediction",
              {"displacement_deviation [1]", "youngs_modulus_error [1]",
               "poisson_ratio_error [1]"});
  const ForceScene prepared(exact);
  ForceResidual residual(prepared, exact);
  const Eigen::VectorXd f = residual.Loads();
  const auto a = residual.Columns().col(0);
  const auto b = residual.Columns().col(1);
  const double b_squared =
      b.squaredNorm() - std::pow(b.dot(f), 2) / f.squaredNorm();
  // Returns what the parameter t fits of the traces: ||(x H + y J) f||^2 over
  // f.f.
  const auto fitted = [&](double x, double y) {
    return residual.StiffenedGram(Eigen::Vector2d(x, y),
                                  Eigen::Vector3d(0, 0, 1))(0, 0) /
           f.squaredNorm();
  };
  const double t_jj = prepared.Traces()(1, 1) - fitted(0, 1);
  const double t_hj = prepared.Traces()(0, 1) -
                      (fitted(1, 1) - fitted(1, 0) - fitted(0, 1)) / 2;
  for (const double deviation : kDeviations) {
    const double noise = NoiseSd(exact, deviation).squaredNorm() * t_jj;
    const double rho = noise / (b_squared + noise);
    const double bias = rho * (-t_hj / t_jj - kCuboidElasticity.poisson_ratio);
    const double nu = kCuboidElasticity.poisson_ratio + bias;
    const IsotropicElasticity expected =
        IsotropicElasticity::FromComplianceScale(
            f.dot(a + nu * b) / f.squaredNorm(), nu, SectionModel::kSolid);
    table.AddRow(
        {deviation,
         expected.youngs_modulus / kCuboidElasticity.youngs_modulus - 1, bias});
  }
  return table;
}

// Runs on the first 1, 2, ... load cases of `exact`.
PaperTrials WithSeveralCases(const Scene& exact, int num_trials) {
  PaperTrials trials;
  for (int num_cases = 1; num_cases <= kNumCases; ++num_cases) {
    Scene part = exact;
    part.load_cases.resize(num_cases);
    for (PaperTrial& row : UnderNoise(
             part, std::array<double, 1>{kSeveralCasesDeviation}, num_trials,
             Comparison(part, kCuboidElasticity, "closed-form"))) {
      trials.push_back({double(num_cases), std::move(row.trial)});
    }
  }
  return trials;
}

Scene SeveralMeasurements() {
  Scene scene = MeasuredCuboid();
  scene.load_cases.resize(kNumCases, scene.load_cases[0]);
  return scene;
}

// Returns a scene whose first force is that of the other experiments.  Further
// forces have its magnitude, and directions that are uniform on the sphere.
Scene SeveralForces() {
  std::mt19937_64 generator(kForceSeed);
  std::normal_distribution<double> normal;
  Scene scene = CuboidScene({});
  while (scene.load_cases.size() < kNumCases) {
    CuboidOptions options;
    const double magnitude = options.force.norm();
    for (double& component : options.force) {
      component = normal(generator);
    }
    options.force *= magnitude / options.force.norm();
    scene.load_cases.push_back(CuboidScene(options).load_cases[0]);
  }
  Measure(kCuboidElasticity, scene);
  return scene;
}

PaperTrials OnOrgan(int num_trials) {
  Scene organ = OrganScene({});
  Measure(kOrganElasticity, organ);
  EstimatorOptions options;
  options.poisson_ratio.upper = kLargestOrganPoissonRatio;
  return UnderNoise(organ, kDeviations, num_trials,
                    Comparison(organ, kOrganElasticity, "bounded", options));
}

struct Shape {
  const char* name;
  Eigen::Vector3i cells;
  Eigen::Vector3d size;  // Of cells with edges of 0.2 m.
};

Scene HoldWhere(const Eigen::Array<bool, 1, Eigen::Dynamic>& held,
                Scene scene) {
  const Eigen::Vector3d force = CuboidOptions().force;
  scene.supports.held = held.replicate<3, 1>();
  NodalForces forces{force.replicate(1, held.size())};
  for (Eigen::Index node = 0; node < held.size(); ++node) {
    if (held[node]) {
      forces.force.col(node).setZero();
    }
  }
  scene.load_cases[0].loads = {forces};
  return scene;
}

Table CuboidChoice(int num_trials) {
  std::vector<std::string> columns = {"size", "support",
                                      "displacement_deviation [1]"};
  const std::vector<std::string> trial_columns = TrialColumns();
  columns.insert(columns.end(), trial_columns.begin(), trial_columns.end());
  Table table("paper_cuboid_choice", columns);
  const std::array<Shape, 3> shapes = {
      Shape{"1 x 1 x 0.4 m", {5, 5, 2}, {1, 1, 0.4}},
      Shape{"2 x 1 x 0.2 m", {10, 5, 1}, {2, 1, 0.2}},
      Shape{"5 x 0.4 x 0.2 m", {25, 2, 1}, {5, 0.4, 0.2}}};
  for (const Shape& shape : shapes) {
    CuboidOptions options;
    options.cells = shape.cells;
    options.size = shape.size;
    const Scene cuboid = CuboidScene(options);
    const auto x = cuboid.mesh.nodes.row(0).array();
    const auto z = cuboid.mesh.nodes.row(2).array();
    const std::vector<
        std::pair<std::string, Eigen::Array<bool, 1, Eigen::Dynamic>>>
        supports = {{"bottom face", z == 0},
                    {"one end", x == 0},
                    {"both ends", x == 0 || x == shape.size.x()}};
    for (const auto& [support, held] : supports) {
      Scene exact = HoldWhere(held, cuboid);
      Measure(kCuboidElasticity, exact);
      const std::array<double, 2> deviations = {0.01, 0.1};
      for (const PaperTrial& row :
           UnderNoise(exact, deviations, num_trials,
                      Comparison(exact, kCuboidElasticity, "closed-form"))) {
        table.AddRow({shape.name, support, row.setting}, TrialCells(row.trial));
      }
    }
  }
  return table;
}

Table TrialTable(const std::string& name, const std::string& setting,
                 const PaperTrials& trials) {
  std::vector<std::string> columns = TrialColumns();
  columns.insert(columns.begin(), setting);
  Table table(name, columns);
  for (const PaperTrial& row : trials) {
    table.AddRow({row.setting}, TrialCells(row.trial));
  }
  return table;
}

}  // namespace

StudyResult RunPaperStudy(bool is_quick, Progress& progress) {
  const NumTrials& num_trials = is_quick ? kQuick : kFull;
  const Scene cuboid = MeasuredCuboid();
  progress.Show("paper: noise of increasing magnitude");
  const PaperTrials noise =
      UnderNoise(cuboid, kDeviations, num_trials.noise,
                 Comparison(cuboid, kCuboidElasticity, "closed-form"));
  progress.Show("paper: many noises of one magnitude");
  const PaperTrials spatial_noise =
      UnderNoise(cuboid, std::array<double, 1>{kSpatialNoiseDeviation},
                 num_trials.spatial_noise,
                 Comparison(cuboid, kCuboidElasticity, "closed-form"));
  progress.Show("paper: several measurements of one force");
  const PaperTrials measurements =
      WithSeveralCases(SeveralMeasurements(), num_trials.several_cases);
  progress.Show("paper: several forces");
  const PaperTrials forces =
      WithSeveralCases(SeveralForces(), num_trials.several_cases);
  progress.Show("paper: organ");
  const PaperTrials organ = OnOrgan(num_trials.organ);
  progress.Show("paper: shapes and supports of the cuboid");
  const Table cuboid_choice = CuboidChoice(num_trials.cuboid_choice);

  const std::string deviation = "displacement_deviation [1]";
  return {
      {TrialTable("paper_noise", deviation, noise), NoisePrediction(cuboid),
       TrialTable("paper_spatial_noise", deviation, spatial_noise),
       TrialTable("paper_measurements", "measurements [1]", measurements),
       TrialTable("paper_forces", "forces [1]", forces),
       TrialTable("paper_organ", deviation, organ), cuboid_choice,
       PaperFindings(noise, measurements, forces, organ)},
      {{"noise_law", "uniform"},
       {"noise_seeds", "1 to the number of trials; column seed"},
       {"force_seed", kForceSeed},
       {"deviation_of_several_measurements_and_forces", kSeveralCasesDeviation},
       {"cuboid",
        "default of elastimate generate cuboid: 1 x 1 x 0.4 m, held at z = "
        "0, (0, 0, -30) N on each free node"},
       {"organ", "default of elastimate generate organ"}}};
}

}  // namespace elastimate
