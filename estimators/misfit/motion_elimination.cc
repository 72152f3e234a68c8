#include "elastimate/estimators/misfit/motion_elimination.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

// What an iteration takes from the square sum, relative to it, where no more is
// worth while: of a fit, a millionth of the noise; of sensitivities, what does
// not slow a Gauss-Newton step down.
constexpr double kExact = 1e-12;
constexpr double kOfSensitivities = 1e-10;
// Up to so many amounts of a load case, the rows of each are solved for, at all
// moduli or at the first.
constexpr Eigen::Index kColumnsAtATime = 32;
constexpr Eigen::Index kMostColumnsAnew = kColumnsAtATime;
constexpr Eigen::Index kMostColumns = 400;
constexpr Eigen::Index kMostEntries = 20'000'000;
constexpr int kMostIterations = 2000;
// Rounding makes this part of a square sum, and of the largest eigenvalue of
// A^T A.
constexpr double kRoundingOfRows = 1e-14;
constexpr double kDependentAmounts = 1e-13;

// Multiplies the vector of each node by a matrix, in all columns.
Eigen::MatrixXd TimesEachNode(const Eigen::MatrixXd& matrix,
                              const Eigen::MatrixXd& columns) {
  const Eigen::Index dimension = matrix.rows();
  return (matrix * columns.reshaped(dimension, columns.size() / dimension))
      .reshaped(columns.rows(), columns.cols());
}

}  // namespace

MotionElimination::MotionElimination(const Scene& scene,
                                     const ObservedDisplacements& observed,
                                     ForwardModel& model)
    : scene_(scene), observed_(observed), model_(model) {
  for (Eigen::Index k = 0; k < Eigen::Index(scene.load_cases.size()); ++k) {
    first_resultant_.push_back(NumResultants());
    AddResultants(scene, k);
  }
  first_resultant_.push_back(NumResultants());
  SetRotations(Rotations::kFinite);
}

void MotionElimination::SetRotations(Rotations rotations) {
  const Mesh& mesh = scene_.mesh;
  cameras_.clear();
  motions_.clear();
  motion_of_case_.clear();
  first_amount_.clear();
  columns_.clear();
  are_columns_of_here_ = false;
  std::vector<const Supports*> supports_of_motion;
  Eigen::Index num_amounts = 0;
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    const Supports& supports = SupportsOf(scene_, k);
    if (scene_.is_rigid_motion_free && rotations == Rotations::kFinite) {
      cameras_.push_back(TurnOfCamera(scene_, scene_.load_cases[k]));
    }
    const auto same = model_.IsLinear() && cameras_.empty()
                          ? std::find(supports_of_motion.begin(),
                                      supports_of_motion.end(), &supports)
                          : supports_of_motion.end();
    motion_of_case_.push_back(same - supports_of_motion.begin());
    if (same == supports_of_motion.end()) {
      supports_of_motion.push_back(&supports);
      motions_.emplace_back(
          scene_, supports,
          UnknownMotion::Positions{mesh.nodes, SeenAtRest(k)});
    }
    first_amount_.push_back(num_amounts);
    num_amounts += MotionOf(k).NumAmounts();
  }
  amounts_.setZero(num_amounts);
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    const Eigen::SparseMatrix<double>& of_supports = MotionOf(k).of_supports;
    AmountsOf(k, amounts_).head(of_supports.cols()) =
        of_supports.transpose() * MeasuredMotionOfSupports(k);
  }
  held_ = HeldMotion(amounts_);
}

Eigen::VectorXd MotionElimination::MeasuredMotionOfSupports(
    Eigen::Index k) const {
  Eigen::VectorXd measured = MeasuredSupports(scene_, k);
  if (cameras_.empty()) {
    return measured;
  }
  const Eigen::VectorXd by_camera =
      (SeenAtRest(k) - scene_.mesh.nodes).reshaped();
  return TurnedBack(k,
                    (measured.array() != 0).select(measured - by_camera, 0.0));
}

void MotionElimination::AddResultants(const Scene& scene, Eigen::Index k) {
  const int dimension = scene.mesh.Dimension();
  const Supports& supports = SupportsOf(scene, k);
  for (const Resultant& resultant : scene.load_cases[k].resultants) {
    for (int i = 0; i < dimension; ++i) {
      if (std::isnan(resultant.force(i))) {
        continue;
      }
      ResultantRow row = {k, {}, resultant.force(i), resultant.noise_sd(i)};
      for (const int node : resultant.nodes) {
        if (supports.held(i, node)) {
          row.held.push_back(dimension * Eigen::Index(node) + i);
        }
      }
      resultants_.push_back(row);
    }
  }
}

void MotionElimination::SetNoise(double standard_deviation) {
  noise_ = standard_deviation;
  InvertGrams();
}

std::optional<Eigen::VectorXd> MotionElimination::Fit() {
  SolveForColumns();
  return Refit();
}

std::optional<Eigen::VectorXd> MotionElimination::Refit() {
  // A step that changes the amounts or the rows by a smaller part is the last.
  constexpr double kSettled = 1e-8;
  constexpr int kMostSteps = 10;
  for (int i = 0; i < kMostSteps; ++i) {
    if (i > 0) {
      SolveForColumns();
    }
    Eigen::VectorXd rows =
        RowsOf(SeenDisplacements(scene_.mesh, FittedDisplacement(), cameras_),
               model_.SupportForces());
    rows.head(observed_.Size()) -= observed_.Measured();
    rows.tail(NumResultants()) -= noise_ * MeasuredResultants();
    const double before = Norm(rows);
    const Eigen::VectorXd surplus = Minimize(kExact, rows);
    if (!Move(-surplus)) {
      return std::nullopt;
    }
    if ((model_.IsLinear() && cameras_.empty()) ||
        before - Norm(rows) <= kSettled * before ||
        Norm(surplus) <=
            kSettled * (Norm(amounts_) + model_.Displacement().norm())) {
      return rows;
    }
  }
  return std::nullopt;
}

bool MotionElimination::Move(const Eigen::VectorXd& increments) {
  Eigen::MatrixXd change = HeldMotion(increments);
  for (Eigen::Index k = 0; k < change.cols() && !model_.IsLinear(); ++k) {
    change.col(k) = FiniteIncrement(scene_.mesh, SupportsOf(scene_, k),
                                    held_.col(k), change.col(k));
  }
  for (Eigen::Index k = 0; k < Eigen::Index(cameras_.size()); ++k) {
    const Eigen::MatrixXd& of_all = MotionOf(k).of_all;
    const Eigen::MatrixXd seen = PositionsOfCamera(k);
    Eigen::VectorXd motion = RigidMotionNearest(
        seen, (of_all * AmountsOf(k, increments).tail(of_all.cols()))
                  .reshaped(seen.rows(), seen.cols()));
    Camera& camera = cameras_[k];
    camera.translation = MovedRigidly(camera.translation, motion);
    motion.head(seen.rows()).setZero();
    camera.rotation = MovedRigidly(camera.rotation, motion);
  }
  amounts_ += increments;
  held_ += change;
  return model_.MoveSupports(change);
}

Eigen::MatrixXd MotionElimination::SeenAtRest(Eigen::Index k) const {
  const Eigen::MatrixXd& nodes = scene_.mesh.nodes;
  return cameras_.empty() ? nodes : cameras_[k].Seen(nodes);
}

// At small strains, a trial of moduli that are far too small displaces the
// specimen by many times its size, about which a rotation would mean nothing.
Eigen::MatrixXd MotionElimination::PositionsOfCamera(Eigen::Index k) const {
  const Mesh& mesh = scene_.mesh;
  if (model_.IsLinear()) {
    return SeenAtRest(k);
  }
  const Eigen::MatrixXd positions =
      mesh.nodes +
      model_.Displacement().col(k).reshaped(mesh.Dimension(), mesh.NumNodes());
  return cameras_.empty() ? positions : cameras_[k].Seen(positions);
}

Eigen::MatrixXd MotionElimination::SeenAtRest() const {
  return SeenDisplacements(
      scene_.mesh,
      Eigen::MatrixXd::Zero(model_.Load().rows(), observed_.NumLoadCases()),
      cameras_);
}

Eigen::MatrixXd MotionElimination::FittedDisplacement() const {
  return cameras_.empty() ? WithMotionOfAll(amounts_, model_.Displacement())
                          : model_.Displacement();
}

Eigen::MatrixXd MotionElimination::Turned(
    Eigen::Index k, const Eigen::MatrixXd& changes) const {
  return cameras_.empty() ? changes
                          : TimesEachNode(cameras_[k].rotation, changes);
}

Eigen::MatrixXd MotionElimination::TurnedBack(
    Eigen::Index k, const Eigen::MatrixXd& changes) const {
  return cameras_.empty()
             ? changes
             : TimesEachNode(cameras_[k].rotation.transpose(), changes);
}

Eigen::MatrixXd MotionElimination::Turned(Eigen::MatrixXd changes) const {
  for (Eigen::Index k = 0; k < Eigen::Index(cameras_.size()); ++k) {
    changes.col(k) = Turned(k, changes.col(k));
  }
  return changes;
}

Eigen::MatrixXd MotionElimination::TurnedBack(Eigen::MatrixXd changes) const {
  for (Eigen::Index k = 0; k < Eigen::Index(cameras_.size()); ++k) {
    changes.col(k) = TurnedBack(k, changes.col(k));
  }
  return changes;
}

void MotionElimination::Linearize() {
  const Mesh& mesh = scene_.mesh;
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    Eigen::MatrixXd of_faces = mesh.nodes;
    if (!model_.IsLinear()) {
      of_faces += held_.col(k).reshaped(mesh.Dimension(), mesh.NumNodes());
    }
    UnknownMotion about(scene_, SupportsOf(scene_, k),
                        {of_faces, PositionsOfCamera(k)});
    UnknownMotion& motion = motions_[motion_of_case_[k]];
    // Nodes that are on a line to within rounding may be off it once moved.
    if (about.of_supports.cols() == motion.of_supports.cols() &&
        about.of_all.cols() == motion.of_all.cols()) {
      motion = std::move(about);
    }
  }
}

Eigen::VectorXd MotionElimination::Eliminate(
    const Eigen::MatrixXd& displacements,
    const Eigen::MatrixXd& support_forces) {
  return Eliminate(RowsOf(Turned(displacements), support_forces));
}

Eigen::VectorXd MotionElimination::Eliminate(Eigen::VectorXd rows) {
  Minimize(kOfSensitivities, rows);
  return rows;
}

Eigen::VectorXd MotionElimination::Resultants(
    const Eigen::MatrixXd& support_forces) const {
  Eigen::VectorXd forces(NumResultants());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    forces.segment(first_resultant_[k], NumResultantsOf(k)) =
        ResultantsOfCase(k, support_forces.col(k));
  }
  return forces;
}

Eigen::VectorXd MotionElimination::ResultantsOfCase(
    Eigen::Index k, const Eigen::VectorXd& support_forces) const {
  Eigen::VectorXd forces(NumResultantsOf(k));
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    const ResultantRow& row = resultants_[first_resultant_[k] + i];
    forces(i) = support_forces(row.held).sum() / row.noise_sd;
  }
  return forces;
}

Eigen::MatrixXd MotionElimination::ResultantsTransposed(
    const Eigen::VectorXd& rows) const {
  Eigen::MatrixXd forces =
      Eigen::MatrixXd::Zero(model_.Load().rows(), observed_.NumLoadCases());
  for (Eigen::Index i = 0; i < NumResultants(); ++i) {
    const ResultantRow& row = resultants_[i];
    for (const Eigen::Index dof : row.held) {
      forces(dof, row.load_case) += noise_ / row.noise_sd * rows(i);
    }
  }
  return forces;
}

Eigen::VectorXd MotionElimination::MeasuredResultants() const {
  Eigen::VectorXd forces(NumResultants());
  std::transform(
      resultants_.begin(), resultants_.end(), forces.begin(),
      [](const ResultantRow& row) { return row.force / row.noise_sd; });
  return forces;
}

Eigen::VectorXd MotionElimination::RowsOf(
    const Eigen::MatrixXd& displacements,
    const Eigen::MatrixXd& support_forces) const {
  Eigen::VectorXd rows(NumRows());
  rows << observed_.Restrict(displacements),
      noise_ * Resultants(support_forces);
  return rows;
}

Eigen::VectorXd MotionElimination::MultiplyColumns(
    const Eigen::VectorXd& amounts) const {
  Eigen::VectorXd rows(NumRows());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    const auto of_case = AmountsOf(k, amounts);
    rows.segment(observed_.CaseStart(k), NumObservedOf(k)) =
        columns_[k].of_displacements * of_case;
    rows.segment(observed_.Size() + first_resultant_[k], NumResultantsOf(k)) =
        noise_ * (columns_[k].of_resultants * of_case);
  }
  return rows;
}

Eigen::VectorXd MotionElimination::MultiplyColumnsTransposed(
    const Eigen::VectorXd& rows) const {
  Eigen::VectorXd amounts(amounts_.size());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    AmountsOf(k, amounts) =
        InnerProducts(columns_[k].of_displacements,
                      rows.segment(observed_.CaseStart(k), NumObservedOf(k))) +
        noise_ *
            InnerProducts(columns_[k].of_resultants,
                          rows.segment(observed_.Size() + first_resultant_[k],
                                       NumResultantsOf(k)));
  }
  return amounts;
}

Eigen::MatrixXd MotionElimination::HeldMotion(
    const Eigen::VectorXd& amounts) const {
  Eigen::MatrixXd held(model_.Load().rows(), observed_.NumLoadCases());
  for (Eigen::Index k = 0; k < held.cols(); ++k) {
    const Eigen::SparseMatrix<double>& of_supports = MotionOf(k).of_supports;
    held.col(k) = of_supports * AmountsOf(k, amounts).head(of_supports.cols());
  }
  return held;
}

Eigen::MatrixXd MotionElimination::SupportMotion(
    const Eigen::VectorXd& amounts) {
  return model_.Extend(HeldMotion(amounts));
}

Eigen::MatrixXd MotionElimination::WithMotionOfAll(
    const Eigen::VectorXd& amounts, Eigen::MatrixXd displacements) const {
  for (Eigen::Index k = 0; k < displacements.cols(); ++k) {
    const Eigen::MatrixXd& of_all = MotionOf(k).of_all;
    displacements.col(k) += of_all * AmountsOf(k, amounts).tail(of_all.cols());
  }
  return displacements;
}

Eigen::VectorXd MotionElimination::Multiply(const Eigen::VectorXd& amounts) {
  if (are_columns_of_here_) {
    return MultiplyColumns(amounts);
  }
  const Eigen::MatrixXd motion = SupportMotion(amounts);
  return RowsOf(WithMotionOfAll(amounts, Turned(motion)),
                model_.HeldForces(motion));
}

Eigen::VectorXd MotionElimination::MultiplyTransposed(
    const Eigen::VectorXd& rows) {
  if (are_columns_of_here_) {
    return MultiplyColumnsTransposed(rows);
  }
  const Eigen::MatrixXd of_nodes =
      observed_.RestrictTransposed(rows.head(observed_.Size()));
  Eigen::MatrixXd of_model = of_nodes;
  for (Eigen::Index k = 0; k < of_model.cols(); ++k) {
    of_model.col(k) = TurnedBack(k, of_model.col(k));
  }
  const Eigen::MatrixXd of_held = model_.ExtendTransposed(
      of_model + model_.HeldForcesTransposed(
                     ResultantsTransposed(rows.tail(NumResultants()))));
  Eigen::VectorXd amounts(amounts_.size());
  for (Eigen::Index k = 0; k < of_nodes.cols(); ++k) {
    const UnknownMotion& motion = MotionOf(k);
    AmountsOf(k, amounts) << InnerProducts(motion.of_supports, of_held.col(k)),
        InnerProducts(motion.of_all, of_nodes.col(k));
  }
  return amounts;
}

bool MotionElimination::AreAmountsFew() const {
  return amounts_.size() > 0 &&
         std::all_of(motions_.begin(), motions_.end(),
                     [&](const UnknownMotion& motion) {
                       const Eigen::Index n = motion.NumAmounts();
                       return n <= kMostColumns &&
                              n * NumRows() <= kMostEntries;
                     });
}

void MotionElimination::SolveForColumns() {
  if (!model_.IsLinear() || !cameras_.empty()) {
    Linearize();
  }
  are_columns_of_here_ = false;
  const bool are_worth_solving_anew = std::all_of(
      motions_.begin(), motions_.end(), [](const UnknownMotion& motion) {
        return motion.NumAmounts() <= kMostColumnsAnew;
      });
  if (!AreAmountsFew() || (!are_worth_solving_anew && !columns_.empty())) {
    return;
  }
  are_columns_of_here_ = true;
  columns_.clear();
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    const Eigen::Index n = MotionOf(k).NumAmounts();
    columns_.push_back({Eigen::MatrixXd(NumObservedOf(k), n),
                        Eigen::MatrixXd(NumResultantsOf(k), n),
                        {}});
  }
  for (std::size_t motion = 0; motion < motions_.size(); ++motion) {
    SolveForColumnsOf(motion);
  }
  InvertGrams();
}

void MotionElimination::SolveForColumnsOf(std::size_t index) {
  const UnknownMotion& motion = motions_[index];
  const Eigen::Index n = motion.NumAmounts();
  const Eigen::Index num_of_supports = motion.of_supports.cols();
  const Eigen::Index case_of_motion =
      std::find(motion_of_case_.begin(), motion_of_case_.end(), index) -
      motion_of_case_.begin();
  for (Eigen::Index first = 0; first < n; first += kColumnsAtATime) {
    const Eigen::Index end = std::min(n, first + kColumnsAtATime);
    Eigen::MatrixXd motions(motion.of_all.rows(), end - first);
    for (Eigen::Index j = first; j < end; ++j) {
      motions.col(j - first) =
          j < num_of_supports
              ? Eigen::VectorXd(motion.of_supports.col(j))
              : Eigen::VectorXd(motion.of_all.col(j - num_of_supports));
    }
    const Eigen::Index num_extended =
        std::clamp<Eigen::Index>(num_of_supports - first, 0, end - first);
    motions.leftCols(num_extended) =
        model_.ExtendInCase(case_of_motion, motions.leftCols(num_extended));
    Eigen::MatrixXd forces =
        Eigen::MatrixXd::Zero(motions.rows(), motions.cols());
    forces.leftCols(num_extended) =
        model_.HeldForcesInCase(case_of_motion, motions.leftCols(num_extended));
    // Load cases that share a motion have no cameras that turn.
    motions.leftCols(num_extended) =
        Turned(case_of_motion, motions.leftCols(num_extended));
    for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
      for (Eigen::Index j = first; j < end && motion_of_case_[k] == index;
           ++j) {
        columns_[k].of_displacements.col(j) =
            observed_.RestrictToCase(k, motions.col(j - first));
        columns_[k].of_resultants.col(j) =
            ResultantsOfCase(k, forces.col(j - first));
      }
    }
  }
}

void MotionElimination::InvertGrams() {
  for (Columns& columns : columns_) {
    if (columns.of_displacements.cols() == 0) {
      continue;
    }
    const SymmetricEigenDecomposition gram = DecomposeSymmetric(
        InnerProducts(columns.of_displacements, columns.of_displacements) +
        noise_ * noise_ *
            InnerProducts(columns.of_resultants, columns.of_resultants));
    // What rigid motions of supports and of all have in common is zero here.
    const double least = kDependentAmounts * gram.values.maxCoeff();
    columns.inverse_gram = gram.vectors *
                           (gram.values.array() > least)
                               .select(gram.values.cwiseInverse().array(), 0.0)
                               .matrix()
                               .asDiagonal() *
                           gram.vectors.transpose();
  }
}

Eigen::VectorXd MotionElimination::Precondition(
    const Eigen::VectorXd& gradient) const {
  if (columns_.empty()) {
    return gradient;
  }
  Eigen::VectorXd direction(gradient.size());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    AmountsOf(k, direction) = columns_[k].inverse_gram * AmountsOf(k, gradient);
  }
  return direction;
}

Eigen::VectorXd MotionElimination::Minimize(double tolerance,
                                            Eigen::VectorXd& rows) {
  Eigen::VectorXd amounts = Eigen::VectorXd::Zero(amounts_.size());
  if (amounts.size() == 0) {
    return amounts;
  }
  const double nothing = kRoundingOfRows * kRoundingOfRows * SquaredNorm(rows);
  Eigen::VectorXd gradient = MultiplyTransposed(rows);
  Eigen::VectorXd preconditioned = Precondition(gradient);
  Eigen::VectorXd direction = preconditioned;
  double square = InnerProduct(gradient, preconditioned);
  for (int i = 0; i < kMostIterations && square > 0; ++i) {
    const Eigen::VectorXd step = Multiply(direction);
    const double length = square / SquaredNorm(step);
    amounts += length * direction;
    rows -= length * step;
    const double left = SquaredNorm(rows);
    if (left <= nothing || length * square <= tolerance * left) {
      break;
    }
    gradient = MultiplyTransposed(rows);
    preconditioned = Precondition(gradient);
    const double next = InnerProduct(gradient, preconditioned);
    direction = preconditioned + next / square * direction;
    square = next;
  }
  return amounts;
}

}  // namespace elastimate
