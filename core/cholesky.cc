#include "elastimate/core/cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <cassert>
#include <new>
#include <type_traits>
#include <vector>

namespace elastimate {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

// The smallest ratio of pivots (a cheap condition estimate) with which a
// solution still has correct digits.
constexpr double kSmallestPivotRatio = 1e-15;

// A view of our arrays as a symmetric matrix of which the lower triangle is
// stored; CHOLMOD does not write to it.
cholmod_sparse SymmetricView(const std::int64_t* column_start,
                             const std::int64_t* row, const double* values,
                             std::size_t size, std::size_t num_values) {
  cholmod_sparse view{};
  view.nrow = size;
  view.ncol = size;
  view.nzmax = num_values;
  view.p = const_cast<std::int64_t*>(column_start);
  view.i = const_cast<std::int64_t*>(row);
  view.x = const_cast<double*>(values);
  view.stype = -1;
  view.itype = CHOLMOD_LONG;
  view.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

void ThrowIfOutOfMemory(const cholmod_common& common) {
  if (common.status == CHOLMOD_OUT_OF_MEMORY ||
      common.status == CHOLMOD_TOO_LARGE) {
    throw std::bad_alloc();
  }
}

// Nested dissection of the graph of the nodes, as an ordering of the free
// degrees of freedom.
std::vector<std::int64_t> NestedDissection(
    const NodeGraph& graph, const DegreesOfFreedom& degrees_of_freedom,
    cholmod_common* common) {
  const std::size_t num_nodes = graph.start.size() - 1;
  const std::vector<std::int64_t> start(graph.start.begin(), graph.start.end());
  const std::vector<std::int64_t> row(graph.row.begin(), graph.row.end());
  cholmod_sparse pattern =
      SymmetricView(start.data(), row.data(), nullptr, num_nodes, row.size());
  std::vector<SuiteSparse_long> node_order(num_nodes);
  if (cholmod_l_metis(&pattern, nullptr, 0, 1, node_order.data(), common) ==
      0) {
    ThrowIfOutOfMemory(*common);
    assert(false && "cholmod_l_metis refused the graph");
  }
  std::vector<std::int64_t> order;
  order.reserve(degrees_of_freedom.NumFree());
  for (const SuiteSparse_long node : node_order) {
    for (int i = 0; i < 3; ++i) {
      if (degrees_of_freedom.place[3 * node + i] >= 0) {
        order.push_back(degrees_of_freedom.place[3 * node + i]);
      }
    }
  }
  return order;
}

}  // namespace

struct Cholesky::Workspace {
  const SymmetricPattern& pattern;
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  double factorization_flops = 0;
  cholmod_dense* solution = nullptr;
  cholmod_dense* forward = nullptr;
  cholmod_dense* permuted = nullptr;

  explicit Workspace(const SymmetricPattern& symmetric_pattern)
      : pattern(symmetric_pattern) {
    cholmod_l_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.quick_return_if_not_posdef = 1;
  }
  ~Workspace() {
    cholmod_l_free_dense(&solution, &common);
    cholmod_l_free_dense(&forward, &common);
    cholmod_l_free_dense(&permuted, &common);
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  cholmod_sparse Matrix(const double* values) const {
    return SymmetricView(pattern.column_start.data(), pattern.row.data(),
                         values, pattern.Size(), pattern.row.size());
  }
};

Cholesky::Cholesky(const StiffnessAssembly& assembly,
                   const DegreesOfFreedom& degrees_of_freedom)
    : workspace_(std::make_unique<Workspace>(assembly.Pattern())) {
  cholmod_common* common = &workspace_->common;
  std::vector<std::int64_t> order =
      NestedDissection(assembly.Graph(), degrees_of_freedom, common);
  common->nmethods = 1;
  common->method[0].ordering = CHOLMOD_GIVEN;
  common->postorder = 1;
  cholmod_sparse matrix = workspace_->Matrix(nullptr);
  workspace_->factor =
      cholmod_l_analyze_p(&matrix, order.data(), nullptr, 0, common);
  ThrowIfOutOfMemory(*common);
  assert(workspace_->factor != nullptr);
  workspace_->factorization_flops = common->fl;
}

Cholesky::~Cholesky() = default;

bool Cholesky::Factorize(const Eigen::VectorXd& values) {
  cholmod_common* common = &workspace_->common;
  cholmod_sparse matrix = workspace_->Matrix(values.data());
  if (!values.allFinite()) {
    return false;
  }
  cholmod_l_factorize(&matrix, workspace_->factor, common);
  ThrowIfOutOfMemory(*common);
  return common->status == CHOLMOD_OK &&
         cholmod_l_rcond(workspace_->factor, common) > kSmallestPivotRatio;
}

std::optional<Eigen::MatrixXd> Cholesky::Solve(
    const Eigen::MatrixXd& right_hand_sides, double /*tolerance*/) {
  if (right_hand_sides.cols() == 0) {
    return right_hand_sides;  // CHOLMOD refuses.
  }
  cholmod_common* common = &workspace_->common;
  cholmod_dense view{};
  view.nrow = right_hand_sides.rows();
  view.ncol = right_hand_sides.cols();
  view.nzmax = right_hand_sides.size();
  view.d = view.nrow;
  view.x = const_cast<double*>(right_hand_sides.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  if (cholmod_l_solve2(CHOLMOD_A, workspace_->factor, &view, nullptr,
                       &workspace_->solution, nullptr, &workspace_->forward,
                       &workspace_->permuted, common) == 0) {
    ThrowIfOutOfMemory(*common);
    assert(false && "cholmod_l_solve2 refused the right-hand sides");
  }
  return Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(workspace_->solution->x),
      right_hand_sides.rows(), right_hand_sides.cols());
}

double Cholesky::FactorizationFlops() const {
  return workspace_->factorization_flops;
}

double Cholesky::FactorValues() const {
  return static_cast<double>(workspace_->factor->xsize);
}

}  // namespace elastimate
