#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_ESTIMATOR_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_ESTIMATOR_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/capabilities.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/prepared_estimator.h"

namespace elastimate {

/// How a displacement residual counts.
enum class Loss {
  kNone,    ///< Least squares.
  kHuber,   ///< Linear beyond 1.345 robust standard deviations.
  kCauchy,  ///< Logarithmic beyond 2.385 robust standard deviations.
};

/// How often fits of measured displacements divide the mesh to find its error
/// (FitRefined).
enum class Refine {
  kAutomatic,  ///< Once where the error of the mesh as it is matters.
  kNever,      ///< The error is then that of quadratic elements of the mesh.
  kAlways,     ///< Once.
};

/// The size of deformations for which isotropic materials are fitted.
enum class Kinematics {
  /// `auto` fits laws of large strains where small strains leave out what
  /// anybody would mention (KinematicErrorOf); others fit small strains.
  kAutomatic,
  kSmall,
  kLarge,  ///< Laws of large strains are fitted and compared.
};

/// The defaults suit a scene of which nothing more is known.
struct EstimatorOptions {
  // What is estimated.  What is known of one of several materials stands in
  // the scene (Material).

  /// Poisson's ratio of one isotropic material when it is known [-], in
  /// (-1, 1/2): E alone is estimated.
  std::optional<double> known_poisson_ratio;
  /// Bounds on nu [-], within [-1, 1/2] and leaving a part of the range
  /// above; not with a known nu.  Of all materials that have none of their own.
  Bounds poisson_ratio;
  /// Bounds on E [pressure], positive; likewise.
  Bounds youngs_modulus;

  // How it is estimated.

  /// Treatment of outliers among the measured displacements.
  Loss loss = Loss::kNone;
  Refine refinement = Refine::kAutomatic;
  Kinematics kinematics = Kinematics::kAutomatic;
  /// Degree of the polynomial virtual fields, 1 to 3, for the estimators that
  /// have some; the others refuse it.
  std::optional<int> virtual_field_degree;
  /// Iterations after which an iterative estimator gives up; at least 1.
  int max_iterations = 50;
  /// How estimators that solve for displacements do so.
  SolverKind solver = SolverKind::kAutomatic;
  /// Called by those before each factorisation, or set-up of multigrid, with
  /// its number, from 1 on.  May be empty.
  std::function<void(int)> on_factorization;

  /// A sentence that names the option, its value and the broken rule; empty
  /// when the options are valid.
  [[nodiscard]] std::string WhyInvalid() const;
};

/// A method that turns a scene into an estimate of the parameters of its
/// materials.  CONTRIBUTING.md says how to add one, to the library or to a
/// program of its own (RegisterEstimator).
class Estimator : public std::enable_shared_from_this<Estimator> {
 public:
  Estimator() = default;
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;
  virtual ~Estimator() = default;

  /// Checks the input, runs the method, and checks the result.
  ///
  /// Throws std::invalid_argument, with one sentence, for an invalid scene
  /// (ValidateScene), invalid options, options or a scene that this estimator
  /// does not support (WhyUnsupported), a load case without measured
  /// displacements or with zero displacement, and loads that are zero on all
  /// free degrees of freedom unless a modulus is known.  Numerical outcomes
  /// never throw: they are statuses of the estimate.
  ///
  /// An estimate that the method calls usable, but that has neither a standard
  /// error of each parameter that it estimates nor a reason for that
  /// (`why_no_standard_error`), comes back as a failure (`errors_missing`).
  ///
  /// May be called from several threads at once.  The same input gives the same
  /// bits in each of them and on every call, on the same kind of processor with
  /// the same number of BLAS threads, unless another thread calls rand()
  /// meanwhile, which the ordering of a factorisation (METIS) seeds and draws
  /// from.
  [[nodiscard]] Estimate Run(const Scene& scene,
                             const EstimatorOptions& options) const;

  /// Does all that does not depend on what was measured, for a scene that is
  /// measured again and again; displacements of `scene` are not looked at.
  /// Copies the scene and the options.  Throws std::invalid_argument as Run
  /// does.  What is prepared keeps an estimator that a std::shared_ptr owns, as
  /// that of MakeEstimator is, so MakeEstimator(name)->Prepare(...) is safe.  A
  /// local one has to outlive it, and a temporary one does not compile.
  [[nodiscard]] PreparedEstimator Prepare(
      const Scene& scene, const EstimatorOptions& options) const&;
  PreparedEstimator Prepare(const Scene&,
                            const EstimatorOptions&) const&& = delete;

  /// The name by which the registry knows it, such as "closed-form".
  virtual std::string_view Name() const = 0;
  /// One line for people: method, needs, and source.
  virtual std::string_view Description() const = 0;
  /// What it takes.
  virtual Capabilities WhatItTakes() const = 0;
  /// Why it cannot serve this scene with these options, and what could; empty
  /// when it can: what follows from its capabilities.
  /// Preconditions: a valid scene and valid options.
  [[nodiscard]] virtual std::string WhyUnsupported(
      const Scene& scene, const EstimatorOptions& options) const;

 protected:
  friend class PreparedEstimator;

  /// Estimates from a scene and options that Run has checked.  An estimate
  /// starts out as a failure: Estimate::Accept makes it usable, and
  /// Estimate::Fail names the reason why it is not.  Run checks afterwards
  /// whether it is finite, physical and determined.
  virtual Estimate DoRun(const Scene& scene,
                         const EstimatorOptions& options) const = 0;
  /// Prepares what does not depend on the measurement.  The default keeps
  /// nothing, and calls DoRun for each measurement.  `scene`, without
  /// displacements, and `options` outlive the preparation.
  virtual std::unique_ptr<Preparation> DoPrepare(
      const Scene& scene, const EstimatorOptions& options) const;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_ESTIMATOR_H_
