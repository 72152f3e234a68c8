#include "elastimate/estimators/observed_displacements.h"

#include "elastimate/estimators/estimator.h"

namespace elastimate {

ObservedDisplacements::ObservedDisplacements(const Scene& scene) {
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  std::vector<double> weights;
  std::vector<double> measured;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const double weight = 1 / load_case.noise_sd.value_or(1);
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      const Eigen::Index first = Eigen::Index(places_.size());
      for (int i = 0; i < 3; ++i) {
        if (!scene.supports.held(i, node) && IsObserved(load_case, i, node)) {
          places_.push_back(3 * (num_nodes * Eigen::Index(k) + node) + i);
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
  measured_ = Eigen::Map<Eigen::VectorXd>(measured.data(),
                                          Eigen::Index(measured.size()));
  weights_ =
      Eigen::Map<Eigen::VectorXd>(weights.data(), Eigen::Index(weights.size()));
  norm_ = measured_.norm();
  measured_ /= norm_;
  weights_ /= norm_;
}

Eigen::VectorXd ObservedDisplacements::Restrict(
    const Eigen::MatrixXd& displacements) const {
  return displacements.reshaped()(places_).cwiseProduct(weights_);
}

}  // namespace elastimate
