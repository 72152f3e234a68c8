#include "benchmarks/block_jackknife.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace elastimate {
namespace {

// The nodes of each block that has some.
std::vector<std::vector<Eigen::Index>> BlocksOf(const Mesh& mesh, int n) {
  const Eigen::Vector2d lower = mesh.nodes.rowwise().minCoeff();
  const Eigen::Vector2d size = mesh.nodes.rowwise().maxCoeff() - lower;
  std::map<int, std::vector<Eigen::Index>> by_place;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Array2i place =
        (n * (mesh.nodes.col(node) - lower).cwiseQuotient(size))
            .array()
            .floor()
            .cast<int>()
            .min(n - 1);
    by_place[n * place(0) + place(1)].push_back(node);
  }
  std::vector<std::vector<Eigen::Index>> blocks;
  blocks.reserve(by_place.size());
  for (const auto& [place, nodes] : by_place) {
    blocks.push_back(nodes);
  }
  return blocks;
}

}  // namespace

std::optional<Eigen::Vector2d> BlockJackknife(const Estimator& estimator,
                                              const Scene& scene, int n) {
  const std::vector<std::vector<Eigen::Index>> blocks = BlocksOf(scene.mesh, n);
  const auto num_blocks = static_cast<double>(blocks.size());
  Eigen::MatrixXd estimates(2, Eigen::Index(blocks.size()));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    Scene others = scene;
    for (LoadCase& load_case : others.load_cases) {
      if (load_case.observed.size() == 0) {
        load_case.observed.setConstant(2, scene.mesh.NumNodes(), true);
      }
      load_case.observed(Eigen::all, blocks[i]).setConstant(false);
    }
    const Estimate estimate = estimator.Run(others, {});
    if (!estimate.IsUsable()) {
      return std::nullopt;
    }
    estimates.col(Eigen::Index(i))
        << std::log(estimate.elasticity.youngs_modulus),
        estimate.elasticity.poisson_ratio;
  }
  const Eigen::MatrixXd changes =
      estimates.colwise() - estimates.rowwise().mean();
  return ((num_blocks - 1) / num_blocks * changes.rowwise().squaredNorm())
      .cwiseSqrt();
}

}  // namespace elastimate
