#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_ESTIMATE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_ESTIMATE_H_

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/camera.h"
#include "elastimate/core/scene/deformation_size.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/error_budget.h"
#include "elastimate/estimators/interface/finding.h"
#include "elastimate/estimators/interface/map_estimate.h"

namespace elastimate {

/// Seconds that a stage of an estimator took.
struct StageTime {
  std::string stage;
  double seconds;
};

/// Ends of an interval.
struct Interval {
  double lower;
  double upper;
};

/// "region 3", "regions 1, 2 and 4 more".
[[nodiscard]] std::string RegionsLabel(const std::vector<int>& regions);

/// What is said of one parameter of a material.
struct ParameterEstimate {
  std::string name;          ///< As its law calls it, "youngs_modulus".
  std::string symbol;        ///< As people write it, "E".
  std::vector<int> regions;  ///< Where its material is; empty: everywhere.
  bool is_modulus = false;   ///< [pressure], else a ratio [1].
  bool is_known = false;     ///< Given, not estimated.
  /// A stiffness off the diagonal may have either sign.  Its errors are
  /// relative to this geometric mean of those beside it [pressure].
  std::optional<double> beside;
  /// Between which it is physical, ends excluded: whatever the others are.
  Interval limits = {-std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
  double value = std::numeric_limits<double>::quiet_NaN();
  /// Empty when unknown, as for a parameter that is given.
  std::optional<double> standard_error;
  /// Where it lies with a probability of 95 %.
  std::optional<Interval> interval;

  /// "nu of region 3", "E" of a material of the whole mesh.
  std::string Label() const;
  /// Whether errors are relative, to ErrorUnit; else it is a ratio.
  bool IsStiffness() const { return is_modulus || beside; }
  double ErrorUnit() const { return is_modulus ? value : beside.value_or(1); }
  bool IsPhysical() const {
    return value > limits.lower && value < limits.upper;
  }
  /// Whether it is given, or has a standard error that is small enough to be of
  /// use (Limits).
  bool IsDetermined() const;
};

/// The shear modulus, which follows from the parameters of a law.
struct ModulusEstimate {
  double value;           ///< [pressure]
  double standard_error;  ///< [pressure]
  /// The part of the standard error that noise makes; not a number where it is
  /// unknown.
  double of_noise = std::numeric_limits<double>::quiet_NaN();

  double RelativeError() const { return standard_error / value; }
  /// Returns it as a parameter, "shear_modulus", with its standard error.
  ParameterEstimate AsParameter() const;
  /// Whether its standard error is small enough to be of use (Limits).
  bool IsDetermined() const;
};

/// The stiffness of a material that is not isotropic, in its own frame and the
/// notation of Voigt: 6 x 6, in the plane 3 x 3 [pressure].
struct StiffnessEstimate {
  std::vector<int> regions;  ///< As of its parameters.
  Eigen::MatrixXd value;
  Eigen::MatrixXd standard_error;  ///< NaN where it is unknown.

  /// "the stiffness of region 3".
  std::string Label() const;
};

/// The axis of a material whose axis was not known.
struct AxisEstimate {
  std::vector<int> regions;  ///< As of its parameters.
  /// The place of the first component of the rotation among its parameters; the
  /// others follow.
  std::size_t first_rotation = 0;
  /// A unit vector, of either end; empty where it is not determined.
  std::optional<Eigen::Vector3d> direction;
  /// Towards where it is largest [rad]; empty where it is unknown.
  std::optional<double> standard_error;
  /// How far its material is from one that is alike in all directions, of chi^2
  /// with 3 degrees of freedom where it is one, about an axis that is given.
  double anisotropy = 0;

  /// "the axis of region 3".
  std::string Label() const;
};

/// An estimator that `auto` ran, or passed over.
struct Rung {
  std::string estimator;
  int element_order = 1;
  /// Empty when it was passed over.
  std::optional<Status> status;
  /// E and nu of one isotropic material; empty where there is no number.
  std::optional<IsotropicElasticity> elasticity;
  Work work;
  double seconds = 0;
  /// Why the ladder went on, or stopped.
  std::string decision;
};

/// Regions that became one material, or would have next: two that the
/// measurement hardly tells apart.
struct RegionMerge {
  std::vector<int> first;
  std::vector<int> second;
  /// Their distance, of chi^2 where they are the same, and how much is allowed.
  double chi_square;
  double limit;
  bool is_taken;
};

/// A law that was compared with others.
struct LawComparison {
  std::string law;
  Eigen::Index num_parameters;  ///< In all materials.
  /// The distance of its nearest parameters from those of no symmetry, of
  /// chi^2 where the material is of this law.
  double chi_square;
  /// The Bayesian information criterion, chi^2 + num_parameters ln n, less
  /// that of the best.
  double criterion;
};

/// How many of the parameters of a material are determined: all that are not
/// known, some, or none.
enum class Determination { kDetermined, kWeakly, kNot };

/// "determined", "weakly" or "not".
[[nodiscard]] std::string_view DeterminationName(Determination determination);

/// What is said of one of several materials.
struct MaterialEstimate {
  std::vector<int> regions;
  /// Empty where there are no errors.
  std::optional<Determination> determination;
  // Fits of displacements know what follows; it is empty where unknown.
  /// Its part of the strain energy of all load cases together.
  std::optional<double> energy_share;
  /// The mean square of the residuals of points in it, over that of the noise.
  std::optional<double> residual_chi_square;
  /// The correlation of the residuals of neighbours in it.
  std::optional<double> residual_correlation;
  /// By how much two regions of a merged material may differ (95 %) in each of
  /// its parameters, relative for moduli; empty for others.
  std::vector<double> largest_differences;
};

/// A measurement that was left out of a fit.
struct Outlier {
  Eigen::Index load_case;
  Eigen::Index index;  ///< Names its node or, with `is_point`, its point.
  bool is_point;

  bool operator==(const Outlier& other) const {
    return load_case == other.load_case && index == other.index &&
           is_point == other.is_point;
  }
};

/// How parameters change over the frames of a series: from the least load to
/// the largest or, as loads are the same, from the first frame to the last.  In
/// the order of Estimate::ParametersAndShearModulus, relative for moduli; not a
/// number for those that are given or, beside a shear modulus, not joined.
struct Trend {
  bool is_over_load = false;
  Eigen::VectorXd change;
  Eigen::VectorXd standard_error;
  Eigen::VectorXd p_value;  ///< How probable so large a change is by chance.
};

/// What a joint estimate of many frames was made of.
struct SeriesSummary {
  std::size_t num_frames = 0;
  std::size_t num_used = 0;
  /// By which the loads of the scene were multiplied.
  Interval loads = {1, 1};
  std::optional<Trend> trend;  ///< Empty for few frames.
};

/// What an estimator says about a scene.  Starts out as a failure, so that it
/// cannot be mistaken for a result before an estimator has filled it in.
struct Estimate {
  std::string estimator;
  Status status = Status::kNumericalFailure;
  /// The order of the elements: 1 for linear ones, 2 for quadratic ones; 0 as
  /// long as no estimator was run.
  int element_order = 0;
  /// How often the mesh was divided for that.
  int mesh_divisions = 0;
  /// Whether the residual is none that independent noise leaves, so that the
  /// mesh, the supports or the loads are not those of the experiment.
  bool is_model_in_doubt = false;
  /// Why the status is not ok, and what to do: the sentence of the finding that
  /// is an error; empty when there is none.
  std::string message = "the estimator was not run; run it on a scene";
  /// E [pressure] and nu [-] of one isotropic material; NaN of others, and
  /// where there is no number at all.
  IsotropicElasticity elasticity = {kUnknown, kUnknown};
  /// Covariance of (E, nu) of one isotropic material.  NaN in the row and
  /// column of a parameter that was given, or that is held by a bound, or of
  /// both when unknown.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kUnknown);
  /// What there is to say, each code once; one error at most, which is the
  /// reason of the status.
  std::vector<Finding> findings = {{FindingCode::kNotRun, Severity::kError,
                                    "the estimator was not run",
                                    "run it on a scene"}};

  /// The parameters of the materials of the scene, in their order.
  std::vector<ParameterEstimate> parameters;
  /// The covariance of `parameters`, square.  NaN stands in the rows and
  /// columns of what is not estimated, or unknown.
  Eigen::MatrixXd parameter_covariance;
  /// The stiffness of each material that is not isotropic, by its parameters.
  std::vector<StiffnessEstimate> stiffnesses;

  /// The axis of each material whose axis was to be found, by its parameters.
  std::vector<AxisEstimate> axes;

  /// mu of one isotropic material whose E and nu the data do not determine,
  /// while they determine mu; empty for others (FindShearModulus).
  std::optional<ModulusEstimate> shear_modulus;

  /// What the errors come from.
  ErrorBudget error_budget;
  /// How large the measured deformation is (MeasureDeformation).
  DeformationSize deformation;
  /// Where nu lies with a probability of 95 %: one-sided when it reaches -1 or
  /// 1/2, where a standard error says little.  Empty when unknown.
  std::optional<Interval> poisson_ratio_interval;
  /// Why a standard error is missing; empty when none is.
  std::string why_no_standard_error;

  /// Estimated (or given, when it is known) noise standard deviation of a
  /// measured displacement component [length]; of the first load case when
  /// they differ.
  std::optional<double> noise_sd;
  /// Degrees of freedom that the noise was estimated from, where they are few:
  /// intervals are then those of Student's t.
  std::optional<double> noise_degrees_of_freedom;
  /// ||A(nu) q - t f|| / ||t f|| over the free degrees of freedom.
  std::optional<double> force_residual;
  /// ||u - q|| / ||q|| over the observed free components.
  std::optional<double> displacement_residual;
  /// Angle between the sensitivities of the observed displacements to ln E and
  /// to nu [rad]: small when the data determine one combination of them only.
  std::optional<double> identifiability_angle;
  /// rho: the share by which displacement noise has pulled nu towards the
  /// value that pure noise has (about 2/3); 0 without noise, 1 when the noise
  /// hides nu altogether.
  std::optional<double> noise_attenuation;
  /// Correlation of the displacement residuals of neighbouring nodes: near 0
  /// for independent noise, near 1 when the model misses something smooth.
  std::optional<double> residual_correlation;
  /// Over which displacement residuals are alike, the integral of their
  /// autocorrelation [length]: 0 for independent noise.  Of fits of several
  /// materials and of unknown motions.
  std::optional<double> correlation_length;
  /// What the elements leave uncertain, and supports that end within them, as
  /// one standard deviation, which is part of the standard errors: relative of
  /// E, and of a free nu.
  std::optional<double> discretization_error;
  std::optional<double> poisson_ratio_discretization_error;
  /// By how much E (relative) and nu were corrected for what the elements miss,
  /// in fits of measured displacements, and for where supports end within
  /// them.  Also of what was refused, as far as that was corrected.
  std::optional<Eigen::Vector2d> discretization_correction;
  /// The values of `parameters` at the minimum of a fit, which are not
  /// corrected for the error of the elements; empty where none was corrected.
  Eigen::VectorXd uncorrected_parameters;
  /// Points that lie too far off for noise, and were left out.
  std::vector<Outlier> outliers;
  /// The fitted displacement of a scene of unknown motion, num_dofs x
  /// num_load_cases [length]; empty for other scenes.
  Eigen::MatrixXd fitted_displacement;
  /// The cameras that see it, one for each load case.  Empty where the rigid
  /// motion is not free, and where the rotation of the specimen is a linear
  /// one, which is then a part of the displacement.
  std::vector<Camera> cameras;
  /// Bounds that the estimate lies on, such as "nu_max".
  std::vector<std::string> active_bounds;

  /// In their order, where they are several; empty for one.
  std::vector<MaterialEstimate> materials;
  /// In words, which combinations of parameters are all that is determined of
  /// them.  Of fits of displacements of several materials.
  std::vector<std::string> combinations;
  /// In order, where regions were to be merged; empty for others.
  std::vector<RegionMerge> merges;
  /// The best first, where the law was to be chosen; empty for others.
  std::vector<LawComparison> laws;
  /// The law of large strains that was fitted in place of the isotropic one;
  /// empty for others.
  std::string large_strain_law;
  /// The map of the modulus where one was asked for (Material::fields); E above
  /// is then its geometric mean over the volume.  Empty for others.
  std::optional<MapEstimate> map;
  /// What the frames of a joint estimate say together; empty for others.
  std::optional<SeriesSummary> series;

  /// What `auto` ran, in order; empty for other estimators.
  std::vector<Rung> rungs;
  Work work;
  std::vector<StageTime> stages;
  double seconds = 0;  ///< Time of the whole estimator.

  bool IsUsable() const { return status == Status::kOk; }
  /// Whether it is usable, and no warning names parameters that the data do not
  /// determine.
  bool DeterminesAll() const;
  /// Whether something of this code was found.
  bool Has(FindingCode code) const;
  /// Whether the error has this code.
  bool IsRefusedFor(FindingCode code) const;
  /// The sentences of the findings of this severity.
  std::vector<std::string> Sentences(Severity severity) const;
  /// Enters a finding that is no error, unless there is one of its code.
  void Add(const Finding& finding);
  /// Enters a finding that is no error in place of others of its code.
  void Replace(const Finding& finding);
  /// Makes it usable: without an error.
  void Accept();
  /// Makes it one that is not usable, with the status of the code and without
  /// covariance, standard errors and those of noise.  Precondition: the finding
  /// is an error.
  void Fail(const Finding& finding);
  /// The values of `parameters`.
  Eigen::VectorXd ParameterValues() const;
  /// `parameters`, and after them `shear_modulus` where there is one.
  std::vector<ParameterEstimate> ParametersAndShearModulus() const;
  /// `parameter_covariance`, in which what is given has no error.
  Eigen::MatrixXd CovarianceWithGiven() const;
  /// Square roots of the diagonal of `covariance`; empty when unknown.
  std::optional<double> YoungsModulusStandardError() const;
  std::optional<double> PoissonRatioStandardError() const;
  /// Correlation of the errors of E and nu; empty when unknown.
  std::optional<double> Correlation() const;
  /// mu = E / (2 (1 + nu)), or `shear_modulus` where there is one.
  double ShearModulus() const;
  /// The standard errors of mu and of 1 / kappa.  Where there is a
  /// `shear_modulus`, that of mu is its own.  Otherwise they are those of first
  /// order, and empty unless the covariance of both E and nu is known.
  std::optional<double> ShearModulusStandardError() const;
  std::optional<double> BulkComplianceStandardError() const;

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_ESTIMATE_H_
