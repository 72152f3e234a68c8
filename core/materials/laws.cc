#include "elastimate/core/materials/laws.h"

#include <algorithm>
#include <iterator>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "elastimate/core/large_strain/corotated_law.h"
#include "elastimate/core/large_strain/mooney_rivlin_law.h"
#include "elastimate/core/large_strain/neo_hookean_law.h"
#include "elastimate/core/large_strain/st_venant_kirchhoff_law.h"
#include "elastimate/core/large_strain/yeoh_law.h"
#include "elastimate/core/materials/anisotropic_law.h"
#include "elastimate/core/materials/free_axis_law.h"
#include "elastimate/core/materials/green_strain_law.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/law_check.h"
#include "elastimate/core/materials/orthotropic_law.h"
#include "elastimate/core/materials/transversely_isotropic_law.h"

namespace elastimate {
namespace {

using LawList = std::vector<std::shared_ptr<const Law>>;

// The registry of all laws.  Its mutex admits one thread at a time.
struct LawRegistry {
  std::mutex mutex;
  LawList laws = {
      std::make_shared<IsotropicLaw>(),
      std::make_shared<TransverselyIsotropicLaw>(),
      std::make_shared<FreeAxisLaw>(),
      std::make_shared<OrthotropicLaw>(SectionModel::kSolid),
      std::make_shared<OrthotropicLaw>(SectionModel::kPlaneStress),
      std::make_shared<AnisotropicLaw>(),
      std::make_shared<CorotatedLaw>(),
      std::make_shared<StVenantKirchhoffLaw>(),
      std::make_shared<GreenStrainLaw>(
          std::make_unique<TransverselyIsotropicLaw>()),
      std::make_shared<GreenStrainLaw>(
          std::make_unique<OrthotropicLaw>(SectionModel::kSolid)),
      std::make_shared<GreenStrainLaw>(std::make_unique<AnisotropicLaw>()),
      std::make_shared<NeoHookeanLaw>(),
      std::make_shared<MooneyRivlinLaw>(),
      std::make_shared<YeohLaw>()};
};

LawRegistry& RegistryOfLaws() {
  static LawRegistry registry;
  return registry;
}

// Tells whether a material that names a law could mean either of these.
bool AreAmbiguous(const Law& a, const Law& b) {
  return a.Name() == b.Name() &&
         std::any_of(std::begin(kAllSectionModels), std::end(kAllSectionModels),
                     [&](SectionModel model) {
                       return a.Takes(model) && b.Takes(model);
                     });
}

bool IsTaken(const Law& law, std::optional<SectionModel> model) {
  return !model || law.Takes(*model);
}

}  // namespace

std::vector<const Law*> Laws() {
  LawRegistry& registry = RegistryOfLaws();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  std::vector<const Law*> all;
  all.reserve(registry.laws.size());
  for (const auto& law : registry.laws) {
    all.push_back(law.get());
  }
  return all;
}

void RegisterLaw(std::shared_ptr<const Law> law) {
  if (!law) {
    throw std::invalid_argument(
        "the law to be registered is a null pointer; give one of "
        "std::make_shared");
  }
  const std::vector<std::string> wrong = CheckLaw(*law);
  if (!wrong.empty()) {
    throw std::invalid_argument(
        wrong[0] + (wrong.size() == 1
                        ? ""
                        : " (and " + std::to_string(wrong.size() - 1) +
                              " more; CheckLaw returns all sentences)"));
  }
  LawRegistry& registry = RegistryOfLaws();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  for (const auto& other : registry.laws) {
    if (AreAmbiguous(*law, *other)) {
      throw std::invalid_argument(
          "there is a law '" + std::string(law->Name()) +
          "' already for a section that the new one takes; give the new one "
          "another name");
    }
  }
  registry.laws.push_back(std::move(law));
}

std::string LawNames(std::optional<SectionModel> model) {
  std::vector<std::string_view> names;
  std::string list;
  for (const Law* const law : Laws()) {
    if (IsTaken(*law, model) &&
        std::find(names.begin(), names.end(), law->Name()) == names.end()) {
      list += (names.empty() ? "" : ", ") + std::string(law->Name());
      names.push_back(law->Name());
    }
  }
  return list;
}

std::string WhyOutOfRange(const LawParameter& parameter, double value) {
  if (value >= parameter.lower && value <= parameter.upper) {
    return "";
  }
  if (parameter.beside) {
    return "must be finite";
  }
  if (parameter.is_modulus) {
    return "must be positive and finite";
  }
  std::ostringstream why;
  why << "must be between " << parameter.lower << " and " << parameter.upper;
  return why.str();
}

Eigen::VectorXd ParametersByName(const Law& law,
                                 std::map<std::string, double> values) {
  const std::vector<LawParameter>& wanted = law.Parameters();
  Eigen::VectorXd parameters(wanted.size());
  std::string missing;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string name(wanted[i].name);
    const auto value = values.find(name);
    if (value == values.end()) {
      missing += (missing.empty() ? "" : ", ") + name;
      continue;
    }
    const std::string why = WhyOutOfRange(wanted[i], value->second);
    if (!why.empty()) {
      throw std::invalid_argument(name + " " + why);
    }
    parameters(Eigen::Index(i)) = value->second;
    values.erase(value);
  }
  const std::string law_name(law.Name());
  if (!values.empty()) {
    throw std::invalid_argument(
        law_name + " has no parameter " + values.begin()->first +
        (missing.empty() ? "; leave it out" : "; give " + missing));
  }
  if (!missing.empty()) {
    throw std::invalid_argument(law_name + " needs " + missing + " as well");
  }
  return parameters;
}

const Law* FindLaw(std::string_view name, std::optional<SectionModel> model) {
  for (const Law* const law : Laws()) {
    if (law->Name() == name && IsTaken(*law, model)) {
      return law;
    }
  }
  return nullptr;
}

}  // namespace elastimate
