#include "elastimate/core/solvers/petsc_ranks.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <numeric>
#include <thread>

namespace elastimate {
namespace {

// MPI counts in int.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr int kTag = 2007;

// A halo whose values PETSc's star forest exchanges, one column at a time.
class StarForestHalo : public Halo {
 public:
  StarForestHalo(MPI_Comm communicator, Eigen::Index num_own,
                 const std::vector<int>& others, int block)
      : num_own_rows_(block * num_own),
        num_rows_(block * (num_own + Eigen::Index(others.size()))) {
    PetscLayout layout = nullptr;
    PetscLayoutCreate(communicator, &layout);
    PetscLayoutSetLocalSize(layout, PetscInt(num_own));
    PetscLayoutSetUp(layout);
    const std::vector<PetscInt> numbers(others.begin(), others.end());
    PetscSFCreate(communicator, &forest_);
    PetscSFSetGraphLayout(forest_, layout, PetscInt(numbers.size()), nullptr,
                          PETSC_COPY_VALUES, numbers.data());
    PetscSFSetUp(forest_);
    PetscLayoutDestroy(&layout);
    MPI_Type_contiguous(block, MPI_DOUBLE, &block_);
    MPI_Type_commit(&block_);
  }
  ~StarForestHalo() override {
    int is_over = 0;
    MPI_Finalized(&is_over);
    if (is_over == 0) {
      MPI_Type_free(&block_);
      PetscSFDestroy(&forest_);
    }
  }
  StarForestHalo(const StarForestHalo&) = delete;
  StarForestHalo& operator=(const StarForestHalo&) = delete;

  Eigen::MatrixXd WithOthers(const Eigen::MatrixXd& own) const override {
    Eigen::MatrixXd all(num_rows_, own.cols());
    all.topRows(num_own_rows_) = own;
    for (Eigen::Index k = 0; k < own.cols(); ++k) {
      const double* const from = own.col(k).data();
      double* const to = all.col(k).data() + num_own_rows_;
      PetscSFBcastBegin(forest_, block_, from, to, MPI_REPLACE);
      PetscSFBcastEnd(forest_, block_, from, to, MPI_REPLACE);
    }
    return all;
  }

  Eigen::MatrixXd Added(const Eigen::MatrixXd& with_others) const override {
    Eigen::MatrixXd own = with_others.topRows(num_own_rows_);
    for (Eigen::Index k = 0; k < own.cols(); ++k) {
      const double* const from = with_others.col(k).data() + num_own_rows_;
      double* const to = own.col(k).data();
      PetscSFReduceBegin(forest_, block_, from, to, MPI_SUM);
      PetscSFReduceEnd(forest_, block_, from, to, MPI_SUM);
    }
    return own;
  }

 private:
  Eigen::Index num_own_rows_;
  Eigen::Index num_rows_;
  PetscSF forest_ = nullptr;
  MPI_Datatype block_ = MPI_DATATYPE_NULL;
};

}  // namespace

MpiRanks::MpiRanks(MPI_Comm communicator) : communicator_(communicator) {
  MPI_Comm_rank(communicator_, &rank_);
  MPI_Comm_size(communicator_, &size_);
}

void MpiRanks::Send(int to, const void* data, std::size_t bytes) const {
  const char* next = static_cast<const char*>(data);
  for (; bytes > 0; bytes -= std::min(bytes, kMostBytes)) {
    const std::size_t size = std::min(bytes, kMostBytes);
    MPI_Send(next, int(size), MPI_BYTE, to, kTag, communicator_);
    next += size;
  }
}

void MpiRanks::Receive(int from, void* data, std::size_t bytes) const {
  char* next = static_cast<char*>(data);
  for (; bytes > 0; bytes -= std::min(bytes, kMostBytes)) {
    const std::size_t size = std::min(bytes, kMostBytes);
    MPI_Recv(next, int(size), MPI_BYTE, from, kTag, communicator_,
             MPI_STATUS_IGNORE);
    next += size;
  }
}

void MpiRanks::Wait(int from) const {
  // A call of MPI that waits keeps a core busy, which another rank may need.
  int is_there = 0;
  for (;;) {
    MPI_Iprobe(from, kTag, communicator_, &is_there, MPI_STATUS_IGNORE);
    if (is_there != 0) {
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

void MpiRanks::Sum(double* values, std::size_t size) const {
  MPI_Allreduce(MPI_IN_PLACE, values, int(size), MPI_DOUBLE, MPI_SUM,
                communicator_);
}

Eigen::MatrixXd MpiRanks::AllRows(const Eigen::MatrixXd& own) const {
  std::vector<int> num_rows(static_cast<std::size_t>(size_));
  const int num_own = int(own.rows());
  MPI_Allgather(&num_own, 1, MPI_INT, num_rows.data(), 1, MPI_INT,
                communicator_);
  std::vector<int> first(num_rows.size() + 1, 0);
  std::partial_sum(num_rows.begin(), num_rows.end(), first.begin() + 1);
  Eigen::MatrixXd all(first.back(), own.cols());
  for (Eigen::Index k = 0; k < own.cols(); ++k) {
    MPI_Allgatherv(own.col(k).data(), num_own, MPI_DOUBLE, all.col(k).data(),
                   num_rows.data(), first.data(), MPI_DOUBLE, communicator_);
  }
  return all;
}

std::shared_ptr<const Halo> MpiRanks::MakeHalo(Eigen::Index num_own,
                                               const std::vector<int>& others,
                                               int block) const {
  return std::make_shared<StarForestHalo>(communicator_, num_own, others,
                                          block);
}

void MpiRanks::Abort() const {
  constexpr int kExitCode = 2;
  MPI_Abort(communicator_, kExitCode);
  std::abort();
}

}  // namespace elastimate

const elastimate::Ranks* elastimate_ranks() {
  PetscBool is_running = PETSC_FALSE;
  PetscInitialized(&is_running);
  if (is_running == PETSC_FALSE) {
    return nullptr;
  }
  static const elastimate::MpiRanks ranks(PETSC_COMM_WORLD);
  return ranks.Size() > 1 ? &ranks : nullptr;
}
