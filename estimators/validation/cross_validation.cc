#include "elastimate/estimators/validation/cross_validation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/material_fit/fitted_scene.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Standard errors are hardly better known than this.
constexpr double kNotableRatio = 1.25;
// Chance explains so many standard deviations of chi^2.
constexpr double kChance = 4;

// Returns the spaces of a fit, from coarse to fine: the scene with the elements
// of its mesh, and with those that the fit had in place of them.
std::vector<Scene> FittedSpaces(const Scene& scene, const Estimate& estimate) {
  std::vector<Scene> spaces = {scene};
  if (std::optional<Scene> fitted = FittedScene(scene, estimate)) {
    spaces.front().materials = fitted->materials;
    if (fitted->mesh.Order() > scene.mesh.Order()) {
      spaces.push_back(std::move(*fitted));
    }
  }
  for (int i = 0; i < estimate.mesh_divisions; ++i) {
    spaces.push_back(FinerScene(spaces.back()));
  }
  return spaces;
}

// Returns the spaces that help to solve in the finest one.  Unknown motions
// need a factorisation there.
std::vector<const Scene*> SpacesOfMisfit(const std::vector<Scene>& spaces) {
  std::vector<const Scene*> list;
  list.reserve(spaces.size());
  for (const Scene& scene : spaces) {
    list.push_back(&scene);
  }
  return HasUnknownMotion(spaces.front())
             ? std::vector<const Scene*>{list.back()}
             : list;
}

// Returns a root L of the covariance L L^T of the variables of a fit; empty
// where the estimate has none.
Eigen::MatrixXd RootOfCovariance(const FreeParameters& free,
                                 const Eigen::VectorXd& x,
                                 const Estimate& estimate) {
  const std::vector<Eigen::Index>& places = free.All().Free();
  const Eigen::Index num_parameters = Eigen::Index(estimate.parameters.size());
  if (estimate.parameter_covariance.rows() != num_parameters) {
    return {};
  }
  const Eigen::MatrixXd covariance =
      estimate.parameter_covariance(places, places);
  if (!covariance.allFinite()) {
    return {};
  }
  const SymmetricEigenDecomposition decomposition =
      DecomposeSymmetric(covariance);
  const Eigen::VectorXd root = decomposition.values.cwiseMax(0).cwiseSqrt();
  return Inverse(free.ParameterJacobian(x)) * decomposition.vectors *
         root.asDiagonal();
}

// What was predicted of a fold, row by row of ObservedDisplacements.
struct PredictedRows {
  Prediction prediction;
  Eigen::VectorXd difference;  // Predicted - measured [length].
  Eigen::VectorXd error;       // [length].
};

// Compares rows whose noise has the variance `variance`.
PredictedRows Compare(const Eigen::VectorXd& residual, Eigen::MatrixXd by_root,
                      double variance, Eigen::Index num_values) {
  PredictedRows rows;
  if (by_root.cols() == 0) {
    by_root.setZero(residual.size(), 1);
  }
  Eigen::MatrixXd small = by_root.transpose() * by_root;
  small.diagonal().array() += variance;
  const Eigen::VectorXd a = by_root.transpose() * residual;
  rows.prediction.num_values = num_values;
  rows.prediction.chi_square =
      (residual.squaredNorm() - a.dot(small.llt().solve(a))) / variance;
  rows.difference = residual;
  rows.error = (by_root.rowwise().squaredNorm().array() + variance).sqrt();
  return rows;
}

class FoldPredictor {
 public:
  FoldPredictor(const Scene& held_out, const Estimate& estimate,
                const EstimatorOptions& options)
      : spaces_(FittedSpaces(held_out, estimate)),
        misfit_(SpacesOfMisfit(spaces_), options),
        estimate_(estimate) {
    if (held_out.is_rigid_motion_free && estimate.cameras.empty()) {
      misfit_.SetRotations(MotionElimination::Rotations::kLinear);
    }
  }

  const ObservedDisplacements& Observed() const { return misfit_.Observed(); }
  Eigen::Index NumNodes() const { return spaces_.back().mesh.NumNodes(); }

  // Empty where the model cannot be solved.
  std::optional<PredictedRows> Predict() {
    const FreeParameters& free = misfit_.Free();
    const Eigen::VectorXd x = free.VariablesOf(estimate_.ParameterValues());
    Eigen::VectorXd residual;
    Eigen::MatrixXd jacobian;
    if (!x.allFinite() || !misfit_.Evaluate(x, &residual, &jacobian)) {
      return std::nullopt;
    }
    const Eigen::Index num_rows = Observed().Size();
    const Eigen::MatrixXd root = RootOfCovariance(free, x, estimate_);
    PredictedRows rows = Compare(
        residual.head(num_rows),
        root.size() == 0 ? Eigen::MatrixXd(num_rows, 0)
                         : Eigen::MatrixXd(jacobian.topRows(num_rows) * root),
        Variance(), std::max<Eigen::Index>(num_rows - misfit_.NumAmounts(), 0));
    const Eigen::VectorXd unit = Observed().RowUnits();
    rows.difference.array() *= unit.array();
    rows.error.array() *= unit.array();
    rows.prediction.square_sum = rows.difference.squaredNorm();
    rows.prediction.measured_square_sum =
        unit.cwiseProduct(Observed().MeasuredWithoutTurn()).squaredNorm();
    return rows;
  }

 private:
  double Variance() const {
    const double noise =
        Observed().GivenNoise() ? 1 : estimate_.noise_sd.value_or(0);
    return std::pow(std::max(noise / Observed().Norm(), kLeastNoise), 2);
  }

  std::vector<Scene> spaces_;
  DisplacementMisfit misfit_;
  const Estimate& estimate_;
};

std::vector<PredictionErrors> NoErrors(const Scene& scene) {
  std::vector<PredictionErrors> errors;
  for (const LoadCase& load_case : scene.load_cases) {
    const int dimension = scene.mesh.Dimension();
    const Eigen::MatrixXd nodes =
        Eigen::MatrixXd::Constant(dimension, scene.mesh.NumNodes(), kNone);
    const Eigen::MatrixXd points = Eigen::MatrixXd::Constant(
        dimension, load_case.points.points.Size(), kNone);
    errors.push_back({nodes, points, nodes, points});
  }
  return errors;
}

// Enters the rows of a fold, of `observed`, into the errors of all load cases.
// `fitted_nodes` is the number of nodes of the mesh that was fitted.
void EnterErrors(const PredictedRows& rows,
                 const ObservedDisplacements& observed,
                 const std::vector<Eigen::Index>& load_cases,
                 Eigen::Index fitted_nodes,
                 std::vector<PredictionErrors>& errors) {
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    PredictionErrors& of_case = errors[load_cases[point.load_case]];
    const bool is_node = point.index < fitted_nodes;
    const Eigen::Index column =
        is_node ? point.index : point.index - fitted_nodes;
    for (Eigen::Index row = point.first; row < point.first + point.count;
         ++row) {
      const int i = observed.Component(row);
      const double error = -rows.difference(row);
      (is_node ? of_case.of_nodes : of_case.of_points)(i, column) = error;
      (is_node ? of_case.standardised_of_nodes
               : of_case.standardised_of_points)(i, column) =
          error / rows.error(row);
    }
  }
}

}  // namespace

Prediction& Prediction::operator+=(const Prediction& other) {
  num_values += other.num_values;
  chi_square += other.chi_square;
  square_sum += other.square_sum;
  measured_square_sum += other.measured_square_sum;
  return *this;
}

double Prediction::ErrorRatio() const {
  return std::sqrt(chi_square / static_cast<double>(num_values));
}

double Prediction::RmsError() const {
  return std::sqrt(square_sum / static_cast<double>(num_values));
}

double Prediction::RelativeError() const {
  return std::sqrt(square_sum / measured_square_sum);
}

bool Prediction::IsOff() const {
  const double n = static_cast<double>(num_values);
  return ErrorRatio() > kNotableRatio &&
         chi_square > n + kChance * std::sqrt(2 * n);
}

Prediction CrossValidation::Total() const {
  Prediction total;
  for (const FoldPrediction& fold : folds) {
    total += fold.prediction;
  }
  return total;
}

bool CrossValidation::IsComplete() const {
  return std::all_of(folds.begin(), folds.end(),
                     [](const auto& fold) { return fold.why_not.empty(); });
}

bool CrossValidation::IsOff() const {
  return Total().IsOff() ||
         std::any_of(folds.begin(), folds.end(),
                     [](const auto& fold) { return fold.prediction.IsOff(); });
}

CrossValidation CrossValidate(const Scene& scene, const Folds& folds,
                              const Estimator& estimator,
                              const EstimatorOptions& options,
                              const std::function<void(int)>& progress) {
  for (const Material& material : scene.materials) {
    if (!material.fields.empty()) {
      throw std::invalid_argument(
          "a map cannot be validated; leave out the map, or give regions");
    }
  }
  CrossValidation validation = {{}, NoErrors(scene)};
  for (int i = 0; i < folds.Size(); ++i) {
    progress(i);
    FoldPrediction fold;
    fold.estimate = estimator.Run(WithoutFold(scene, folds, i).scene, options);
    const PartOfScene held_out = OnlyFold(scene, folds, i);
    if (!fold.estimate.ParameterValues().allFinite()) {
      fold.why_not = fold.estimate.message;
    } else {
      FoldPredictor predictor(held_out.scene, fold.estimate, options);
      if (const std::optional<PredictedRows> rows = predictor.Predict()) {
        fold.prediction = rows->prediction;
        EnterErrors(*rows, predictor.Observed(), held_out.load_cases,
                    predictor.NumNodes(), validation.errors);
      } else {
        fold.why_not =
            "the model cannot be solved at the parameters of the other folds";
      }
    }
    validation.folds.push_back(std::move(fold));
  }
  return validation;
}

}  // namespace elastimate
