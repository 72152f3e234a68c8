#include "elastimate/core/equilibrium/large_strain_model.h"

#include <utility>

#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {
namespace {

// Steps of the load to where there is an equilibrium take 10 to 60 tangents;
// those of moduli that are far too soft take hundreds.
constexpr int kMostTangentsFromRest = 150;

}  // namespace

LargeStrainModel::LargeStrainModel(const Scene& scene)
    : scene_(scene),
      equilibrium_(scene, Dilatation::kMeanOfElement,
                   HasUnknownMotion(scene) ? KeptFactors::kOfEachCase
                                           : KeptFactors::kLast),
      given_(equilibrium_.HeldDisplacement()),
      states_(scene.load_cases.size()),
      displacement_(given_.rows(), given_.cols()) {}

void LargeStrainModel::BeginWith(const Eigen::MatrixXd& displacement) {
  begin_ = displacement;
  why_not_solved_.clear();
}

void LargeStrainModel::SetDilatation(Dilatation dilatation) {
  equilibrium_.SetDilatation(dilatation);
  why_not_solved_.clear();
  // The displacements of elements that lock may be far from those of others.
  if (!IsFirstSolve()) {
    BeginWith(displacement_);
  }
}

LargeStrainState LargeStrainModel::FollowModuli(Eigen::Index k) {
  constexpr double kShortestStep = 1.0 / 4;
  const CaseState& last = states_[k];
  LargeStrainState found;
  found.displacement = last.displacement;
  double done = 0;
  double step = 1.0 / 2;
  while (done < 1) {
    LargeStrainState next = equilibrium_.SolveFrom(
        found.displacement,
        last.moduli + (done + step) * (moduli_ - last.moduli), k);
    if (next.status == EquilibriumStatus::kDone) {
      found = next;
      done += step;
    } else if (step > kShortestStep) {
      step /= 2;
    } else {
      return next;
    }
  }
  return found;
}

bool LargeStrainModel::SolveInCase(Eigen::Index k,
                                   const Eigen::VectorXd& start) {
  LargeStrainState found;
  if (start.size() > 0) {
    found = equilibrium_.SolveFrom(start, moduli_, k);
  }
  if (found.status != EquilibriumStatus::kDone && !IsFirstSolve()) {
    found = FollowModuli(k);
  }
  if (found.status != EquilibriumStatus::kDone) {
    found = equilibrium_.Solve(moduli_, k,
                               IsFirstSolve() ? kMostTangentsFromRest : 0);
  }
  if (found.status != EquilibriumStatus::kDone) {
    why_not_solved_ = "in load case " + std::to_string(k + 1) + ", " +
                      WhyNotInEquilibrium(found);
    return false;
  }
  StiffnessSolver& solver = equilibrium_.TangentSolver(k);
  case_of_factor_[&solver] = k;
  CaseState& state = states_[k];
  state.moduli = moduli_;
  state.displacement = found.displacement;
  displacement_.col(k) = found.displacement;
  state.sensitivities = -solver.Solve(
      equilibrium_.Forces().ModuliDerivatives(moduli_, found.displacement));
  return true;
}

bool LargeStrainModel::Solve(const Eigen::VectorXd& moduli) {
  // A search asks again where it begins.
  if (!why_not_solved_.empty() && moduli == moduli_) {
    return false;
  }
  return SolveMoved(moduli,
                    Eigen::MatrixXd::Zero(given_.rows(), given_.cols()));
}

bool LargeStrainModel::SolveMoved(const Eigen::VectorXd& moduli,
                                  const Eigen::MatrixXd& held) {
  why_not_solved_.clear();
  moduli_ = moduli;
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    equilibrium_.SetHeldDisplacement(k, given_.col(k) + held.col(k));
    const CaseState& last = states_[k];
    Eigen::VectorXd start;
    if (begin_) {
      start = begin_->col(k);
    } else if (last.moduli.size() > 0) {
      start = last.displacement + last.sensitivities * (moduli - last.moduli);
    }
    if (!SolveInCase(k, start)) {
      return false;
    }
  }
  begin_.reset();
  return true;
}

bool LargeStrainModel::MoveSupports(const Eigen::MatrixXd& held) {
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    if (!MoveSupportsOfCase(k, held.col(k))) {
      return false;
    }
  }
  return true;
}

bool LargeStrainModel::MoveSupportsOfCase(Eigen::Index k,
                                          const Eigen::VectorXd& held) {
  constexpr double kShortestStep = 1.0 / 16;
  const Eigen::VectorXd from = equilibrium_.HeldDisplacement().col(k);
  double done = 0;
  double step = 1;
  while (done < 1) {
    equilibrium_.SetHeldDisplacement(k, from + (done + step) * held);
    if (SolveInCase(k, states_[k].displacement)) {
      done += step;
    } else {
      step /= 2;
    }
    if (step < kShortestStep) {
      return false;
    }
  }
  why_not_solved_.clear();
  return true;
}

template <class Function>
Eigen::MatrixXd LargeStrainModel::ByCase(const Eigen::MatrixXd& columns,
                                         const Function& of_case) const {
  const Eigen::Index n = columns.cols() / NumLoadCases();
  Eigen::MatrixXd results(columns.rows(), columns.cols());
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    results.middleCols(n * k, n) = of_case(k, columns.middleCols(n * k, n));
  }
  return results;
}

StiffnessSolver& LargeStrainModel::TangentSolver(Eigen::Index k) {
  StiffnessSolver& solver = equilibrium_.TangentSolver(k);
  if (std::exchange(case_of_factor_[&solver], k) != k) {
    equilibrium_.FactorizeAgain(moduli_, k, displacement_.col(k));
  }
  return solver;
}

Eigen::MatrixXd LargeStrainModel::TangentProducts(
    Eigen::Index k, const Eigen::MatrixXd& columns) const {
  return equilibrium_.Forces().TangentProducts(moduli_, displacement_.col(k),
                                               columns);
}

Eigen::MatrixXd LargeStrainModel::OfHeldInCase(Eigen::Index k,
                                               Eigen::MatrixXd values) const {
  const auto& held = SupportsOf(scene_, k).held;
  for (Eigen::Index dof = 0; dof < values.rows(); ++dof) {
    if (!held(dof)) {
      values.row(dof).setZero();
    }
  }
  return values;
}

Eigen::MatrixXd LargeStrainModel::Sensitivities(
    const Eigen::MatrixXd& directions) {
  Eigen::MatrixXd sensitivities(displacement_.rows(),
                                directions.cols() * NumLoadCases());
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    sensitivities.middleCols(directions.cols() * k, directions.cols()) =
        states_[k].sensitivities * directions;
  }
  return sensitivities;
}

Eigen::MatrixXd LargeStrainModel::SolveFor(const Eigen::MatrixXd& forces) {
  return ByCase(forces, [&](Eigen::Index k, const Eigen::MatrixXd& columns) {
    return TangentSolver(k).Solve(columns);
  });
}

Eigen::MatrixXd LargeStrainModel::ExtendInCase(Eigen::Index k,
                                               const Eigen::MatrixXd& held) {
  return held - TangentSolver(k).Solve(TangentProducts(k, held));
}

Eigen::MatrixXd LargeStrainModel::Extend(const Eigen::MatrixXd& held) {
  return ByCase(held, [&](Eigen::Index k, const Eigen::MatrixXd& columns) {
    return ExtendInCase(k, columns);
  });
}

Eigen::MatrixXd LargeStrainModel::ExtendTransposed(
    const Eigen::MatrixXd& values) {
  return ByCase(values, [&](Eigen::Index k, const Eigen::MatrixXd& columns) {
    return Eigen::MatrixXd(
        OfHeldInCase(k, columns) -
        HeldForcesInCase(k, TangentSolver(k).Solve(columns)));
  });
}

Eigen::MatrixXd LargeStrainModel::HeldForcesInCase(
    Eigen::Index k, const Eigen::MatrixXd& displacements) const {
  return OfHeldInCase(k, TangentProducts(k, displacements));
}

Eigen::MatrixXd LargeStrainModel::HeldForces(
    const Eigen::MatrixXd& displacements) const {
  return ByCase(displacements,
                [&](Eigen::Index k, const Eigen::MatrixXd& columns) {
                  return HeldForcesInCase(k, columns);
                });
}

Eigen::MatrixXd LargeStrainModel::HeldForcesTransposed(
    const Eigen::MatrixXd& held) const {
  return ByCase(held, [&](Eigen::Index k, const Eigen::MatrixXd& columns) {
    return TangentProducts(k, OfHeldInCase(k, columns));
  });
}

Eigen::MatrixXd LargeStrainModel::SupportForces() const {
  return ByCase(displacement_, [&](Eigen::Index k, const Eigen::MatrixXd& u) {
    return OfHeldInCase(k, equilibrium_.Forces().Forces(moduli_, u.col(0)) -
                               equilibrium_.LoadAt(k, u.col(0)));
  });
}

Eigen::MatrixXd LargeStrainModel::SupportForceSensitivities(
    const Eigen::MatrixXd& directions, const Eigen::MatrixXd& sensitivities) {
  return ByCase(
      sensitivities, [&](Eigen::Index k, const Eigen::MatrixXd& of_case) {
        return OfHeldInCase(k, TangentProducts(k, of_case) +
                                   equilibrium_.Forces().ModuliDerivatives(
                                       moduli_, displacement_.col(k)) *
                                       directions);
      });
}

}  // namespace elastimate
