#include "elastimate/core/solvers/multigrid_solver.h"

#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <utility>

namespace elastimate {
namespace {

// Returns the positions of the nodes that have rows, in the order of these.
Eigen::MatrixXd PositionsOf(const Mesh& mesh, const NodeBlocks& blocks) {
  Eigen::MatrixXd positions(mesh.Dimension(), blocks.NumBlocks());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (blocks.OfNodes()[node] >= 0) {
      positions.col(blocks.OfNodes()[node]) = mesh.nodes.col(node);
    }
  }
  return positions;
}

// The rows of all nodes, which are made of the values when they are needed.
class RowsOfNodes : public MultigridRows {
 public:
  RowsOfNodes(const Mesh& mesh, NodeBlocks blocks)
      : blocks_(std::move(blocks)) {
    positions = PositionsOf(mesh, blocks_);
    are_simplices = IsSimplex(mesh.kind);
  }

  // Refers to the values, which may be emptied once Factorize has returned
  // true.
  void Take(const Eigen::VectorXd& values) {
    values_ = &values;
    FreeMatrix();
  }
  const DividedMatrix& Matrix() override {
    if (matrix_.rows.start.empty()) {
      matrix_.rows = blocks_.MatrixOf(*values_);
    }
    return matrix_;
  }
  void ForgetRest() { std::vector<float>().swap(matrix_.rows.rest); }
  // Without the values, the matrix could not be made again, so it stays.
  void FreeMatrix() override {
    if (values_->size() > 0) {
      matrix_ = {};
    }
  }
  const NodeBlocks& Blocks() const { return blocks_; }

 private:
  NodeBlocks blocks_;
  const Eigen::VectorXd* values_ = nullptr;
  DividedMatrix matrix_;
};

// Puts free rows into those of blocks, and takes them from there.
class FreeRows {
 public:
  explicit FreeRows(const NodeBlocks& blocks)
      : row_of_free_(blocks.RowsOfFree()),
        num_rows_(Eigen::Index{blocks.Dimension()} * blocks.NumBlocks()) {}

  Eigen::MatrixXd InBlocks(const Eigen::MatrixXd& of_free) const {
    if (of_free.size() == 0) {
      return {};
    }
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(num_rows_, of_free.cols());
    rows(row_of_free_, Eigen::all) = of_free;
    return rows;
  }
  std::optional<Eigen::MatrixXd> FromBlocks(
      const std::optional<Eigen::MatrixXd>& rows) const {
    return rows ? std::optional<Eigen::MatrixXd>(
                      (*rows)(row_of_free_, Eigen::all))
                : std::nullopt;
  }

 private:
  std::vector<int> row_of_free_;
  Eigen::Index num_rows_;
};

class MultigridOfOneRank : public LinearSolver {
 public:
  MultigridOfOneRank(const Mesh& mesh, NodeBlocks blocks,
                     AlgebraicMultigrid::FindSpaces find_spaces)
      : rows_(mesh, std::move(blocks)),
        free_rows_(rows_.Blocks()),
        multigrid_(rows_, std::move(find_spaces)) {}

  bool Factorize(const Eigen::VectorXd& values) override {
    rows_.Take(values);
    return values.allFinite() && multigrid_.Factorize();
  }
  std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& right_hand_sides,
                                       double tolerance,
                                       const Eigen::MatrixXd& start) override {
    if (right_hand_sides.cols() == 0) {
      return right_hand_sides;
    }
    return free_rows_.FromBlocks(
        multigrid_.Solve(free_rows_.InBlocks(right_hand_sides), tolerance,
                         free_rows_.InBlocks(start)));
  }
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& columns) override {
    if (columns.cols() == 0) {
      return columns;
    }
    return *free_rows_.FromBlocks(
        multigrid_.Cycle(free_rows_.InBlocks(columns)));
  }
  bool Renew() override { return multigrid_.Renew(); }
  bool KeepPreconditioner() override {
    rows_.ForgetRest();
    return true;
  }
  int NumIterations() const override { return multigrid_.NumIterations(); }
  int NumSetUps() const override { return multigrid_.NumSetUps(); }

 private:
  RowsOfNodes rows_;
  FreeRows free_rows_;
  AlgebraicMultigrid multigrid_;
};

// What rank 0 asks the others for.
enum class Task : std::int64_t {
  kMake,
  kFactorize,
  kSolve,
  kPrecondition,
  kRenew,
  kForget,
  kWorkApart,
  kEnd
};

struct Order {
  Task task;
  std::int64_t system = 0;  ///< The number of the system that it is about.
  std::int64_t columns = 0;
  double tolerance = 0;
  std::int64_t has_start = 0;
};

void Tell(const Ranks& ranks, const Order& order) {
  for (int rank = 1; rank < ranks.Size(); ++rank) {
    ranks.Send(rank, &order, sizeof(order));
  }
}

void SendColumns(const Ranks& ranks, int to, const Eigen::MatrixXd& columns) {
  ranks.Send(to, columns.data(), std::size_t(columns.size()) * sizeof(double));
}

Eigen::MatrixXd ReceiveColumns(const Ranks& ranks, int from, Eigen::Index rows,
                               Eigen::Index cols) {
  Eigen::MatrixXd columns(rows, cols);
  ranks.Receive(from, columns.data(),
                std::size_t(columns.size()) * sizeof(double));
  return columns;
}

void SendRows(const Ranks& ranks, int to, const BlockMatrix& rows) {
  SendAll(ranks, to, rows.start);
  SendAll(ranks, to, rows.column);
  SendAll(ranks, to, rows.entries);
  SendAll(ranks, to, rows.rest);
}

BlockMatrix ReceiveRows(const Ranks& ranks, int dimension) {
  BlockMatrix rows;
  rows.block_rows = rows.block_columns = dimension;
  ReceiveAll(ranks, 0, rows.start);
  ReceiveAll(ranks, 0, rows.column);
  ReceiveAll(ranks, 0, rows.entries);
  ReceiveAll(ranks, 0, rows.rest);
  return rows;
}

// The rows that one of several ranks was sent.
class OwnRows : public MultigridRows {
 public:
  explicit OwnRows(const Ranks& of_ranks) { ranks = &of_ranks; }

  // Takes rows whose columns are numbered over all ranks.
  void Take(BlockMatrix rows) {
    others = NumberOwnColumnsFirst(first_own, rows.NumBlockRows(), rows);
    if (!matrix_.halo) {
      matrix_.halo =
          ranks->MakeHalo(rows.NumBlockRows(), others, rows.block_rows);
    }
    matrix_.rows = std::move(rows);
  }
  const DividedMatrix& Matrix() override { return matrix_; }
  void FreeMatrix() override {}

 private:
  DividedMatrix matrix_;
};

// The part of one rank in a system.
struct SystemOfRank {
  OwnRows rows;
  AlgebraicMultigrid multigrid;

  SystemOfRank(const AlgebraicMultigrid::FindSpaces& find_spaces,
               const Ranks& ranks)
      : rows(ranks), multigrid(rows, find_spaces) {}
};

// All ranks take a step together, one at a time.  Where an exception ends it on
// one rank, or the program exits there, the others would wait for ever.
std::mutex step_mutex;
std::atomic<bool> is_in_step = false;

class Step {
 public:
  explicit Step(const Ranks& ranks) : lock_(step_mutex) {
    AbortWithinStep(ranks);
    is_in_step = true;
  }
  ~Step() { is_in_step = std::uncaught_exceptions() > num_exceptions_; }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  // Ends all ranks if a step has not come to its end.
  static void AbortWithinStep(const Ranks& ranks) {
    if (is_in_step) {
      ranks.Abort();
    }
  }

 private:
  std::lock_guard<std::mutex> lock_;
  int num_exceptions_ = std::uncaught_exceptions();
};

class MultigridOfRanks : public LinearSolver {
 public:
  MultigridOfRanks(const Mesh& mesh, NodeBlocks blocks,
                   const AlgebraicMultigrid::FindSpaces& find_spaces,
                   const Ranks& ranks)
      : ranks_(ranks),
        blocks_(std::move(blocks)),
        free_rows_(blocks_),
        own_(std::make_unique<SystemOfRank>(find_spaces, ranks)) {
    const Step step(ranks_);
    static std::int64_t num_systems = 0;
    number_ = num_systems++;
    const Eigen::MatrixXd positions = PositionsOf(mesh, blocks_);
    const std::int64_t are_simplices = IsSimplex(mesh.kind) ? 1 : 0;
    Tell(ranks_, {Task::kMake, number_});
    for (int rank = ranks_.Size() - 1; rank >= 0; --rank) {
      const Eigen::MatrixXd of_rank =
          positions.middleCols(First(rank), First(rank + 1) - First(rank));
      if (rank == 0) {
        own_->rows.positions = of_rank;
        own_->rows.are_simplices = are_simplices != 0;
        continue;
      }
      const std::int64_t sizes[] = {of_rank.rows(), of_rank.cols(), First(rank),
                                    are_simplices};
      ranks_.Send(rank, sizes, sizeof(sizes));
      SendColumns(ranks_, rank, of_rank);
    }
  }

  ~MultigridOfRanks() override {
    const Step step(ranks_);
    Tell(ranks_, {Task::kForget, number_});
    own_.reset();  // By all ranks, as halos are.
  }

  bool Factorize(const Eigen::VectorXd& values) override {
    if (!values.allFinite()) {
      return false;
    }
    const Step step(ranks_);
    Tell(ranks_, {Task::kFactorize, number_});
    SendMatrix(values);
    return own_->multigrid.Factorize();
  }

  std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& right_hand_sides,
                                       double tolerance,
                                       const Eigen::MatrixXd& start) override {
    if (right_hand_sides.cols() == 0) {
      return right_hand_sides;
    }
    const Step step(ranks_);
    Tell(ranks_, {Task::kSolve, number_, right_hand_sides.cols(), tolerance,
                  start.size() > 0 ? 1 : 0});
    const Eigen::MatrixXd force =
        SendOthers(free_rows_.InBlocks(right_hand_sides));
    const Eigen::MatrixXd own_start = SendOthers(free_rows_.InBlocks(start));
    const std::optional<Eigen::MatrixXd> own =
        own_->multigrid.Solve(force, tolerance, own_start);
    return own ? free_rows_.FromBlocks(WithOthers(*own)) : std::nullopt;
  }
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& columns) override {
    if (columns.cols() == 0) {
      return columns;
    }
    const Step step(ranks_);
    Tell(ranks_, {Task::kPrecondition, number_, columns.cols()});
    return *free_rows_.FromBlocks(WithOthers(
        own_->multigrid.Cycle(SendOthers(free_rows_.InBlocks(columns)))));
  }
  bool Renew() override {
    const Step step(ranks_);
    Tell(ranks_, {Task::kRenew, number_});
    return own_->multigrid.Renew();
  }
  int NumIterations() const override { return own_->multigrid.NumIterations(); }
  int NumSetUps() const override { return own_->multigrid.NumSetUps(); }

 private:
  // Returns the first row of blocks of a rank.
  Eigen::Index First(int rank) const {
    return Eigen::Index{blocks_.NumBlocks()} * rank / ranks_.Size();
  }
  Eigen::Index FirstRow(int rank) const {
    return blocks_.Dimension() * First(rank);
  }

  // Sends each other rank its rows, and takes those of rank 0.
  void SendMatrix(const Eigen::VectorXd& values) {
    const BlockMatrix all = blocks_.MatrixOf(values);
    for (int rank = 1; rank < ranks_.Size(); ++rank) {
      SendRows(ranks_, rank, RowsOf(all, First(rank), First(rank + 1)));
    }
    own_->rows.Take(RowsOf(all, 0, First(1)));
  }

  // Sends each other rank its rows, and returns those of rank 0.
  Eigen::MatrixXd SendOthers(const Eigen::MatrixXd& rows) const {
    if (rows.size() == 0) {
      return {};
    }
    for (int rank = 1; rank < ranks_.Size(); ++rank) {
      SendColumns(
          ranks_, rank,
          rows.middleRows(FirstRow(rank), FirstRow(rank + 1) - FirstRow(rank)));
    }
    return rows.topRows(FirstRow(1));
  }

  Eigen::MatrixXd WithOthers(const Eigen::MatrixXd& own) const {
    Eigen::MatrixXd rows(FirstRow(ranks_.Size()), own.cols());
    rows.topRows(own.rows()) = own;
    for (int rank = 1; rank < ranks_.Size(); ++rank) {
      const Eigen::Index size = FirstRow(rank + 1) - FirstRow(rank);
      rows.middleRows(FirstRow(rank), size) =
          ReceiveColumns(ranks_, rank, size, own.cols());
    }
    return rows;
  }

  const Ranks& ranks_;
  NodeBlocks blocks_;
  FreeRows free_rows_;
  std::unique_ptr<SystemOfRank> own_;
  std::int64_t number_ = 0;
};

std::unique_ptr<SystemOfRank> ReceiveSystem(
    const AlgebraicMultigrid::FindSpaces& find_spaces, const Ranks& ranks) {
  std::int64_t sizes[4] = {};
  ranks.Receive(0, sizes, sizeof(sizes));
  auto system = std::make_unique<SystemOfRank>(find_spaces, ranks);
  system->rows.positions = ReceiveColumns(ranks, 0, sizes[0], sizes[1]);
  system->rows.first_own = sizes[2];
  system->rows.are_simplices = sizes[3] != 0;
  return system;
}

void ServePrecondition(const Ranks& ranks, const Order& order,
                       SystemOfRank& system) {
  const Eigen::MatrixXd columns = ReceiveColumns(
      ranks, 0, system.rows.Matrix().rows.NumRows(), order.columns);
  SendColumns(ranks, 0, system.multigrid.Cycle(columns));
}

void ServeSolve(const Ranks& ranks, const Order& order, SystemOfRank& system) {
  const Eigen::Index num_rows = system.rows.Matrix().rows.NumRows();
  const Eigen::MatrixXd force =
      ReceiveColumns(ranks, 0, num_rows, order.columns);
  const Eigen::MatrixXd start =
      order.has_start != 0 ? ReceiveColumns(ranks, 0, num_rows, order.columns)
                           : Eigen::MatrixXd();
  const std::optional<Eigen::MatrixXd> own =
      system.multigrid.Solve(force, order.tolerance, start);
  if (own) {
    SendColumns(ranks, 0, *own);
  }
}

}  // namespace

std::unique_ptr<LinearSolver> MakeMultigridOfOneRank(
    const Mesh& mesh, NodeBlocks blocks,
    AlgebraicMultigrid::FindSpaces find_spaces) {
  return std::make_unique<MultigridOfOneRank>(mesh, std::move(blocks),
                                              std::move(find_spaces));
}

std::unique_ptr<LinearSolver> MakeMultigridOfRanks(
    const Mesh& mesh, NodeBlocks blocks,
    AlgebraicMultigrid::FindSpaces find_spaces, const Ranks& ranks) {
  if (blocks.NumBlocks() < ranks.Size()) {
    return MakeMultigridOfOneRank(mesh, std::move(blocks),
                                  std::move(find_spaces));
  }
  return std::make_unique<MultigridOfRanks>(mesh, std::move(blocks),
                                            find_spaces, ranks);
}

void ServeSolves(const AlgebraicMultigrid::FindSpaces& find_spaces,
                 const Ranks& ranks, const std::function<void()>& apart) {
  std::map<std::int64_t, std::unique_ptr<SystemOfRank>> systems;
  for (;;) {
    ranks.Wait(0);
    const Step step(ranks);
    Order order = {};
    ranks.Receive(0, &order, sizeof(order));
    if (order.task == Task::kEnd) {
      return;
    }
    if (order.task == Task::kMake) {
      systems[order.system] = ReceiveSystem(find_spaces, ranks);
    } else if (order.task == Task::kFactorize) {
      SystemOfRank& system = *systems.at(order.system);
      system.rows.Take(ReceiveRows(ranks, int(system.rows.positions.rows())));
      static_cast<void>(system.multigrid.Factorize());
    } else if (order.task == Task::kSolve) {
      ServeSolve(ranks, order, *systems.at(order.system));
    } else if (order.task == Task::kPrecondition) {
      ServePrecondition(ranks, order, *systems.at(order.system));
    } else if (order.task == Task::kRenew) {
      static_cast<void>(systems.at(order.system)->multigrid.Renew());
    } else if (order.task == Task::kWorkApart) {
      apart();
    } else {
      systems.erase(order.system);
    }
  }
}

void WorkApart(const Ranks& ranks, const std::function<void()>& work) {
  const Step step(ranks);
  Tell(ranks, {Task::kWorkApart});
  work();
}

void EndService(const Ranks& ranks) {
  Step::AbortWithinStep(ranks);
  if (ranks.Rank() == 0) {
    Tell(ranks, {Task::kEnd});
  }
}

}  // namespace elastimate
