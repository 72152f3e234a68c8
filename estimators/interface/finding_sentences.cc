#include "elastimate/estimators/interface/finding_sentences.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

constexpr char kCheckTheModel[] = "check mesh, supports and loads";
constexpr char kCheckWhatIsGiven[] =
    "check mesh, supports, loads and given values";
constexpr char kCheckTheMeasurement[] =
    "check mesh, supports, loads, given values and smoothing";
constexpr char kGiveMore[] = "give Poisson's ratio or another load case";
constexpr char kUnbiased[] = "use reduced-fe, or give Poisson's ratio";
constexpr char kErrorsHold[] = ", which the error bars hold";

// The rate d ln M / d nu along the direction that the data leave free, below
// which the modulus M is called determined by them [1]. Next to nu = 1/2 it
// tells the bulk modulus from lambda + 2 mu, whose rate differs by 2 or more.
constexpr double kUnchanged = 0.02;

struct Modulus {
  std::string name;
  double value;
  Eigen::RowVector2d gradient;  // d ln value / d (ln E, nu).
};

std::array<Modulus, 3> Moduli(const IsotropicElasticity& elasticity) {
  const double nu = elasticity.poisson_ratio;
  return {
      Modulus{"Young's modulus", elasticity.youngs_modulus, {1, 0}},
      Modulus{
          "the shear modulus", elasticity.ShearModulus(), {1, -1 / (1 + nu)}},
      Modulus{
          "the bulk modulus", elasticity.BulkModulus(), {1, 2 / (1 - 2 * nu)}}};
}

// "about 5 %".
std::string AboutPercent(double ratio) {
  const std::string percent = Percent(ratio);
  return (percent.back() == '%' ? "about " : "") + percent;
}

// The largest relative change of a stiffness, and that of a ratio.
std::string ChangesOf(const Eigen::Vector2d& change, const Estimate& estimate) {
  const bool is_isotropic =
      std::all_of(estimate.parameters.begin(), estimate.parameters.end(),
                  [](const ParameterEstimate& parameter) {
                    return parameter.symbol == "E" || parameter.symbol == "nu";
                  });
  return std::string(is_isotropic ? "E" : "stiffnesses") + " by " +
         Percent(change(0)) +
         (change(1) == 0
              ? ""
              : std::string(" and ") + (is_isotropic ? "nu" : "ratios") +
                    " by " + TwoDigits(change(1)));
}

// ", the shear modulus = 3", of the moduli that do not change along
// `direction`; none if that leaves nu as it is.
std::string Unchanged(const IsotropicElasticity& elasticity,
                      const Eigen::Vector2d& direction) {
  std::string text;
  for (const Modulus& modulus : Moduli(elasticity)) {
    if (std::abs(modulus.gradient.dot(direction)) <
        kUnchanged * std::abs(direction(1))) {
      text += ", " + modulus.name + " = " + NumberText(modulus.value);
    }
  }
  return text;
}

// "a, b, c and 4 more".
std::string FirstOf(const std::vector<std::string>& names,
                    std::size_t most_named = 3) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() <= most_named
             ? text
             : text + " and " + std::to_string(names.size() - most_named) +
                   " more";
}

constexpr const char* kRefineTheMesh = "use a finer mesh";

Finding Error(FindingCode code, std::string text, std::string advice) {
  return {code, Severity::kError, std::move(text), std::move(advice)};
}

Finding Warning(FindingCode code, std::string text, std::string advice) {
  return {code, Severity::kWarning, std::move(text), std::move(advice)};
}

// "E open by 3% and nu by 0.02": the largest error of a stiffness, and that of
// a ratio, as far as they are known.
std::string LargestErrors(const ParameterErrors& errors,
                          const std::vector<ParameterEstimate>& parameters) {
  Eigen::Index stiffness = -1;
  Eigen::Index ratio = -1;
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    Eigen::Index& largest = parameters[i].IsStiffness() ? stiffness : ratio;
    if (errors(i) > 0 && (largest < 0 || errors(i) > errors(largest))) {
      largest = i;
    }
  }
  const auto text_of = [&](Eigen::Index i, const std::string& open) {
    return parameters[i].Label() + open + "by " +
           (parameters[i].IsStiffness() ? Percent(errors(i))
                                        : TwoDigits(errors(i)));
  };
  if (stiffness < 0 && ratio < 0) {
    return "the parameters open";
  }
  if (stiffness < 0 || ratio < 0) {
    return text_of(std::max(stiffness, ratio), " open ");
  }
  return text_of(stiffness, " open ") + " and " + text_of(ratio, " ");
}

}  // namespace

Finding NotFinite() {
  return Error(FindingCode::kNotFinite, "the result is not finite",
               kCheckTheModel);
}

Finding SingularStiffness() {
  return Error(FindingCode::kSingularStiffness,
               "the stiffness matrix is singular to working precision",
               "check the mesh for slivers and loose parts, the supports, and "
               "known values");
}

Finding SearchFailed(const std::string& reason) {
  return Error(
      FindingCode::kSearchFailed,
      "the search for the best fit ended without one",
      "check the mesh for slivers, or use reduced-fe (" + reason + ")");
}

Finding NoConvergence(int max_iterations) {
  return Error(FindingCode::kNoConvergence,
               "the fit did not converge in " + std::to_string(max_iterations) +
                   " iterations",
               "use reduced-fe, or give bounds on parameters");
}

Finding FitNotCertified() {
  return Error(FindingCode::kFitNotCertified,
               "the reduced model did not become accurate enough to exclude a "
               "better fit elsewhere",
               "use iterative-fe, or give bounds on parameters");
}

Finding ErrorsMissing(const std::string& estimator, const std::string& what) {
  return Error(
      FindingCode::kErrorsMissing,
      "the estimator " + estimator + " gives neither " + what + " nor a reason",
      "use another one, or enter a covariance or why_no_standard_error");
}

Finding UnphysicalParameters(const std::vector<std::string>& parameters,
                             bool is_by_noise) {
  const std::string text = FirstOf(parameters) +
                           (parameters.size() == 1 ? " is" : " are") +
                           " not physical";
  return is_by_noise
             ? Error(FindingCode::kUnphysical,
                     text + ", as noise or coarse elements make it here",
                     kUnbiased)
             : Error(FindingCode::kUnphysical, text,
                     std::string("give bounds, and ") + kCheckTheModel);
}

Finding DisplacementsOpposeLoads() {
  return Error(FindingCode::kDisplacementsOpposeLoads,
               "the measured displacements oppose the loads",
               "check their signs, order and units, and whether noise "
               "outweighs them");
}

Finding YoungsModulusDiverges() {
  return Error(
      FindingCode::kYoungsModulusDiverges,
      "the data pull Young's modulus to zero or infinity",
      std::string(kCheckTheModel) + ", and whether noise outweighs them");
}

Finding PoissonRatioAtMinusOne() {
  return Error(FindingCode::kPoissonRatioDiverges,
               "the data pull Poisson's ratio to -1, where no material is",
               std::string("give Poisson's ratio, or ") + kCheckTheModel);
}

Finding PoissonRatioDivergesByNoise() {
  return Error(FindingCode::kPoissonRatioDiverges,
               "the data pull Poisson's ratio to the end of its range, as "
               "noise or coarse elements do here",
               "give bounds, or use reduced-fe");
}

Finding LoadsDoNoWork() {
  return Error(FindingCode::kLoadsDoNoWork,
               "the loads do no work on the virtual fields",
               "raise their degree, or use reduced-fe");
}

Finding OneCombination(const IsotropicElasticity& elasticity,
                       const Eigen::Vector2d& direction) {
  return Error(FindingCode::kOneCombination,
               "the data determine one combination of Young's modulus and "
               "Poisson's ratio only" +
                   Unchanged(elasticity, direction),
               kGiveMore);
}

Finding ParametersUndetermined(const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersUndetermined,
               "the data do not determine " + FirstOf(parameters),
               "give what is known of them, join regions, or add load cases");
}

Finding ParametersUndeterminedByElements(
    const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersUndetermined,
               "elements this coarse do not determine " + FirstOf(parameters),
               kRefineTheMesh);
}

Finding ParametersUndeterminedOnBounds(
    const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersUndetermined,
               "on bounds, the data do not determine " + FirstOf(parameters),
               "check the bounds, which the data may contradict");
}

Finding AxisUndetermined(const std::vector<std::string>& axes) {
  return Error(FindingCode::kAxisUndetermined,
               "the data do not determine " + axes[0] +
                   (axes.size() == 1
                        ? ""
                        : " and " + std::to_string(axes.size() - 1) + " more") +
                   ", as of an isotropic material",
               "use --material=auto, or give the axis");
}

Finding CombinationsOnly(const std::vector<std::string>& combinations) {
  return Warning(FindingCode::kCombinationsOnly,
                 "data determine only " + combinations[0],
                 "give what is known of them, join regions, or add load cases");
}

Finding ResidualInRegion(const std::string& region, double correlation) {
  return Warning(FindingCode::kResidualInRegion,
                 "in " + region + " the residuals of neighbours are alike (" +
                     TwoDigits(correlation) + "): its material may vary",
                 "divide it, or check what is known there");
}

Finding AxisTurned(double angle, const std::string& region, double change) {
  return Warning(FindingCode::kAxisTurned,
                 "axes" + (region.empty() ? "" : " of " + region) +
                     " turned by " + TwoDigits(kDegreesOfRadian * angle) +
                     " degrees fit better, with parameters " + Percent(change) +
                     " away" + kErrorsHold,
                 "check them, or use --axis=free");
}

Finding RegionsMayDiffer(const std::vector<std::string>& differences,
                         Severity severity) {
  return {FindingCode::kRegionsMayDiffer, severity,
          "regions that became one material may differ by up to " +
              FirstOf(differences) + " (95 %)",
          "use --regions=each"};
}

Finding RegionMayBeAnother(const std::string& region,
                           const std::vector<std::string>& differences) {
  return Warning(FindingCode::kRegionsMayDiffer,
                 region + " may be off the material it became part of by " +
                     FirstOf(differences) + " (95 %)",
                 "use --regions=each");
}

Finding RegionsNotCompared(const std::vector<std::string>& regions) {
  return {FindingCode::kRegionsNotCompared, Severity::kNotice,
          "the data determine too little of " + FirstOf(regions) +
              " to compare it with others",
          "add another load case, or name its material in the scene"};
}

Finding LawsFitAlike(const std::string& chosen, const std::string& other,
                     double difference) {
  return Warning(FindingCode::kLawsFitAlike,
                 "the law " + other + " explains the data about as well as " +
                     chosen + " (BIC differs by " + TwoDigits(difference) + ")",
                 "measure another load case, or name the law by --material");
}

Finding DependentForces() {
  return Error(FindingCode::kParametersUndetermined,
               "the data determine combinations of the parameters only",
               "give what is known of them, join regions, or add load cases");
}

Finding TooFewMeasurements(Eigen::Index num_components) {
  return Error(FindingCode::kTooFewMeasurements,
               std::to_string(num_components) +
                   " measured components are too few to tell how good the "
                   "estimate is",
               "measure more, or give the standard deviation of the noise");
}

Finding BoundContradicted(const std::string& label, bool is_less_asked_for) {
  return Error(FindingCode::kBoundContradicted,
               "the data contradict the bound on " + label + ", and ask for " +
                   (is_less_asked_for ? "less" : "more"),
               "check the bound, mesh, supports and loads");
}

Finding KnownPoissonRatioContradicted(const std::string& label,
                                      double poisson_ratio,
                                      double standard_error,
                                      Severity severity) {
  return {FindingCode::kKnownPoissonRatioContradicted, severity,
          "the data contradict the given " + label + ": they ask for " +
              TwoDigits(poisson_ratio) + " +- " + TwoDigits(standard_error),
          "check that value, mesh, supports and loads"};
}

Finding LargeCorrection(double correction) {
  return Error(FindingCode::kLargeCorrection,
               "the loads balance only with displacements that differ from the "
               "measured ones by " +
                   Percent(correction),
               "check mesh, supports, loads, noise and given values");
}

Finding LoadsOutOfBalance(double imbalance, Severity severity) {
  return {FindingCode::kLoadsOutOfBalance, severity,
          "the supports leave the specimen free to move, and " +
              PercentOf(imbalance, "the loads") + " push it that way",
          "complete the supports or the loads"};
}

Finding ResidualAboveNoise(ResidualKind kind, double ratio) {
  const std::string times = TwoDigits(ratio) + " times ";
  const std::string what =
      kind == ResidualKind::kDisplacement
          ? "the displacement residual is " + times + "the given noise"
      : kind == ResidualKind::kForce
          ? "the force residual is " + times + "what the given noise explains"
          : "virtual work is off balance by " + times +
                "what the given noise explains";
  return Warning(FindingCode::kResidualAboveNoise, what + kErrorsHold,
                 "check the noise, mesh, supports and loads");
}

Finding SmoothResidual(double correlation) {
  return Warning(FindingCode::kSmoothResidual,
                 "neighbouring residuals are alike (correlation " +
                     TwoDigits(correlation) + ")" + kErrorsHold,
                 "check mesh, supports, loads, smoothing; the material may not "
                 "be the same all over");
}

Finding LargeSmoothResidual(double smooth) {
  return Error(FindingCode::kSmoothResidual,
               "the model misses a smooth part of the measured displacement, " +
                   PercentOf(smooth, "it"),
               "check mesh, supports, loads, given values, and whether the "
               "material varies");
}

Finding LargeResidual(double displacement_residual) {
  return Warning(
      FindingCode::kLargeResidual,
      "the displacement residual is " +
          PercentOf(displacement_residual, "the measured displacement"),
      std::string(kCheckTheModel) + ", unless the noise is as large");
}

Finding VirtualWorkImbalance() {
  return Warning(
      FindingCode::kVirtualWorkImbalance,
      std::string("virtual work is off balance by more than noise explains") +
          kErrorsHold,
      kCheckTheMeasurement);
}

Finding VirtualWorkImbalance(double force_residual, Severity severity) {
  return {FindingCode::kVirtualWorkImbalance, severity,
          "virtual-fields finds more than noise in the force residual (" +
              TwoDigits(force_residual) + " of the load)" +
              (severity == Severity::kWarning ? kErrorsHold : ""),
          kCheckWhatIsGiven};
}

Finding RatiosAtLimit(const std::vector<std::string>& parameters) {
  return Error(FindingCode::kPoissonRatioAtLimit,
               "the data pull " + FirstOf(parameters, 1) +
                   " to the end of its range and leave a residual that is not "
                   "noise",
               kCheckTheModel);
}

Finding OutliersAtLimit(const std::vector<std::string>& parameters) {
  return Error(FindingCode::kPoissonRatioAtLimit,
               "some nodes lie far off, which may be what pulls " +
                   FirstOf(parameters, 1) + " to the end of its range",
               "use a loss (huber or cauchy)");
}

Finding Outliers(const Eigen::Vector2d& change, const Estimate& estimate) {
  return Warning(FindingCode::kOutliers,
                 "some nodes lie far off; leaving them out would change " +
                     ChangesOf(change, estimate),
                 "use a loss (huber or cauchy)");
}

Finding FarNeighbours() {
  return Warning(FindingCode::kOutliers,
                 "neighbouring nodes lie far off, so that the material may not "
                 "be the same all over",
                 "give it regions, or check mesh, supports and loads");
}

Finding OutliersLeftOut(const std::vector<Outlier>& outliers,
                        const Eigen::Vector2d& change,
                        const Estimate& estimate) {
  constexpr std::size_t kMostNames = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(outliers.size(), kMostNames); ++i) {
    names += (i == 0 ? "" : ", ") +
             std::string(outliers[i].is_point ? "point " : "node ") +
             std::to_string(outliers[i].index);
  }
  if (outliers.size() > kMostNames) {
    names += ", ...";
  }
  return Warning(FindingCode::kOutliersLeftOut,
                 std::to_string(outliers.size()) + " outliers (" + names +
                     ") are left out, which changes " +
                     ChangesOf(change, estimate),
                 "look at them, marked in --out");
}

Finding HeldNodesMoved(const std::vector<std::size_t>& load_cases) {
  const std::size_t num_others = load_cases.size() - 1;
  return Warning(
      FindingCode::kHeldNodesMoved,
      "held nodes of load case " + std::to_string(load_cases.front()) +
          (num_others == 0 ? ""
                           : " (and " + std::to_string(num_others) + " more)") +
          " were measured elsewhere, which is not used",
      "check the supports");
}

Finding ResultantsContradicted(double distance) {
  return Warning(FindingCode::kResultantsContradicted,
                 "a measured resultant is " + TwoDigits(distance) +
                     " of its standard deviations from the force of the fit" +
                     kErrorsHold,
                 "check loads and resultants");
}

Finding NoFrameUsable(std::size_t num_frames, const std::string& reason) {
  return {FindingCode::kNoFrameUsable, Severity::kError,
          "none of " + std::to_string(num_frames) +
              " frames gives an estimate with error bars",
          "the first says: " + reason};
}

Finding FramesScatter(double excess, std::size_t farthest) {
  return Warning(FindingCode::kFramesScatter,
                 "frames scatter by " + TwoDigits(excess) +
                     " times their noise, frame " + std::to_string(farthest) +
                     " most",
                 "check the loads of the frames, and that one above all");
}

Finding FramesAlike(double correlation) {
  return Warning(FindingCode::kFramesAlike,
                 "the residuals of frames are alike (correlation " +
                     TwoDigits(correlation) +
                     "), and what they share does not average out",
                 "check the reference image, supports and loads");
}

Finding FramesLeftOut(std::size_t num_left_out, std::size_t num_frames) {
  return {FindingCode::kFramesLeftOut, Severity::kNotice,
          std::to_string(num_left_out) + " of " + std::to_string(num_frames) +
              " frames are not used",
          "see why in the table of --series"};
}

Finding TrendOverFrames(const std::string& parameter, bool is_relative,
                        const Trend& trend, Eigen::Index place) {
  const auto text = [is_relative](double value) {
    return is_relative ? Percent(value) : TwoDigits(value);
  };
  return Warning(FindingCode::kTrendOverFrames,
                 parameter + " changes by " + text(trend.change(place)) +
                     " +- " + text(trend.standard_error(place)) +
                     (trend.is_over_load ? " from the least load to the largest"
                                         : " from the first frame to the last"),
                 trend.is_over_load
                     ? "check that frames and loads are in one order (the load "
                       "record can name the files), or take frames of small "
                       "load"
                     : "look for creep, and drift of camera or load");
}

Finding ParametersOnBounds(const std::vector<std::string>& parameters) {
  return Warning(
      FindingCode::kParametersOnBounds,
      FirstOf(parameters) +
          (parameters.size() == 1 ? " lies on a bound" : " lie on bounds"),
      "check the bounds; the standard errors are those without them");
}

Finding ParametersNearLimits(const std::vector<std::string>& parameters,
                             Severity severity) {
  return {FindingCode::kParametersNearLimits, severity,
          FirstOf(parameters) + " may lie at a limit, within errors",
          severity == Severity::kError
              ? "give what is known of it, or use iterative-fe"
              : "give what is known of it; error bars there may be too small"};
}

Finding ParameterBias(const std::string& parameter, double bias,
                      bool is_relative, Severity severity) {
  return {
      FindingCode::kNoiseBias, severity,
      std::isfinite(bias)
          ? "displacement noise biases " + parameter + " by " +
                (is_relative ? AboutPercent(bias) : "about " + TwoDigits(bias))
          : "displacement noise hides " + parameter,
      "use reduced-fe or virtual-fields, which noise does not bias"};
}

Finding LargeDeformation(const DeformationSize& size,
                         double relative_error_of_modulus, Severity severity) {
  if (size.strain > kLimits.impossible_strain) {
    return {FindingCode::kLargeDeformation, severity,
            "the displacements are larger than the body: they are strains of " +
                TwoDigits(size.strain),
            "check that they are displacements, not positions after the load, "
            "and in the unit of length of the coordinates"};
  }
  constexpr double kDegreesOfRadian = 57.29578;
  return {FindingCode::kLargeDeformation, severity,
          "strains of " + Percent(size.strain) + " and rotations of " +
              TwoDigits(kDegreesOfRadian * size.rotation) +
              " degrees are beyond small-strain elasticity (E +- " +
              Percent(relative_error_of_modulus) + ")",
          size.strain < kLimits.mentioned_strain
              ? "measure at smaller loads, or say \"rigid_motion\": \"free\""
              : "measure at smaller loads, not larger ones"};
}

Finding MarginNotGiven(double relative_error) {
  return Warning(FindingCode::kMarginNotGiven,
                 "the mesh ends at its outermost points, which may lie inside "
                 "of the specimen; what that may change of E is " +
                     Percent(relative_error),
                 "give \"margin\", their distance from the free edges, or "
                 "take a mesh of the specimen, over which points need not be "
                 "nodes");
}

Finding NegativePoissonRatio(const ParameterEstimate& poisson_ratio) {
  return Warning(FindingCode::kNegativePoissonRatio,
                 poisson_ratio.Label() + " is negative, " +
                     TwoDigits(poisson_ratio.value) +
                     ", as one displacement component of the wrong sign makes "
                     "it",
                 "check that x and u, y and v point alike");
}

Finding DiscretizationErrorFinding(const Estimate& estimate) {
  return Warning(
      FindingCode::kDiscretizationError,
      "the mesh leaves " + LargestErrors(estimate.error_budget.discretization,
                                         estimate.parameters),
      "use a finer mesh if you need a smaller error");
}

Finding MeshErrorUnknown() {
  return Warning(FindingCode::kMeshErrorUnknown,
                 "this estimator does not know the mesh error, so that the "
                 "errors are those of noise",
                 "use reduced-fe, or --origin=computed for simulated data");
}

Finding ComputedByLinearElements() {
  return Error(FindingCode::kComputedByLinearElements,
               "linear elements of this mesh fit far better than finer ones, "
               "as if they had computed the data",
               "if so, give --origin=computed");
}

Finding SupportsEndWithinElements(const ParameterErrors& errors,
                                  const Estimate& estimate) {
  return Warning(FindingCode::kSupportsEndWithinElements,
                 "where supports end within elements is not known, which "
                 "leaves " +
                     LargestErrors(errors, estimate.parameters),
                 "give the supports as boxes");
}

Finding WithoutErrorBars(Finding finding) {
  const std::size_t place = finding.text.rfind(kErrorsHold);
  if (place != std::string::npos) {
    finding.text.erase(place);
  }
  return finding;
}

Finding SolverFallback(const std::string& notice) {
  return {FindingCode::kSolverFallback, Severity::kNotice, notice,
          "expect more time and memory than multigrid takes"};
}

}  // namespace elastimate
