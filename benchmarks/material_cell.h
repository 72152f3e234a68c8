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

/// Holds a level with all that its trials have in common.
class PreparedLevel {
 public:
  /// `level` outlives it.  Cost: three factorisations.
  explicit PreparedLevel(const MaterialLevel& level);

  const MaterialLevel& Level() const { return level_; }
  const MaterialParameters& OfModel() const { return of_model_; }
  /// Returns the Cramer-Rao bounds in the units of
  /// MaterialParameters::UnitsOfErrors; empty where the model has no true
  /// parameters.
  const Eigen::VectorXd& Bounds() const { return bounds_; }
  /// Returns the smallest share that a material of the specimen has of the
  /// strain energy of the first load case.
  double LeastEnergyShare() const { return least_energy_share_; }

  /// Returns the model with the measurement of this seed.
  Scene Measured(int seed) const;
  /// Returns the parameters of the model, some of which are equal where regions
  /// were merged; empty where the estimate has none.
  std::vector<ParameterEstimate> ParametersOfModel(
      const Estimate& estimate) const;
  /// Returns the error of the displacement under the unseen load, relative to
  /// that displacement; NaN where no material has these parameters.
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
  Eigen::VectorXd unseen_displacement_;  ///< The true one, of `unseen_`.
};

/// Collects the trials of a level by one method.
class MaterialCell {
 public:
  /// `prepared` must outlive this object.
  explicit MaterialCell(const PreparedLevel& prepared) : prepared_(prepared) {}

  void Add(const Estimate& estimate, double seconds);

  static Table MakeTable();
  void AddTo(Table& table, const std::string& method) const;

 private:
  /// The sums are of stiffnesses or of ratios, which have different units.
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
