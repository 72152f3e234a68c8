#include "elastimate/core/equilibrium/equilibrium.h"

#include <algorithm>
#include <stdexcept>

#include "elastimate/core/equilibrium/assembled_stiffness.h"
#include "elastimate/core/equilibrium/nested_stiffness.h"
#include "elastimate/core/equilibrium/refined_stiffness.h"
#include "elastimate/core/equilibrium/supported_stiffness.h"
#include "elastimate/core/equilibrium/vertex_space.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {

Equilibrium::Equilibrium(const Scene& scene, SolverKind solver)
    : Equilibrium(std::vector<const Scene*>{&scene}, solver) {}

Equilibrium::Equilibrium(const std::vector<const Scene*>& spaces,
                         SolverKind solver, double tolerance,
                         const StiffnessSolver* shared)
    : Equilibrium(UsedSpacesOf(spaces, solver), solver, tolerance, shared) {}

Equilibrium::UsedSpaces Equilibrium::UsedSpacesOf(
    const std::vector<const Scene*>& spaces, SolverKind solver) {
  if (AreNested(spaces)) {
    return {spaces, nullptr};
  }
  UsedSpaces used = {{spaces.back()},
                     VertexSpaceToSolveBy(*spaces.back(), solver)};
  if (used.vertices) {
    used.scenes.insert(used.scenes.begin(), &used.vertices->scene);
  }
  return used;
}

Equilibrium::Equilibrium(UsedSpaces used, SolverKind solver, double tolerance,
                         const StiffnessSolver* shared)
    : vertices_(std::move(used.vertices)),
      values_(std::make_unique<NestedStiffness>(used.scenes)),
      mesh_(&used.scenes.back()->mesh),
      load_(AssembleLoadCases(*used.scenes.back())),
      has_unknown_motion_(HasUnknownMotion(*used.scenes.back())),
      tolerance_(IsRefined() ? tolerance : StiffnessSolver::kAccurate) {
  const Scene& scene = *used.scenes.back();
  if (vertices_) {
    shared = &vertices_->solver;
  }
  const HeldGroups groups = GroupByHeld(scene);
  stiffness_of_case_ = groups.of_case;
  for (const Eigen::Index k : groups.first_cases) {
    const bool is_like_shared =
        shared != nullptr && shared->Holds(SupportsOf(*used.scenes.front(), k));
    AddStiffness(used.scenes, k, solver, is_like_shared ? shared : nullptr);
    if (is_like_shared) {
      shared = nullptr;  // Two of them would factorise in turns.
    }
  }
  SetTolerance(tolerance_);
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    const Eigen::VectorXd held =
        elastimate::HeldDisplacement(SupportsOf(scene, k));
    if (held_displacement_.size() == 0 && !held.isZero(0)) {
      held_displacement_.setZero(load_.rows(), load_.cols());
    }
    if (held_displacement_.size() > 0) {
      held_displacement_.col(k) = held;
    }
  }
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    Eigen::Index first = 0;
    while (stiffness_of_case_[first] != stiffness_of_case_[k] ||
           (held_displacement_.size() > 0 &&
            held_displacement_.col(first) != held_displacement_.col(k))) {
      ++first;
    }
    first_held_alike_.push_back(first);
  }
}

void Equilibrium::AddStiffness(const std::vector<const Scene*>& spaces,
                               Eigen::Index k, SolverKind solver,
                               const StiffnessSolver* shared) {
  std::vector<const Mesh*> meshes;
  std::vector<const Supports*> supports;
  for (const Scene* const space : spaces) {
    meshes.push_back(&space->mesh);
    supports.push_back(&SupportsOf(*space, k));
  }
  if (spaces.size() > 1) {
    stiffness_.push_back(
        std::make_unique<RefinedStiffness>(meshes, supports, solver, shared));
  } else {
    stiffness_.push_back(std::make_unique<AssembledStiffness>(
        *meshes[0], *supports[0], solver, shared));
  }
}

template <class Function>
Eigen::MatrixXd Equilibrium::ByStiffness(const Eigen::MatrixXd& columns,
                                         const Function& of_stiffness) const {
  const Eigen::Index n = columns.cols() / NumLoadCases();
  std::vector<std::vector<Eigen::Index>> own(stiffness_.size());
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    own[stiffness_of_case_[j / n]].push_back(j);
  }
  if (stiffness_.size() == 1) {
    return of_stiffness(*stiffness_[0], columns, own[0]);
  }
  Eigen::MatrixXd results(columns.rows(), columns.cols());
  for (std::size_t i = 0; i < stiffness_.size(); ++i) {
    results(Eigen::all, own[i]) =
        of_stiffness(*stiffness_[i], columns(Eigen::all, own[i]), own[i]);
  }
  return results;
}

Equilibrium::~Equilibrium() = default;
Equilibrium::Equilibrium(Equilibrium&&) noexcept = default;
Equilibrium& Equilibrium::operator=(Equilibrium&&) noexcept = default;

const InternalForces& Equilibrium::Forces() const {
  return values_->Forces(values_->NumSpaces() - 1);
}

const NodeGraph& Equilibrium::Graph() const {
  if (!IsRefined()) {
    return stiffness_[0]->GraphOfAssembled();
  }
  if (!graph_) {
    graph_.emplace(*mesh_);
  }
  return *graph_;
}

void Equilibrium::SetTolerance(double tolerance) {
  for (const std::unique_ptr<SupportedStiffness>& stiffness : stiffness_) {
    stiffness->SetTolerance(tolerance);
  }
}

bool Equilibrium::SolveRoughly(const Eigen::VectorXd& moduli) {
  constexpr double kRough = 1e-4;
  SetTolerance(std::max(kRough, tolerance_));
  const bool is_solved = Solve(moduli);
  SetTolerance(tolerance_);
  return is_solved;
}

const StiffnessSolver* Equilibrium::SolverOfCoarsest() const {
  return stiffness_[0]->SolverOfCoarsest();
}

bool Equilibrium::IsRefined() const { return values_->NumSpaces() > 1; }

bool Equilibrium::Solve(const Eigen::VectorXd& moduli) {
  // The moduli come in any unit.  The stiffness that is factorised is scaled to
  // moduli of at most 1.
  moduli_ = moduli;
  scale_ = moduli.cwiseAbs().maxCoeff();
  const Eigen::VectorXd scaled = moduli / scale_;
  directions_.resize(0, 0);
  for (const std::unique_ptr<SupportedStiffness>& stiffness : stiffness_) {
    stiffness->Forget();
  }
  values_->SetModuli(scaled);
  for (const std::unique_ptr<SupportedStiffness>& stiffness : stiffness_) {
    if (!stiffness->Factorize(*values_, has_unknown_motion_)) {
      return false;
    }
  }
  values_->ForgetInverseBlocks();
  if (held_displacement_.size() == 0) {
    displacement_ = SolveFrom(displacement_, load_);
    return !displacement_.hasNaN();
  }
  const Eigen::MatrixXd start =
      displacement_.size() > 0 && support_response_.size() > 0
          ? Eigen::MatrixXd(displacement_ - support_response_)
          : Eigen::MatrixXd();
  SolveForSupports(scaled);
  displacement_ = SolveFrom(start, load_) + support_response_;
  return !displacement_.hasNaN();
}

void Equilibrium::SolveForSupports(const Eigen::VectorXd& scaled_moduli) {
  // The iterations begin with the response of the free nodes at the last
  // moduli.
  const Eigen::MatrixXd start =
      support_response_.size() > 0
          ? Eigen::MatrixXd(held_displacement_ - support_response_)
          : Eigen::MatrixXd();
  support_response_ = held_displacement_;
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    if (first_held_alike_[k] != k) {
      support_response_.col(k) = support_response_.col(first_held_alike_[k]);
    } else if (!held_displacement_.col(k).isZero(0)) {
      ++element_passes_;
      support_response_.col(k) -= stiffness_[stiffness_of_case_[k]]->Solve(
          Forces().Multiply(scaled_moduli, held_displacement_.col(k)),
          start.size() > 0 ? Eigen::MatrixXd(start.col(k)) : start);
    }
  }
}

Eigen::MatrixXd Equilibrium::Sensitivities(const Eigen::MatrixXd& directions) {
  if (directions_.size() > 0 && directions_.cols() == directions.cols() &&
      directions_ == directions) {
    return sensitivities_;
  }
  const Eigen::Index n = directions.cols();
  const bool has_start = sensitivities_.cols() == n * displacement_.cols();
  if (!has_start) {
    sensitivities_.resize(displacement_.rows(), n * displacement_.cols());
  }
  directions_.resize(0, 0);
  // Iterations over finer spaces take as long for each column alone, and need
  // less memory.
  const Eigen::Index at_a_time = IsRefined() ? 1 : n;
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    for (Eigen::Index i = 0; i < n; i += at_a_time) {
      auto columns = sensitivities_.middleCols(n * k + i, at_a_time);
      const std::optional<double> growth =
          at_a_time == 1 ? GrowthAlong(directions.col(i)) : std::nullopt;
      if (growth) {
        columns = -*growth * displacement_.col(k);
        if (support_response_.size() > 0) {
          columns += *growth * support_response_.col(k);
        }
        continue;
      }
      ++element_passes_;
      columns = -stiffness_[stiffness_of_case_[k]]->Solve(
          Forces().Along(directions.middleCols(i, at_a_time) / scale_,
                         displacement_.col(k)),
          has_start ? Eigen::MatrixXd(columns) : Eigen::MatrixXd());
    }
  }
  directions_ = directions;
  return sensitivities_;
}

std::optional<double> Equilibrium::GrowthAlong(
    const Eigen::VectorXd& direction) const {
  // Directions come from a few products of moduli, each rounded by 2e-16.  If a
  // direction is as close to the moduli by chance, its sensitivities differ by
  // less than the error that iterations leave (1e-8), as long as no modulus is
  // a millionth of another.
  constexpr double kRounding = 1e-14;
  const double growth = direction.dot(moduli_) / moduli_.squaredNorm();
  return !has_unknown_motion_ && (direction - growth * moduli_).norm() <=
                                     kRounding * direction.norm()
             ? std::optional<double>(growth)
             : std::nullopt;
}

Eigen::MatrixXd Equilibrium::SolveFor(const Eigen::MatrixXd& forces) {
  return SolveFrom({}, forces);
}

void Equilibrium::ClearHeld(Eigen::MatrixXd& columns) const {
  const Eigen::Index n = columns.cols() / NumLoadCases();
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    stiffness_[stiffness_of_case_[k]]->ClearHeld(columns.middleCols(n * k, n));
  }
}

Eigen::MatrixXd Equilibrium::Precondition(const Eigen::MatrixXd& forces) {
  return ByStiffness(
      forces, [&](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns,
                  const auto& /*own*/) {
        Eigen::MatrixXd x = stiffness.Precondition(columns);
        x /= scale_;
        return x;
      });
}

Eigen::MatrixXd Equilibrium::SolveFrom(const Eigen::MatrixXd& start,
                                       const Eigen::MatrixXd& forces) {
  return ByStiffness(
      forces, [&](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns,
                  const std::vector<Eigen::Index>& own) {
        Eigen::MatrixXd x = stiffness.Solve(
            columns, start.size() > 0 ? Eigen::MatrixXd(start(Eigen::all, own))
                                      : Eigen::MatrixXd());
        x /= scale_;
        return x;
      });
}

Eigen::MatrixXd Equilibrium::Extend(const Eigen::MatrixXd& held) {
  return ByStiffness(
      held, [](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns,
               const auto& /*own*/) { return stiffness.Extend(columns); });
}

Eigen::MatrixXd Equilibrium::ExtendTransposed(const Eigen::MatrixXd& values) {
  return ByStiffness(
      values,
      [](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns,
         const auto& /*own*/) { return stiffness.ExtendTransposed(columns); });
}

Eigen::MatrixXd Equilibrium::ExtendInCase(Eigen::Index k,
                                          const Eigen::MatrixXd& held) {
  return stiffness_[stiffness_of_case_[k]]->Extend(held);
}

bool Equilibrium::MoveSupports(const Eigen::MatrixXd& held) {
  directions_.resize(0, 0);
  displacement_ += Extend(held);
  return true;
}

Eigen::MatrixXd Equilibrium::HeldForces(
    const Eigen::MatrixXd& displacements) const {
  return ByStiffness(
      displacements, [&](const SupportedStiffness& stiffness,
                         const Eigen::MatrixXd& columns, const auto& /*own*/) {
        return Eigen::MatrixXd(scale_ * stiffness.HeldForces(columns));
      });
}

Eigen::MatrixXd Equilibrium::HeldForcesTransposed(
    const Eigen::MatrixXd& held) const {
  return ByStiffness(held, [&](const SupportedStiffness& stiffness,
                               const Eigen::MatrixXd& columns,
                               const auto& /*own*/) {
    return Eigen::MatrixXd(scale_ * stiffness.HeldForcesTransposed(columns));
  });
}

Eigen::MatrixXd Equilibrium::HeldForcesInCase(
    Eigen::Index k, const Eigen::MatrixXd& displacements) const {
  return scale_ * stiffness_[stiffness_of_case_[k]]->HeldForces(displacements);
}

Eigen::MatrixXd Equilibrium::SupportForces() const {
  return HeldForces(displacement_) -
         ByStiffness(load_,
                     [](const SupportedStiffness& stiffness,
                        const Eigen::MatrixXd& loads, const auto& /*own*/) {
                       return stiffness.OfHeld(loads);
                     });
}

Eigen::MatrixXd Equilibrium::SupportForceSensitivities(
    const Eigen::MatrixXd& directions, const Eigen::MatrixXd& sensitivities) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd forces = HeldForces(sensitivities);
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    ++element_passes_;
    forces.middleCols(n * k, n) += stiffness_[stiffness_of_case_[k]]->OfHeld(
        Forces().Along(directions, displacement_.col(k)));
  }
  return forces;
}

Work Equilibrium::WorkDone() const {
  Work work;
  for (const std::unique_ptr<SupportedStiffness>& stiffness : stiffness_) {
    work = work + stiffness->WorkDone();
  }
  work.element_passes += element_passes_ + values_->NumPasses();
  return work;
}

const std::string& Equilibrium::Notice() const {
  for (const std::unique_ptr<SupportedStiffness>& stiffness : stiffness_) {
    if (!stiffness->Notice().empty()) {
      return stiffness->Notice();
    }
  }
  return stiffness_[0]->Notice();
}

Eigen::MatrixXd DisplacementsAt(const Scene& scene,
                                const Eigen::VectorXd& parameters,
                                SolverKind solver) {
  return DisplacementsAt(std::vector<const Scene*>{&scene}, parameters, solver);
}

Eigen::MatrixXd DisplacementsAt(const std::vector<const Scene*>& spaces,
                                const Eigen::VectorXd& parameters,
                                SolverKind solver) {
  Equilibrium model(spaces, solver);
  if (!model.Solve(model.Forces().Parameters().Moduli(parameters))) {
    throw std::runtime_error(
        "the stiffness matrix is singular to working precision");
  }
  return model.Displacement();
}

}  // namespace elastimate
