#ifndef ELASTIMATE_CORE_SOLVERS_PETSC_RANKS_H_
#define ELASTIMATE_CORE_SOLVERS_PETSC_RANKS_H_

#include <petscsf.h>

#include <memory>
#include <vector>

#include "elastimate/core/parallel/ranks.h"

namespace elastimate {

/// The ranks of a communicator of MPI.
class MpiRanks : public Ranks {
 public:
  explicit MpiRanks(MPI_Comm communicator);

  MPI_Comm Communicator() const { return communicator_; }
  int Rank() const override { return rank_; }
  int Size() const override { return size_; }
  void Send(int to, const void* data, std::size_t bytes) const override;
  void Receive(int from, void* data, std::size_t bytes) const override;
  void Wait(int from) const override;
  void Sum(double* values, std::size_t size) const override;
  Eigen::MatrixXd AllRows(const Eigen::MatrixXd& own) const override;
  std::shared_ptr<const Halo> MakeHalo(Eigen::Index num_own,
                                       const std::vector<int>& others,
                                       int block) const override;
  [[noreturn]] void Abort() const override;

 private:
  MPI_Comm communicator_;
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace elastimate

/// Returns the ranks of PETSC_COMM_WORLD; null where PETSc does not run or has
/// but one.  core/solvers/multigrid.cc looks this function up in the module.
extern "C" __attribute__((visibility("default"))) const elastimate::Ranks*
elastimate_ranks();

#endif  // ELASTIMATE_CORE_SOLVERS_PETSC_RANKS_H_
