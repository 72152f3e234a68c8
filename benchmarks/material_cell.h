#ifndef ELASTIMATE_BENCHMARKS_MATERIAL_CELL_H_
#define ELASTIMATE_BENCHMARKS_MATERIAL_CELL_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/material_levels.h"
#include "benchmarks/table.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// What all trials of a level have.
class PreparedLevel {
 public:
  /// `level` outlives it.  Cost: three factorisations.
  explicit PreparedLevel(const MaterialLevel& level);

  const MaterialLevel& Level() const { return level_; }
  const MaterialParameters& OfModel() const { return of_model_; }
  /// Cramer-Rao, in the units of MaterialParameters::UnitsOfErrors; empty
  /// without a truth.
  const Eigen::VectorXd& Bounds() const { return bounds_; }
  /// The least share of the strain energy of the first load case that a
  /// material of the specimen has.
  double LeastEnergyShare() const { return least_energy_share_; }

  /// The model with the measurement of a seed.
  Scene Measured(int seed) const;
  /// The parameters of the model, of which merged regions share some; empty
  /// where the estimate has none.
  std::vector<ParameterEstimate> ParametersOfModel(
      const Estimate& estimate) const;
  /// The error of the displacement under the unseen load, relative to it; NaN
  /// where the parameters are none of a material.
  double PredictionError(
      const std::vector<ParameterEstimate>& parameters) const;

 private:
  const MaterialLevel& level_;
  Scene model_;  ///< Measured without noise.
  MaterialParameters of_model_;
  std::vector<double> noise_sd_;
  Eigen::VectorXd bounds_;
  double least_energy_share_;
  Scene unseen_;                         ///< The model under the unseen load.
  Eigen::VectorXd unseen_displacement_;  ///< That the specimen has.
};

/// The trials of a level by one method.
class MaterialCell {
 public:
  /// `prepared` outlives it.
  explicit MaterialCell(const PreparedLevel& prepared) : prepared_(prepared) {}

  void Add(const Estimate& estimate, double seconds);

  static Table MakeTable();
  void AddTo(Table& table, const std::string& method) const;

 private:
  /// The errors of stiffnesses, or of ratios.
  struct Errors {
    double square_sum = 0;
    int count = 0;
  };

  void Compare(const std::vector<ParameterEstimate>& parameters);
  double BoundOf(bool is_stiffness) const;

  const PreparedLevel& prepared_;
  int num_trials_ = 0;
  int num_usable_ = 0;
  int num_warned_ = 0;
  int num_dishonest_ = 0;
  int num_covered_ = 0;
  Errors scores_;  ///< Over their bounds.
  Errors of_stiffnesses_;
  Errors of_ratios_;
  std::vector<double> numbers_of_parameters_;
  std::vector<double> predictions_;
  std::vector<double> factorizations_;
  std::vector<double> seconds_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MATERIAL_CELL_H_
