#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_FINDING_SENTENCES_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_FINDING_SENTENCES_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/interface/finding.h"

namespace elastimate {

// The sentences of each finding, made from its numbers.  Who decides whether
// there is something to say is the judge (judge.h).

// Why there is no estimate.
Finding NotFinite();
Finding SingularStiffness();
/// `reason` is that of the solver.
Finding SearchFailed(const std::string& reason);
Finding NoConvergence(int max_iterations);
Finding FitNotCertified();
/// `estimator` calls an estimate usable without `what` it owes, such as "a
/// standard error of E".
Finding ErrorsMissing(const std::string& estimator, const std::string& what);

// Why it is unphysical.
/// `parameters` describes each, such as "E of region 3 = -2"; `is_by_noise` for
/// a method whose estimate noise drives out of the physical range.
Finding UnphysicalParameters(const std::vector<std::string>& parameters,
                             bool is_by_noise);
Finding DisplacementsOpposeLoads();
Finding YoungsModulusDiverges();
Finding PoissonRatioAtMinusOne();
/// For a method that noise drives to the end of the range of nu.
Finding PoissonRatioDivergesByNoise();

// What the data do not determine.
Finding LoadsDoNoWork();
/// For data that leave `direction` in (ln E, nu) free: names the modulus that
/// does not change along it, if one of E, mu and kappa does not, with its value
/// at `elasticity`.
Finding OneCombination(const IsotropicElasticity& elasticity,
                       const Eigen::Vector2d& direction);
/// `parameters` describes each, such as "E of region 3 (+- 45 %)".
Finding ParametersUndetermined(const std::vector<std::string>& parameters);
/// E and nu are those of one isotropic material.
Finding ParametersOfOneUndetermined(const std::vector<std::string>& parameters);
/// The data determine the shear modulus, but not these parameters, as in
/// torsion.
Finding ShearModulusOnly(const std::vector<std::string>& parameters,
                         const ModulusEstimate& shear_modulus);
/// Says so where most of the errors is what the elements miss.
Finding ParametersUndeterminedByElements(
    const std::vector<std::string>& parameters);
/// Says so where bounds that a user gave hold some of them.
Finding ParametersUndeterminedOnBounds(
    const std::vector<std::string>& parameters);
/// `axes` describes each, such as "the axis of region 3 (+- 24 degrees)".
Finding AxisUndetermined(const std::vector<std::string>& axes);
Finding OtherAxisAlike();
/// Says the first of them.
Finding CombinationsOnly(const std::vector<std::string>& combinations);
/// "region 3".
Finding ResidualInRegion(const std::string& region, double correlation);
/// By an angle [rad]; of a region, "" where there is one material.
Finding AxisTurned(double angle, const std::string& region, double change);
/// By how much, such as "3 % in E".
Finding RegionsMayDiffer(const std::vector<std::string>& differences,
                         Severity severity);
/// Says so of one region, "region 3", which is off by more than the errors of
/// the material include.
Finding RegionMayBeAnother(const std::string& region,
                           const std::vector<std::string>& differences);
Finding RegionsNotCompared(const std::vector<std::string>& regions);
/// By how much their Bayesian information criteria differ.
Finding LawsFitAlike(const std::string& chosen, const std::string& other,
                     double difference);
Finding DependentForces();
Finding TooFewMeasurements(Eigen::Index num_components);

// What the model does not explain.
Finding BoundContradicted(const std::string& label, bool is_less_asked_for);
/// `label` names the known ratio; the data ask for `poisson_ratio`.
Finding KnownPoissonRatioContradicted(const std::string& label,
                                      double poisson_ratio,
                                      double standard_error, Severity severity);
/// Relative to the measured displacements.
Finding LargeCorrection(double correction);
/// `imbalance` is a share of the loads.
Finding LoadsOutOfBalance(double imbalance, Severity severity);
/// `ratio` is that of the residual to what the given noise explains, in
/// standard deviations.
Finding ResidualAboveNoise(ResidualKind kind, double ratio);
/// For a smooth residual that matters to the standard errors.
Finding SmoothResidual(double correlation);
/// For one that is too large for a usable estimate; relative to the
/// measurement.
Finding LargeSmoothResidual(double smooth);
Finding LargeResidual(double displacement_residual);
/// By virtual-fields itself.
Finding VirtualWorkImbalance();
/// By the check of another method: `force_residual` is relative to the load.
Finding VirtualWorkImbalance(double force_residual, Severity severity);
/// `parameters` names each, as below.
Finding RatiosAtLimit(const std::vector<std::string>& parameters);
Finding OutliersAtLimit(const std::vector<std::string>& parameters);
/// `change` is that of (ln E, nu) without the pull of the outliers.
Finding Outliers(const Eigen::Vector2d& change, const Estimate& estimate);
/// Where the residuals of neighbours are alike as well, so that leaving nodes
/// out would not help.
Finding FarNeighbours();
/// `load_cases` holds their numbers, from 1 on.  Precondition: not empty.
/// `change` is of ln E and nu.
Finding OutliersLeftOut(const std::vector<Outlier>& outliers,
                        const Eigen::Vector2d& change,
                        const Estimate& estimate);
Finding HeldNodesMoved(const std::vector<std::size_t>& load_cases);
/// Names the element that is turned inside out most, with its det F.
Finding InvertedElements(std::size_t load_case, Eigen::Index element,
                         double volume_ratio);
/// `angle` is in rad.
Finding RigidFaceTurned(std::size_t load_case, double angle);
/// In standard deviations, as stated.
Finding ResultantsContradicted(double distance);
// What a series of frames shows.
/// `reason` says why the first frame is not usable.
Finding NoFrameUsable(std::size_t num_frames, const std::string& reason);
Finding FramesLeftOut(std::size_t num_left_out, std::size_t num_frames);
/// Names the parameter in `place`.
Finding TrendOverFrames(const std::string& parameter, bool is_relative,
                        const Trend& trend, Eigen::Index place);
/// By so many times their noise; `farthest` is the number of a frame.
Finding FramesScatter(double excess, std::size_t farthest);
Finding FramesAlike(double correlation);

// What the method does to the estimate.
/// `parameters` names each, such as "nu of region 3".
Finding ParametersOnBounds(const std::vector<std::string>& parameters);
/// `parameters` names each.
Finding ParametersNearLimits(const std::vector<std::string>& parameters,
                             Severity severity);
/// Names the parameter that is biased most.
Finding ParameterBias(const std::string& parameter, double bias,
                      bool is_relative, Severity severity);
/// A fit found no parameters with an equilibrium, for a reason
/// "text; advice" (ForwardModel::WhyNotSolved).
/// Computed displacements, which fits of small strains take as exact.
Finding TakenAsLinear(const DeformationSize& size);
Finding NoEquilibrium(const std::string& reason);
/// Laws of large strains were fitted.
Finding LargeStrainsFitted(const DeformationSize& size, const std::string& law);
/// Other laws of large strains explain the data about as well.
Finding LargeStrainLawsFitAlike(const std::string& chosen,
                                const std::vector<std::string>& others);
/// What linear kinematics leave out (KinematicErrorOf).  A turn of the whole
/// specimen may be the reason, unless the scene has its rigid motion free.
Finding LargeDeformation(const DeformationSize& size,
                         double relative_error_of_modulus, Severity severity,
                         bool is_rigid_motion_free);
/// How much a margin of half a spacing of the points changes E.
Finding MarginNotGiven(double relative_error);

/// How far a parameter, as the data alone have it, is from its prior, and the
/// probability of a larger distance by chance.
Finding PriorContradicted(const ParameterEstimate& of_data, double probability);
Finding NegativePoissonRatio(const ParameterEstimate& poisson_ratio);
/// `errors` are of (ln E, nu).
Finding SupportsEndWithinElements(const ParameterErrors& errors,
                                  const Estimate& estimate);
/// For a mesh whose facets are flat where the specimen may be round: `error` is
/// that of the moduli, positive where they are too large.
Finding FacetsOfRoundBody(double error);
/// Precondition: there is a discretisation error.
Finding DiscretizationErrorFinding(const Estimate& estimate);
/// Measured displacements and a method that sees no mesh error.
Finding MeshErrorUnknown();
/// The elements of a map are quadratic already.
Finding MeshErrorOfMapUnknown();
/// Returns the finding without advice to use the estimator `auto`.
Finding WithoutAdviceOfAuto(Finding finding);
/// Displacements that are said to be measured, and are those of the elements.
/// A warning where the errors include the difference from linear elements.
Finding ComputedByLinearElements(Severity severity);
/// Says nothing of error bars, of which there are none.
Finding WithoutErrorBars(Finding finding);
Finding SolverFallback(const std::string& notice);

// What a map does not tell.
/// The residual is `ratio` times as large as the given noise explains.
Finding Misfit(double ratio);
/// `regions` are narrower than what is resolved, because of the elements or of
/// the measurement.
Finding NotResolved(const std::vector<std::string>& regions,
                    bool is_by_elements);
Finding NoiseNeeded(double num_rows, double supported_parameters);
/// `spread` is the standard deviation of ln E, where nothing tells what the
/// elements miss.
Finding MayBeTheMesh(double spread);
/// Structure explains this part of the displacements, and what the elements may
/// miss is at least as large.
Finding StructureWithinMeshError(double explained, double by_mesh);
/// `force_residual` is relative to the loads.
Finding LocalMapNeedsExactData(double force_residual);
Finding LocalMapUndetermined();
Finding LocalModuliNotPositive(Eigen::Index num_bad, Eigen::Index num_elements);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_FINDING_SENTENCES_H_
