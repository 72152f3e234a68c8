#include "elastimate/core/materials/material.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/material_frames.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/materials/stiffness_factors.h"

namespace elastimate {
namespace {

std::string NameOf(std::size_t material) {
  return "material " + std::to_string(material + 1);
}

const LawParameter& FindParameter(const Law& law, const std::string& name,
                                  const std::string& material) {
  std::string all;
  for (const LawParameter& candidate : law.Parameters()) {
    if (candidate.name == name) {
      return candidate;
    }
    all += (all.empty() ? "" : ", ") + std::string(candidate.name);
  }
  throw std::invalid_argument(material + " gives \"" + name +
                              "\", but the law " + std::string(law.Name()) +
                              " has " + all + " only; correct the name");
}

void RequireInRange(const LawParameter& parameter, double value,
                    const std::string& what) {
  const std::string why = WhyOutOfRange(parameter, value);
  if (!why.empty()) {
    std::ostringstream text;
    text << what << parameter.name << " = " << value << "; it " << why;
    throw std::invalid_argument(text.str());
  }
}

void ValidateWhatIsGiven(const Law& law, const Material& material,
                         const std::string& name) {
  std::set<std::string> names;
  const auto require_once = [&](const std::string& parameter) {
    if (!names.insert(parameter).second) {
      throw std::invalid_argument(
          name + " gives " + parameter +
          " twice; give it once, as known or by bounds");
    }
  };
  for (const KnownParameter& known : material.known) {
    const LawParameter& parameter = FindParameter(law, known.name, name);
    require_once(known.name);
    RequireInRange(parameter, known.value, name + " gives ");
  }
  for (const BoundsOfParameter& bounded : material.bounds) {
    const LawParameter& parameter = FindParameter(law, bounded.name, name);
    if (parameter.beside) {
      throw std::invalid_argument(
          name + " gives bounds of " + bounded.name +
          ", whose range follows from the other parameters; leave the bounds "
          "out, or give its value");
    }
    require_once(bounded.name);
    const auto& [lower, upper] = bounded.bounds;
    for (const std::optional<double>& bound : {lower, upper}) {
      if (bound) {
        RequireInRange(parameter, *bound, name + " gives the bound ");
      }
    }
    if (lower && upper && !(*lower < *upper)) {
      throw std::invalid_argument(name + " gives crossed bounds on " +
                                  bounded.name +
                                  "; the first must be the smaller one");
    }
  }
}

void ValidatePriors(const Law& law, const Material& material,
                    const std::string& name) {
  std::set<std::string> names;
  for (const KnownParameter& known : material.known) {
    names.insert(known.name);
  }
  for (const Prior& prior : material.priors) {
    const LawParameter& parameter = FindParameter(law, prior.name, name);
    if (!names.insert(prior.name).second) {
      throw std::invalid_argument(name + " gives " + prior.name +
                                  " twice; give it once, as known or by a "
                                  "prior");
    }
    RequireInRange(parameter, prior.value, name + " gives the prior ");
    for (const BoundsOfParameter& bounded : material.bounds) {
      const auto& [lower, upper] = bounded.bounds;
      if (bounded.name == prior.name &&
          !(prior.value >= lower.value_or(prior.value) &&
            prior.value <= upper.value_or(prior.value))) {
        throw std::invalid_argument(name + " gives a prior of " + prior.name +
                                    " beyond its bounds; correct one of them");
      }
    }
    if (!(prior.sd > 0 && std::isfinite(prior.sd))) {
      throw std::invalid_argument(
          name + " gives the prior of " + prior.name +
          " a standard deviation that is not positive and finite; correct it");
    }
  }
}

// Tells whether the values of a material are all known and give a stiffness
// that is not positive definite.  Shear moduli need not be known, as any
// positive ones will do.
bool IsKnownNotPositiveDefinite(const MaterialParameters& parameters) {
  const auto can_be_any = [](const MaterialParameters::Parameter& parameter) {
    return !parameter.known &&
           parameter.law_parameter->name.rfind("shear_modulus", 0) != 0;
  };
  return std::none_of(parameters.All().begin(), parameters.All().end(),
                      can_be_any) &&
         !IsStiffnessPositiveDefinite(
             parameters.LawOf(0), parameters.Typical(1), parameters.Model());
}

// Returns the value of the parameter of this name, if it is known.
std::optional<double> KnownValue(const MaterialParameters& parameters,
                                 std::string_view name) {
  for (const MaterialParameters::Parameter& parameter : parameters.All()) {
    if (parameter.law_parameter->name == name) {
      return parameter.known;
    }
  }
  return std::nullopt;
}

// Tells whether known values contradict every material, whatever the others
// are: c_ij^2 >= c_ii c_jj for stiffnesses, or nu_ij^2 >= E_i / E_j for ratios.
bool IsTooLarge(const LawParameter& parameter,
                const MaterialParameters& parameters) {
  constexpr std::string_view kRatio = "poisson_ratio_";
  const std::optional<double> value = KnownValue(parameters, parameter.name);
  std::optional<double> first;
  std::optional<double> second;
  if (parameter.beside) {
    first = parameters.All()[std::size_t((*parameter.beside)[0])].known;
    second = parameters.All()[std::size_t((*parameter.beside)[1])].known;
  } else if (parameter.name.rfind(kRatio, 0) == 0) {
    const std::string_view directions = parameter.name.substr(kRatio.size());
    const std::string modulus = "youngs_modulus_";
    first = KnownValue(parameters, modulus + directions.front());
    second = KnownValue(parameters, modulus + directions.back());
  }
  return value && first && second &&
         *value * *value >=
             (parameter.beside ? *first * *second : *first / *second);
}

// Throws where no values of the other parameters make what is known a material.
// It finds contradictions between two directions, and any contradiction where
// all but shear moduli are known.
void RequirePositiveDefinite(const Material& material, SectionModel model,
                             const std::string& name) {
  const MaterialParameters parameters({material}, model);
  for (const LawParameter& parameter : parameters.LawOf(0).Parameters()) {
    if (IsTooLarge(parameter, parameters)) {
      throw std::invalid_argument(
          name + " gives " + std::string(parameter.name) +
          " a value too far from zero for a positive definite stiffness with "
          "the other known parameters; correct them");
    }
  }
  if (IsKnownNotPositiveDefinite(parameters)) {
    throw std::invalid_argument(
        name +
        " gives known parameters with which the stiffness is not positive "
        "definite; correct them");
  }
}

// Returns the material of each region id.
std::map<int, int> MaterialOfRegions(const std::vector<Material>& materials) {
  std::map<int, int> material_of;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    for (const int region : materials[i].regions) {
      if (!material_of.emplace(region, static_cast<int>(i)).second) {
        throw std::invalid_argument("region " + std::to_string(region) +
                                    " is given to " +
                                    NameOf(material_of[region]) + " and to " +
                                    NameOf(i) + "; give it to one of them");
      }
    }
  }
  return material_of;
}

// Returns "1, 2, 5"; only the first ids where there are many.
std::string ListOf(const std::set<int>& ids) {
  constexpr std::size_t kMost = 20;
  std::string list;
  std::size_t count = 0;
  for (const int id : ids) {
    if (++count > kMost) {
      return list + ", ...";
    }
    list += (list.empty() ? "" : ", ") + std::to_string(id);
  }
  return list;
}

void ValidateRegions(const std::vector<Material>& materials, const Mesh& mesh) {
  if (materials.size() == 1 && materials[0].regions.empty()) {
    return;
  }
  const std::map<int, int> material_of = MaterialOfRegions(materials);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (materials[i].regions.empty()) {
      throw std::invalid_argument(NameOf(i) +
                                  " names no region, but there are several "
                                  "materials; give the regions of each");
    }
  }
  if (mesh.regions.size() == 0) {
    throw std::invalid_argument(
        "materials name regions, but the mesh has none; give it an id for each "
        "element");
  }
  const std::set<int> ids(mesh.regions.begin(), mesh.regions.end());
  for (const auto& [region, material] : material_of) {
    if (ids.count(region) == 0) {
      throw std::invalid_argument(NameOf(material) + " names region " +
                                  std::to_string(region) +
                                  ", of which the mesh has no element; its "
                                  "regions are " +
                                  ListOf(ids) + "; correct the region");
    }
  }
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    if (material_of.count(mesh.regions(e)) == 0) {
      throw std::invalid_argument(
          "element " + std::to_string(e) + " is in region " +
          std::to_string(mesh.regions(e)) +
          ", which no material names; give that region a material");
    }
  }
}

void ValidateAxes(const std::vector<Material>& materials, const Mesh& mesh) {
  std::vector<std::vector<Eigen::Index>> elements(materials.size());
  const std::vector<int> material_of = MaterialOfElements(materials, mesh);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    elements[material_of[e]].push_back(e);
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Law& law = *FindLaw(materials[i].law, mesh.section.model);
    if (law.NumAxes() == 0 && !materials[i].axes.empty()) {
      throw std::invalid_argument(
          NameOf(i) + " has an axis, but the law " + materials[i].law +
          (law.NumModuli() == 2 ? " is alike in all directions"
                                : " finds its axis") +
          "; leave it out");
    }
    if (law.HasAxesOfScene() && materials[i].axes.empty()) {
      continue;
    }
    const std::string why =
        WhyNotTheseAxes(materials[i].axes, law.NumAxes(), mesh.Dimension(),
                        mesh.NumElements(), elements[i]);
    if (!why.empty()) {
      throw std::invalid_argument(NameOf(i) + " (" + materials[i].law + ") " +
                                  why);
    }
  }
}

void ValidateFields(const Law& law, const Material& material,
                    const std::string& name) {
  for (const std::string& field : material.fields) {
    if (FindParameter(law, field, name).name != "youngs_modulus" ||
        law.Name() != IsotropicLaw::kName || material.fields.size() > 1) {
      throw std::invalid_argument(
          name + " has " + field +
          " as a field, but only youngs_modulus of the "
          "law isotropic may differ "
          "between elements; give that law, or leave out "
          "\"fields\" and --map");
    }
  }
}

}  // namespace

bool Material::operator==(const Material& other) const {
  return law == other.law && regions == other.regions && known == other.known &&
         bounds == other.bounds && priors == other.priors &&
         fields == other.fields &&
         std::equal(
             axes.begin(), axes.end(), other.axes.begin(), other.axes.end(),
             [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
               return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
             });
}

void ValidateMaterials(const std::vector<Material>& materials,
                       const Mesh& mesh) {
  if (materials.empty()) {
    return;
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (FindLaw(materials[i].law) == nullptr) {
      throw std::invalid_argument(
          NameOf(i) + " has the law \"" + materials[i].law +
          "\", which does not exist; the laws are " + LawNames());
    }
    const SectionModel model = mesh.section.model;
    const Law* const law = FindLaw(materials[i].law, model);
    if (law == nullptr) {
      throw std::invalid_argument(NameOf(i) + " has the law " +
                                  materials[i].law +
                                  ", which does not exist for the model " +
                                  std::string(SectionModelName(model)) +
                                  "; its laws are " + LawNames(model));
    }
    ValidateWhatIsGiven(*law, materials[i], NameOf(i));
    ValidatePriors(*law, materials[i], NameOf(i));
    ValidateFields(*law, materials[i], NameOf(i));
    RequirePositiveDefinite(materials[i], model, NameOf(i));
  }
  ValidateRegions(materials, mesh);
  ValidateAxes(materials, mesh);
}

bool HasFields(const std::vector<Material>& materials) {
  return std::any_of(
      materials.begin(), materials.end(),
      [](const Material& material) { return !material.fields.empty(); });
}

void GiveField(const std::string& parameter, std::vector<Material>& materials) {
  if (materials.empty()) {
    materials.emplace_back();
  }
  materials[0].fields = {parameter};
}

bool HasPriors(const std::vector<Material>& materials) {
  return std::any_of(
      materials.begin(), materials.end(),
      [](const Material& material) { return !material.priors.empty(); });
}

bool IsOneIsotropicMaterial(const std::vector<Material>& materials) {
  return materials.empty() ||
         (materials.size() == 1 && materials[0].law == IsotropicLaw::kName &&
          materials[0].known.empty() && materials[0].bounds.empty());
}

std::vector<Material> IsotropicMaterialOfEachRegion(const Mesh& mesh) {
  std::vector<Material> materials;
  for (const int region :
       std::set<int>(mesh.regions.begin(), mesh.regions.end())) {
    materials.push_back({std::string(IsotropicLaw::kName), {region}, {}, {}});
  }
  return materials;
}

std::vector<int> MaterialOfElements(const std::vector<Material>& materials,
                                    const Mesh& mesh) {
  std::vector<int> of_elements(mesh.NumElements(), 0);
  if (materials.size() > 1) {
    const std::map<int, int> material_of = MaterialOfRegions(materials);
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      of_elements[e] = material_of.at(mesh.regions(e));
    }
  }
  return of_elements;
}

}  // namespace elastimate
