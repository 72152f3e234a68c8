#include "elastimate/estimators/maps/field_sensitivity.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {
namespace {

// Solves with so many columns at a time are nearly as quick as they get.
constexpr Eigen::Index kFieldColumns = 64;

// Applies `function` to some columns at a time.
template <class Function>
Eigen::MatrixXd ByColumns(const Eigen::MatrixXd& columns, Eigen::Index num_rows,
                          const Function& function) {
  Eigen::MatrixXd results(num_rows, columns.cols());
  for (Eigen::Index j = 0; j < columns.cols(); j += kFieldColumns) {
    const Eigen::Index n = std::min(kFieldColumns, columns.cols() - j);
    results.middleCols(j, n) = function(columns.middleCols(j, n));
  }
  return results;
}

}  // namespace

Scene WithMaterialOfEachElement(Scene scene) {
  const int num_elements = static_cast<int>(scene.mesh.NumElements());
  scene.mesh.regions.setLinSpaced(num_elements, 0, num_elements - 1);
  scene.materials.assign(std::size_t(num_elements), Material());
  for (int e = 0; e < num_elements; ++e) {
    scene.materials[std::size_t(e)].regions = {e};
  }
  return scene;
}

FieldSensitivity::FieldSensitivity(const Scene& scene, SolverKind solver)
    : mesh_(scene.mesh),
      scene_(WithMaterialOfEachElement(scene)),
      model_(scene_, solver),
      observed_(scene_),
      parts_(SplitIntoElements(scene.mesh)),
      of_parts_(parts_.mesh),
      forces_(scene.load_cases.size()),
      forces_by_poisson_ratio_(scene.load_cases.size()) {
  if (HasUnknownMotion(scene_)) {
    motion_.emplace(scene_, observed_, model_);
  }
}

Eigen::Index FieldSensitivity::NumRows() const {
  return motion_ ? motion_->NumRows() : observed_.Size();
}

Eigen::Index FieldSensitivity::NumIndependentRows() const {
  return NumRows() - (motion_ ? motion_->NumAmounts() : 0);
}

bool FieldSensitivity::MoveTo(const Eigen::VectorXd& log_moduli,
                              double poisson_ratio, double noise) {
  const SectionModel section = mesh_.section.model;
  const double factor = ComplianceFactor(poisson_ratio, section);
  const Eigen::VectorXd scale = log_moduli.array().exp() / factor;
  Eigen::VectorXd moduli(2 * NumElements());
  moduli(Eigen::seq(0, Eigen::last, 2)) = scale;
  moduli(Eigen::seq(1, Eigen::last, 2)) = poisson_ratio * scale;
  if (!moduli.allFinite()) {
    return false;
  }
  if (motion_) {
    motion_->SetNoise(noise);
    if (!model_.SolveMoved(moduli, motion_->HeldMotion())) {
      return false;
    }
    const std::optional<Eigen::VectorXd> rows = motion_->Fit();
    if (!rows) {
      return false;
    }
    residual_ = -*rows;
  } else {
    if (!model_.Solve(moduli)) {
      return false;
    }
    residual_ =
        observed_.Measured() - observed_.Restrict(model_.Displacement());
  }
  StiffnessProducts products;
  of_parts_.Multiply(parts_.Gather(model_.Displacement()), products);
  const double slope = ComplianceFactorSlope(poisson_ratio, section) / factor;
  const int dimension = mesh_.Dimension();
  for (Eigen::Index k = 0; k < NumCases(); ++k) {
    const auto gather = [&](const Eigen::VectorXd& of_copies) {
      Eigen::MatrixXd of_elements(dimension * mesh_.elements.rows(),
                                  NumElements());
      for (Eigen::Index e = 0; e < NumElements(); ++e) {
        for (Eigen::Index i = 0; i < mesh_.elements.rows(); ++i) {
          of_elements.col(e).segment(dimension * i, dimension) =
              scale(e) *
              of_copies.segment(
                  dimension * Eigen::Index(parts_.mesh.elements(i, e)),
                  dimension);
        }
      }
      return of_elements;
    };
    forces_[k] = gather(products.h.col(k) + poisson_ratio * products.j.col(k));
    forces_by_poisson_ratio_[k] =
        gather(products.j.col(k)) - slope * forces_[k];
  }
  return residual_.allFinite();
}

double FieldSensitivity::RelativeResidual() const {
  return residual_.head(observed_.Size()).norm() /
         observed_.MeasuredWithoutTurn().norm();
}

Eigen::MatrixXd FieldSensitivity::FittedDisplacement() const {
  return motion_ ? motion_->FittedDisplacement() : Eigen::MatrixXd();
}

Eigen::VectorXd FieldSensitivity::Scatter(
    const Eigen::MatrixXd& of_elements,
    const Eigen::Ref<const Eigen::VectorXd>& factor) const {
  const int dimension = mesh_.Dimension();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(mesh_.NumDofs());
  for (Eigen::Index e = 0; e < NumElements(); ++e) {
    if (factor(e) == 0) {
      continue;
    }
    for (Eigen::Index i = 0; i < mesh_.elements.rows(); ++i) {
      forces.segment(dimension * Eigen::Index(mesh_.elements(i, e)),
                     dimension) +=
          factor(e) * of_elements.col(e).segment(dimension * i, dimension);
    }
  }
  return forces;
}

Eigen::MatrixXd FieldSensitivity::RowsOf(const Eigen::MatrixXd& forces) {
  const Eigen::MatrixXd change = -model_.SolveFor(forces);
  const Eigen::Index n = forces.cols() / NumCases();
  Eigen::MatrixXd rows(NumRows(), n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::MatrixXd of_column =
        change(Eigen::all, Eigen::seq(j, Eigen::last, n));
    if (!motion_) {
      rows.col(j) = observed_.Restrict(of_column);
      continue;
    }
    rows.col(j) = motion_->Eliminate(
        of_column,
        model_.HeldForces(of_column) +
            OfHeld(scene_, forces(Eigen::all, Eigen::seq(j, Eigen::last, n))));
  }
  return rows;
}

Eigen::MatrixXd FieldSensitivity::Multiply(const Eigen::MatrixXd& v) {
  return ByColumns(v, NumRows(), [&](const Eigen::MatrixXd& some) {
    const Eigen::Index n = some.cols();
    Eigen::MatrixXd forces(mesh_.NumDofs(), n * NumCases());
    for (Eigen::Index j = 0; j < forces.cols(); ++j) {
      forces.col(j) = Scatter(forces_[j / n], some.col(j % n));
    }
    return RowsOf(forces);
  });
}

Eigen::VectorXd FieldSensitivity::OfPoissonRatio() {
  Eigen::MatrixXd forces(mesh_.NumDofs(), NumCases());
  for (Eigen::Index k = 0; k < NumCases(); ++k) {
    forces.col(k) = Scatter(forces_by_poisson_ratio_[k],
                            Eigen::VectorXd::Ones(NumElements()));
  }
  return RowsOf(forces);
}

Eigen::MatrixXd FieldSensitivity::MultiplyTransposed(const Eigen::MatrixXd& w) {
  const int dimension = mesh_.Dimension();
  return ByColumns(w, NumElements(), [&](const Eigen::MatrixXd& some) {
    const Eigen::Index n = some.cols();
    Eigen::MatrixXd sources(mesh_.NumDofs(), n * NumCases());
    Eigen::MatrixXd held = Eigen::MatrixXd::Zero(0, 0);
    if (motion_ && motion_->NumResultants() > 0) {
      held.setZero(mesh_.NumDofs(), n * NumCases());
    }
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto of_column = Eigen::seq(j, Eigen::last, n);
      const Eigen::MatrixXd seen =
          observed_.RestrictTransposed(some.col(j).head(observed_.Size()));
      sources(Eigen::all, of_column) =
          motion_ ? motion_->TurnedBack(seen) : seen;
      if (held.size() > 0) {
        held(Eigen::all, of_column) = motion_->ResultantsTransposed(
            some.col(j).tail(motion_->NumResultants()));
      }
    }
    if (held.size() > 0) {
      sources += model_.HeldForcesTransposed(held);
    }
    Eigen::MatrixXd adjoint = -model_.SolveFor(sources);
    if (held.size() > 0) {
      adjoint += held;
    }
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(NumElements(), n);
    for (Eigen::Index c = 0; c < adjoint.cols(); ++c) {
      const Eigen::MatrixXd& forces = forces_[c / n];
      for (Eigen::Index e = 0; e < NumElements(); ++e) {
        for (Eigen::Index i = 0; i < mesh_.elements.rows(); ++i) {
          products(e, c % n) +=
              forces.col(e)
                  .segment(dimension * i, dimension)
                  .dot(adjoint.col(c).segment(
                      dimension * Eigen::Index(mesh_.elements(i, e)),
                      dimension));
        }
      }
    }
    return products;
  });
}

Eigen::MatrixXd FieldSensitivity::Eliminate(Eigen::MatrixXd rows) {
  for (Eigen::Index j = 0; motion_ && j < rows.cols(); ++j) {
    rows.col(j) = motion_->Eliminate(Eigen::VectorXd(rows.col(j)));
  }
  return rows;
}

}  // namespace elastimate
