#include "elastimate/estimators/interface/prepared_estimator.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/core/scene/loads.h"
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
                                  "prepare a scene of one of the two");
    }
    load_case.displacement.resize(0, 0);
  }
  return scene;
}

// Sets what was measured at the points of load case `k`, whose rows stay.
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

bool AreSame(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN()))
             .all();
}

bool AreSame(const Resultant& a, const Resultant& b) {
  return a.nodes == b.nodes && AreSame(a.force, b.force) &&
         AreSame(a.noise_sd, b.noise_sd);
}

// But for what was measured at the same nodes or points.
bool IsMeasuredAlike(const Mesh& mesh, const LoadCase& a, const LoadCase& b) {
  return a.noise_sd == b.noise_sd && a.observed.size() == b.observed.size() &&
         (a.observed == b.observed).all() &&
         a.points.points.elements.size() == b.points.points.elements.size() &&
         a.points.points.elements == b.points.points.elements &&
         AreSame(a.points.points.local, b.points.points.local) &&
         AreSame(a.points.noise_sd, b.points.noise_sd) &&
         AreSame(
             a.points.displacement.array().isNaN().cast<double>().matrix(),
             b.points.displacement.array().isNaN().cast<double>().matrix()) &&
         std::equal(a.resultants.begin(), a.resultants.end(),
                    b.resultants.begin(), b.resultants.end(),
                    [](const Resultant& one, const Resultant& other) {
                      return AreSame(one, other);
                    }) &&
         AssembleLoads(mesh, a.loads) == AssembleLoads(mesh, b.loads);
}

}  // namespace

struct PreparedEstimator::State {
  const Estimator& estimator;
  /// Keeps the estimator, where a std::shared_ptr owns it.
  std::shared_ptr<const Estimator> owner;
  std::string name;
  Scene scene;
  EstimatorOptions options;
  std::unique_ptr<Preparation> preparation;
};

PreparedEstimator::PreparedEstimator(const Estimator& estimator,
                                     const Scene& scene,
                                     const EstimatorOptions& options)
    : state_(new State{estimator, estimator.weak_from_this().lock(),
                       std::string(estimator.Name()), WithoutMeasurement(scene),
                       options, nullptr}) {
  ValidateScene(state_->scene);
  CheckOptions(options);
  CheckLoads(state_->scene);
  CheckSupported(estimator, state_->scene, options);
  // The preparation refers to a scene and options that stay where they are.
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
    throw std::invalid_argument("the number of measured displacements is " +
                                std::to_string(displacements.size()) +
                                ", and that of load cases is " +
                                std::to_string(scene.load_cases.size()) +
                                "; give one measurement for each load case");
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
  Estimate estimate = RunHere();
  estimate.seconds = stopwatch.Lap();
  return estimate;
}

void PreparedEstimator::ForgetStart() { state_->preparation->ForgetStart(); }

Estimate PreparedEstimator::RunHere() {
  const Scene& scene = state_->scene;
  const std::vector<Finding> findings = CheckMeasurements(scene);
  Estimate estimate = state_->preparation->Run(scene);
  FinishEstimate(state_->name, scene, state_->options, findings, estimate);
  return estimate;
}

Estimate PreparedEstimator::RunLoadCases(
    const std::vector<LoadCase>& load_cases) {
  Stopwatch stopwatch;
  Scene& scene = state_->scene;
  if (!state_->preparation->TakesOtherLoadCases()) {
    std::vector<Eigen::MatrixXd> displacements;
    bool are_alike = scene.load_cases.size() == load_cases.size();
    for (std::size_t k = 0; k < load_cases.size(); ++k) {
      are_alike = are_alike && IsMeasuredAlike(scene.mesh, scene.load_cases[k],
                                               load_cases[k]);
      displacements.push_back(load_cases[k].points.points.Size() != 0
                                  ? load_cases[k].points.displacement
                                  : load_cases[k].displacement);
    }
    if (!are_alike) {
      Scene other = scene;
      other.load_cases = load_cases;
      *this = PreparedEstimator(state_->estimator, other, state_->options);
    }
    Estimate estimate = Run(displacements);
    estimate.seconds = stopwatch.Lap();
    return estimate;
  }
  const std::vector<LoadCase> before =
      std::exchange(scene.load_cases, load_cases);
  try {
    ValidateScene(scene);
    CheckLoads(scene);
    CheckSupported(state_->estimator, scene, state_->options);
    Estimate estimate = RunHere();
    estimate.seconds = stopwatch.Lap();
    return estimate;
  } catch (...) {
    scene.load_cases = before;
    throw;
  }
}

}  // namespace elastimate
