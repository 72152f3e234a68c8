#include "elastimate/core/mechanics/stiffness_traces.h"

#include <cstdint>
#include <random>

#include "elastimate/core/mechanics/gradient_products.h"

namespace elastimate {

namespace {

template <int kDimension>
Eigen::Matrix2d TracesOfDimension(const Mesh& mesh,
                                  const DegreesOfFreedom& degrees_of_freedom) {
  using Block = NodeBlock<kDimension>;
  const NodeGraph graph(mesh);
  const Eigen::MatrixXd products = GradientProducts(mesh, graph);
  const double shear_share = ShearShareOfJ(mesh.section.model);
  const auto free = [&](Eigen::Index node) {
    Eigen::Matrix<double, kDimension, 1> mask;
    for (int i = 0; i < kDimension; ++i) {
      mask(i) = degrees_of_freedom.place[kDimension * node + i] >= 0 ? 1 : 0;
    }
    return mask;
  };
  Eigen::Matrix2d traces = Eigen::Matrix2d::Zero();
  for (Eigen::Index j = 0; j < mesh.NumNodes(); ++j) {
    const auto free_j = free(j);
    for (Eigen::Index k = graph.start[j]; k < graph.start[j + 1]; ++k) {
      const int i = graph.row[k];
      const Block mask = free(i) * free_j.transpose();
      const Block m = products.block<kDimension, kDimension>(0, kDimension * k);
      const Block block_h = StiffnessBlockH<kDimension>(m).cwiseProduct(mask);
      const Block block_j =
          StiffnessBlockJ<kDimension>(m, shear_share).cwiseProduct(mask);
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

}  // namespace

Eigen::Matrix2d StiffnessTraces(const Mesh& mesh,
                                const DegreesOfFreedom& degrees_of_freedom) {
  return mesh.Dimension() == 3 ? TracesOfDimension<3>(mesh, degrees_of_freedom)
                               : TracesOfDimension<2>(mesh, degrees_of_freedom);
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
