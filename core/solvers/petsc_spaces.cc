#include "elastimate/core/solvers/petsc_spaces.h"

#include <petscksp.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/solvers/petsc_ranks.h"

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
  explicit PetscMatrix(MultigridRows& rows);
  ~PetscMatrix() {
    PCDestroy(&preconditioner_);
    MatDestroy(&matrix_);
  }
  PetscMatrix(const PetscMatrix&) = delete;
  PetscMatrix& operator=(const PetscMatrix&) = delete;

  MultigridSpaces FindSpaces();

 private:
  MPI_Comm Communicator() const {
    return rows_.ranks == nullptr
               ? PETSC_COMM_SELF
               : static_cast<const MpiRanks*>(rows_.ranks)->Communicator();
  }
  Eigen::Index Dimension() const { return rows_.positions.rows(); }
  void TakeEntries(const BlockMatrix& rows);
  PetscInt NumberInAll(int column) const;
  PCType PreconditionerFor(const BlockMatrix& rows) const;
  void SetNearNullSpace();

  MultigridRows& rows_;
  std::vector<PetscInt> row_start_;
  std::vector<PetscInt> column_;
  std::vector<double> entries_;
  PCType type_;
  Mat matrix_ = nullptr;
  PC preconditioner_ = nullptr;
};

PetscMatrix::PetscMatrix(MultigridRows& rows) : rows_(rows) {
  TakeEntries(rows.Matrix().rows);
  type_ = PreconditionerFor(rows.Matrix().rows);
  rows.FreeMatrix();  // PETSc needs its memory.
  const auto size = static_cast<PetscInt>(rows.positions.size());
  if (rows.ranks == nullptr) {
    Check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, size, size,
                                    row_start_.data(), column_.data(),
                                    entries_.data(), &matrix_));
  } else {
    Check(MatCreateMPIAIJWithArrays(Communicator(), size, size, PETSC_DETERMINE,
                                    PETSC_DETERMINE, row_start_.data(),
                                    column_.data(), entries_.data(), &matrix_));
    column_ = {};
    entries_ = {};
  }
  Check(MatSetBlockSize(matrix_, PetscInt(Dimension())));
  Check(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
}

// Returns the number over all ranks of a column of blocks.
PetscInt PetscMatrix::NumberInAll(int column) const {
  const Eigen::Index num_own = rows_.positions.cols();
  return column < num_own ? PetscInt(rows_.first_own + column)
                          : PetscInt(rows_.others[column - num_own]);
}

void PetscMatrix::TakeEntries(const BlockMatrix& rows) {
  const Eigen::Index d = Dimension();
  if (rows.entries.size() > std::size_t(std::numeric_limits<PetscInt>::max())) {
    throw std::bad_alloc();
  }
  row_start_.assign(1, 0);
  column_.reserve(rows.entries.size());
  entries_.reserve(rows.entries.size());
  // PETSc wants the columns of a row in ascending order.
  std::vector<std::pair<PetscInt, Eigen::Index>> blocks;
  for (Eigen::Index a = 0; a < rows.NumBlockRows(); ++a) {
    blocks.clear();
    for (Eigen::Index k = rows.start[a]; k < rows.start[a + 1]; ++k) {
      blocks.emplace_back(NumberInAll(rows.column[k]), k);
    }
    std::sort(blocks.begin(), blocks.end());
    for (Eigen::Index i = 0; i < d; ++i) {
      for (const auto& [column, k] : blocks) {
        for (Eigen::Index j = 0; j < d; ++j) {
          const Eigen::Index at = d * d * k + d * j + i;
          column_.push_back(PetscInt(d * column + j));
          entries_.push_back(double{rows.entries[at]} + double{rows.rest[at]});
        }
      }
      row_start_.push_back(static_cast<PetscInt>(column_.size()));
    }
  }
}

// Makes the modes that a coarse mesh must represent as well as a fine one.
void PetscMatrix::SetNearNullSpace() {
  Vec positions = nullptr;
  Check(MatCreateVecs(matrix_, &positions, nullptr));
  double* values = nullptr;
  Check(VecGetArray(positions, &values));
  Eigen::MatrixXd::Map(values, rows_.positions.rows(), rows_.positions.cols()) =
      rows_.positions;
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
// tetrahedra, by two only, which takes four times as long.  The interpolations
// of ML cannot be read where several ranks have them.
PCType PetscMatrix::PreconditionerFor(const BlockMatrix& rows) const {
#ifdef ELASTIMATE_HAS_ML
  constexpr Eigen::Index kFewBlocks = 8;
  Eigen::Index num_with_few = 0;
  for (Eigen::Index a = 0; a < rows.NumBlockRows(); ++a) {
    num_with_few += rows.start[a + 1] - rows.start[a] <= kFewBlocks ? 1 : 0;
  }
  if (rows_.ranks == nullptr &&
      (!rows_.are_simplices || num_with_few > rows.NumBlockRows() / 4)) {
    return PCML;
  }
#endif
  return PCGAMG;
}

// Returns the own rows of a matrix in blocks of this size, of which those
// without an entry are left out.
DividedMatrix InBlocks(Mat matrix, int block_rows, int block_columns) {
  PetscInt first_row = 0;
  PetscInt end_row = 0;
  Check(MatGetOwnershipRange(matrix, &first_row, &end_row));
  PetscInt num_columns = 0;
  Check(MatGetSize(matrix, nullptr, &num_columns));
  BlockMatrix rows;
  rows.block_rows = block_rows;
  rows.block_columns = block_columns;
  rows.num_columns = num_columns;
  rows.start.assign(1, 0);
  const int size = block_rows * block_columns;
  MatInfo info;
  Check(MatGetInfo(matrix, MAT_LOCAL, &info));
  const auto num_entries = static_cast<std::size_t>(info.nz_used);
  rows.column.reserve(num_entries / size);
  rows.entries.reserve(num_entries);
  std::vector<Eigen::Index> place(num_columns / block_columns, -1);
  for (PetscInt first = first_row; first < end_row; first += block_rows) {
    for (int r = 0; r < block_rows; ++r) {
      PetscInt length = 0;
      const PetscInt* columns = nullptr;
      const double* values = nullptr;
      Check(MatGetRow(matrix, first + r, &length, &columns, &values));
      for (PetscInt k = 0; k < length; ++k) {
        Eigen::Index& block = place[columns[k] / block_columns];
        if (block < rows.start.back()) {
          block = Eigen::Index(rows.column.size());
          rows.column.push_back(columns[k] / block_columns);
          rows.entries.resize(rows.entries.size() + size, 0);
        }
        const Eigen::Index at =
            block * size +
            Eigen::Index{columns[k] % block_columns} * block_rows + r;
        rows.entries[at] = static_cast<float>(values[k]);
      }
      Check(MatRestoreRow(matrix, first + r, &length, &columns, &values));
    }
    rows.start.push_back(Eigen::Index(rows.column.size()));
  }
  rows.column.shrink_to_fit();
  rows.entries.shrink_to_fit();
  return {std::move(rows), nullptr};
}

MultigridSpaces PetscMatrix::FindSpaces() {
  SetNearNullSpace();
#ifdef ELASTIMATE_HAS_ML
  // The estimates of largest eigenvalues start from random vectors.
  ML_set_random_seed(1);
#endif
  Check(PCCreate(Communicator(), &preconditioner_));
  Check(PCSetOptionsPrefix(preconditioner_, "elastimate_"));
  Check(PCSetType(preconditioner_, type_));
  Check(PCSetOperators(preconditioner_, matrix_, matrix_));
  Check(PCSetFromOptions(preconditioner_));
  Check(PCSetUp(preconditioner_));
  MultigridSpaces spaces;
  PetscInt num_spaces = 0;
  Check(PCMGGetLevels(preconditioner_, &num_spaces));
  const int coarse_block = int(3 * Dimension() - 3);
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
      spaces.interpolations.push_back(
          InBlocks(interpolation, is_finest ? int(Dimension()) : coarse_block,
                   coarse_block));
    }
  }
  return spaces;
}

}  // namespace
}  // namespace elastimate

bool elastimate_find_multigrid_spaces(elastimate::MultigridRows& rows,
                                      elastimate::MultigridSpaces& spaces) {
  try {
    const elastimate::UseOfPetsc use;
    spaces = elastimate::PetscMatrix(rows).FindSpaces();
  } catch (const elastimate::PetscFailure&) {
    return false;
  }
  return true;
}

bool elastimate_is_petsc_running() { return elastimate::IsPetscRunning(); }
