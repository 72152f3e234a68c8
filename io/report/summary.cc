#include "elastimate/io/report/summary.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/io/report/summary_lines.h"

namespace elastimate {
namespace {

std::string WithError(double value, const std::optional<double>& error) {
  if (!std::isfinite(value)) {
    return "none";
  }
  return error ? ValueWithError(value, *error)
               : NumberText(value) + " (no standard error)";
}

// Tells whether nu is near 1/2 or -1, where E and nu are not what the data
// determine.
bool ReachesLimit(const Estimate& estimate) {
  return estimate.poisson_ratio_interval->upper == 0.5 ||
         estimate.poisson_ratio_interval->lower == -1;
}

// Adds the parts of the error of E (place 0, relative) or of nu (1), the
// largest first.
void AddErrors(const std::string& name, Eigen::Index place,
               const ErrorBudget& budget, std::ostringstream& text) {
  std::vector<std::pair<double, const char*>> parts;
  for (const auto& [errors, cause] :
       {std::pair{&budget.noise, "noise"},
        std::pair{&budget.bias, "the bias by noise"},
        std::pair{&budget.model, "the model"},
        std::pair{&budget.outliers, "outliers"},
        std::pair{&budget.discretization, "the mesh"},
        std::pair{&budget.curvature, "other values that fit as well"},
        std::pair{&budget.law, "the choice of the law"},
        std::pair{&budget.kinematics, "large deformations"},
        std::pair{&budget.section, "the margin"},
        std::pair{&budget.prior, "the prior"}}) {
    if (errors->size() > place && (*errors)(place) > 0) {
      parts.emplace_back((*errors)(place), cause);
    }
  }
  if (parts.empty()) {
    return;
  }
  std::sort(parts.rbegin(), parts.rend());
  // A smaller part does not show in the sum.
  constexpr double kSmallest = 0.05;
  std::string list;
  for (const auto& [error, cause] : parts) {
    if (error >= kSmallest * parts.front().first) {
      list += std::string(list.empty() ? "mostly " : ", ") + cause + " (" +
              (place == 0 ? Percent(error) : TwoDigits(error)) + ")";
    }
  }
  AddLine("error of " + name, list, text);
}

// Adds what was done for the elements, and where the errors come from.
void AddErrors(const Estimate& estimate, std::ostringstream& text) {
  const std::vector<ParameterEstimate>& parameters = estimate.parameters;
  if (parameters.size() != 2 || parameters[0].symbol != "E" ||
      parameters[1].symbol != "nu") {
    return;
  }
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (parameters[i].standard_error) {
      AddErrors(parameters[i].symbol, i, estimate.error_budget, text);
    }
  }
  if (!estimate.YoungsModulusStandardError()) {
    return;
  }
  constexpr double kNotable = 0.1;  // Of a standard error.
  const Eigen::Vector2d correction =
      estimate.discretization_correction.value_or(Eigen::Vector2d::Zero());
  if (std::abs(correction(0)) * estimate.elasticity.youngs_modulus >
          kNotable * *estimate.YoungsModulusStandardError() ||
      std::abs(correction(1)) >
          kNotable * estimate.PoissonRatioStandardError().value_or(0)) {
    AddLine("corrected by",
            PercentOf(correction(0), "E") + " and " +
                NumberText(correction(1), 2) +
                " in nu for the error of the elements",
            text);
  }
}

// Adds the parameters of one isotropic material.
// Returns a parameter with its error, or that it is known.
std::string ParameterText(const ParameterEstimate& parameter) {
  return parameter.is_known && std::isfinite(parameter.value)
             ? NumberText(parameter.value, 6) + " (known)"
             : WithError(parameter.value, parameter.standard_error);
}

void AddElasticity(const Estimate& estimate, std::ostringstream& text) {
  const IsotropicElasticity& elasticity = estimate.elasticity;
  const bool is_mean =
      estimate.map && estimate.map->verdict != MapVerdict::kHomogeneous;
  AddLine(is_mean ? "geometric mean of E" : "Young's modulus E",
          WithError(elasticity.youngs_modulus,
                    estimate.YoungsModulusStandardError()),
          text);
  const bool is_known =
      estimate.parameters.size() == 2 && estimate.parameters[1].is_known;
  AddLine("Poisson's ratio nu",
          is_known ? ParameterText(estimate.parameters[1])
                   : WithError(elasticity.poisson_ratio,
                               estimate.PoissonRatioStandardError()),
          text);
  const bool is_at_limit =
      estimate.poisson_ratio_interval && ReachesLimit(estimate);
  if (is_at_limit) {
    AddLine("95 % interval of nu",
            NumberText(estimate.poisson_ratio_interval->lower, 4) + " to " +
                NumberText(estimate.poisson_ratio_interval->upper, 4),
            text);
  }
  if (is_at_limit || estimate.shear_modulus) {
    AddLine("shear modulus mu",
            WithError(estimate.ShearModulus(),
                      estimate.ShearModulusStandardError()),
            text);
  }
  if (is_at_limit && !estimate.shear_modulus) {
    AddLine("1 / bulk modulus",
            WithError(elasticity.BulkCompliance(),
                      estimate.BulkComplianceStandardError()),
            text);
  }
}

// Returns "determined, 12 % of the strain energy, residuals 1.1 times the
// noise".
std::string Verdict(const MaterialEstimate& material) {
  std::string verdict;
  if (material.determination) {
    verdict =
        std::string(DeterminationName(*material.determination)) +
        (material.determination == Determination::kDetermined ? ""
                                                              : " determined");
  }
  const auto add = [&verdict](const std::string& part) {
    verdict += (verdict.empty() ? "" : ", ") + part;
  };
  if (material.energy_share) {
    add(PercentOf(*material.energy_share, "the strain energy"));
  }
  if (material.residual_chi_square) {
    add("residuals " + NumberText(std::sqrt(*material.residual_chi_square), 2) +
        " times the noise");
  }
  return verdict;
}

void AddParameters(const Estimate& estimate, std::ostringstream& text) {
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    // The axis is described in words instead.
    if (AxisOfParameter(estimate, i) != nullptr) {
      continue;
    }
    AddLine(parameter.Label(), ParameterText(parameter), text);
  }
}

// Adds lines such as "0.0012, 0.7066, 0.7076 +- 0.42 degrees".
void AddAxes(const Estimate& estimate, std::ostringstream& text) {
  for (const AxisEstimate& axis : estimate.axes) {
    std::string components;
    for (const double component :
         axis.direction.value_or(Eigen::Vector3d::Zero())) {
      components += (components.empty() ? "" : ", ") + NumberText(component, 4);
    }
    // The label is shown without "the".
    AddLine(axis.Label().substr(4),
            !axis.direction
                ? "not determined"
                : components + (axis.standard_error
                                    ? " +- " +
                                          NumberText(kDegreesOfRadian *
                                                         *axis.standard_error,
                                                     2) +
                                          " degrees"
                                    : " (no standard error)"),
            text);
  }
}

void AddMaterials(const Estimate& estimate, std::ostringstream& text) {
  AddParameters(estimate, text);
  AddAxes(estimate, text);
  for (const MaterialEstimate& material : estimate.materials) {
    // Some estimators have no verdict.
    const std::string verdict = Verdict(material);
    if (!verdict.empty()) {
      AddLine(RegionsLabel(material.regions), verdict, text);
    }
  }
  for (const std::string& combination : estimate.combinations) {
    AddLine("determined only", combination, text);
  }
}

void AddDiagnostics(const Estimate& estimate, std::ostringstream& text) {
  if (estimate.noise_sd) {
    AddLine("noise sd", NumberText(*estimate.noise_sd, 3), text);
  }
  if (estimate.force_residual) {
    AddLine("force residual",
            NumberText(*estimate.force_residual, 3) + " of the load", text);
  }
  if (estimate.displacement_residual) {
    AddLine("displacement residual",
            NumberText(*estimate.displacement_residual, 3) +
                " of the measured displacement",
            text);
  }
  if (estimate.residual_correlation) {
    AddLine("residual correlation",
            NumberText(*estimate.residual_correlation, 2) +
                " between neighbours" +
                (estimate.correlation_length.value_or(0) > 0
                     ? ", alike over a length of " +
                           NumberText(*estimate.correlation_length, 2)
                     : ""),
            text);
  }
  if (estimate.noise_attenuation) {
    AddLine("noise attenuation", NumberText(*estimate.noise_attenuation, 3),
            text);
  }
  if (estimate.identifiability_angle) {
    AddLine("identifiability angle",
            NumberText(kDegreesOfRadian * *estimate.identifiability_angle, 3) +
                " degrees",
            text);
  }
}

std::string Solving(const Work& work) {
  const std::string solves = Counted(work.solves, "solve");
  const std::string ranks =
      work.ranks > 1 ? " on " + std::to_string(work.ranks) + " ranks, " : ", ";
  const std::string factorizations =
      Counted(work.factorizations, "factorisation") + ", ";
  if (work.multigrid_set_ups == 0) {
    return factorizations + solves + ranks;
  }
  return (work.factorizations == 0 ? "" : factorizations) +
         Counted(work.multigrid_set_ups, "multigrid set-up") + ", " + solves +
         " in " + Counted(work.iterations, "iteration") + ranks;
}

std::string ListOf(const std::vector<int>& regions) {
  std::string list;
  for (const int region : regions) {
    list += (list.empty() ? "" : ", ") + std::to_string(region);
  }
  return list;
}

// Adds the merges that were taken, and the nearest one that was not.
void AddMerges(const std::vector<RegionMerge>& merges,
               std::ostringstream& text) {
  for (const RegionMerge& merge : merges) {
    AddLine(merge.is_taken ? "merged" : "told apart",
            "regions " + ListOf(merge.first) + " and " + ListOf(merge.second) +
                " (chi^2 " + NumberText(merge.chi_square, 3) + ", limit " +
                NumberText(merge.limit, 3) + ")",
            text);
    if (!merge.is_taken) {
      break;
    }
  }
}

// Adds the laws that were compared, the best first.  The chi^2 of laws of large
// strains is their distance from the best, as their BIC is.
void AddLaws(const Estimate& estimate, std::ostringstream& text) {
  const std::vector<LawComparison>& laws = estimate.laws;
  for (const LawComparison& law : laws) {
    const bool is_chosen = &law == laws.data();
    AddLine(is_chosen ? "law chosen" : "law not chosen",
            law.law + " (" + Counted(law.num_parameters, "parameter") +
                (estimate.large_strain_law.empty()
                     ? ", chi^2 " + NumberText(law.chi_square, 3)
                     : "") +
                ", BIC " +
                (is_chosen ? "least" : "+" + NumberText(law.criterion, 3)) +
                ")",
            text);
  }
}

void AddSeries(const SeriesSummary& series, std::ostringstream& text) {
  const Interval& loads = series.loads;
  std::string under;
  if (loads.lower != 1 || loads.upper != 1) {
    under =
        ", at " + NumberText(loads.lower, 4) +
        (loads.lower < loads.upper ? " to " + NumberText(loads.upper, 4) : "") +
        " times the loads";
  }
  AddLine("frames",
          std::to_string(series.num_used) + " of " +
              std::to_string(series.num_frames) + " used" + under,
          text);
}

// Returns "5.1 +- 0.2 %", the change from the least load to the largest, or in
// time.
std::string ChangeText(double change, double error, bool is_relative) {
  if (!is_relative) {
    return TwoDigits(change) + " +- " + TwoDigits(error);
  }
  std::string text = Percent(change);
  if (text.back() == '%') {
    text.erase(text.size() - 2);
  }
  return text + " +- " + Percent(error);
}

void AddTrend(const std::vector<ParameterEstimate>& parameters,
              const Trend& trend, std::ostringstream& text) {
  std::string changes;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto place = Eigen::Index(i);
    if (std::isnan(trend.change(place))) {
      continue;
    }
    changes += (changes.empty() ? "" : ", ") + parameters[i].Label() + " " +
               ChangeText(trend.change(place), trend.standard_error(place),
                          parameters[i].is_modulus);
  }
  AddLine(trend.is_over_load ? "change over the load" : "change in time",
          changes, text);
}

// Says what the map is, the verdict first.
void AddMap(const MapEstimate& map, std::ostringstream& text) {
  if (map.verdict == MapVerdict::kElements) {
    AddLine("map",
            "E of each element by itself, from " +
                NumberText(map.youngs_modulus.minCoeff(), 4) + " to " +
                NumberText(map.youngs_modulus.maxCoeff(), 4),
            text);
    return;
  }
  AddLine("map",
          map.verdict == MapVerdict::kHomogeneous ? "one material"
          : map.verdict == MapVerdict::kField
              ? "a field that varies smoothly"
              : std::to_string(map.regions.size()) + " regions",
          text);
  AddLine("",
          "ln evidence over one material: " +
              NumberText(map.region_log_evidence, 3) + " for regions, " +
              NumberText(map.field_log_evidence, 3) + " for a field",
          text);
  AddLine("",
          "the data support " + NumberText(map.supported_parameters, 3) +
              " of " + std::to_string(map.youngs_modulus.size()) +
              " parameters",
          text);
  const auto add_region = [&text](const std::string& name,
                                  const MapRegion& region) {
    AddLine(
        name,
        "E = " + ValueWithError(region.youngs_modulus, region.standard_error) +
            ", volume " + NumberText(region.volume, 3),
        text);
  };
  for (std::size_t i = 0; i < map.regions.size() && map.regions.size() > 1;
       ++i) {
    add_region("region " + std::to_string(i + 1), map.regions[i]);
  }
  if (map.boundary) {
    add_region("their boundary", *map.boundary);
  }
}

void AddSceneSize(const Scene& scene, std::ostringstream& text) {
  AddLine("scene",
          std::to_string(scene.mesh.NumVertices()) + " nodes, " +
              std::to_string(scene.mesh.NumElements()) +
              (IsCurved(scene.mesh.kind) ? " curved quadratic "
               : scene.mesh.Order() == 2 ? " quadratic "
                                         : " ") +
              std::string(
                  scene.mesh.Topology().ShapeName(scene.mesh.NumElements())) +
              ", " + Counted(scene.load_cases.size(), "load case"),
          text);
  if (scene.mesh.Dimension() == 2) {
    AddLine("section",
            std::string(scene.mesh.section.model == SectionModel::kPlaneStress
                            ? "plane stress"
                            : "plane strain") +
                ", thickness " + NumberText(scene.mesh.section.thickness, 4),
            text);
  }
}

}  // namespace

std::string Summary(const Estimate& estimate, const Scene& scene,
                    const ReportTimes& times) {
  std::ostringstream text;
  AddSceneSize(scene, text);
  AddLoadLines(scene, text);
  AddMerges(estimate.merges, text);
  AddLaws(estimate, text);
  if (estimate.series) {
    AddSeries(*estimate.series, text);
  }
  AddLine("estimator", estimate.estimator, text);
  AddLine("status",
          std::string(StatusName(estimate.status)) +
              (estimate.IsUsable() ? "" : ": NOT USABLE"),
          text);
  if (!estimate.message.empty()) {
    AddLine("", estimate.message, text);
  }
  if (estimate.map) {
    AddMap(*estimate.map, text);
  }
  if (IsOneIsotropicMaterial(scene.materials)) {
    AddElasticity(estimate, text);
  } else {
    AddMaterials(estimate, text);
  }
  AddErrors(estimate, text);
  if (!estimate.why_no_standard_error.empty()) {
    AddLine("", "no standard error: " + estimate.why_no_standard_error, text);
  }
  AddDiagnostics(estimate, text);
  if (estimate.series && estimate.series->trend) {
    AddTrend(estimate.ParametersAndShearModulus(), *estimate.series->trend,
             text);
  }
  AddLine("work",
          std::to_string(estimate.work.element_passes) +
              (estimate.work.element_passes == 1 ? " element pass, "
                                                 : " element passes, ") +
              Solving(estimate.work) + NumberText(estimate.seconds, 3) + " s",
          text);
  AddLine("time",
          NumberText(times.read, 3) + " s to read the scene, " +
              NumberText(times.total, 3) + " s in all",
          text);
  for (const Rung& rung : estimate.rungs) {
    AddLine(
        "rung",
        rung.estimator +
            (rung.element_order == 2 ? " with quadratic elements" : "") +
            (rung.status ? ", " + NumberText(rung.seconds, 2) + " s, " : ", ") +
            rung.decision,
        text);
  }
  for (const Severity severity : {Severity::kWarning, Severity::kNotice}) {
    for (const std::string& sentence : estimate.Sentences(severity)) {
      AddLine(std::string(SeverityName(severity)), sentence, text);
    }
  }
  return text.str();
}

}  // namespace elastimate
