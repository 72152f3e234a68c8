#include "elastimate/core/solvers/cholesky.h"

#include <cholmod.h>
#include <omp.h>

#include <Eigen/SparseCore>
#include <cassert>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/solvers/cholmod_view.h"
#include "elastimate/core/solvers/nested_dissection.h"
#include "elastimate/core/solvers/permuted_matrix.h"

// Returns 2 if OpenBLAS has threads of OpenMP; null for another BLAS.
extern "C" [[gnu::weak]] int openblas_get_parallel();

namespace elastimate {
namespace {

// CHOLMOD asks for four threads of OpenMP in a small loop for each supernode,
// however many processors there are, and waking them takes longer than the
// loops do.  While this lives, the loops of the calling thread have one.  It
// does nothing where the threads of BLAS may be those of OpenMP, since dense
// products need them.
class OneThreadInLoops {
 public:
  OneThreadInLoops() {
    constexpr int kOpenMp = 2;
    if (openblas_get_parallel != nullptr &&
        openblas_get_parallel() != kOpenMp) {
      levels_ = omp_get_max_active_levels();
      omp_set_max_active_levels(0);
    }
  }
  ~OneThreadInLoops() {
    if (levels_) {
      omp_set_max_active_levels(*levels_);
    }
  }
  OneThreadInLoops(const OneThreadInLoops&) = delete;
  OneThreadInLoops& operator=(const OneThreadInLoops&) = delete;

 private:
  std::optional<int> levels_;
};

// Ratios of pivots (a cheap condition estimate): below the first a solution has
// no correct digit, below the second rounding may have made the smallest pivot,
// which one solution tells.
constexpr double kSmallestPivotRatio = 1e-15;
constexpr double kSuspiciousPivotRatio = 1e-9;

// Orders the free degrees of freedom by nodes.
std::vector<std::int64_t> OrderOfDofs(
    const NodeGraph& graph, const DegreesOfFreedom& degrees_of_freedom) {
  std::vector<std::int64_t> order;
  order.reserve(degrees_of_freedom.NumFree());
  for (const std::int64_t node :
       NestedDissection({graph.start.begin(), graph.start.end()},
                        {graph.row.begin(), graph.row.end()})) {
    for (int i = 0; i < degrees_of_freedom.dimension; ++i) {
      const Eigen::Index place =
          degrees_of_freedom.place[degrees_of_freedom.dimension * node + i];
      if (place >= 0) {
        order.push_back(place);
      }
    }
  }
  return order;
}

}  // namespace

struct Cholesky::Workspace {
  const SymmetricPattern& pattern;
  PermutedMatrix permuted_matrix;
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
};

Cholesky::Cholesky(const StiffnessAssembly& assembly,
                   const DegreesOfFreedom& degrees_of_freedom)
    : workspace_(std::make_unique<Workspace>(assembly.Pattern())) {
  cholmod_common* common = &workspace_->common;
  std::vector<std::int64_t> order =
      OrderOfDofs(assembly.Graph(), degrees_of_freedom);
  common->nmethods = 1;
  common->method[0].ordering = CHOLMOD_GIVEN;
  common->postorder = 1;
  const SymmetricPattern& pattern = assembly.Pattern();
  cholmod_sparse matrix =
      SymmetricView(pattern.column_start, pattern.row, nullptr);
  workspace_->factor =
      cholmod_l_analyze_p(&matrix, order.data(), nullptr, 0, common);
  ThrowIfOutOfMemory(*common);
  assert(workspace_->factor != nullptr);
  workspace_->factorization_flops = common->fl;
  workspace_->permuted_matrix = {
      pattern, static_cast<const std::int64_t*>(workspace_->factor->Perm)};
}

Cholesky::~Cholesky() = default;

bool Cholesky::Factorize(const Eigen::VectorXd& values) {
  cholmod_common* common = &workspace_->common;
  if (!values.allFinite()) {
    return false;
  }
  // cholmod_l_factorize would transpose the matrix twice to permute it, which
  // takes half of the time of a factorisation on a small mesh.
  PermutedMatrix& permuted = workspace_->permuted_matrix;
  cholmod_sparse matrix =
      SymmetricView(permuted.Pattern().column_start, permuted.Pattern().row,
                    permuted.ValuesFrom(values).data());
  matrix.sorted = 0;
  {
    const OneThreadInLoops one_thread;
    double no_shift[2] = {0, 0};
    cholmod_l_super_numeric(&matrix, nullptr, no_shift, workspace_->factor,
                            common);
  }
  ThrowIfOutOfMemory(*common);
  if (common->status != CHOLMOD_OK) {
    return false;
  }
  const double pivot_ratio = cholmod_l_rcond(workspace_->factor, common);
  return pivot_ratio > kSuspiciousPivotRatio ||
         (pivot_ratio > kSmallestPivotRatio && FactorHasTheEnergyOf(values));
}

// Where rounding has made the smallest pivot, the solution x for nearly any
// right-hand side b is a motion that the matrix does not resist, and x^T A x is
// not x^T b.
bool Cholesky::FactorHasTheEnergyOf(const Eigen::VectorXd& values) {
  constexpr double kLargestError = 0.1;
  const SymmetricPattern& pattern = workspace_->pattern;
  std::mt19937_64 generator(20071107);
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(
      pattern.Size(), [&] { return (generator() & 1U) != 0 ? 1.0 : -1.0; });
  const Eigen::VectorXd x = *Solve(b, 0, {});
  const Eigen::Map<
      const Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>>
      matrix(pattern.Size(), pattern.Size(), values.size(),
             pattern.column_start.data(), pattern.row.data(), values.data());
  const double energy =
      InnerProduct(x, matrix.selfadjointView<Eigen::Lower>() * x);
  const double work = InnerProduct(x, b);
  return std::abs(energy - work) <= kLargestError * work;
}

std::optional<Eigen::MatrixXd> Cholesky::Solve(
    const Eigen::MatrixXd& right_hand_sides, double /*tolerance*/,
    const Eigen::MatrixXd& /*start*/) {
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
