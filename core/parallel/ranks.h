#ifndef ELASTIMATE_CORE_PARALLEL_RANKS_H_
#define ELASTIMATE_CORE_PARALLEL_RANKS_H_

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

namespace elastimate {

/// The rows of other ranks that the columns of a divided matrix refer to.
class Halo {
 public:
  virtual ~Halo() = default;

  /// Returns the own rows, and below them those of others.
  [[nodiscard]] virtual Eigen::MatrixXd WithOthers(
      const Eigen::MatrixXd& own) const = 0;
  /// Returns the own rows of such columns, to each of which the other ranks
  /// have added what they hold for it.  It is the transpose of WithOthers.
  [[nodiscard]] virtual Eigen::MatrixXd Added(
      const Eigen::MatrixXd& with_others) const = 0;
};

/// The processes of a program that solve linear systems together, which MPI
/// calls ranks.  Each has some rows of matrices and vectors, in the order of
/// the ranks.  All of them call Sum, AllRows, MakeHalo and the functions of a
/// Halo, in the same order.  Where a process is lost, MPI ends the others.
class Ranks {
 public:
  virtual ~Ranks() = default;

  [[nodiscard]] virtual int Rank() const = 0;
  [[nodiscard]] virtual int Size() const = 0;
  virtual void Send(int to, const void* data, std::size_t bytes) const = 0;
  virtual void Receive(int from, void* data, std::size_t bytes) const = 0;
  /// Sleeps until a message of that rank is there.
  virtual void Wait(int from) const = 0;
  /// Replaces each value by its sum over the ranks, with the same bits on each.
  virtual void Sum(double* values, std::size_t size) const = 0;
  /// Returns the rows of all ranks.
  [[nodiscard]] virtual Eigen::MatrixXd AllRows(
      const Eigen::MatrixXd& own) const = 0;
  /// Finds the rows of blocks `others`, which are numbered over all ranks, of
  /// vectors with `num_own` rows of blocks of `block` rows on this rank.
  [[nodiscard]] virtual std::shared_ptr<const Halo> MakeHalo(
      Eigen::Index num_own, const std::vector<int>& others,
      int block) const = 0;
  /// Ends all ranks at once, with the exit code 2.
  [[noreturn]] virtual void Abort() const = 0;
};

/// Replaces each value by its sum over the ranks where there are several.
inline void SumOverRanks(const Ranks* ranks, Eigen::RowVectorXd& values) {
  if (ranks != nullptr) {
    ranks->Sum(values.data(), std::size_t(values.size()));
  }
}

/// Sends the values of a std::vector or a std::string.
template <class Values>
void SendAll(const Ranks& ranks, int to, const Values& values) {
  const std::size_t size = values.size();
  ranks.Send(to, &size, sizeof(size));
  ranks.Send(to, values.data(), size * sizeof(*values.data()));
}

template <class Values>
void ReceiveAll(const Ranks& ranks, int from, Values& values) {
  std::size_t size = 0;
  ranks.Receive(from, &size, sizeof(size));
  values.resize(size);
  ranks.Receive(from, values.data(), size * sizeof(*values.data()));
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_PARALLEL_RANKS_H_
