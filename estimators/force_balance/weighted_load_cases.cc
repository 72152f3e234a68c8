#include "elastimate/estimators/force_balance/weighted_load_cases.h"

#include "elastimate/core/algebra/large_pages.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {

Eigen::MatrixXd WeightedDisplacements(const Scene& scene) {
  const Supports& supports = scene.supports;
  Eigen::MatrixXd q;
  ResizeInLargePages(scene.mesh.NumDofs(),
                     Eigen::Index(scene.load_cases.size()), q);
  for (Eigen::Index k = 0; k < q.cols(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    q.col(k).reshaped(supports.held.rows(), scene.mesh.NumNodes()) =
        1 / load_case.noise_sd.value_or(1) *
        supports.held.select(supports.displacement, load_case.displacement);
  }
  return q;
}

Eigen::MatrixXd WeightedLoads(const Scene& scene) {
  Eigen::MatrixXd f;
  ResizeInLargePages(scene.mesh.NumDofs(),
                     Eigen::Index(scene.load_cases.size()), f);
  AssembleLoadCases(scene, f);
  for (Eigen::Index k = 0; k < f.cols(); ++k) {
    f.col(k) *= 1 / scene.load_cases[k].noise_sd.value_or(1);
  }
  return f;
}

}  // namespace elastimate
