#include "benchmarks/material_cell.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>

#include "benchmarks/quantile.h"
#include "benchmarks/trial.h"
#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/plan/load_plan.h"

namespace elastimate {
namespace {

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

double LeastEnergyShareOf(const Scene& specimen,
                          const Eigen::VectorXd& true_parameters,
                          const Eigen::VectorXd& displacement) {
  const InternalForces forces(specimen.mesh, specimen.materials);
  const MaterialParameters& parameters = forces.Parameters();
  const Eigen::VectorXd energies =
      (forces.Columns(displacement).transpose() * displacement)
          .cwiseProduct(parameters.Moduli(true_parameters));
  double least = 1;
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    const Eigen::Index first = parameters.FirstModulus(i);
    const Eigen::Index count = parameters.LawOf(i).NumModuli();
    least =
        std::min(least, energies.segment(first, count).sum() / energies.sum());
  }
  return least;
}

Eigen::VectorXd CramerRaoBounds(Scene scene,
                                const std::vector<double>& noise_sd,
                                const MaterialLevel& level) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].noise_sd = noise_sd[k];
  }
  return PlanLoads(scene, {{"again", scene.load_cases[0]}},
                   level.parameters_of_model, level.noise)
      .before.OfParameters();
}

// Returns whether `regions` are those of the material that the region `others`
// has become by merging.
bool Hold(const std::vector<int>& regions, const std::vector<int>& others) {
  return regions.empty() || std::includes(regions.begin(), regions.end(),
                                          others.begin(), others.end());
}

}  // namespace

PreparedLevel::PreparedLevel(const MaterialLevel& level)
    : level_(level),
      model_(level.specimen),
      of_model_(level.materials_of_model, level.specimen.mesh.section.model),
      unseen_(level.specimen) {
  const Mesh& mesh = model_.mesh;
  const Eigen::MatrixXd displacement =
      SolveAt(level.specimen, level.parameters);
  const Eigen::MatrixXd free =
      DegreesOfFreedom(model_.supports).Restrict(displacement);
  for (std::size_t k = 0; k < model_.load_cases.size(); ++k) {
    const Eigen::Index column = Eigen::Index(k);
    model_.load_cases[k].displacement =
        displacement.col(column).reshaped(mesh.Dimension(), mesh.NumNodes());
    model_.origin = Origin::kComputed;
    noise_sd_.push_back(level.noise * free.col(column).norm() /
                        std::sqrt(double(free.rows())));
  }
  least_energy_share_ =
      LeastEnergyShareOf(level.specimen, level.parameters, displacement.col(0));
  model_.mesh.regions = level.regions_of_model;
  model_.materials = level.materials_of_model;
  if (level.parameters_of_model.size() != 0) {
    bounds_ = CramerRaoBounds(model_, noise_sd_, level);
  }
  unseen_.load_cases = {level.unseen};
  unseen_displacement_ = SolveAt(unseen_, level.parameters).col(0);
  unseen_.mesh.regions = level.regions_of_model;
  unseen_.materials = level.materials_of_model;
}

Scene PreparedLevel::Measured(int seed) const {
  Scene scene = model_;
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    MeasurementErrors errors;
    errors.noise_sd = noise_sd_[k];
    AddErrors(errors, scene.mesh.nodes, scene.supports.held, generator,
              scene.load_cases[k].displacement);
    if (scene.load_cases.size() > 1) {
      // Unequal noise of load cases has to be stated, since it weights them.
      scene.load_cases[k].noise_sd = noise_sd_[k];
    }
  }
  return scene;
}

std::vector<ParameterEstimate> PreparedLevel::ParametersOfModel(
    const Estimate& estimate) const {
  std::vector<ParameterEstimate> parameters;
  for (const MaterialParameters::Parameter& parameter : of_model_.All()) {
    const std::vector<int>& regions =
        level_.materials_of_model[parameter.material].regions;
    const auto place =
        std::find_if(estimate.parameters.begin(), estimate.parameters.end(),
                     [&](const ParameterEstimate& estimated) {
                       return estimated.name == parameter.law_parameter->name &&
                              Hold(estimated.regions, regions);
                     });
    if (place == estimate.parameters.end()) {
      return {};
    }
    parameters.push_back(*place);
  }
  return parameters;
}

double PreparedLevel::PredictionError(
    const std::vector<ParameterEstimate>& parameters) const {
  if (parameters.empty()) {
    return kUnknownNumber;
  }
  Eigen::VectorXd values(of_model_.NumParameters());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = parameters[std::size_t(i)].value;
    const LawParameter& law = *of_model_.All()[std::size_t(i)].law_parameter;
    if (!(values(i) >= law.lower && values(i) <= law.upper)) {
      return kUnknownNumber;
    }
  }
  return (SolveAt(unseen_, values).col(0) - unseen_displacement_).norm() /
         unseen_displacement_.norm();
}

void MaterialCell::Add(const Estimate& estimate, double seconds) {
  const std::vector<ParameterEstimate> parameters =
      prepared_.ParametersOfModel(estimate);
  ++num_trials_;
  seconds_.push_back(seconds);
  factorizations_.push_back(estimate.work.factorizations);
  predictions_.push_back(prepared_.PredictionError(parameters));
  if (!estimate.IsUsable()) {
    return;
  }
  ++num_usable_;
  num_warned_ += !estimate.Sentences(Severity::kWarning).empty();
  numbers_of_parameters_.push_back(double(estimate.parameters.size()));
  if (prepared_.Bounds().size() != 0) {
    Compare(parameters);
  }
}

// Compares the parameters with the truth, and with the bound of its error.
void MaterialCell::Compare(const std::vector<ParameterEstimate>& parameters) {
  const Eigen::VectorXd& truths = prepared_.Level().parameters_of_model;
  const Eigen::VectorXd units = prepared_.OfModel().UnitsOfErrors(truths);
  bool is_wrong = false;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterEstimate& parameter = parameters[i];
    const Eigen::Index place = Eigen::Index(i);
    const double truth = truths(place);
    const double error = parameter.is_modulus
                             ? std::log(parameter.value / truth)
                             : (parameter.value - truth) / units(place);
    Errors& of_kind = parameter.IsStiffness() ? of_stiffnesses_ : of_ratios_;
    of_kind.square_sum += error * error;
    ++of_kind.count;
    const double bound = prepared_.Bounds()(place);
    scores_.square_sum += error * error / (bound * bound);
    ++scores_.count;
    const bool is_covered = parameter.interval &&
                            parameter.interval->lower <= truth &&
                            truth <= parameter.interval->upper;
    num_covered_ += is_covered;
    const double stated =
        parameter.standard_error.value_or(0) / std::abs(parameter.ErrorUnit());
    const double large =
        parameter.IsStiffness() ? kWrongYoungsModulus : kWrongPoissonRatio;
    is_wrong = is_wrong || (!is_covered && std::abs(error) > large &&
                            std::abs(error) > kWrongStandardErrors * stated);
  }
  num_dishonest_ += is_wrong;
}

Table MaterialCell::MakeTable() {
  return {"materials_cells",
          {"factor",
           "level",
           "assumption",
           "noise [1]",
           "estimator",
           "trials [1]",
           "parameters [1]",
           "estimated_parameters [1]",
           "least_energy_share [1]",
           "usable_share [1]",
           "warned_share [1]",
           "dishonest_share [1]",
           "error_over_cramer_rao [1]",
           "coverage [1]",
           "stiffness_root_mean_square_error [1]",
           "stiffness_cramer_rao [1]",
           "ratio_root_mean_square_error [1]",
           "ratio_cramer_rao [1]",
           "prediction_error [1]",
           "factorizations [1]",
           "time [s]"}};
}

void MaterialCell::AddTo(Table& table, const std::string& method) const {
  const MaterialLevel& level = prepared_.Level();
  const double usable = num_usable_;
  const bool has_truth = prepared_.Bounds().size() != 0;
  const auto of_truth = [&](double number) {
    return has_truth ? number : kUnknownNumber;
  };
  const auto root_mean_square = [&](const Errors& errors) {
    return of_truth(std::sqrt(errors.square_sum / errors.count));
  };
  table.AddRow(
      {level.factor, level.level, level.assumption, level.noise, method,
       std::int64_t{num_trials_},
       std::int64_t{prepared_.OfModel().NumParameters()},
       Quantile(numbers_of_parameters_, 0.5), prepared_.LeastEnergyShare(),
       usable / num_trials_, num_warned_ / usable,
       of_truth(double(num_dishonest_) / num_trials_),
       root_mean_square(scores_),
       of_truth(num_covered_ / double(scores_.count)),
       root_mean_square(of_stiffnesses_), of_truth(BoundOf(true)),
       root_mean_square(of_ratios_), of_truth(BoundOf(false))},
      {Quantile(predictions_, 0.5), Quantile(factorizations_, 0.5),
       Quantile(seconds_, 0.5)});
}

// Returns the root mean square of the bounds of all stiffnesses, or of all
// ratios.
double MaterialCell::BoundOf(bool is_stiffness) const {
  const Eigen::VectorXd& bounds = prepared_.Bounds();
  Errors errors;
  for (Eigen::Index i = 0; i < bounds.size(); ++i) {
    const LawParameter& parameter =
        *prepared_.OfModel().All()[std::size_t(i)].law_parameter;
    if ((parameter.is_modulus || parameter.beside) == is_stiffness) {
      errors.square_sum += bounds(i) * bounds(i);
      ++errors.count;
    }
  }
  return std::sqrt(errors.square_sum / errors.count);
}

}  // namespace elastimate
