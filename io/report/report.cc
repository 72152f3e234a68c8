#include "elastimate/io/report/report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "elastimate/core/package/version.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/io/report/json_number.h"
#include "elastimate/io/scene/origin.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Json = nlohmann::ordered_json;

Json OptionsJson(const EstimatorOptions& options) {
  const char* const loss_names[] = {"none", "huber", "cauchy"};
  const char* const solver_names[] = {"automatic", "cholesky", "multigrid"};
  return {{"nu", OrNull(options.known_poisson_ratio)},
          {"nu_min", OrNull(options.poisson_ratio.lower)},
          {"nu_max", OrNull(options.poisson_ratio.upper)},
          {"youngs_min", OrNull(options.youngs_modulus.lower)},
          {"youngs_max", OrNull(options.youngs_modulus.upper)},
          {"loss", loss_names[static_cast<int>(options.loss)]},
          {"degree", options.virtual_field_degree
                         ? Json(*options.virtual_field_degree)
                         : Json(nullptr)},
          {"max_iterations", options.max_iterations},
          {"solver", solver_names[static_cast<int>(options.solver)]}};
}

Json MeshJson(const Scene& scene, const Estimate& estimate) {
  const Mesh& mesh = scene.mesh;
  Json json = {
      {"kind", mesh.Topology().name},
      {"dimension", mesh.Dimension()},
      {"model", SectionModelName(mesh.section.model)},
      {"thickness",
       mesh.Dimension() == 2 ? Json(mesh.section.thickness) : Json(nullptr)},
      {"nodes", mesh.NumVertices()},
      {"elements", mesh.NumElements()}};
  if (mesh.Topology().shape == "tetrahedron") {
    json["tetrahedra"] = mesh.NumElements();
  }
  json["load_cases"] = scene.load_cases.size();
  json["order"] = mesh.Order();
  json["divisions"] = estimate.mesh_divisions;
  return json;
}

// Writes null for a component that was not measured.
Json MeasuredJson(const Eigen::VectorXd& force) {
  Json components = Json::array();
  for (const double component : force) {
    components.push_back(std::isnan(component) ? Json(nullptr)
                                               : Json(component));
  }
  return components;
}

Json LoadsJson(const Scene& scene) {
  Json cases = Json::array();
  for (const LoadCase& load_case : scene.load_cases) {
    Json loads = Json::array();
    for (const Load& load : load_case.loads) {
      const LoadResultant resultant = ResultantOf(scene.mesh, load);
      loads.push_back(
          {{"type", resultant.type},
           {"resultant", std::vector<double>(resultant.force.begin(),
                                             resultant.force.end())},
           {"area", OrNull(resultant.area)}});
    }
    for (const Resultant& resultant : load_case.resultants) {
      loads.push_back({{"type", "resultant"},
                       {"resultant", MeasuredJson(resultant.force)},
                       {"area", nullptr}});
    }
    cases.push_back(loads);
  }
  return cases;
}

Json NoticesJson(const std::vector<std::string>& notices) {
  Json list = Json::array();
  for (const std::string& notice : notices) {
    list.push_back(Printable(notice, kLongestSentence));
  }
  return list;
}

Json FindingsJson(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"code", FindingCodeName(finding.code)},
                    {"severity", SeverityName(finding.severity)},
                    {"text", finding.text},
                    {"advice", finding.advice}});
  }
  return list;
}

// Writes null for one material of the whole mesh, else an id or a list of
// joined ids.
Json RegionsJson(const std::vector<int>& regions) {
  return regions.empty()       ? Json(nullptr)
         : regions.size() == 1 ? Json(regions[0])
                               : Json(regions);
}

Json MaterialJson(const Scene& scene) {
  Json regions = Json::array();
  for (const Material& material : scene.materials) {
    regions.push_back(RegionsJson(material.regions));
  }
  // The report has one law, or the law of each material.
  Json laws = Json::array();
  for (const Material& material : scene.materials) {
    laws.push_back(material.law);
  }
  const bool is_one_law =
      std::all_of(laws.begin(), laws.end(),
                  [&laws](const Json& law) { return law == laws[0]; });
  return {
      {"law", laws.empty() ? Json(Material().law)
              : is_one_law ? laws[0]
                           : laws},
      {"regions", scene.materials.empty() ? Json::array({nullptr}) : regions}};
}

Json ParametersJson(const Estimate& estimate) {
  Json parameters = Json::array();
  for (const ParameterEstimate& parameter : estimate.parameters) {
    const std::optional<Interval>& interval = parameter.interval;
    parameters.push_back(
        {{"name", parameter.name},
         {"region", RegionsJson(parameter.regions)},
         {"value", OrNull(parameter.value)},
         {"known", parameter.is_known},
         {"standard_error", OrNull(parameter.standard_error)},
         {"determined", parameter.IsDetermined()},
         {"interval", interval ? Json({interval->lower, interval->upper})
                               : Json(nullptr)}});
  }
  return parameters;
}

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (const auto& row : matrix.rowwise()) {
    Json values = Json::array();
    for (const double value : row) {
      values.push_back(OrNull(value));
    }
    rows.push_back(values);
  }
  return rows;
}

// Writes the stiffness of each material that is not isotropic.
Json StiffnessJson(const Estimate& estimate) {
  Json stiffnesses = Json::array();
  for (const StiffnessEstimate& stiffness : estimate.stiffnesses) {
    stiffnesses.push_back(
        {{"region", RegionsJson(stiffness.regions)},
         {"value", MatrixJson(stiffness.value)},
         {"standard_error", MatrixJson(stiffness.standard_error)}});
  }
  return stiffnesses;
}

// Writes the axis of each material whose axis was to be found.
Json AxesJson(const Estimate& estimate) {
  Json axes = Json::array();
  for (const AxisEstimate& axis : estimate.axes) {
    Json direction;
    if (axis.direction) {
      direction =
          std::vector<double>(axis.direction->begin(), axis.direction->end());
    }
    axes.push_back({{"region", RegionsJson(axis.regions)},
                    {"direction", direction},
                    {"standard_error_deg",
                     axis.standard_error && axis.direction
                         ? Json(kDegreesOfRadian * *axis.standard_error)
                         : Json(nullptr)}});
  }
  return axes;
}

// Writes parameters by name for one isotropic material, else in their order.
Json BudgetJson(const Scene& scene, const ErrorBudget& budget) {
  const bool is_by_name = IsOneIsotropicMaterial(scene.materials);
  const auto of = [is_by_name](const ParameterErrors& errors) {
    if (is_by_name) {
      const bool is_known = errors.size() == 2;
      return Json({{"youngs_modulus", is_known ? OrNull(errors(0)) : nullptr},
                   {"poisson_ratio", is_known ? OrNull(errors(1)) : nullptr}});
    }
    Json values = Json::array();
    for (const double error : errors) {
      values.push_back(OrNull(error));
    }
    return errors.size() == 0 ? Json(nullptr) : values;
  };
  return {{"noise", of(budget.noise)},
          {"bias", of(budget.bias)},
          {"model", of(budget.model)},
          {"outliers", of(budget.outliers)},
          {"discretization", of(budget.discretization)},
          {"curvature", of(budget.curvature)},
          {"law", of(budget.law)},
          {"kinematics", of(budget.kinematics)},
          {"section", of(budget.section)},
          {"prior", of(budget.prior)}};
}

Json CorrectionJson(const Estimate& estimate) {
  if (!estimate.discretization_correction) {
    return nullptr;
  }
  return {{"youngs_modulus", (*estimate.discretization_correction)(0)},
          {"poisson_ratio", (*estimate.discretization_correction)(1)}};
}

Json WorkJson(const Work& work) {
  return {{"element_passes", work.element_passes},
          {"factorizations", work.factorizations},
          {"multigrid_set_ups", work.multigrid_set_ups},
          {"solves", work.solves},
          {"iterations", work.iterations},
          {"ranks", work.ranks}};
}

Json RungsJson(const Estimate& estimate) {
  Json rungs = Json::array();
  for (const Rung& rung : estimate.rungs) {
    const auto& elasticity = rung.elasticity;
    rungs.push_back(
        {{"estimator", rung.estimator},
         {"order", rung.element_order},
         {"status",
          rung.status ? Json(StatusName(*rung.status)) : Json(nullptr)},
         {"youngs_modulus",
          elasticity ? Json(elasticity->youngs_modulus) : Json(nullptr)},
         {"poisson_ratio",
          elasticity ? OrNull(elasticity->poisson_ratio) : Json(nullptr)},
         {"work", WorkJson(rung.work)},
         {"seconds", rung.seconds},
         {"decision", rung.decision}});
  }
  return rungs;
}

// Writes outliers; load cases count from 1 on, as in the names of arrays.
Json OutliersJson(const std::vector<Outlier>& outliers) {
  Json list = Json::array();
  for (const Outlier& outlier : outliers) {
    list.push_back({{"load_case", outlier.load_case + 1},
                    {outlier.is_point ? "point" : "node", outlier.index}});
  }
  return list;
}

Json DiagnosticsJson(const Estimate& estimate) {
  std::optional<double> angle = estimate.identifiability_angle;
  if (angle) {
    *angle *= kDegreesOfRadian;
  }
  return {{"identifiability_angle_deg", OrNull(angle)},
          {"noise_attenuation", OrNull(estimate.noise_attenuation)},
          {"residual_correlation", OrNull(estimate.residual_correlation)},
          {"correlation_length", OrNull(estimate.correlation_length)},
          {"discretization_error", OrNull(estimate.discretization_error)},
          {"poisson_ratio_discretization_error",
           OrNull(estimate.poisson_ratio_discretization_error)},
          {"discretization_correction", CorrectionJson(estimate)},
          {"outliers", OutliersJson(estimate.outliers)},
          {"active_bounds", estimate.active_bounds},
          {"why_no_standard_error", estimate.why_no_standard_error},
          {"warnings", estimate.Sentences(Severity::kWarning)}};
}

// Writes the materials where there are several, in their order.
Json MaterialsJson(const Estimate& estimate) {
  Json materials = Json::array();
  for (const MaterialEstimate& material : estimate.materials) {
    materials.push_back(
        {{"region", RegionsJson(material.regions)},
         {"determination",
          material.determination
              ? Json(DeterminationName(*material.determination))
              : Json(nullptr)},
         {"energy_share", OrNull(material.energy_share)},
         {"residual_chi_square", OrNull(material.residual_chi_square)},
         {"residual_correlation", OrNull(material.residual_correlation)},
         {"largest_differences", material.largest_differences}});
  }
  return materials;
}

Json MergesJson(const Estimate& estimate) {
  Json merges = Json::array();
  for (const RegionMerge& merge : estimate.merges) {
    merges.push_back({{"regions", {merge.first, merge.second}},
                      {"chi_square", OrNull(merge.chi_square)},
                      {"limit", merge.limit},
                      {"merged", merge.is_taken}});
  }
  return merges;
}

Json LawsJson(const Estimate& estimate) {
  Json laws = Json::array();
  for (const LawComparison& law : estimate.laws) {
    laws.push_back({{"law", law.law},
                    {"num_parameters", law.num_parameters},
                    {"chi_square", OrNull(law.chi_square)},
                    {"bic_difference", OrNull(law.criterion)}});
  }
  return laws;
}

Json RegionJson(const MapRegion& region) {
  return {{"youngs_modulus", OrNull(region.youngs_modulus)},
          {"standard_error", OrNull(region.standard_error)},
          {"volume", region.volume},
          {"diameter", region.diameter},
          {"resolved", region.is_resolved}};
}

// Writes the map of a modulus; its arrays are in the VTU file.
Json MapJson(const std::optional<MapEstimate>& map) {
  if (!map) {
    return nullptr;
  }
  Json regions = Json::array();
  for (const MapRegion& region : map->regions) {
    regions.push_back(RegionJson(region));
  }
  return {{"parameter", "youngs_modulus"},
          {"verdict", MapVerdictName(map->verdict)},
          {"log_evidence",
           {{"homogeneous", 0},
            {"regions", OrNull(map->region_log_evidence)},
            {"field", OrNull(map->field_log_evidence)}}},
          {"supported_parameters", OrNull(map->supported_parameters)},
          {"elements", map->youngs_modulus.size()},
          {"regions", regions},
          {"boundary", map->boundary ? RegionJson(*map->boundary) : Json()}};
}

Json SeriesJson(const Estimate& estimate) {
  if (!estimate.series) {
    return nullptr;
  }
  const SeriesSummary& series = *estimate.series;
  Json changes = nullptr;
  if (series.trend) {
    changes = Json::array();
    Eigen::Index place = 0;
    for (const ParameterEstimate& parameter :
         estimate.ParametersAndShearModulus()) {
      changes.push_back(
          {{"name", parameter.name},
           {"region", RegionsJson(parameter.regions)},
           {"change", OrNull(series.trend->change(place))},
           {"standard_error", OrNull(series.trend->standard_error(place))},
           {"p_value", OrNull(series.trend->p_value(place))}});
      ++place;
    }
  }
  return {{"frames", series.num_frames},
          {"used", series.num_used},
          {"loads", {series.loads.lower, series.loads.upper}},
          {"changes_over",
           series.trend ? Json(series.trend->is_over_load ? "load" : "time")
                        : Json(nullptr)},
          {"changes", changes}};
}

Json SecondsJson(const Estimate& estimate, const ReportTimes& times) {
  Json stages = Json::object();
  for (const StageTime& stage : estimate.stages) {
    stages[stage.stage] = stage.seconds;
  }
  return {{"read", times.read},
          {"estimate", estimate.seconds},
          {"total", times.total},
          {"stages", stages}};
}

}  // namespace

std::string JsonReport(const Estimate& estimate, const Scene& scene,
                       const EstimatorOptions& options,
                       const ReportTimes& times,
                       const std::vector<std::string>& notices) {
  const IsotropicElasticity& elasticity = estimate.elasticity;
  const std::optional<Interval>& interval = estimate.poisson_ratio_interval;
  const Json report = {
      {"elastimate", Version()},
      {"estimator", estimate.estimator},
      {"status", StatusName(estimate.status)},
      {"usable", estimate.IsUsable()},
      {"message", estimate.message},
      {"youngs_modulus", OrNull(elasticity.youngs_modulus)},
      {"poisson_ratio", OrNull(elasticity.poisson_ratio)},
      {"standard_error",
       {{"youngs_modulus", OrNull(estimate.YoungsModulusStandardError())},
        {"poisson_ratio", OrNull(estimate.PoissonRatioStandardError())},
        {"shear_modulus", OrNull(estimate.ShearModulusStandardError())},
        {"bulk_compliance", OrNull(estimate.BulkComplianceStandardError())}}},
      {"correlation", OrNull(estimate.Correlation())},
      {"poisson_ratio_interval",
       interval ? Json({interval->lower, interval->upper}) : Json(nullptr)},
      {"shear_modulus", OrNull(estimate.ShearModulus())},
      {"bulk_modulus", OrNull(elasticity.BulkModulus())},
      {"bulk_compliance", OrNull(elasticity.BulkCompliance())},
      {"noise_sd", OrNull(estimate.noise_sd)},
      {"mesh", MeshJson(scene, estimate)},
      {"loads", LoadsJson(scene)},
      {"origin", NameOf(scene.origin)},
      {"notices", NoticesJson(notices)},
      {"residual",
       {{"force_relative", OrNull(estimate.force_residual)},
        {"displacement_relative", OrNull(estimate.displacement_residual)}}},
      {"material", MaterialJson(scene)},
      {"parameters", ParametersJson(estimate)},
      {"covariance", MatrixJson(estimate.parameter_covariance)},
      {"stiffness", StiffnessJson(estimate)},
      {"axes", AxesJson(estimate)},
      {"error_budget", BudgetJson(scene, estimate.error_budget)},
      {"deformation",
       {{"strain", OrNull(estimate.deformation.strain)},
        {"rotation", OrNull(estimate.deformation.rotation)}}},
      {"findings", FindingsJson(estimate.findings)},
      {"diagnostics", DiagnosticsJson(estimate)},
      {"materials", MaterialsJson(estimate)},
      {"combinations", estimate.combinations},
      {"merges", MergesJson(estimate)},
      {"laws", LawsJson(estimate)},
      {"map", MapJson(estimate.map)},
      {"series", SeriesJson(estimate)},
      {"work", WorkJson(estimate.work)},
      {"rungs", RungsJson(estimate)},
      {"options", OptionsJson(options)},
      {"seconds", SecondsJson(estimate, times)}};
  return report.dump(2) + "\n";
}

}  // namespace elastimate
