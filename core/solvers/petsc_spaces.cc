#include "elastimate/core/solvers/petsc_spaces.h"

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

#include "elastimate/core/solvers/free_memory.h"

#ifdef ELASTIMATE_HAS_ML
// ml_utils.h declares this function, but would bring in all of Trilinos.
extern "C" void ML_set_random_seed(int seed);
#endif

namespace elastimate {
namespace {

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

// Only the spaces are PETSc's: nothing smooths or solves here.  GAMG estimates
// largest eigenvalues by GMRES.  PETSc would take conjugate gradients, which
// end early where a matrix is not positive definite; PETSc then reads numbers
// that nothing has set, and with some of them it never ends.
constexpr char kOptions[] =
    "-elastimate_pc_gamg_esteig_ksp_type gmres "
    "-elastimate_mg_levels_ksp_type richardson "
    "-elastimate_mg_levels_pc_type none "
    "-elastimate_mg_coarse_ksp_type richardson "
    "-elastimate_mg_coarse_pc_type none";

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

// Multigrid needs blocks of equal size, so the matrix has all components of
// each node that has a free one.  Where a component is held, its row has only a
// diagonal entry, of the size of the others of its node.
class PetscMatrix {
 public:
  PetscMatrix(const StiffnessAssembly& assembly,
              const DegreesOfFreedom& degrees_of_freedom);
  ~PetscMatrix() {
    PCDestroy(&preconditioner_);
    MatDestroy(&matrix_);
  }
  PetscMatrix(const PetscMatrix&) = delete;
  PetscMatrix& operator=(const PetscMatrix&) = delete;

  void SetValues(const Eigen::VectorXd& values);
  MultigridSpaces FindSpaces(const Mesh& mesh);

 private:
  /// Appends the matrices of all spaces but the finest, and all interpolations.
  void AppendCoarseSpaces(MultigridSpaces& spaces) const;
  void NumberBlocks();
  void BuildPattern();
  /// Finds the rows of numbers for the rows of blocks that have these columns.
  void ExpandBlocks(const std::vector<int>& block_column);
  void Create();
  void SetNearNullSpace(const Mesh& mesh);
  PCType Preconditioner(const Mesh& mesh) const;

  const StiffnessAssembly& assembly_;
  const DegreesOfFreedom& degrees_of_freedom_;
  int dimension_;
  /// The block of each node, -1 when it has no free component.
  std::vector<int> block_;
  int num_blocks_ = 0;
  /// The row of the matrix for each free degree of freedom.
  std::vector<int> row_of_free_;
  /// The rows of blocks, compressed, columns ascending.
  std::vector<PetscInt> block_start_;
  std::vector<PetscInt> row_start_;
  std::vector<PetscInt> column_;
  std::vector<double> entries_;  ///< The entries of the matrix.
  Mat matrix_ = nullptr;
  PC preconditioner_ = nullptr;
};

PetscMatrix::PetscMatrix(const StiffnessAssembly& assembly,
                         const DegreesOfFreedom& degrees_of_freedom)
    : assembly_(assembly),
      degrees_of_freedom_(degrees_of_freedom),
      dimension_(degrees_of_freedom.dimension) {
  BuildPattern();
}

void PetscMatrix::NumberBlocks() {
  block_.assign(assembly_.Graph().start.size() - 1, -1);
  row_of_free_.reserve(degrees_of_freedom_.NumFree());
  for (const Eigen::Index dof : degrees_of_freedom_.free) {
    int& of_node = block_[dof / dimension_];
    if (of_node < 0) {
      of_node = num_blocks_++;
    }
    row_of_free_.push_back(dimension_ * of_node +
                           static_cast<int>(dof % dimension_));
  }
}

void PetscMatrix::BuildPattern() {
  NumberBlocks();
  const NodeGraph& graph = assembly_.Graph();
  const auto num_nodes = Eigen::Index(graph.start.size()) - 1;
  const auto for_pairs = [&](const auto& visit) {
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
        if (block_[node] >= 0 && block_[graph.row[k]] >= 0) {
          visit(block_[node], block_[graph.row[k]]);
        }
      }
    }
  };
  std::vector<Eigen::Index> count(num_blocks_, 0);
  Eigen::Index num_entries = 0;
  for_pairs([&](int a, int b) {
    ++count[a];
    count[b] += a != b;
    num_entries += (a != b ? 2 : 1) * Eigen::Index{dimension_} * dimension_;
  });
  if (num_entries > std::numeric_limits<PetscInt>::max()) {
    throw std::bad_alloc();
  }
  block_start_.assign(1, 0);
  for (const Eigen::Index n : count) {
    block_start_.push_back(block_start_.back() + static_cast<PetscInt>(n));
  }
  std::vector<int> neighbour(block_start_.back());
  std::vector<PetscInt> next(block_start_.begin(), block_start_.end() - 1);
  // Column a is entered into the rows b > a before row b gets its diagonal.
  for_pairs([&](int a, int b) {
    neighbour[next[a]++] = b;
    if (a != b) {
      neighbour[next[b]++] = a;
    }
  });
  column_.reserve(num_entries);
  ExpandBlocks(neighbour);
  entries_.resize(num_entries);
}

void PetscMatrix::ExpandBlocks(const std::vector<int>& block_column) {
  row_start_.assign(1, 0);
  for (int a = 0; a < num_blocks_; ++a) {
    for (int i = 0; i < dimension_; ++i) {
      for (PetscInt k = block_start_[a]; k < block_start_[a + 1]; ++k) {
        for (int j = 0; j < dimension_; ++j) {
          column_.push_back(dimension_ * block_column[k] + j);
        }
      }
      row_start_.push_back(static_cast<PetscInt>(column_.size()));
    }
  }
}

void PetscMatrix::SetValues(const Eigen::VectorXd& values) {
  const NodeGraph& graph = assembly_.Graph();
  const auto num_nodes = Eigen::Index(graph.start.size()) - 1;
  const auto is_free = [&](Eigen::Index node, int component) {
    return degrees_of_freedom_.place[dimension_ * node + component] >= 0;
  };
  // Returns entry (i, j) of the k-th block of a row of blocks.
  const auto entry = [&](int a, PetscInt k, int i, int j) -> double& {
    return entries_[row_start_[dimension_ * a + i] +
                    dimension_ * (k - block_start_[a]) + j];
  };
  std::vector<PetscInt> next(block_start_.begin(), block_start_.end() - 1);
  const double* value = values.data();
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    const int a = block_[node];
    if (a < 0) {
      continue;
    }
    const PetscInt diagonal = next[a];
    double scale = 0;
    for (int j = 0; j < dimension_; ++j) {
      if (!is_free(node, j)) {
        continue;
      }
      PetscInt own = diagonal;
      for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
        const int row = graph.row[k];
        const int b = block_[row];
        if (b < 0) {
          continue;
        }
        for (int i = b == a ? j : 0; i < dimension_; ++i) {
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
    for (int j = 0; j < dimension_; ++j) {
      if (!is_free(node, j)) {
        entry(a, diagonal, j, j) = scale;
      }
    }
    for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
      const int b = block_[graph.row[k]];
      if (b >= 0 && b != a) {
        ++next[b];
      }
    }
  }
}

// Makes the modes that a coarse mesh must represent as well as a fine one.
void PetscMatrix::SetNearNullSpace(const Mesh& mesh) {
  Vec positions = nullptr;
  Check(MatCreateVecs(matrix_, &positions, nullptr));
  double* values = nullptr;
  Check(VecGetArray(positions, &values));
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (block_[node] >= 0) {
      Eigen::VectorXd::Map(values + Eigen::Index{dimension_} * block_[node],
                           dimension_) = mesh.nodes.col(node);
    }
  }
  Check(VecRestoreArray(positions, &values));
  MatNullSpace rigid_motions = nullptr;
  Check(MatNullSpaceCreateRigidBody(positions, &rigid_motions));
  Check(MatSetNearNullSpace(matrix_, rigid_motions));
  Check(MatNullSpaceDestroy(&rigid_motions));
  Check(VecDestroy(&positions));
}

// GAMG of PETSc 3.18 needs a quarter of the memory of Trilinos' ML for
// tetrahedra as Gmsh makes them.  On hexahedra it is a third slower, and it
// coarsens meshes with many nodes of few neighbours, such as cubes of five
// tetrahedra, by two only, which takes four times as long.
PCType PetscMatrix::Preconditioner(const Mesh& mesh) const {
#ifdef ELASTIMATE_HAS_ML
  constexpr PetscInt kFewBlocks = 8;
  int num_with_few = 0;
  for (int a = 0; a < num_blocks_; ++a) {
    num_with_few += block_start_[a + 1] - block_start_[a] <= kFewBlocks ? 1 : 0;
  }
  if (!IsSimplex(mesh.kind) || num_with_few > num_blocks_ / 4) {
    return PCML;
  }
#endif
  return PCGAMG;
}

// Returns a matrix in blocks of this size, of which those without an entry are
// left out, with or without the rest of single precision.
BlockMatrix InBlocks(Mat matrix, int block_rows, int block_columns,
                     bool with_rest = false) {
  PetscInt num_rows = 0;
  PetscInt num_columns = 0;
  Check(MatGetSize(matrix, &num_rows, &num_columns));
  BlockMatrix result;
  result.block_rows = block_rows;
  result.block_columns = block_columns;
  result.num_columns = num_columns;
  result.start.assign(1, 0);
  const int size = block_rows * block_columns;
  MatInfo info;
  Check(MatGetInfo(matrix, MAT_LOCAL, &info));
  const auto num_entries = static_cast<std::size_t>(info.nz_used);
  result.column.reserve(num_entries / size);
  result.entries.reserve(num_entries);
  result.rest.reserve(with_rest ? num_entries : 0);
  std::vector<Eigen::Index> place(num_columns / block_columns, -1);
  for (PetscInt first = 0; first < num_rows; first += block_rows) {
    for (int r = 0; r < block_rows; ++r) {
      PetscInt length = 0;
      const PetscInt* columns = nullptr;
      const double* values = nullptr;
      Check(MatGetRow(matrix, first + r, &length, &columns, &values));
      for (PetscInt k = 0; k < length; ++k) {
        Eigen::Index& block = place[columns[k] / block_columns];
        if (block < result.start.back()) {
          block = Eigen::Index(result.column.size());
          result.column.push_back(columns[k] / block_columns);
          result.entries.resize(result.entries.size() + size, 0);
          result.rest.resize(with_rest ? result.entries.size() : 0, 0);
        }
        const Eigen::Index at =
            block * size + (columns[k] % block_columns) * block_rows + r;
        result.entries[at] = static_cast<float>(values[k]);
        if (with_rest) {
          result.rest[at] =
              static_cast<float>(values[k] - double{result.entries[at]});
        }
      }
      Check(MatRestoreRow(matrix, first + r, &length, &columns, &values));
    }
    result.start.push_back(Eigen::Index(result.column.size()));
  }
  result.column.shrink_to_fit();
  result.entries.shrink_to_fit();
  result.rest.shrink_to_fit();
  return result;
}

void PetscMatrix::Create() {
  const PetscInt size = dimension_ * num_blocks_;
  Check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, size, size,
                                  row_start_.data(), column_.data(),
                                  entries_.data(), &matrix_));
  Check(MatSetBlockSize(matrix_, dimension_));
  Check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
}

MultigridSpaces PetscMatrix::FindSpaces(const Mesh& mesh) {
  Create();
  SetNearNullSpace(mesh);
  MultigridSpaces spaces;
  spaces.row_of_free = std::move(row_of_free_);
#ifdef ELASTIMATE_HAS_ML
  // The estimates of largest eigenvalues start from random vectors.
  ML_set_random_seed(1);
#endif
  Check(PCCreate(PETSC_COMM_SELF, &preconditioner_));
  Check(PCSetOptionsPrefix(preconditioner_, "elastimate_"));
  Check(PCSetType(preconditioner_, Preconditioner(mesh)));
  Check(PCSetOperators(preconditioner_, matrix_, matrix_));
  Check(PCSetFromOptions(preconditioner_));
  Check(PCSetUp(preconditioner_));
  AppendCoarseSpaces(spaces);
  // The finest matrix is copied last, when PETSc has given back the memory of
  // all that it made of it.
  Check(PCDestroy(&preconditioner_));
  ReturnFreeMemory();
  spaces.matrices.push_back(InBlocks(matrix_, dimension_, dimension_, true));
  return spaces;
}

void PetscMatrix::AppendCoarseSpaces(MultigridSpaces& spaces) const {
  PetscInt num_spaces = 0;
  Check(PCMGGetLevels(preconditioner_, &num_spaces));
  const int coarse_block = 3 * dimension_ - 3;
  for (PetscInt space = 0; space < num_spaces; ++space) {
    const bool is_finest = space + 1 == num_spaces;
    if (!is_finest) {
      KSP smoother = nullptr;
      Mat matrix = nullptr;
      Check(PCMGGetSmoother(preconditioner_, space, &smoother));
      Check(KSPGetOperators(smoother, nullptr, &matrix));
      spaces.matrices.push_back(InBlocks(matrix, coarse_block, coarse_block));
    }
    if (space > 0) {
      Mat interpolation = nullptr;
      Check(PCMGGetInterpolation(preconditioner_, space, &interpolation));
      spaces.interpolations.push_back(InBlocks(
          interpolation, is_finest ? dimension_ : coarse_block, coarse_block));
    }
  }
}

}  // namespace
}  // namespace elastimate

bool elastimate_find_multigrid_spaces(
    const elastimate::Mesh& mesh, const elastimate::StiffnessAssembly& assembly,
    const elastimate::DegreesOfFreedom& degrees_of_freedom,
    const Eigen::VectorXd& values, elastimate::MultigridSpaces& spaces) {
  try {
    const elastimate::UseOfPetsc use;
    elastimate::PetscMatrix matrix(assembly, degrees_of_freedom);
    matrix.SetValues(values);
    spaces = matrix.FindSpaces(mesh);
  } catch (const elastimate::PetscFailure&) {
    return false;
  }
  return true;
}

bool elastimate_is_petsc_running() { return elastimate::IsPetscRunning(); }
