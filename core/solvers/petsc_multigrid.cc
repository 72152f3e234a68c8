#include "elastimate/core/solvers/petsc_multigrid.h"

#include <petscksp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <vector>

#ifdef ELASTIMATE_HAS_ML
// ml_utils.h declares this function, but would bring in all of Trilinos.
extern "C" void ML_set_random_seed(int seed);
#endif

namespace elastimate {
namespace {

constexpr int kMostIterations = 500;
// The iterations stop by the norm sqrt(r^T B r) for the preconditioner B.
// Where B is A^-1, this is the energy norm of the error; in soft modes that B
// lacks, it is smaller.  Such modes show as small eigenvalues of B A when the
// iterations go on, and the effect of these on the norm is checked then.
constexpr double kStricter = 1e-3;

// An error of PETSc other than a lack of memory.
struct PetscFailure {};

void Check(PetscErrorCode error) {
  if (error == PETSC_ERR_MEM) {
    throw std::bad_alloc();
  }
  if (error != 0) {
    throw PetscFailure();
  }
}

// PETSc keeps global state, which two threads must not enter at once.
std::mutex& PetscMutex() {
  static std::mutex mutex;
  return mutex;
}

// Trilinos' ML aggregates every mesh well, in a tenth of the time of GAMG of
// PETSc 3.18, which coarsens meshes with nodes of few neighbours by two only.
// Chebyshev smoothing is symmetric, and twice as fast as SOR.  Its largest
// eigenvalue is estimated by GMRES.  PETSc would take conjugate gradients,
// which end early where a matrix is not positive definite; PETSc then reads
// numbers that nothing has set, and with some of them it never ends.
constexpr char kOptions[] =
    "-elastimate_ksp_type cg -elastimate_ksp_norm_type natural "
#ifdef ELASTIMATE_HAS_ML
    "-elastimate_pc_type ml "
#else
    "-elastimate_pc_type gamg "
#endif
    "-elastimate_mg_levels_ksp_type chebyshev "
    "-elastimate_mg_levels_ksp_max_it 2 "
    "-elastimate_mg_levels_esteig_ksp_type gmres "
    "-elastimate_mg_levels_pc_type jacobi";

bool IsPetscRunning() {
  PetscBool is_running = PETSC_FALSE;
  PetscInitialized(&is_running);
  return is_running == PETSC_TRUE;
}

// While an object of this class lives, no other thread is in PETSc, PETSc
// writes no errors, and the options above hold instead of the program's.
class UseOfPetsc {
 public:
  UseOfPetsc() : lock_(PetscMutex()) {
    if (!IsPetscRunning()) {
      throw PetscFailure();
    }
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
    PetscOptionsCreate(&options_);
    PetscOptionsInsertString(options_, kOptions);
    PetscOptionsPush(options_);
  }
  ~UseOfPetsc() {
    PetscOptionsPop();
    PetscOptionsDestroy(&options_);
    PetscPopErrorHandler();
  }
  UseOfPetsc(const UseOfPetsc&) = delete;
  UseOfPetsc& operator=(const UseOfPetsc&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
  PetscOptions options_ = nullptr;
};

}  // namespace

// Multigrid needs blocks of equal size, so the matrix has all components of
// each node that has a free one.  Where a component is held, its row has only a
// diagonal entry, of the size of the others of its node.
struct PetscMultigrid::Workspace {
  const StiffnessAssembly& assembly;
  const DegreesOfFreedom& degrees_of_freedom;
  int dimension;
  /// The block of each node, -1 when it has no free component.
  std::vector<int> block;
  int num_blocks = 0;
  /// The row of the matrix for each free degree of freedom.
  std::vector<PetscInt> row_of_free;
  /// The rows of blocks, compressed, columns ascending.
  std::vector<PetscInt> block_start;
  std::vector<PetscInt> row_start;
  std::vector<PetscInt> column;
  std::vector<double> entries;  ///< The entries of the matrix.
  Mat matrix = nullptr;
  Vec right_hand_side = nullptr;
  Vec solution = nullptr;
  KSP solver = nullptr;
  /// False when PETSc failed before there was a matrix to set up.
  bool is_ready = false;
  int num_iterations = 0;

  Workspace(const StiffnessAssembly& stiffness, const DegreesOfFreedom& dofs)
      : assembly(stiffness),
        degrees_of_freedom(dofs),
        dimension(dofs.dimension) {}
  ~Workspace() {
    const std::lock_guard lock(PetscMutex());
    if (!IsPetscRunning()) {
      return;  // It never was, or this is an object of static lifetime.
    }
    KSPDestroy(&solver);
    VecDestroy(&right_hand_side);
    VecDestroy(&solution);
    MatDestroy(&matrix);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  void NumberBlocks();
  void BuildPattern();
  /// Finds the rows of numbers for the rows of blocks that have these columns.
  void ExpandBlocks(const std::vector<int>& block_column);
  void Fill(const Eigen::VectorXd& values, double* entries) const;
  void SetNearNullSpace(const Mesh& mesh);
  void CreateSolver(const Mesh& mesh);
  /// Bounds the energy error of the last solution, relative to the solution:
  /// ||e||_A^2 = r^T A^-1 r is at most r^T B r / (smallest eigenvalue of B A).
  double EnergyErrorBound(PetscInt iterations) const;
};

double PetscMultigrid::Workspace::EnergyErrorBound(PetscInt iterations) const {
  if (iterations == 0) {
    return 0;  // Of no force.
  }
  double norm = 0;
  double largest = 0;
  double smallest = 0;
  double energy = 0;
  Check(KSPGetResidualNorm(solver, &norm));
  Check(KSPComputeExtremeSingularValues(solver, &largest, &smallest));
  Check(VecDot(right_hand_side, solution, &energy));
  return norm / std::sqrt(smallest * energy);
}

void PetscMultigrid::Workspace::NumberBlocks() {
  block.assign(assembly.Graph().start.size() - 1, -1);
  row_of_free.reserve(degrees_of_freedom.NumFree());
  for (const Eigen::Index dof : degrees_of_freedom.free) {
    int& of_node = block[dof / dimension];
    if (of_node < 0) {
      of_node = num_blocks++;
    }
    row_of_free.push_back(dimension * of_node +
                          static_cast<int>(dof % dimension));
  }
}

void PetscMultigrid::Workspace::BuildPattern() {
  NumberBlocks();
  const NodeGraph& graph = assembly.Graph();
  const auto num_nodes = Eigen::Index(graph.start.size()) - 1;
  const auto for_pairs = [&](const auto& visit) {
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
        if (block[node] >= 0 && block[graph.row[k]] >= 0) {
          visit(block[node], block[graph.row[k]]);
        }
      }
    }
  };
  std::vector<Eigen::Index> count(num_blocks, 0);
  Eigen::Index num_entries = 0;
  for_pairs([&](int a, int b) {
    ++count[a];
    count[b] += a != b;
    num_entries += (a != b ? 2 : 1) * Eigen::Index{dimension} * dimension;
  });
  if (num_entries > std::numeric_limits<PetscInt>::max()) {
    throw std::bad_alloc();
  }
  block_start.assign(1, 0);
  for (const Eigen::Index n : count) {
    block_start.push_back(block_start.back() + static_cast<PetscInt>(n));
  }
  std::vector<int> neighbour(block_start.back());
  std::vector<PetscInt> next(block_start.begin(), block_start.end() - 1);
  // Column a is entered into the rows b > a before row b gets its diagonal.
  for_pairs([&](int a, int b) {
    neighbour[next[a]++] = b;
    if (a != b) {
      neighbour[next[b]++] = a;
    }
  });
  column.reserve(num_entries);
  ExpandBlocks(neighbour);
  entries.resize(num_entries);
}

void PetscMultigrid::Workspace::ExpandBlocks(
    const std::vector<int>& block_column) {
  row_start.assign(1, 0);
  for (int a = 0; a < num_blocks; ++a) {
    for (int i = 0; i < dimension; ++i) {
      for (PetscInt k = block_start[a]; k < block_start[a + 1]; ++k) {
        for (int j = 0; j < dimension; ++j) {
          column.push_back(dimension * block_column[k] + j);
        }
      }
      row_start.push_back(static_cast<PetscInt>(column.size()));
    }
  }
}

void PetscMultigrid::Workspace::Fill(const Eigen::VectorXd& values,
                                     double* entries) const {
  const NodeGraph& graph = assembly.Graph();
  const auto num_nodes = Eigen::Index(graph.start.size()) - 1;
  std::fill_n(entries, column.size(), 0);
  const auto is_free = [&](Eigen::Index node, int component) {
    return degrees_of_freedom.place[dimension * node + component] >= 0;
  };
  // Returns entry (i, j) of the k-th block of a row of blocks.
  const auto entry = [&](int a, PetscInt k, int i, int j) -> double& {
    return entries[row_start[dimension * a + i] +
                   dimension * (k - block_start[a]) + j];
  };
  std::vector<PetscInt> next(block_start.begin(), block_start.end() - 1);
  const double* value = values.data();
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    const int a = block[node];
    if (a < 0) {
      continue;
    }
    const PetscInt diagonal = next[a];
    double scale = 0;
    for (int j = 0; j < dimension; ++j) {
      if (!is_free(node, j)) {
        continue;
      }
      PetscInt own = diagonal;
      for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
        const int row = graph.row[k];
        const int b = block[row];
        if (b < 0) {
          continue;
        }
        for (int i = b == a ? j : 0; i < dimension; ++i) {
          if (is_free(row, i)) {
            entry(a, own, j, i) = *value;
            entry(b, b == a ? own : next[b], i, j) = *value;
            ++value;
          }
        }
        ++own;
      }
      scale = std::max(scale, entry(a, diagonal, j, j));
    }
    for (int j = 0; j < dimension; ++j) {
      if (!is_free(node, j)) {
        entry(a, diagonal, j, j) = scale;
      }
    }
    for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
      const int b = block[graph.row[k]];
      if (b >= 0 && b != a) {
        ++next[b];
      }
    }
  }
}

// Makes the modes that a coarse mesh must represent as well as a fine one.
void PetscMultigrid::Workspace::SetNearNullSpace(const Mesh& mesh) {
  Vec positions = nullptr;
  Check(VecDuplicate(solution, &positions));
  double* values = nullptr;
  Check(VecGetArray(positions, &values));
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (block[node] >= 0) {
      Eigen::VectorXd::Map(values + Eigen::Index{dimension} * block[node],
                           dimension) = mesh.nodes.col(node);
    }
  }
  Check(VecRestoreArray(positions, &values));
  MatNullSpace rigid_motions = nullptr;
  Check(MatNullSpaceCreateRigidBody(positions, &rigid_motions));
  Check(MatSetNearNullSpace(matrix, rigid_motions));
  Check(MatNullSpaceDestroy(&rigid_motions));
  Check(VecDestroy(&positions));
}

void PetscMultigrid::Workspace::CreateSolver(const Mesh& mesh) {
  const PetscInt size = dimension * num_blocks;
  Check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, size, size, row_start.data(),
                                  column.data(), entries.data(), &matrix));
  Check(MatSetBlockSize(matrix, dimension));
  Check(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  Check(MatCreateVecs(matrix, &solution, &right_hand_side));
  SetNearNullSpace(mesh);
  Check(KSPCreate(PETSC_COMM_SELF, &solver));
  Check(KSPSetOptionsPrefix(solver, "elastimate_"));
  Check(KSPSetComputeSingularValues(solver, PETSC_TRUE));
  Check(KSPSetFromOptions(solver));
}

PetscMultigrid::PetscMultigrid(const Mesh& mesh,
                               const StiffnessAssembly& assembly,
                               const DegreesOfFreedom& degrees_of_freedom)
    : workspace_(std::make_unique<Workspace>(assembly, degrees_of_freedom)) {
  try {
    const UseOfPetsc use;
    workspace_->BuildPattern();
    workspace_->CreateSolver(mesh);
    workspace_->is_ready = true;
  } catch (const PetscFailure&) {
    // Factorize tells.
  }
}

PetscMultigrid::~PetscMultigrid() = default;

bool PetscMultigrid::Factorize(const Eigen::VectorXd& values) {
  if (!workspace_->is_ready || !values.allFinite()) {
    return false;
  }
  Workspace& work = *workspace_;
  try {
    const UseOfPetsc use;
    double* entries = nullptr;
    Check(MatSeqAIJGetArray(work.matrix, &entries));
    work.Fill(values, entries);
    Check(MatSeqAIJRestoreArray(work.matrix, &entries));
#ifdef ELASTIMATE_HAS_ML
    // The estimates of largest eigenvalues start from random vectors.
    ML_set_random_seed(1);
#endif
    Check(KSPSetOperators(work.solver, work.matrix, work.matrix));
    Check(KSPSetUp(work.solver));
  } catch (const PetscFailure&) {
    return false;
  }
  return true;
}

std::optional<Eigen::MatrixXd> PetscMultigrid::Solve(
    const Eigen::MatrixXd& right_hand_sides, double tolerance) {
  Workspace& work = *workspace_;
  Eigen::MatrixXd solutions(right_hand_sides.rows(), right_hand_sides.cols());
  try {
    const UseOfPetsc use;
    constexpr double kNoMatterTheUnits = 0;
    Check(KSPSetTolerances(work.solver, kStricter * tolerance,
                           kNoMatterTheUnits, PETSC_DEFAULT, kMostIterations));
    for (Eigen::Index column = 0; column < right_hand_sides.cols(); ++column) {
      double* values = nullptr;
      Check(VecSet(work.right_hand_side, 0));
      Check(VecGetArray(work.right_hand_side, &values));
      for (Eigen::Index i = 0; i < right_hand_sides.rows(); ++i) {
        values[work.row_of_free[i]] = right_hand_sides(i, column);
      }
      Check(VecRestoreArray(work.right_hand_side, &values));
      Check(KSPSolve(work.solver, work.right_hand_side, work.solution));
      PetscInt iterations = 0;
      Check(KSPGetIterationNumber(work.solver, &iterations));
      work.num_iterations += iterations;
      KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
      Check(KSPGetConvergedReason(work.solver, &reason));
      if (reason < 0) {
        return std::nullopt;
      }
      const double* solution = nullptr;
      Check(VecGetArrayRead(work.solution, &solution));
      for (Eigen::Index i = 0; i < right_hand_sides.rows(); ++i) {
        solutions(i, column) = solution[work.row_of_free[i]];
      }
      Check(VecRestoreArrayRead(work.solution, &solution));
      if (!(work.EnergyErrorBound(iterations) <= tolerance)) {
        return std::nullopt;
      }
    }
  } catch (const PetscFailure&) {
    return std::nullopt;
  }
  return solutions;
}

int PetscMultigrid::NumIterations() const { return workspace_->num_iterations; }

}  // namespace elastimate

elastimate::LinearSolver* elastimate_make_multigrid(
    const elastimate::Mesh& mesh, const elastimate::StiffnessAssembly& assembly,
    const elastimate::DegreesOfFreedom& degrees_of_freedom) {
  return new elastimate::PetscMultigrid(mesh, assembly, degrees_of_freedom);
}

bool elastimate_is_petsc_running() { return elastimate::IsPetscRunning(); }
