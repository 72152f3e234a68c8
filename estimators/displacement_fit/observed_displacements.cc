#include "elastimate/estimators/displacement_fit/observed_displacements.h"

#include <algorithm>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

ObservedDisplacements::ObservedDisplacements(const Scene& scene)
    : dimension_(scene.mesh.Dimension()), num_dofs_(scene.mesh.NumDofs()) {
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  std::vector<double> weights;
  std::vector<double> measured;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    case_start_.push_back(Eigen::Index(places_.size()));
    const double weight = 1 / load_case.noise_sd.value_or(1);
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      const Eigen::Index first = Eigen::Index(places_.size());
      for (int i = 0; i < dimension_; ++i) {
        if (!scene.supports.held(i, node) && IsObserved(load_case, i, node)) {
          places_.push_back(num_dofs_ * Eigen::Index(k) + dimension_ * node +
                            i);
          weights.push_back(weight);
          measured.push_back(weight * load_case.displacement(i, node));
        }
      }
      const int count = static_cast<int>(Eigen::Index(places_.size()) - first);
      if (count > 0) {
        nodes_.push_back({node, Eigen::Index(k), first, count});
      }
    }
  }
  case_start_.push_back(Eigen::Index(places_.size()));
  measured_ = Eigen::Map<Eigen::VectorXd>(measured.data(),
                                          Eigen::Index(measured.size()));
  weights_ =
      Eigen::Map<Eigen::VectorXd>(weights.data(), Eigen::Index(weights.size()));
  norm_ = measured_.norm();
  measured_ /= norm_;
  weights_ /= norm_;
}

void ObservedDisplacements::Remeasure(const Scene& scene) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const Eigen::Index first = case_start_[k];
    measured_.segment(first, case_start_[k + 1] - first) = RestrictToCase(
        Eigen::Index(k), scene.load_cases[k].displacement.reshaped());
  }
}

Eigen::VectorXd ObservedDisplacements::Restrict(
    const Eigen::MatrixXd& displacements) const {
  return displacements.reshaped()(places_).cwiseProduct(weights_);
}

Eigen::VectorXd ObservedDisplacements::LargestWeights() const {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(num_dofs_);
  for (Eigen::Index row = 0; row < Size(); ++row) {
    double& weight = largest(places_[row] % num_dofs_);
    weight = std::max(weight, weights_(row));
  }
  return largest;
}

Eigen::VectorXd ObservedDisplacements::RestrictToCase(
    Eigen::Index k, const Eigen::VectorXd& displacement) const {
  const Eigen::Index first = case_start_[k];
  Eigen::VectorXd rows(case_start_[k + 1] - first);
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    rows(i) = weights_(first + i) *
              displacement(places_[first + i] - k * displacement.size());
  }
  return rows;
}

}  // namespace elastimate
