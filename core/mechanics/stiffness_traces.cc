#include "elastimate/core/mechanics/stiffness_traces.h"

#include <cstdint>
#include <random>

#include "elastimate/core/mechanics/gradient_products.h"

namespace elastimate {

Eigen::Matrix2d StiffnessTraces(const Mesh& mesh,
                                const DegreesOfFreedom& degrees_of_freedom) {
  const NodeGraph graph(mesh);
  const Eigen::Matrix4Xd products = GradientProducts(mesh, graph);
  const auto free = [&](Eigen::Index node) {
    Eigen::Vector3d mask;
    for (int i = 0; i < 3; ++i) {
      mask(i) = degrees_of_freedom.place[3 * node + i] >= 0 ? 1 : 0;
    }
    return mask;
  };
  Eigen::Matrix2d traces = Eigen::Matrix2d::Zero();
  for (Eigen::Index j = 0; j < mesh.NumNodes(); ++j) {
    const Eigen::Vector3d free_j = free(j);
    for (Eigen::Index k = graph.start[j]; k < graph.start[j + 1]; ++k) {
      const int i = graph.row[k];
      const Eigen::Matrix3d mask = free(i) * free_j.transpose();
      const Eigen::Matrix3d m = products.block<3, 3>(0, 3 * k);
      const Eigen::Matrix3d block_h = StiffnessBlockH(m).cwiseProduct(mask);
      const Eigen::Matrix3d block_j = StiffnessBlockJ(m).cwiseProduct(mask);
      // A pair of different nodes stands for two blocks of the matrix.
      const double weight = i == j ? 1 : 2;
      traces(0, 0) += weight * block_h.squaredNorm();
      traces(0, 1) += weight * block_h.cwiseProduct(block_j).sum();
      traces(1, 1) += weight * block_j.squaredNorm();
    }
  }
  traces(1, 0) = traces(0, 1);
  return traces;
}

void SetTraceProbes(const ComponentMask& held,
                    Eigen::Ref<Eigen::MatrixXd> probes) {
  // Looked up, since a branch could not be predicted.
  constexpr double kSigns[2] = {-1, 1};
  std::mt19937_64 generator(20071107);
  probes.setZero();
  for (auto probe : probes.colwise()) {
    // A sign in each bit.
    std::uint64_t signs = 0;
    for (Eigen::Index dof = 0; dof < held.size(); ++dof, signs >>= 1U) {
      if (dof % 64 == 0) {
        signs = generator();
      }
      if (!held.data()[dof]) {
        probe(dof) = kSigns[signs & 1U];
      }
    }
  }
}

Eigen::Matrix2d EstimateStiffnessTraces(
    const ComponentMask& held, const Eigen::Ref<const Eigen::MatrixXd>& h,
    const Eigen::Ref<const Eigen::MatrixXd>& j) {
  Eigen::Matrix2d traces = Eigen::Matrix2d::Zero();
  for (Eigen::Index k = 0; k < h.cols(); ++k) {
    for (Eigen::Index dof = 0; dof < held.size(); ++dof) {
      if (!held.data()[dof]) {
        const Eigen::Vector2d products(h(dof, k), j(dof, k));
        traces += products * products.transpose();
      }
    }
  }
  return traces / static_cast<double>(h.cols());
}

}  // namespace elastimate
