#include "elastimate/io/report/parameters_file.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/materials/stiffness_factors.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/json_value.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

std::vector<long long> ReadRegions(const JsonValue& entry) {
  std::vector<long long> regions;
  if (!entry.Has("region") || entry.At("region").IsNull()) {
    return regions;
  }
  const JsonValue region = entry.At("region");
  if (!region.IsList()) {
    if (!region.IsInteger()) {
      region.Fail("must be the id of a region, a list of ids, or null");
    }
    return {region.Integer()};
  }
  for (const JsonValue& each : region.Items()) {
    regions.push_back(each.Integer());
  }
  return regions;
}

std::vector<long long> RegionsOf(const Scene& scene, std::size_t material) {
  return scene.materials.empty()
             ? std::vector<long long>{}
             : std::vector<long long>(scene.materials[material].regions.begin(),
                                      scene.materials[material].regions.end());
}

std::string OfRegions(const std::vector<long long>& regions) {
  std::string text;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    text += (i == 0 ? " of region " : ", ") + std::to_string(regions[i]);
  }
  return text;
}

std::string Describe(const MaterialParameters::Parameter& parameter,
                     const std::vector<long long>& regions) {
  return std::string(parameter.law_parameter->name) + OfRegions(regions);
}

/// Tells why no material has a parameter of this name and these regions, and
/// what to do about it.
std::string WhyNoParameter(const std::vector<long long>& regions,
                           const Scene& scene,
                           const MaterialParameters& parameters) {
  std::string all;  // "region 1; region 2, 3"
  std::string names;
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    const std::vector<long long> of_one = RegionsOf(scene, i);
    all += of_one.empty() ? "" : (all.empty() ? "" : ";") + OfRegions(of_one);
    if (of_one == regions) {
      names.clear();
      for (const LawParameter& parameter : parameters.LawOf(i).Parameters()) {
        names += (names.empty() ? "" : ", ") + std::string(parameter.name);
      }
    }
  }
  if (all.empty() && !regions.empty()) {
    return scene.mesh.regions.size() == 0
               ? "names a region, but the mesh has none; leave it out"
               : "names a region, but all regions share one material; give "
                 "each its own by --regions=each, or leave the region out";
  }
  if (!all.empty() && regions.empty()) {
    return "names no region, but the materials of the scene are" + all +
           "; name the region";
  }
  return names.empty() ? "is" + OfRegions(regions) +
                             ", but the materials of the scene are" + all +
                             "; correct the region"
                       : "is no parameter of its material, which has " + names +
                             "; correct the name";
}

void RequirePositiveDefinite(const std::filesystem::path& path,
                             const Scene& scene,
                             const MaterialParameters& parameters,
                             const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    const Law& law = parameters.LawOf(i);
    if (!IsStiffnessPositiveDefinite(
            law,
            values.segment(parameters.FirstParameter(i),
                           Eigen::Index(law.Parameters().size())),
            parameters.Model())) {
      ThrowInputError(
          path,
          "the stiffness" + OfRegions(RegionsOf(scene, i)) +
              " is not positive definite with these parameters; correct them");
    }
  }
}

}  // namespace

Eigen::VectorXd ReadParameters(const std::filesystem::path& path,
                               const Scene& scene) {
  const nlohmann::json parsed = ParseJsonFile(path);
  const JsonValue document(path, parsed);
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  Eigen::VectorXd values = Eigen::VectorXd::Constant(
      parameters.NumParameters(), std::numeric_limits<double>::quiet_NaN());
  for (const JsonValue& entry : document.At("parameters").Items()) {
    const std::string name = entry.At("name").String();
    const std::vector<long long> regions = ReadRegions(entry);
    bool is_found = false;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const MaterialParameters::Parameter& parameter = parameters.All()[i];
      if (parameter.law_parameter->name != name ||
          RegionsOf(scene, parameter.material) != regions) {
        continue;
      }
      if (!std::isnan(values(i))) {
        entry.Fail("is a second value of " + Describe(parameter, regions) +
                   "; keep one of them");
      }
      const JsonValue value = entry.At("value");
      values(i) = value.Number();
      const std::string why =
          WhyOutOfRange(*parameter.law_parameter, values(i));
      if (!why.empty()) {
        value.Fail(why);
      }
      is_found = true;
    }
    if (!is_found) {
      entry.Fail("(" + Printable(name) + ") " +
                 WhyNoParameter(regions, scene, parameters));
    }
  }
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::isnan(values(i))) {
      const MaterialParameters::Parameter& parameter = parameters.All()[i];
      ThrowInputError(
          path, "there is no value of " +
                    Describe(parameter, RegionsOf(scene, parameter.material)) +
                    "; add it to \"parameters\"");
    }
  }
  RequirePositiveDefinite(path, scene, parameters, values);
  return values;
}

}  // namespace elastimate
