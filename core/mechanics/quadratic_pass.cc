#include "elastimate/core/mechanics/quadratic_pass.h"

#include <hwy/aligned_allocator.h>
#include <hwy/cache_control.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <new>
#include <vector>

#include "elastimate/core/laws/elasticity.h"

namespace elastimate {
namespace {

using Records = hwy::AlignedFreeUniquePtr<double[]>;

// Each thread works in one of these.
struct Workspace {
  Records records;
  std::vector<double> coefficients_of_a;
  std::vector<double> coefficients_of_p;
};

std::vector<Workspace> AllocateWorkspaces(const QuadraticMesh& mesh,
                                          Eigen::Index record_size,
                                          Eigen::Index num_coefficients) {
  const ElementBlocks& blocks = mesh.Blocks();
  // Blocks of one parity are worked on at a time.
  const Eigen::Index most_threads =
      (Eigen::Index(blocks.blocks.size()) + 1) / 2;
  std::vector<Workspace> workspaces(
      omp_in_parallel() != 0
          ? 1
          : std::min<Eigen::Index>(most_threads, omp_get_max_threads()));
  for (Workspace& workspace : workspaces) {
    workspace.records = hwy::AllocateAligned<double>(
        std::size_t(record_size * blocks.most_nodes));
    if (!workspace.records) {
      throw std::bad_alloc();
    }
    workspace.coefficients_of_a.resize(num_coefficients);
    workspace.coefficients_of_p.resize(num_coefficients);
  }
  return workspaces;
}

Eigen::Index NumElementsOfLargest(const ElementBlocks& blocks) {
  Eigen::Index most = 0;
  for (const ElementBlock& block : blocks.blocks) {
    most = std::max(most, Eigen::Index(block.end - block.first));
  }
  return most;
}

// Asks for the values of a later node.  Nodes of a mesh that was numbered again
// are scattered over a column, and without this a pass takes a sixth longer.
template <int kDimension, class Value>
void PrefetchLater(const QuadraticMesh& mesh, std::ptrdiff_t node,
                   const NodeRange& nodes, Value* values) {
  constexpr std::ptrdiff_t kNodesAhead = 32;
  if (node + kNodesAhead < nodes.end) {
    hwy::Prefetch(values + kDimension * mesh.NodeOfMesh(node + kNodesAhead));
  }
}

// Copies the values of each node of a range to the first of its record, with
// zeros behind.  Loops of a length that the compiler knows become vectors
// rather than calls.
template <int kDimension, Eigen::Index kSize>
void FillNodeRecords(const QuadraticMesh& mesh, const NodeRange& nodes,
                     const double* values, double* records) {
  for (std::ptrdiff_t i = nodes.first; i < nodes.end; ++i, records += kSize) {
    PrefetchLater<kDimension>(mesh, i, nodes, values);
    const double* const of_node = values + kDimension * mesh.NodeOfMesh(i);
    double first[kDimension];
    for (int k = 0; k < kDimension; ++k) {
      first[k] = of_node[k];
    }
    for (int k = 0; k < kDimension; ++k) {
      records[k] = first[k];
    }
    for (Eigen::Index k = kDimension; k < kSize; ++k) {
      records[k] = 0;
    }
  }
}

// Sets the rows of the nodes that are in no block of even number.
template <int kDimension>
void SetGapsToZero(const QuadraticMesh& mesh, Eigen::MatrixXd& result) {
  const std::vector<NodeRange>& gaps = mesh.Blocks().gaps;
#pragma omp parallel for schedule(dynamic) if (gaps.size() > 1)
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    for (std::ptrdiff_t i = gaps[k].first; i < gaps[k].end; ++i) {
      result.middleRows<kDimension>(kDimension * mesh.NodeOfMesh(i)).setZero();
    }
  }
}

// Blocks of even number come first to a node.
template <class Sum>
void EnterSum(const Sum& sum, bool is_first, double* result) {
  for (Eigen::Index k = 0; k < sum.size(); ++k) {
    result[k] = is_first ? sum(k) : result[k] + sum(k);
  }
}

QuadraticPass PassOver(const ElementBlock& block, const QuadraticMesh& mesh,
                       Workspace& workspace) {
  QuadraticPass pass;
  pass.elements = mesh.Element(block.first);
  pass.num_elements = block.end - block.first;
  pass.positions = mesh.Positions();
  pass.thickness = mesh.Thickness();
  pass.coefficients_of_a = workspace.coefficients_of_a.empty()
                               ? nullptr
                               : workspace.coefficients_of_a.data();
  pass.coefficients_of_p = workspace.coefficients_of_p.empty()
                               ? nullptr
                               : workspace.coefficients_of_p.data();
  pass.first_node = block.nodes.first;
  pass.records = workspace.records.get();
  return pass;
}

template <int kDimension, std::size_t kNumSums>
using Sums = std::array<Eigen::Matrix<double, kDimension, 1>, kNumSums>;

// Runs a pass over a block for one column, and enters `sums_of(record)` of each
// node in the columns of the results.
template <int kDimension, Eigen::Index kSize, std::size_t kNumSums,
          class SumsOf>
void RunBlock(const QuadraticMesh& mesh, const ElementBlock& block,
              const double* displacement, const RunPass& run,
              const SumsOf& sums_of, bool is_first, Workspace& workspace,
              const std::array<double*, kNumSums>& results) {
  FillNodeRecords<kDimension, kSize>(mesh, block.nodes, displacement,
                                     workspace.records.get());
  run(PassOver(block, mesh, workspace));
  const double* record = workspace.records.get();
  for (std::ptrdiff_t i = block.nodes.first; i < block.nodes.end;
       ++i, record += kSize) {
    const Sums<kDimension, kNumSums> sums = sums_of(record);
    for (std::size_t k = 0; k < kNumSums; ++k) {
      PrefetchLater<kDimension>(mesh, i, block.nodes, results[k]);
      EnterSum(sums[k], is_first, results[k] + kDimension * mesh.NodeOfMesh(i));
    }
  }
}

// Runs a pass for one column after the other.  Before each block,
// `prepare(block, workspace)` sets the coefficients.
template <int kDimension, Eigen::Index kSize, std::size_t kNumSums,
          class Prepare, class SumsOf>
void RunInBlocks(const QuadraticMesh& mesh, const Eigen::MatrixXd& displacement,
                 const RunPass& run, std::vector<Workspace>& workspaces,
                 const Prepare& prepare, const SumsOf& sums_of,
                 const std::array<Eigen::MatrixXd*, kNumSums>& results) {
  const std::vector<ElementBlock>& blocks = mesh.Blocks().blocks;
  const auto num_blocks = std::ptrdiff_t(blocks.size());
  for (Eigen::MatrixXd* const result : results) {
    result->resize(displacement.rows(), displacement.cols());
    SetGapsToZero<kDimension>(mesh, *result);
  }
  for (Eigen::Index column = 0; column < displacement.cols(); ++column) {
    std::array<double*, kNumSums> columns;
    for (std::size_t k = 0; k < kNumSums; ++k) {
      columns[k] = results[k]->col(column).data();
    }
    for (const std::ptrdiff_t parity : {0, 1}) {
#pragma omp parallel for num_threads(int(workspaces.size())) \
    schedule(dynamic) if (workspaces.size() > 1)
      for (std::ptrdiff_t b = parity; b < num_blocks; b += 2) {
        Workspace& workspace =
            workspaces[workspaces.size() > 1 ? omp_get_thread_num() : 0];
        prepare(blocks[b], workspace);
        RunBlock<kDimension, kSize>(mesh, blocks[b],
                                    displacement.col(column).data(), run,
                                    sums_of, parity == 0, workspace, columns);
      }
    }
  }
}

template <int kDimension>
void SetProducts(const QuadraticMesh& mesh, const Eigen::MatrixXd& displacement,
                 const RunPass& run, StiffnessProducts& products) {
  const double share = ShearShareOfJ(mesh.Model());
  std::vector<Workspace> workspaces =
      AllocateWorkspaces(mesh, kSizeForProducts, 0);
  RunInBlocks<kDimension, kSizeForProducts, 2>(
      mesh, displacement, run, workspaces,
      [](const ElementBlock&, const Workspace&) {},
      [share](const double* record) -> Sums<kDimension, 2> {
        using Sum = Eigen::Map<const Eigen::Matrix<double, kDimension, 1>>;
        const Sum a(record + kFour);
        return {a, Sum(record + 2 * kFour) - share * a};
      },
      {&products.h, &products.j});
}

template <int kDimension>
Eigen::MatrixXd SumOf(const QuadraticMesh& mesh,
                      const Eigen::Matrix2Xd& coefficients,
                      const Eigen::MatrixXd& displacement, const RunPass& run) {
  // J q = p - share a.
  const double share = ShearShareOfJ(mesh.Model());
  std::vector<Workspace> workspaces = AllocateWorkspaces(
      mesh, kSizeForSum, NumElementsOfLargest(mesh.Blocks()) + kMostLanes);
  assert(coefficients.cols() == mesh.NumElements());
  Eigen::MatrixXd forces;
  RunInBlocks<kDimension, kSizeForSum, 1>(
      mesh, displacement, run, workspaces,
      [&](const ElementBlock& block, Workspace& workspace) {
        for (std::ptrdiff_t e = block.first; e < block.end; ++e) {
          const auto of_element = coefficients.col(mesh.ElementOfMesh(e));
          workspace.coefficients_of_a[e - block.first] =
              of_element(0) - share * of_element(1);
          workspace.coefficients_of_p[e - block.first] = of_element(1);
        }
        // Lanes behind the last element multiply these by a mass of zero.
        const auto end = std::size_t(block.end - block.first);
        std::fill_n(&workspace.coefficients_of_a[end], kMostLanes, 0.0);
        std::fill_n(&workspace.coefficients_of_p[end], kMostLanes, 0.0);
      },
      [](const double* record) -> Sums<kDimension, 1> {
        return {Eigen::Map<const Eigen::Matrix<double, kDimension, 1>>(record +
                                                                       kFour)};
      },
      {&forces});
  return forces;
}

}  // namespace

void MultiplyByPass(const QuadraticMesh& mesh,
                    const Eigen::MatrixXd& displacement, const RunPass& run,
                    StiffnessProducts& products) {
  if (mesh.Dimension() == 3) {
    SetProducts<3>(mesh, displacement, run, products);
  } else {
    SetProducts<2>(mesh, displacement, run, products);
  }
}

Eigen::MatrixXd MultiplyByPass(const QuadraticMesh& mesh,
                               const Eigen::Matrix2Xd& coefficients,
                               const Eigen::MatrixXd& displacement,
                               const RunPass& run) {
  return mesh.Dimension() == 3
             ? SumOf<3>(mesh, coefficients, displacement, run)
             : SumOf<2>(mesh, coefficients, displacement, run);
}

}  // namespace elastimate
