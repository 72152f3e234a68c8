#include "elastimate/estimators/interface/prepared_estimator.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/input_checks.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/stopwatch.h"

namespace elastimate {
namespace {

Scene WithoutMeasurement(Scene scene) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    LoadCase& load_case = scene.load_cases[k];
    if (load_case.displacement.size() != 0 &&
        load_case.points.points.Size() != 0) {
      throw std::invalid_argument("load case " + std::to_string(k + 1) +
                                  " was measured at nodes and at points; "
                                  "prepare a scene of either");
    }
    load_case.displacement.resize(0, 0);
  }
  return scene;
}

// Of the points of load case `k`, whose rows stay.
void SetAtPoints(const Eigen::MatrixXd& displacement, std::size_t k,
                 PointDisplacements& points) {
  if (displacement.rows() != points.displacement.rows() ||
      displacement.cols() != points.displacement.cols() ||
      (displacement.array().isNaN() != points.displacement.array().isNaN())
          .any()) {
    throw std::invalid_argument(
        "the displacements of load case " + std::to_string(k + 1) +
        " are not those of the points that were measured when the scene was "
        "prepared; prepare a scene of these points");
  }
  points.displacement = displacement;
}

}  // namespace

struct PreparedEstimator::State {
  std::string name;
  Scene scene;
  EstimatorOptions options;
  std::unique_ptr<Preparation> preparation;
};

PreparedEstimator::PreparedEstimator(const Estimator& estimator,
                                     const Scene& scene,
                                     const EstimatorOptions& options)
    : state_(new State{std::string(estimator.Name()), WithoutMeasurement(scene),
                       options, nullptr}) {
  ValidateScene(state_->scene);
  CheckOptions(options);
  CheckLoads(state_->scene);
  CheckSupported(estimator, state_->scene, options);
  // Of the scene and options that stay where they are.
  state_->preparation = estimator.DoPrepare(state_->scene, state_->options);
}

PreparedEstimator::~PreparedEstimator() = default;
PreparedEstimator::PreparedEstimator(PreparedEstimator&&) noexcept = default;
PreparedEstimator& PreparedEstimator::operator=(PreparedEstimator&&) noexcept =
    default;

Estimate PreparedEstimator::Run(
    const std::vector<Eigen::MatrixXd>& displacements) {
  Stopwatch stopwatch;
  Scene& scene = state_->scene;
  if (displacements.size() != scene.load_cases.size()) {
    throw std::invalid_argument(std::to_string(displacements.size()) +
                                " measured displacements for " +
                                std::to_string(scene.load_cases.size()) +
                                " load cases; give one for each");
  }
  for (std::size_t k = 0; k < displacements.size(); ++k) {
    LoadCase& load_case = scene.load_cases[k];
    if (load_case.points.points.Size() != 0) {
      SetAtPoints(displacements[k], k, load_case.points);
    } else {
      load_case.displacement = displacements[k];
    }
  }
  ValidateMeasurements(scene);
  const std::vector<Finding> findings = CheckMeasurements(scene);
  Estimate estimate = state_->preparation->Run(scene);
  FinishEstimate(state_->name, scene, state_->options, findings, estimate);
  estimate.seconds = stopwatch.Lap();
  return estimate;
}

}  // namespace elastimate
