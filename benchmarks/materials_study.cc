#include "benchmarks/materials_study.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/material_levels.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/quantile.h"
#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/plan/load_plan.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr int kMaterialTrials = 40;
constexpr int kQuickMaterialTrials = 1;
// Fits of more regions take as many times longer.
constexpr int kTimesFewerOfMany = 5;
constexpr std::size_t kManyRegions = 5;
constexpr double kUnknownNumber = std::numeric_limits<double>::quiet_NaN();

Eigen::MatrixXd SolveAt(const Scene& scene, const Eigen::VectorXd& parameters) {
  Equilibrium model(scene, SolverKind::kCholesky);
  if (!model.Solve(model.Forces().Parameters().Moduli(parameters))) {
    return Eigen::MatrixXd::Constant(scene.mesh.NumDofs(),
                                     Eigen::Index(scene.load_cases.size()),
                                     kUnknownNumber);
  }
  return model.Displacement();
}

// Each parameter as errors are given: ln of moduli, ratios as they are.
double AsError(const ParameterEstimate& parameter, double value, double truth) {
  return parameter.is_modulus ? std::log(value / truth) : value - truth;
}

double StatedError(const ParameterEstimate& parameter) {
  return parameter.standard_error.value_or(0) /
         (parameter.is_modulus ? std::abs(parameter.value) : 1);
}

// What all trials of a level have.
struct PreparedLevel {
  const MaterialLevel* level;
  Scene model;  ///< Measured without noise.
  MaterialParameters of_model;
  std::vector<double> noise_sd;
  Eigen::VectorXd bounds;  ///< Cramer-Rao; empty without a truth.
  double least_energy_share;
  Scene unseen;  ///< The specimen under the unseen load.
  Eigen::VectorXd unseen_displacement;

  explicit PreparedLevel(const MaterialLevel& of)
      : level(&of),
        model(of.specimen),
        of_model(of.materials_of_model, of.specimen.mesh.section.model),
        least_energy_share(1),
        unseen(of.specimen) {
    const Mesh& mesh = model.mesh;
    const Eigen::MatrixXd displacement = SolveAt(of.specimen, of.parameters);
    const Eigen::MatrixXd free =
        DegreesOfFreedom(model.supports).Restrict(displacement);
    for (std::size_t k = 0; k < model.load_cases.size(); ++k) {
      const Eigen::Index column = Eigen::Index(k);
      model.load_cases[k].displacement =
          displacement.col(column).reshaped(mesh.Dimension(), mesh.NumNodes());
      noise_sd.push_back(of.noise * free.col(column).norm() /
                         std::sqrt(double(free.rows())));
    }
    least_energy_share = LeastEnergyShare(displacement.col(0));
    model.mesh.regions = of.regions_of_model;
    model.materials = of.materials_of_model;
    if (of.parameters_of_model.size() != 0) {
      bounds = CramerRaoBounds();
    }
    unseen.load_cases = {UnseenLoad()};
    unseen_displacement = SolveAt(unseen, of.parameters).col(0);
  }

  Scene Measured(int seed) const {
    Scene scene = model;
    std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
    for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
      MeasurementErrors errors;
      errors.noise_sd = noise_sd[k];
      AddErrors(errors, scene.mesh.nodes, scene.supports.held, generator,
                scene.load_cases[k].displacement);
      if (scene.load_cases.size() > 1) {
        // Of load cases of unequal noise.
        scene.load_cases[k].noise_sd = noise_sd[k];
      }
    }
    return scene;
  }

  // Of the displacement under the unseen load, relative to it.
  double PredictionError(const Estimate& estimate) const {
    // Some estimates that failed have none, or unphysical ones.
    if (estimate.parameters.size() != of_model.All().size()) {
      return kUnknownNumber;
    }
    Eigen::VectorXd parameters(of_model.NumParameters());
    for (Eigen::Index i = 0; i < parameters.size(); ++i) {
      parameters(i) = estimate.parameters[std::size_t(i)].value;
      const LawParameter& law = *of_model.All()[std::size_t(i)].law_parameter;
      if (!(parameters(i) >= law.lower && parameters(i) <= law.upper)) {
        return kUnknownNumber;
      }
    }
    Scene predicted = unseen;
    predicted.mesh.regions = model.mesh.regions;
    predicted.materials = model.materials;
    return (SolveAt(predicted, parameters).col(0) - unseen_displacement)
               .norm() /
           unseen_displacement.norm();
  }

 private:
  double LeastEnergyShare(const Eigen::VectorXd& displacement) const {
    const InternalForces forces(model.mesh, model.materials);
    const MaterialParameters& parameters = forces.Parameters();
    const Eigen::VectorXd energies =
        (forces.Columns(displacement).transpose() * displacement)
            .cwiseProduct(parameters.Moduli(level->parameters));
    double least = 1;
    for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
      const Eigen::Index first = parameters.FirstModulus(i);
      const Eigen::Index count = parameters.LawOf(i).NumModuli();
      least = std::min(least,
                       energies.segment(first, count).sum() / energies.sum());
    }
    return least;
  }

  Eigen::VectorXd CramerRaoBounds() const {
    Scene scene = model;
    for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
      scene.load_cases[k].noise_sd = noise_sd[k];
    }
    return PlanLoads(scene, {{"again", scene.load_cases[0]}},
                     level->parameters_of_model, level->noise)
        .before.OfParameters();
  }
};

// The trials of a level by one estimator.
class MaterialCell {
 public:
  explicit MaterialCell(const PreparedLevel& prepared) : prepared_(prepared) {}

  void Add(const Estimate& estimate, double seconds) {
    ++num_trials_;
    seconds_.push_back(seconds);
    factorizations_.push_back(estimate.work.factorizations);
    predictions_.push_back(prepared_.PredictionError(estimate));
    if (!estimate.IsUsable()) {
      return;
    }
    ++num_usable_;
    num_warned_ += !estimate.Sentences(Severity::kWarning).empty();
    if (prepared_.bounds.size() != 0) {
      Compare(estimate);
    }
  }

  static Table MakeTable() {
    return {"materials_cells",
            {"factor",
             "level",
             "assumption",
             "noise [1]",
             "estimator",
             "trials [1]",
             "parameters [1]",
             "least_energy_share [1]",
             "usable_share [1]",
             "warned_share [1]",
             "dishonest_share [1]",
             "error_over_cramer_rao [1]",
             "coverage [1]",
             "youngs_modulus_root_mean_square_error [1]",
             "youngs_modulus_cramer_rao [1]",
             "poisson_ratio_root_mean_square_error [1]",
             "poisson_ratio_cramer_rao [1]",
             "prediction_error [1]",
             "factorizations [1]",
             "time [s]"}};
  }

  void AddTo(Table& table, const std::string& estimator) const {
    const MaterialLevel& level = *prepared_.level;
    const double usable = num_usable_;
    const std::int64_t count = prepared_.of_model.NumParameters();
    const bool has_truth = prepared_.bounds.size() != 0;
    const auto share = [&](double number) {
      return has_truth ? number : kUnknownNumber;
    };
    std::vector<Value> cells = {level.factor,
                                level.level,
                                level.assumption,
                                level.noise,
                                estimator,
                                std::int64_t{num_trials_},
                                count,
                                prepared_.least_energy_share,
                                usable / num_trials_,
                                num_warned_ / usable,
                                share(double(num_dishonest_) / num_trials_),
                                share(std::sqrt(scores_ / double(num_errors_))),
                                share(num_covered_ / double(num_errors_))};
    for (const bool is_modulus : {true, false}) {
      const double square_sum = squares_[is_modulus ? 0 : 1];
      const double errors_of_kind = num_errors_of_[is_modulus ? 0 : 1];
      cells.emplace_back(share(std::sqrt(square_sum / errors_of_kind)));
      cells.emplace_back(has_truth ? BoundOf(is_modulus) : kUnknownNumber);
    }
    table.AddRow(cells,
                 {Quantile(predictions_, 0.5), Quantile(factorizations_, 0.5),
                  Quantile(seconds_, 0.5)});
  }

 private:
  // The root mean square of the bounds of all moduli, or of all ratios.
  double BoundOf(bool is_modulus) const {
    double square_sum = 0;
    int count = 0;
    for (Eigen::Index i = 0; i < prepared_.bounds.size(); ++i) {
      const MaterialParameters::Parameter& parameter =
          prepared_.of_model.All()[std::size_t(i)];
      if (parameter.law_parameter->is_modulus == is_modulus) {
        square_sum += prepared_.bounds(i) * prepared_.bounds(i);
        ++count;
      }
    }
    return std::sqrt(square_sum / count);
  }

  // With the truth, and the bound of its error.
  void Compare(const Estimate& estimate) {
    bool is_wrong = false;
    for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      const Eigen::Index place = Eigen::Index(i);
      const double truth = prepared_.level->parameters_of_model(place);
      const double error = AsError(parameter, parameter.value, truth);
      const double bound = prepared_.bounds(place);
      squares_[parameter.is_modulus ? 0 : 1] += error * error;
      ++num_errors_of_[parameter.is_modulus ? 0 : 1];
      scores_ += error * error / (bound * bound);
      ++num_errors_;
      const bool is_covered = parameter.interval &&
                              parameter.interval->lower <= truth &&
                              truth <= parameter.interval->upper;
      num_covered_ += is_covered;
      const double large =
          parameter.is_modulus ? kWrongYoungsModulus : kWrongPoissonRatio;
      is_wrong = is_wrong || (std::abs(error) > large && !is_covered &&
                              std::abs(error) > kWrongStandardErrors *
                                                    StatedError(parameter));
    }
    num_dishonest_ += is_wrong;
  }

  const PreparedLevel& prepared_;
  int num_trials_ = 0;
  int num_usable_ = 0;
  int num_warned_ = 0;
  int num_dishonest_ = 0;
  int num_covered_ = 0;
  std::int64_t num_errors_ = 0;
  double scores_ = 0;
  double squares_[2] = {0, 0};  ///< Of E and of nu.
  int num_errors_of_[2] = {0, 0};
  std::vector<double> predictions_;
  std::vector<double> factorizations_;
  std::vector<double> seconds_;
};

}  // namespace

StudyResult RunMaterialsStudy(bool is_quick, Progress& progress) {
  const int num_trials = is_quick ? kQuickMaterialTrials : kMaterialTrials;
  Table table = MaterialCell::MakeTable();
  for (const MaterialLevel& level : MaterialLevels()) {
    const PreparedLevel prepared(level);
    const int num_of_level = level.materials_of_model.size() < kManyRegions
                                 ? num_trials
                                 : std::max(1, num_trials / kTimesFewerOfMany);
    for (const std::string name : {"virtual-fields", "iterative-fe"}) {
      progress.Show("materials: " + level.factor + ", " + level.level + ", " +
                    level.assumption + ", " + name);
      const std::unique_ptr<Estimator> estimator = MakeEstimator(name);
      MaterialCell cell(prepared);
      for (int seed = 1; seed <= num_of_level; ++seed) {
        const Scene scene = prepared.Measured(seed);
        const double start = ProcessorSeconds();
        const Estimate estimate = estimator->Run(scene, {});
        cell.Add(estimate, ProcessorSeconds() - start);
      }
      cell.AddTo(table, name);
    }
  }
  return {{table},
          {{"specimen",
            "a strip of 2 x 1 x 1 in plane strain, of 24 x 12 quadrilaterals, "
            "held at one end, pulled by (100, 20) at the other; E = 10 000 and "
            "nu = 0.3, or twice as stiff and nu = 0.2, in pieces in turn"},
           {"unless_said_otherwise",
            "two regions, Gaussian noise of 1 % of the rms displacement at all "
            "nodes, of the same elements"},
           {"unseen_load", "a body force of (1, -2)"},
           {"noise_seeds", "1 to the number of trials"},
           {"dishonest_standard_errors", kWrongStandardErrors},
           {"dishonest_youngs_modulus_error", kWrongYoungsModulus},
           {"dishonest_poisson_ratio_error", kWrongPoissonRatio}}};
}

}  // namespace elastimate
