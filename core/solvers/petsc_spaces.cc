#include "elastimate/core/solvers/petsc_spaces.h"

#include <petscksp.h>

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

class PetscMatrix {
 public:
  PetscMatrix(const Mesh& mesh, const NodeBlocks& blocks,
              const Eigen::VectorXd& values);
  ~PetscMatrix() {
    PCDestroy(&preconditioner_);
    MatDestroy(&matrix_);
  }
  PetscMatrix(const PetscMatrix&) = delete;
  PetscMatrix& operator=(const PetscMatrix&) = delete;

  MultigridSpaces FindSpaces();

 private:
  void SetEntries(const Eigen::VectorXd& values);
  void SetNearNullSpace();
  PCType Preconditioner() const;

  const Mesh& mesh_;
  const NodeBlocks& blocks_;
  std::vector<PetscInt> row_start_;
  std::vector<PetscInt> column_;
  std::vector<double> entries_;
  Mat matrix_ = nullptr;
  PC preconditioner_ = nullptr;
};

PetscMatrix::PetscMatrix(const Mesh& mesh, const NodeBlocks& blocks,
                         const Eigen::VectorXd& values)
    : mesh_(mesh), blocks_(blocks) {
  SetEntries(values);
  const PetscInt size = blocks.Dimension() * blocks.NumBlocks();
  Check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, size, size,
                                  row_start_.data(), column_.data(),
                                  entries_.data(), &matrix_));
  Check(MatSetBlockSize(matrix_, blocks.Dimension()));
  Check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
}

void PetscMatrix::SetEntries(const Eigen::VectorXd& values) {
  const int dimension = blocks_.Dimension();
  const std::vector<Eigen::Index>& start = blocks_.Start();
  const Eigen::Index num_entries =
      Eigen::Index(blocks_.Columns().size()) * dimension * dimension;
  if (num_entries > std::numeric_limits<PetscInt>::max()) {
    throw std::bad_alloc();
  }
  row_start_.assign(1, 0);
  column_.reserve(num_entries);
  // The place of the first entry of each block, and the length of the rows of
  // the matrix that it lies in.
  std::vector<PetscInt> first(blocks_.Columns().size());
  std::vector<PetscInt> row_length(blocks_.Columns().size());
  for (int a = 0; a < blocks_.NumBlocks(); ++a) {
    for (int i = 0; i < dimension; ++i) {
      for (Eigen::Index k = start[a]; k < start[a + 1]; ++k) {
        if (i == 0) {
          first[k] = static_cast<PetscInt>(column_.size());
          row_length[k] =
              static_cast<PetscInt>(dimension * (start[a + 1] - start[a]));
        }
        for (int j = 0; j < dimension; ++j) {
          column_.push_back(dimension * blocks_.Columns()[k] + j);
        }
      }
      row_start_.push_back(static_cast<PetscInt>(column_.size()));
    }
  }
  entries_.assign(num_entries, 0);
  blocks_.VisitEntries(
      values, [&](Eigen::Index block, int i, int j, double value) {
        entries_[first[block] + i * row_length[block] + j] = value;
      });
}

// Makes the modes that a coarse mesh must represent as well as a fine one.
void PetscMatrix::SetNearNullSpace() {
  Vec positions = nullptr;
  Check(MatCreateVecs(matrix_, &positions, nullptr));
  double* values = nullptr;
  Check(VecGetArray(positions, &values));
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    const Eigen::Index block = blocks_.OfNodes()[node];
    if (block >= 0) {
      Eigen::VectorXd::Map(values + blocks_.Dimension() * block,
                           blocks_.Dimension()) = mesh_.nodes.col(node);
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
PCType PetscMatrix::Preconditioner() const {
#ifdef ELASTIMATE_HAS_ML
  constexpr PetscInt kFewBlocks = 8;
  int num_with_few = 0;
  for (int a = 0; a < blocks_.NumBlocks(); ++a) {
    num_with_few +=
        blocks_.Start()[a + 1] - blocks_.Start()[a] <= kFewBlocks ? 1 : 0;
  }
  if (!IsSimplex(mesh_.kind) || num_with_few > blocks_.NumBlocks() / 4) {
    return PCML;
  }
#endif
  return PCGAMG;
}

// Returns a matrix in blocks of this size, of which those without an entry are
// left out.
BlockMatrix InBlocks(Mat matrix, int block_rows, int block_columns) {
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
        }
        const Eigen::Index at =
            block * size +
            Eigen::Index{columns[k] % block_columns} * block_rows + r;
        result.entries[at] = static_cast<float>(values[k]);
      }
      Check(MatRestoreRow(matrix, first + r, &length, &columns, &values));
    }
    result.start.push_back(Eigen::Index(result.column.size()));
  }
  result.column.shrink_to_fit();
  result.entries.shrink_to_fit();
  return result;
}

MultigridSpaces PetscMatrix::FindSpaces() {
  SetNearNullSpace();
#ifdef ELASTIMATE_HAS_ML
  // The estimates of largest eigenvalues start from random vectors.
  ML_set_random_seed(1);
#endif
  Check(PCCreate(PETSC_COMM_SELF, &preconditioner_));
  Check(PCSetOptionsPrefix(preconditioner_, "elastimate_"));
  Check(PCSetType(preconditioner_, Preconditioner()));
  Check(PCSetOperators(preconditioner_, matrix_, matrix_));
  Check(PCSetFromOptions(preconditioner_));
  Check(PCSetUp(preconditioner_));
  MultigridSpaces spaces;
  PetscInt num_spaces = 0;
  Check(PCMGGetLevels(preconditioner_, &num_spaces));
  const int coarse_block = 3 * blocks_.Dimension() - 3;
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
          interpolation, is_finest ? blocks_.Dimension() : coarse_block,
          coarse_block));
    }
  }
  return spaces;
}

}  // namespace
}  // namespace elastimate

bool elastimate_find_multigrid_spaces(const elastimate::Mesh& mesh,
                                      const elastimate::NodeBlocks& blocks,
                                      const Eigen::VectorXd& values,
                                      elastimate::MultigridSpaces& spaces) {
  try {
    const elastimate::UseOfPetsc use;
    spaces = elastimate::PetscMatrix(mesh, blocks, values).FindSpaces();
  } catch (const elastimate::PetscFailure&) {
    return false;
  }
  return true;
}

bool elastimate_is_petsc_running() { return elastimate::IsPetscRunning(); }
