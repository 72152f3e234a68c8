#include "elastimate/core/equilibrium/equilibrium.h"

#include <algorithm>

#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {

Equilibrium::Equilibrium(const Scene& scene, SolverKind solver)
    : forces_(scene.mesh, scene.materials),
      load_(AssembleLoadCases(scene)),
      held_displacement_(load_.rows(), load_.cols()),
      held_forces_(load_.cols()),
      has_unknown_motion_(HasUnknownMotion(scene)) {
  std::vector<const Supports*> supports_of_stiffness;
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    const Supports& supports = SupportsOf(scene, k);
    const auto same = std::find_if(
        supports_of_stiffness.begin(), supports_of_stiffness.end(),
        [&](const Supports* other) {
          return other == &supports || (other->held == supports.held).all();
        });
    stiffness_of_case_.push_back(same - supports_of_stiffness.begin());
    if (same == supports_of_stiffness.end()) {
      supports_of_stiffness.push_back(&supports);
      stiffness_.emplace_back(scene.mesh, supports, solver);
    }
    held_displacement_.col(k) = elastimate::HeldDisplacement(supports);
    Eigen::Index first = 0;
    while (stiffness_of_case_[first] != stiffness_of_case_[k] ||
           held_displacement_.col(first) != held_displacement_.col(k)) {
      ++first;
    }
    first_held_alike_.push_back(first);
    if (first == k && !held_displacement_.col(k).isZero(0)) {
      held_forces_[k] = forces_.Columns(held_displacement_.col(k));
      ++element_passes_;
    }
  }
}

template <class Stiffnesses, class Function>
Eigen::MatrixXd Equilibrium::ByStiffness(Stiffnesses& stiffnesses,
                                         const Eigen::MatrixXd& columns,
                                         const Function& of_stiffness) const {
  if (stiffnesses.size() == 1) {
    return of_stiffness(stiffnesses[0], columns);
  }
  const Eigen::Index n = columns.cols() / NumLoadCases();
  Eigen::MatrixXd results(columns.rows(), columns.cols());
  for (std::size_t i = 0; i < stiffnesses.size(); ++i) {
    std::vector<Eigen::Index> own;
    for (Eigen::Index j = 0; j < columns.cols(); ++j) {
      if (stiffness_of_case_[j / n] == Eigen::Index(i)) {
        own.push_back(j);
      }
    }
    results(Eigen::all, own) =
        of_stiffness(stiffnesses[i], columns(Eigen::all, own));
  }
  return results;
}

bool Equilibrium::Solve(const Eigen::VectorXd& moduli) {
  ++element_passes_;
  // Of moduli of any unit, a stiffness without one.
  scale_ = moduli.cwiseAbs().maxCoeff();
  const Eigen::VectorXd scaled = moduli / scale_;
  const Eigen::MatrixXd blocks = forces_.Blocks(scaled, Graph());
  for (SupportedStiffness& stiffness : stiffness_) {
    if (!stiffness.Factorize(blocks, has_unknown_motion_)) {
      return false;
    }
  }
  SolveForSupports(scaled);
  displacement_ = SolveFor(load_) + support_response_;
  return !displacement_.hasNaN();
}

void Equilibrium::SolveForSupports(const Eigen::VectorXd& scaled_moduli) {
  support_response_ = held_displacement_;
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    if (first_held_alike_[k] != k) {
      support_response_.col(k) = support_response_.col(first_held_alike_[k]);
    } else if (held_forces_[k].size() > 0) {
      support_response_.col(k) -= stiffness_[stiffness_of_case_[k]].Solve(
          held_forces_[k] * scaled_moduli);
    }
  }
}

Eigen::MatrixXd Equilibrium::Sensitivities(const Eigen::MatrixXd& directions) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd sensitivities(displacement_.rows(), n * displacement_.cols());
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    ++element_passes_;
    sensitivities.middleCols(n * k, n) =
        -stiffness_[stiffness_of_case_[k]].Solve(
            forces_.Columns(displacement_.col(k)) * (directions / scale_));
  }
  return sensitivities;
}

Eigen::MatrixXd Equilibrium::SolveFor(const Eigen::MatrixXd& forces) {
  return ByStiffness(
      stiffness_, forces,
      [&](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns) {
        return Eigen::MatrixXd(stiffness.Solve(columns) / scale_);
      });
}

Eigen::MatrixXd Equilibrium::Extend(const Eigen::MatrixXd& held) {
  return ByStiffness(
      stiffness_, held,
      [](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns) {
        return stiffness.Extend(columns);
      });
}

Eigen::MatrixXd Equilibrium::ExtendTransposed(const Eigen::MatrixXd& values) {
  return ByStiffness(
      stiffness_, values,
      [](SupportedStiffness& stiffness, const Eigen::MatrixXd& columns) {
        return stiffness.ExtendTransposed(columns);
      });
}

Eigen::MatrixXd Equilibrium::ExtendInCase(Eigen::Index k,
                                          const Eigen::MatrixXd& held) {
  return stiffness_[stiffness_of_case_[k]].Extend(held);
}

void Equilibrium::Superpose(const Eigen::MatrixXd& displacement) {
  displacement_ += displacement;
}

Eigen::MatrixXd Equilibrium::HeldForces(
    const Eigen::MatrixXd& displacements) const {
  return ByStiffness(
      stiffness_, displacements,
      [&](const SupportedStiffness& stiffness, const Eigen::MatrixXd& columns) {
        return Eigen::MatrixXd(scale_ * stiffness.HeldForces(columns));
      });
}

Eigen::MatrixXd Equilibrium::HeldForcesTransposed(
    const Eigen::MatrixXd& held) const {
  return ByStiffness(
      stiffness_, held,
      [&](const SupportedStiffness& stiffness, const Eigen::MatrixXd& columns) {
        return Eigen::MatrixXd(scale_ *
                               stiffness.HeldForcesTransposed(columns));
      });
}

Eigen::MatrixXd Equilibrium::HeldForcesInCase(
    Eigen::Index k, const Eigen::MatrixXd& displacements) const {
  return scale_ * stiffness_[stiffness_of_case_[k]].HeldForces(displacements);
}

Eigen::MatrixXd Equilibrium::SupportForces() const {
  return HeldForces(displacement_) -
         ByStiffness(stiffness_, load_,
                     [](const SupportedStiffness& stiffness,
                        const Eigen::MatrixXd& loads) {
                       return stiffness.OfHeld(loads);
                     });
}

Eigen::MatrixXd Equilibrium::SupportForceSensitivities(
    const Eigen::MatrixXd& directions, const Eigen::MatrixXd& sensitivities) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd forces = HeldForces(sensitivities);
  for (Eigen::Index k = 0; k < displacement_.cols(); ++k) {
    ++element_passes_;
    forces.middleCols(n * k, n) += stiffness_[stiffness_of_case_[k]].OfHeld(
        forces_.Columns(displacement_.col(k)) * directions);
  }
  return forces;
}

Work Equilibrium::WorkDone() const {
  Work work;
  for (const SupportedStiffness& stiffness : stiffness_) {
    work = work + stiffness.Solver().WorkDone();
  }
  work.element_passes += element_passes_;
  return work;
}

const std::string& Equilibrium::Notice() const {
  for (const SupportedStiffness& stiffness : stiffness_) {
    if (!stiffness.Solver().Notice().empty()) {
      return stiffness.Solver().Notice();
    }
  }
  return stiffness_[0].Solver().Notice();
}

}  // namespace elastimate
