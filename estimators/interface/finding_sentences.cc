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

constexpr char kCheckTheModel[] = "check the mesh, the supports and the loads";
constexpr char kCheckWhatIsGiven[] =
    "check the mesh, the supports, the loads and the given parameters";
constexpr char kCheckTheMeasurement[] =
    "check the mesh, the supports, the loads, the given parameters and any "
    "smoothing of the displacements";
constexpr char kGiveMore[] =
    "give Poisson's ratio (--nu), or add another load case";
constexpr char kGiveMoreOfMaterials[] =
    "give what is known (--nu, or \"known\" of a material), join regions, or "
    "add load cases";
constexpr char kUseALoss[] = "use --loss=huber or --loss=cauchy";
constexpr char kKeepRegionsApart[] = "use --regions=each";
constexpr char kUseAuto[] = "use --estimator=auto, or ";
constexpr char kErrorsHold[] = ", which the error bars include";

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

// ", namely the shear modulus = 3", of the moduli that do not change along
// `direction`; none if that leaves nu as it is.
std::string Unchanged(const IsotropicElasticity& elasticity,
                      const Eigen::Vector2d& direction) {
  std::string text;
  for (const Modulus& modulus : Moduli(elasticity)) {
    if (std::abs(modulus.gradient.dot(direction)) <
        kUnchanged * std::abs(direction(1))) {
      text += (text.empty() ? ", namely " : ", ") + modulus.name + " = " +
              NumberText(modulus.value);
    }
  }
  return text;
}

// "a, b, c and 4 more", or "a and b" where there are no more than are named.
std::string FirstOf(const std::vector<std::string>& names,
                    std::size_t most_named = 3) {
  const std::size_t num_named = std::min(names.size(), most_named);
  std::string text;
  for (std::size_t i = 0; i < num_named; ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  }
  return num_named == names.size()
             ? text
             : text + " and " + std::to_string(names.size() - num_named) +
                   " more";
}

constexpr const char* kRefineTheMesh = "use a finer mesh";

// Rotations that exceed the strains so many times are more often a turn of the
// whole specimen, or of the camera, than a deformation.
constexpr double kTurnOfAWhole = 3;

// "500 %", or "more than 1000 %".
std::string StrainText(double strain) {
  const std::string percent = Percent(strain);
  return percent.back() == '%' ? percent : "more than 1000 %";
}

Finding Error(FindingCode code, std::string text, std::string advice) {
  return {code, Severity::kError, std::move(text), std::move(advice)};
}

Finding Warning(FindingCode code, std::string text, std::string advice) {
  return {code, Severity::kWarning, std::move(text), std::move(advice)};
}

// "E uncertain by 3 % and nu by 0.02": the largest error of a stiffness, and
// that of a ratio, as far as they are known.
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
  const auto text_of = [&](Eigen::Index i, const std::string& uncertain) {
    return parameters[i].Label() + uncertain + "by " +
           (parameters[i].IsStiffness() ? Percent(errors(i))
                                        : TwoDigits(errors(i)));
  };
  if (stiffness < 0 && ratio < 0) {
    return "the parameters uncertain";
  }
  if (stiffness < 0 || ratio < 0) {
    return text_of(std::max(stiffness, ratio), " uncertain ");
  }
  return text_of(stiffness, " uncertain ") + " and " + text_of(ratio, " ");
}

// "strains of 5.0 % and rotations of 20 degrees", as far as they are mentioned.
std::string DeformationText(const DeformationSize& size) {
  std::string what;
  if (size.strain >= kLimits.mentioned_strain) {
    what = "strains of " + Percent(size.strain);
  }
  if (size.rotation >= kLimits.mentioned_rotation) {
    what += (what.empty() ? "" : " and ") + std::string("rotations of ") +
            TwoDigits(kDegreesOfRadian * size.rotation) + " degrees";
  }
  return what;
}

}  // namespace

Finding NotFinite() {
  return Error(FindingCode::kNumericalFailure,
               "the estimate is not a finite number", kCheckTheModel);
}

Finding SingularStiffness() {
  return Error(
      FindingCode::kNumericalFailure,
      "the stiffness matrix is singular to working precision",
      "check the supports, the given parameters, and the mesh for flat "
      "elements and loose parts");
}

Finding SearchFailed(const std::string& reason) {
  return Error(FindingCode::kNumericalFailure,
               "the search for the best fit failed (" + reason + ")",
               "check the mesh for flat elements, and the loads and their "
               "units");
}

Finding NoConvergence(int max_iterations) {
  return Error(FindingCode::kNoConvergence,
               "the fit did not converge in " +
                   Counted(std::size_t(max_iterations), "iteration"),
               std::string(kUseAuto) + "give bounds on the parameters");
}

Finding FitNotCertified() {
  return Error(FindingCode::kFitNotCertified,
               "the reduced model did not become accurate enough to exclude a "
               "better fit elsewhere",
               "use --estimator=iterative-fe, or give bounds on nu (--nu_min, "
               "--nu_max)");
}

Finding ErrorsMissing(const std::string& estimator, const std::string& what) {
  return Error(FindingCode::kErrorsMissing,
               "the estimator " + estimator + " returned neither " + what +
                   " nor a reason for its absence",
               "use another estimator, or let this one set a covariance or "
               "why_no_standard_error");
}

Finding UnphysicalParameters(const std::vector<std::string>& parameters,
                             bool is_by_noise) {
  const std::string text =
      "the estimate is not physical: " + FirstOf(parameters);
  return is_by_noise
             ? Error(FindingCode::kUnphysical,
                     text +
                         ", which noise or coarse elements can cause with "
                         "this estimator",
                     std::string(kUseAuto) + "give Poisson's ratio (--nu)")
             : Error(FindingCode::kUnphysical, text,
                     std::string(kCheckTheModel) + ", or give bounds");
}

Finding DisplacementsOpposeLoads() {
  return Error(FindingCode::kUnphysical,
               "the measured displacements point against the loads",
               "check the signs, the order and the units of both, and whether "
               "the noise exceeds the displacements");
}

Finding YoungsModulusDiverges() {
  return Error(FindingCode::kUnphysical,
               "the data drive Young's modulus to zero or infinity",
               "check the mesh, the supports, the loads, and whether the noise "
               "exceeds the displacements");
}

Finding PoissonRatioAtMinusOne() {
  return Error(
      FindingCode::kUnphysical,
      "the data drive Poisson's ratio to -1, which no material has",
      std::string(kCheckTheModel) + ", or give Poisson's ratio (--nu)");
}

Finding PoissonRatioDivergesByNoise() {
  return Error(FindingCode::kUnphysical,
               "the data drive Poisson's ratio to the end of its range, which "
               "noise or coarse elements can cause with this estimator",
               std::string(kUseAuto) + "give bounds (--nu_min, --nu_max)");
}

Finding LoadsDoNoWork() {
  return Error(FindingCode::kParametersUndetermined,
               "the loads do no work on any of the virtual fields",
               "raise --degree, or use --estimator=auto");
}

Finding OneCombination(const IsotropicElasticity& elasticity,
                       const Eigen::Vector2d& direction) {
  return Error(FindingCode::kParametersUndetermined,
               "the data determine only one combination of Young's modulus and "
               "Poisson's ratio" +
                   Unchanged(elasticity, direction),
               kGiveMore);
}

Finding ParametersUndetermined(const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersUndetermined,
               "the data do not determine " + FirstOf(parameters),
               kGiveMoreOfMaterials);
}

Finding ParametersOfOneUndetermined(
    const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersUndetermined,
               "the data do not determine " + FirstOf(parameters), kGiveMore);
}

Finding ShearModulusOnly(const std::vector<std::string>& parameters,
                         const ModulusEstimate& shear_modulus) {
  return Error(
      FindingCode::kParametersUndetermined,
      "the data determine the shear modulus = " +
          ValueWithError(shear_modulus.value, shear_modulus.standard_error) +
          ", but not " + FirstOf(parameters),
      kGiveMore);
}

Finding ParametersUndeterminedByElements(
    const std::vector<std::string>& parameters) {
  return Error(
      FindingCode::kParametersUndetermined,
      "the elements are too coarse to determine " + FirstOf(parameters),
      kRefineTheMesh);
}

Finding ParametersUndeterminedOnBounds(
    const std::vector<std::string>& parameters) {
  return Error(
      FindingCode::kParametersUndetermined,
      "the fit lies on given bounds, where the data do not determine " +
          FirstOf(parameters),
      "check the bounds, which the data may contradict");
}

Finding AxisUndetermined(const std::vector<std::string>& axes) {
  return Error(FindingCode::kParametersUndetermined,
               "the data do not determine " + FirstOf(axes, 1) +
                   ", so the material may be isotropic",
               "use --material=auto or --material=isotropic, or give the axis "
               "(--axis=X,Y,Z)");
}

Finding OtherAxisAlike() {
  return Error(
      FindingCode::kParametersUndetermined,
      "another direction of the axis explains the data nearly as "
      "well, or the material may be isotropic",
      "give the axis (--axis=X,Y,Z), add load cases that pull in other "
      "directions, or use --material=auto");
}

Finding CombinationsOnly(const std::vector<std::string>& combinations) {
  return Warning(
      FindingCode::kParametersUndetermined,
      "the data determine only " + combinations[0] + ", and not each parameter",
      kGiveMoreOfMaterials);
}

Finding ResidualInRegion(const std::string& region, double correlation) {
  return Warning(FindingCode::kSmoothResidual,
                 "the residuals of neighbouring nodes in " + region +
                     " are alike (correlation " + TwoDigits(correlation) +
                     "), so its material may vary",
                 "divide it into regions, or check the supports and loads "
                 "there");
}

Finding AxisTurned(double angle, const std::string& region, double change) {
  return Warning(FindingCode::kGivenValueContradicted,
                 "axes" + (region.empty() ? "" : " of " + region) +
                     " that are turned by " +
                     TwoDigits(kDegreesOfRadian * angle) +
                     " degrees fit better and change parameters by " +
                     Percent(change) + kErrorsHold,
                 "check the given axes, or use --axis=free");
}

Finding RegionsMayDiffer(const std::vector<std::string>& differences,
                         Severity severity) {
  return {FindingCode::kRegionsMayDiffer, severity,
          "regions that were merged into one material may differ by up to " +
              FirstOf(differences) + " (95 % confidence)",
          kKeepRegionsApart};
}

Finding RegionMayBeAnother(const std::string& region,
                           const std::vector<std::string>& differences) {
  return Warning(FindingCode::kRegionsMayDiffer,
                 region + " may differ by " + FirstOf(differences) +
                     " (95 % confidence) from the material into which it was "
                     "merged",
                 kKeepRegionsApart);
}

Finding RegionsNotCompared(const std::vector<std::string>& regions) {
  return {FindingCode::kParametersUndetermined, Severity::kNotice,
          "the data determine too little of " + FirstOf(regions) +
              " for a comparison with other regions",
          "add another load case, or give the material in \"materials\" of a "
          "scene.json"};
}

Finding LawsFitAlike(const std::string& chosen, const std::string& other,
                     double difference) {
  return Warning(FindingCode::kLawsFitAlike,
                 "the law " + other + " explains the data about as well as " +
                     chosen + " (their BIC differ by " + TwoDigits(difference) +
                     ")",
                 "add another load case, or name the law by --material");
}

Finding DependentForces() {
  return Error(FindingCode::kParametersUndetermined,
               "the data determine only combinations of the parameters",
               kGiveMoreOfMaterials);
}

Finding TooFewMeasurements(Eigen::Index num_components) {
  return Error(FindingCode::kParametersUndetermined,
               "too few components were measured (" +
                   std::to_string(num_components) +
                   ") to tell the noise from the deformation",
               "measure more, or give the standard deviation of the noise "
               "(--noise_sd)");
}

Finding BoundContradicted(const std::string& label, bool is_less_asked_for) {
  return Error(FindingCode::kParametersOnBounds,
               "the data contradict the bound on " + label +
                   ", and fit much better with a " +
                   (is_less_asked_for ? "smaller" : "larger") + " value",
               "check the bound, the mesh, the supports and the loads");
}

Finding KnownPoissonRatioContradicted(const std::string& label,
                                      double poisson_ratio,
                                      double standard_error,
                                      Severity severity) {
  return {FindingCode::kGivenValueContradicted, severity,
          "the data contradict the given " + label + ", and fit best with " +
              TwoDigits(poisson_ratio) + " +- " + TwoDigits(standard_error),
          "check the given value, the mesh, the supports and the loads"};
}

Finding LargeCorrection(double correction) {
  return Error(FindingCode::kResidualAboveNoise,
               "the loads balance only with displacements that differ from the "
               "measured ones by " +
                   Percent(correction),
               "check the mesh, the supports, the loads, the given parameters "
               "and the noise");
}

Finding LoadsOutOfBalance(double imbalance, Severity severity) {
  return {FindingCode::kLoadsOutOfBalance, severity,
          "the supports leave the specimen free to move, and " +
              PercentOf(imbalance, "the loads") + " push it that way",
          "add the supports or the loads that are missing"};
}

Finding ResidualAboveNoise(ResidualKind kind, double ratio) {
  const std::string times = TwoDigits(ratio) + " times ";
  const std::string what =
      kind == ResidualKind::kDisplacement
          ? "the displacement residual is " + times + "the given noise"
      : kind == ResidualKind::kForce
          ? "the force residual is " + times + "what the given noise explains"
          : "the virtual work of the stresses differs from that of the loads "
            "by " +
                times + "what the given noise explains";
  return Warning(FindingCode::kResidualAboveNoise, what + kErrorsHold,
                 "check the given noise (--noise_sd), the mesh, the supports "
                 "and the loads");
}

Finding SmoothResidual(double correlation) {
  return Warning(
      FindingCode::kSmoothResidual,
      "the residuals of neighbouring nodes are alike (correlation " +
          TwoDigits(correlation) + "), so the model misses something" +
          kErrorsHold,
      "check the mesh, the supports, the loads, any smoothing of the "
      "displacements, and whether the material varies");
}

Finding LargeSmoothResidual(double smooth) {
  return Error(FindingCode::kSmoothResidual,
               "the model does not explain a smooth part of the measured "
               "displacement, " +
                   PercentOf(smooth, "its size"),
               "check the signs and units of displacements, the mesh, the "
               "supports, the loads, the given parameters, and whether the "
               "material varies");
}

Finding LargeResidual(double displacement_residual) {
  return Warning(
      FindingCode::kResidualAboveNoise,
      "the displacement residual is " +
          PercentOf(displacement_residual, "the measured displacement"),
      std::string(kCheckTheModel) + ", unless the noise is that large");
}

Finding VirtualWorkImbalance() {
  return Warning(FindingCode::kResidualAboveNoise,
                 std::string("the virtual work of the stresses differs from "
                             "that of the loads by more than noise explains") +
                     kErrorsHold,
                 kCheckTheMeasurement);
}

Finding VirtualWorkImbalance(double force_residual, Severity severity) {
  return {FindingCode::kResidualAboveNoise, severity,
          "a check by virtual work finds more than noise in the force "
          "residual (" +
              PercentOf(force_residual, "the load") + ")" +
              (severity == Severity::kWarning ? kErrorsHold : ""),
          kCheckWhatIsGiven};
}

Finding RatiosAtLimit(const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersNearLimits,
               "the data drive " + FirstOf(parameters, 1) +
                   " to the end of the physical range and leave a residual "
                   "that is not noise",
               kCheckTheModel);
}

Finding OutliersAtLimit(const std::vector<std::string>& parameters) {
  return Error(FindingCode::kParametersNearLimits,
               "some nodes lie far off the fit, which may be what drives " +
                   FirstOf(parameters, 1) + " to the end of the physical range",
               kUseALoss);
}

Finding Outliers(const Eigen::Vector2d& change, const Estimate& estimate) {
  return Warning(
      FindingCode::kOutliers,
      "some nodes lie far off the fit, and leaving them out would change " +
          ChangesOf(change, estimate),
      kUseALoss);
}

Finding FarNeighbours() {
  return Warning(FindingCode::kOutliers,
                 "several neighbouring nodes lie far off the fit, so the "
                 "material may vary",
                 "give the mesh regions, or check the supports and the loads");
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
  names += ", counted from 0";
  return Warning(FindingCode::kOutliersLeftOut,
                 Counted(outliers.size(), "outlier") + " (" + names +
                     (outliers.size() == 1 ? ") is" : ") are") +
                     " left out, which changes " + ChangesOf(change, estimate),
                 "look at the array 'outlier' in the file of --out");
}

Finding HeldNodesMoved(const std::vector<std::size_t>& load_cases) {
  const std::size_t num_others = load_cases.size() - 1;
  return Warning(
      FindingCode::kHeldNodesMoved,
      "nodes that supports hold in load case " +
          std::to_string(load_cases.front()) +
          (num_others == 0 ? ""
                           : " (and " + std::to_string(num_others) + " more)") +
          " were measured elsewhere, which the estimate ignores",
      "check the supports, or give \"rigid_motion\": \"free\" if the specimen "
      "moved as a whole");
}

Finding InvertedElements(std::size_t load_case, Eigen::Index element,
                         double volume_ratio) {
  return Warning(
      FindingCode::kInvertedElements,
      "the measured displacements of load case " + std::to_string(load_case) +
          " turn element " + std::to_string(element) +
          " inside out (volume ratio " + TwoDigits(volume_ratio) +
          "), which no specimen does",
      "look for errors at its nodes; noise alone does it if it is as large as "
      "elements are");
}

Finding RigidFaceTurned(std::size_t load_case, double angle) {
  return Warning(FindingCode::kRigidFaceTurned,
                 "a rigid face with free components turned by " +
                     TwoDigits(kDegreesOfRadian * angle) +
                     " degrees in load case " + std::to_string(load_case) +
                     ", of which the fit keeps the first order only",
                 "hold all components of the face, or measure its nodes "
                 "(\"displacement\": \"measured\")");
}

Finding ResultantsContradicted(double distance) {
  return Warning(FindingCode::kResultantsContradicted,
                 "a measured resultant differs from the force of the fit by " +
                     TwoDigits(distance) + " times its standard deviation" +
                     kErrorsHold,
                 "check the loads and the resultants");
}

Finding NoFrameUsable(std::size_t num_frames, const std::string& reason) {
  return {FindingCode::kFramesLeftOut, Severity::kError,
          num_frames == 1 ? "the only frame gives no estimate with error bars"
                          : "none of the " + std::to_string(num_frames) +
                                " frames gives an estimate with error bars",
          "see the reasons in the table of --series, of which the first is: " +
              reason};
}

Finding FramesScatter(double excess, std::size_t farthest) {
  return Warning(FindingCode::kFramesScatter,
                 "the estimates of the frames scatter by " + TwoDigits(excess) +
                     " times their noise, frame " + std::to_string(farthest) +
                     " most",
                 "check the loads of the frames, and of that one above all");
}

Finding FramesAlike(double correlation) {
  return Warning(FindingCode::kFramesAlike,
                 "the residuals of successive frames are alike (correlation " +
                     TwoDigits(correlation) +
                     "), and what they share does not average out",
                 "check the reference image, the supports and the loads");
}

Finding FramesLeftOut(std::size_t num_left_out, std::size_t num_frames) {
  return {
      FindingCode::kFramesLeftOut, Severity::kNotice,
      std::to_string(num_left_out) + " of " + std::to_string(num_frames) +
          (num_left_out == 1 ? " frames is not used" : " frames are not used"),
      "see the column 'reason' in the table of --series"};
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
                     ? "check that frames and loads are in the same order (the "
                       "load record can name the files), or use only frames of "
                       "small load"
                     : "look for creep, and for drift of the camera or the "
                       "load cell");
}

Finding ParametersOnBounds(const std::vector<std::string>& parameters) {
  return Warning(FindingCode::kParametersOnBounds,
                 FirstOf(parameters) +
                     (parameters.size() == 1
                          ? " lies on a bound, which its error bar ignores"
                          : " lie on bounds, which their error bars ignore"),
                 "check the bounds");
}

Finding ParametersNearLimits(const std::vector<std::string>& parameters,
                             Severity severity) {
  const bool is_one = parameters.size() == 1;
  return {FindingCode::kParametersNearLimits, severity,
          (is_one ? "the 95 % interval of " : "the 95 % intervals of ") +
              FirstOf(parameters) + (is_one ? " reaches" : " reach") +
              " the end of the physical range (-1 to 0.5), where " +
              (severity == Severity::kError ? "this estimator is not reliable"
                                            : "error bars may be too small"),
          severity == Severity::kError
              ? "give what is known of it (--nu), or use "
                "--estimator=iterative-fe"
              : "give what is known of it (--nu)"};
}

Finding ParameterBias(const std::string& parameter, double bias,
                      bool is_relative, Severity severity) {
  return {
      FindingCode::kNoiseBias, severity,
      std::isfinite(bias)
          ? "displacement noise biases " + parameter + " by " +
                (is_relative ? AboutPercent(bias) : "about " + TwoDigits(bias))
          : "displacement noise is too large for this estimator to determine " +
                parameter,
      "use --estimator=auto, whose fit of displacements noise does not bias"};
}

Finding LargeDeformation(const DeformationSize& size,
                         double relative_error_of_modulus, Severity severity,
                         bool is_rigid_motion_free) {
  if (size.strain > kLimits.doubtful_strain) {
    return {
        FindingCode::kLargeDeformation, severity,
        "the displacements make strains of " + StrainText(size.strain) +
            ", so they are probably in another unit of length than the "
            "coordinates, or are positions after the load",
        "give displacements in the unit of the coordinates, or name the law "
        "(--material)"};
  }
  const std::string text =
      DeformationText(size) +
      " are too large for small-strain elasticity, which leaves E uncertain "
      "by " +
      Percent(relative_error_of_modulus);
  return {FindingCode::kLargeDeformation, severity, text,
          !is_rigid_motion_free && size.rotation > kTurnOfAWhole * size.strain
              ? "give \"rigid_motion\": \"free\" if the specimen or the camera "
                "turned, or use --estimator=auto --kinematics=large"
              : "use --estimator=auto --kinematics=large, or a law of large "
                "strains, such as --material=neo_hookean"};
}

Finding TakenAsLinear(const DeformationSize& size) {
  return {FindingCode::kLargeDeformation, Severity::kNotice,
          "computed displacements with " + DeformationText(size) +
              " were taken as those of small-strain elasticity",
          "if large strains were computed, name their law, such as "
          "--material=neo_hookean"};
}

Finding NoEquilibrium(const std::string& reason) {
  const std::size_t end = std::min(reason.find("; "), reason.size());
  return Error(
      FindingCode::kNumericalFailure,
      "the fit found no parameters to begin with: " + reason.substr(0, end),
      end < reason.size() ? reason.substr(end + 2)
                          : "check the loads and their unit");
}

Finding LargeStrainsFitted(const DeformationSize& size,
                           const std::string& law) {
  const std::string what = DeformationText(size);
  return {FindingCode::kLargeDeformation, Severity::kNotice,
          (what.empty() ? "" : "for " + what + ", ") + "the law " + law +
              " of large strains was fitted",
          size.strain > kLimits.doubtful_strain
              ? "check that displacements have the unit of the coordinates, "
                "and name the law by --material if you know it"
              : "name another law by --material if you know it, or give "
                "--kinematics=small"};
}

Finding LargeStrainLawsFitAlike(const std::string& chosen,
                                const std::vector<std::string>& others) {
  std::string names;
  for (const std::string& name : others) {
    names += (names.empty() ? "" : " and ") + name;
  }
  return {FindingCode::kLawsFitAlike, Severity::kNotice,
          names + (others.size() == 1 ? " explains" : " explain") +
              " the data about as well as " + chosen +
              "; the spread of the parameters is a part of the errors",
          "measure larger deformations, or name the law by --material"};
}

Finding MarginNotGiven(double relative_error) {
  return Warning(
      FindingCode::kMarginNotGiven,
      "the mesh ends at the outermost points, and where the specimen ends "
      "elsewhere, E changes by about " +
          Percent(relative_error),
      "give \"margin\", the distance from these points to the free edges, or "
      "use a mesh of the specimen");
}

Finding PriorContradicted(const ParameterEstimate& of_data,
                          double probability) {
  return Warning(
      FindingCode::kPriorContradicted,
      "the data alone give " + of_data.Label() + " = " +
          ValueWithError(of_data.value, *of_data.standard_error) +
          ", which the prior makes improbable (p " +
          (probability < 1e-6 ? "< 1e-6" : "= " + TwoDigits(probability)) +
          "); the estimate lies between the two",
      "check the loads, the units and the value and deviation of the prior");
}

Finding NegativePoissonRatio(const ParameterEstimate& poisson_ratio) {
  return Warning(FindingCode::kNegativePoissonRatio,
                 poisson_ratio.Label() + " is negative (" +
                     TwoDigits(poisson_ratio.value) +
                     "), which a displacement component of the wrong sign can "
                     "cause",
                 "check that u points along x, and v along y");
}

Finding DiscretizationErrorFinding(const Estimate& estimate) {
  return Warning(FindingCode::kDiscretizationError,
                 "the mesh is so coarse that it leaves " +
                     LargestErrors(estimate.error_budget.discretization,
                                   estimate.parameters),
                 "use a finer mesh if you need a smaller error");
}

Finding FacetsOfRoundBody(double error) {
  return Warning(FindingCode::kFlatFacets,
                 "the facets of the mesh are flat; if the specimen is round "
                 "there, the moduli come out " +
                     Percent(std::abs(error)) + " or more too " +
                     (error > 0 ? "large" : "small") +
                     ", which no error bar includes",
                 "use smaller facets or curved elements, unless the specimen "
                 "has these facets");
}

Finding MeshErrorUnknown() {
  return Warning(FindingCode::kMeshErrorUnknown,
                 "this estimator does not know the error of the mesh, so the "
                 "error bars include noise only",
                 std::string(kUseAuto) +
                     "give --origin=computed for simulated "
                     "data");
}

Finding MeshErrorOfMapUnknown() {
  return Warning(
      FindingCode::kMeshErrorUnknown,
      "the error of the mesh is not known, because its elements are quadratic "
      "already, so the error bars include noise only",
      "give linear elements, of which a map makes quadratic ones by itself, "
      "or give --origin=computed for simulated data");
}

Finding WithoutAdviceOfAuto(Finding finding) {
  if (finding.advice.rfind(kUseAuto, 0) == 0) {
    finding.advice.erase(0, std::string(kUseAuto).size());
  }
  return finding;
}

Finding ComputedByLinearElements(Severity severity) {
  const std::string text =
      "linear elements of this mesh fit far better than finer ones, as if they "
      "had computed the displacements";
  return severity == Severity::kError
             ? Error(FindingCode::kComputedByLinearElements, text,
                     "if they did, give --origin=computed, or simulate with a "
                     "finer mesh if this one was cut into simplices")
             : Warning(FindingCode::kComputedByLinearElements,
                       text + "; the error bars include the difference",
                       "if they did, give --origin=computed; else try another "
                       "law (--material)");
}

Finding SupportsEndWithinElements(const ParameterErrors& errors,
                                  const Estimate& estimate) {
  return Warning(FindingCode::kSupportsEndWithinElements,
                 "it is not known where the supports end between nodes, which "
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

Finding Misfit(double ratio) {
  return {FindingCode::kMisfit, Severity::kWarning,
          "the displacements differ from the map by " + TwoDigits(ratio) +
              " times what the given noise explains",
          "check --noise_sd, then the supports and the loads"};
}

Finding NotResolved(const std::vector<std::string>& regions,
                    bool is_by_elements) {
  const bool is_one = regions.size() == 1;
  return {FindingCode::kNotResolved, Severity::kWarning,
          FirstOf(regions) + " of the map " + (is_one ? "is" : "are") +
              " narrower than three resolution lengths, so that " +
              (is_one ? "its" : "their") + " surroundings blur " +
              (is_one ? "its modulus" : "their moduli"),
          is_by_elements ? "use a finer mesh"
                         : "measure more points or with less noise, or add "
                           "load cases"};
}

Finding NoiseNeeded(double num_rows, double supported_parameters) {
  return {FindingCode::kNoiseNeeded, Severity::kWarning,
          "the " + NumberText(num_rows) +
              " measured components are few beside " +
              TwoDigits(supported_parameters) +
              " parameters of the map, so that noise and structure are hardly "
              "told apart and errors may be too small",
          "give the standard deviation of the noise (--noise_sd)"};
}

Finding MayBeTheMesh(double spread) {
  return {FindingCode::kMayBeTheMesh, Severity::kWarning,
          "the modulus varies by " + Percent(spread) +
              " only, which what the elements miss may cause",
          "use a finer mesh, and see whether the structure stays"};
}

Finding StructureWithinMeshError(double explained, double by_mesh) {
  return {FindingCode::kMayBeTheMesh, Severity::kWarning,
          "a modulus that varies would explain " + Percent(explained) +
              " of the displacements, which is within what the elements may "
              "miss (" +
              Percent(by_mesh) + "), so that one is taken for all",
          "use a finer mesh to see what varies less"};
}

Finding LocalMapNeedsExactData(double force_residual) {
  return {FindingCode::kLocalMap, Severity::kWarning,
          "the map takes each element by itself, whose moduli 1 % of noise "
          "makes useless; " +
              Percent(force_residual) + " of the forces are left over",
          "use --estimator=iterative-fe, unless the displacements have no "
          "noise"};
}

Finding LocalMapUndetermined() {
  return Error(FindingCode::kParametersUndetermined,
               "the forces at the nodes do not determine the modulus of each "
               "element",
               "add load cases, or use --estimator=iterative-fe");
}

Finding LocalModuliNotPositive(Eigen::Index num_bad,
                               Eigen::Index num_elements) {
  return Error(FindingCode::kUnphysical,
               "the modulus of " + std::to_string(num_bad) + " of " +
                   std::to_string(num_elements) +
                   " elements is not positive, which noise causes in a map "
                   "that takes each element by itself",
               "use --estimator=iterative-fe");
}

}  // namespace elastimate
