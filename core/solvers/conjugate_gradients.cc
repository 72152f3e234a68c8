#include "elastimate/core/solvers/conjugate_gradients.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/tall_columns.h"

namespace elastimate {
namespace {

// The tridiagonal matrix of one column, whose eigenvalues are Ritz values of
// M A [Golub & Van Loan, Matrix Computations].
class LanczosMatrix {
 public:
  // Adds a step of this `length` along a direction, which took `share` of the
  // direction before.
  void Add(double length, double share) {
    diagonal_.push_back(1 / length);
    if (diagonal_.size() > 1) {
      diagonal_.back() += share / last_length_;
      beside_.push_back(std::sqrt(std::max(share, 0.0)) / last_length_);
    }
    last_length_ = length;
  }

  // Returns the eigenvalues in ascending order; none before the first step.
  Eigen::VectorXd Eigenvalues() const {
    if (diagonal_.empty()) {
      return {};
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(
        Eigen::Map<const Eigen::VectorXd>(diagonal_.data(),
                                          Eigen::Index(diagonal_.size())),
        Eigen::Map<const Eigen::VectorXd>(beside_.data(),
                                          Eigen::Index(beside_.size())),
        Eigen::EigenvaluesOnly);
    return solver.eigenvalues();
  }

 private:
  std::vector<double> diagonal_;
  std::vector<double> beside_;
  double last_length_ = 0;
};

// Holds the columns that are not done, side by side.
class Iterations {
 public:
  Iterations(const ColumnOperator& multiply, const ColumnOperator& precondition,
             Eigen::MatrixXd right_hand_sides,
             const ConjugateGradientOptions& options)
      : multiply_(multiply),
        precondition_(precondition),
        options_(options),
        num_rows_(right_hand_sides.rows()),
        num_columns_(right_hand_sides.cols()) {
    result_.smallest_eigenvalue = options.smallest_eigenvalue;
    const Eigen::RowVectorXd size = SumsOfMagnitudes(right_hand_sides);
    for (Eigen::Index k = 0; k < right_hand_sides.cols(); ++k) {
      // A column without a force has no displacement, whatever the guess.
      if (size(k) != 0) {
        columns_.push_back(k);
      }
    }
    result_.columns = int(columns_.size());
    residual_ = std::move(right_hand_sides);
    KeepColumns(columns_, residual_);
    x_ = Eigen::MatrixXd::Zero(residual_.rows(), residual_.cols());
    energy_ = Eigen::RowVectorXd::Zero(residual_.cols());
    lanczos_.resize(columns_.size());
  }

  void BeginWith(Eigen::MatrixXd guess) {
    if (guess.cols() == 0 || columns_.empty()) {
      return;
    }
    KeepColumns(columns_, guess);
    const Eigen::RowVectorXd size = SumsOfMagnitudes(guess);
    for (Eigen::Index k = 0; k < guess.cols(); ++k) {
      if (!std::isfinite(size(k))) {
        guess.col(k).setZero();
      }
    }
    const Eigen::MatrixXd product = Multiply(guess);
    const Eigen::RowVectorXd energy = ProductsOfColumns(guess, product);
    const Eigen::RowVectorXd work = ProductsOfColumns(guess, residual_);
    const Eigen::RowVectorXd scale =
        (energy.array() > 0).select(work.array() / energy.array(), 0.0);
    energy_ = scale.cwiseProduct(work);
    AddTo(residual_, product, -scale);
    x_ = std::move(guess);
    Scale(x_, scale);
  }

  ConjugateGradientResult Run() {
    int step = 0;
    while (!columns_.empty() && Step(step)) {
      ++step;
    }
    result_.has_converged = columns_.empty();
    for (const LanczosMatrix& lanczos : lanczos_) {
      TakeEigenvaluesOf(lanczos);
    }
    direction_.resize(0, 0);
    std::vector<Eigen::Index> left(columns_.size());
    std::iota(left.begin(), left.end(), Eigen::Index{0});
    Put(left, x_, result_.solution);
    if (!columns_.empty()) {
      Put(left, residual_, result_.residual);
    }
    return std::move(result_);
  }

 private:
  static void KeepColumns(const std::vector<Eigen::Index>& kept,
                          Eigen::MatrixXd& matrix) {
    if (Eigen::Index(kept.size()) < matrix.cols()) {
      matrix = matrix(Eigen::all, kept).eval();
    }
  }

  Eigen::RowVectorXd ProductsOfColumns(const Eigen::MatrixXd& a,
                                       const Eigen::MatrixXd& b) const {
    Eigen::RowVectorXd products = ColumnProducts(a, b);
    SumOverRanks(options_.ranks, products);
    return products;
  }

  Eigen::RowVectorXd SumsOfMagnitudes(const Eigen::MatrixXd& a) const {
    Eigen::RowVectorXd sums = ColumnMagnitudes(a);
    SumOverRanks(options_.ranks, sums);
    return sums;
  }

  Eigen::MatrixXd Multiply(const Eigen::MatrixXd& x) {
    ++result_.products;
    return multiply_(x);
  }

  // Makes a step, and tells whether the iterations may go on.
  bool Step(int step) {
    Eigen::MatrixXd z = precondition_(residual_);
    Eigen::RowVectorXd rz = ProductsOfColumns(residual_, z);
    if (!(rz.array() >= 0).all() || !rz.allFinite()) {
      return false;
    }
    TakeWhatIsDone(z, rz);
    if (columns_.empty() || step == options_.most_iterations) {
      return false;
    }
    Eigen::RowVectorXd share = Eigen::RowVectorXd::Zero(rz.cols());
    if (step > 0) {
      share = rz.cwiseQuotient(last_rz_);
      Scale(direction_, share);
      AddTo(direction_, z);
      z.resize(0, 0);  // A column of a large mesh needs much memory.
    } else {
      direction_ = std::move(z);
    }
    const Eigen::MatrixXd product = Multiply(direction_);
    const Eigen::RowVectorXd energy = ProductsOfColumns(direction_, product);
    if (!(energy.array() > 0).all() || !energy.allFinite()) {
      return false;
    }
    length_ = rz.cwiseQuotient(energy);
    last_rz_ = rz;
    AddTo(x_, direction_, length_);
    AddTo(residual_, product, -length_);
    energy_ += length_.cwiseProduct(rz);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      lanczos_[k].Add(length_(Eigen::Index(k)), share(Eigen::Index(k)));
    }
    result_.iterations += static_cast<int>(columns_.size());
    return true;
  }

  void TakeEigenvaluesOf(const LanczosMatrix& lanczos) {
    const Eigen::VectorXd values = lanczos.Eigenvalues();
    if (values.size() > 0 && values.allFinite()) {
      result_.smallest_eigenvalue =
          std::min(result_.smallest_eigenvalue, values(0));
      result_.largest_eigenvalue =
          std::max(result_.largest_eigenvalue, values(values.size() - 1));
    }
  }

  bool IsDone(std::size_t k, double rz, double energy) {
    const double most = options_.tolerance * options_.tolerance * energy;
    // The smallest eigenvalue that is known can only decrease later.
    if (!(rz <= most * result_.smallest_eigenvalue)) {
      return false;
    }
    TakeEigenvaluesOf(lanczos_[k]);
    return rz <= most * result_.smallest_eigenvalue;
  }

  // Puts the columns at these places into all columns.
  void Put(const std::vector<Eigen::Index>& places, Eigen::MatrixXd& columns,
           Eigen::MatrixXd& all) const {
    if (Eigen::Index(places.size()) == num_columns_) {
      all = std::move(columns);
      return;
    }
    if (all.cols() == 0) {
      all.setZero(num_rows_, num_columns_);
    }
    for (const Eigen::Index k : places) {
      all.col(columns_[k]) = columns.col(k);
    }
  }

  // Puts the columns that are done into the result, and keeps the others.
  void TakeWhatIsDone(Eigen::MatrixXd& z, Eigen::RowVectorXd& rz) {
    std::vector<Eigen::Index> done;
    std::vector<Eigen::Index> kept;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const auto place = Eigen::Index(k);
      (IsDone(k, rz(place), energy_(place)) ? done : kept).push_back(place);
    }
    if (done.empty()) {
      return;
    }
    Put(done, x_, result_.solution);
    for (Eigen::MatrixXd* const matrix : {&x_, &residual_, &direction_, &z}) {
      if (matrix->cols() > 0) {
        KeepColumns(kept, *matrix);
      }
    }
    for (Eigen::RowVectorXd* const row : {&rz, &length_, &last_rz_, &energy_}) {
      if (row->size() > 0) {
        *row = (*row)(kept).eval();
      }
    }
    for (std::size_t k = 0; k < kept.size(); ++k) {
      columns_[k] = columns_[kept[k]];
      lanczos_[k] = lanczos_[kept[k]];
    }
    columns_.resize(kept.size());
    lanczos_.resize(kept.size());
  }

  const ColumnOperator& multiply_;
  const ColumnOperator& precondition_;
  const ConjugateGradientOptions& options_;
  Eigen::Index num_rows_;
  Eigen::Index num_columns_;
  ConjugateGradientResult result_;
  std::vector<Eigen::Index>
      columns_;  // Of the right-hand sides, in ascending order.
  Eigen::MatrixXd x_;
  Eigen::MatrixXd residual_;
  Eigen::MatrixXd direction_;
  Eigen::RowVectorXd length_;
  Eigen::RowVectorXd last_rz_;
  /// The squared energy norm of the solution so far, as a measure of its size:
  /// that of the scaled guess plus those of the steps. The sum is exact once
  /// the residual is zero, since the guess is then conjugate to the sum of the
  /// steps.
  Eigen::RowVectorXd energy_;
  std::vector<LanczosMatrix> lanczos_;
};

}  // namespace

ConjugateGradientResult SolveByConjugateGradients(
    const ColumnOperator& multiply, const ColumnOperator& precondition,
    Eigen::MatrixXd right_hand_sides, Eigen::MatrixXd start,
    const ConjugateGradientOptions& options) {
  Iterations iterations(multiply, precondition, std::move(right_hand_sides),
                        options);
  iterations.BeginWith(std::move(start));
  return iterations.Run();
}

}  // namespace elastimate
