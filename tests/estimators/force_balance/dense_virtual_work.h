#ifndef ELASTIMATE_TESTS_ESTIMATORS_FORCE_BALANCE_DENSE_VIRTUAL_WORK_H_
#define ELASTIMATE_TESTS_ESTIMATORS_FORCE_BALANCE_DENSE_VIRTUAL_WORK_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "tests/dense_reference.h"

namespace elastimate::testing {

/// The virtual fields V of a scene, and H V and J V in its free rows, by dense
/// matrices.
struct DenseVirtualWork {
  DenseVirtualWork(const Scene& scene, const VirtualWork& work)
      : fields(work.Fields()),
        h(DenseStiffness<double>(scene.mesh, DenseDH())),
        j(DenseStiffness<double>(scene.mesh, DenseDJ())) {
    const std::vector<Eigen::Index> free =
        DegreesOfFreedom(scene.supports).free;
    h_fields = (h * fields)(free, Eigen::all);
    j_fields = (j * fields)(free, Eigen::all);
  }

  Eigen::MatrixXd fields;
  Eigen::MatrixXd h;
  Eigen::MatrixXd j;
  Eigen::MatrixXd h_fields;
  Eigen::MatrixXd j_fields;
};

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_ESTIMATORS_FORCE_BALANCE_DENSE_VIRTUAL_WORK_H_
