// Laws: a list of them, and laws that are written in Python.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "elastimate/core/large_strain/homogeneous_deformation.h"
#include "elastimate/core/materials/law_check.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/scene/section.h"
#include "python/bindings.h"
#include "python/python_law.h"

namespace py = pybind11;

namespace elastimate {
namespace {

using NamesAndLimits =
    std::tuple<std::string, std::string, bool, double, double, double>;

std::shared_ptr<PythonLaw> MakeLaw(
    const py::object& object, const std::string& name,
    const std::string& description,
    const std::vector<NamesAndLimits>& parameters, int num_moduli,
    const std::vector<std::string>& sections) {
  std::vector<PythonLawParameter> made;
  made.reserve(parameters.size());
  for (const auto& [of_law, symbol, is_modulus, lower, upper, typical] :
       parameters) {
    made.push_back({of_law, symbol, is_modulus, lower, upper, typical});
  }
  std::vector<SectionModel> models;
  for (const std::string& section : sections) {
    const std::optional<SectionModel> model = SectionModelOfName(section);
    if (!model) {
      throw std::invalid_argument("the law " + name + " takes the section \"" +
                                  section + "\"; it must be " + kSectionModels);
    }
    models.push_back(*model);
  }
  return std::make_shared<PythonLaw>(object, name, description, std::move(made),
                                     num_moduli, std::move(models));
}

std::vector<std::tuple<std::string, std::string, std::vector<std::string>>>
DescribedLaws() {
  std::vector<std::tuple<std::string, std::string, std::vector<std::string>>>
      described;
  for (const Law* const law : Laws()) {
    std::vector<std::string> parameters;
    for (const LawParameter& parameter : law->Parameters()) {
      parameters.emplace_back(parameter.name);
    }
    described.emplace_back(law->Name(), law->Description(), parameters);
  }
  return described;
}

// Returns the stress of each mode at each stretch, NaN where there is none.
std::map<std::string, std::vector<double>> CurvesOf(
    const std::string& name, const std::map<std::string, double>& parameters,
    const std::vector<double>& stretches) {
  const Law* const law = FindLaw(name, SectionModel::kSolid);
  if (law == nullptr) {
    throw std::invalid_argument("law is \"" + name +
                                "\"; it must be one of three dimensions: " +
                                LawNames(SectionModel::kSolid));
  }
  for (const double stretch : stretches) {
    if (!(stretch > 0 && std::isfinite(stretch))) {
      throw std::invalid_argument("a stretch is " + NumberText(stretch) +
                                  "; it must be positive and finite");
    }
  }
  const Eigen::VectorXd moduli =
      law->Moduli(ParametersByName(*law, parameters), SectionModel::kSolid);
  std::map<std::string, std::vector<double>> curves;
  for (const DeformationMode mode : kAllDeformationModes) {
    std::vector<double>& stresses =
        curves[std::string(DeformationModeName(mode))];
    for (const auto& state :
         DeformHomogeneously(*law, moduli, mode, stretches)) {
      stresses.push_back(state ? state->stress
                               : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return curves;
}

}  // namespace

void BindLaws(py::module_& module) {
  // The libraries lock their list of laws while they call a law, which takes
  // the lock of the interpreter; so no caller may hold that.
  using Released = py::call_guard<py::gil_scoped_release>;
  py::class_<PythonLaw, std::shared_ptr<PythonLaw>>(module, "PythonLaw")
      .def(py::init(&MakeLaw), py::arg("law"), py::arg("name"),
           py::arg("description"), py::arg("parameters"), py::arg("num_moduli"),
           py::arg("sections"));
  module.def("laws", &DescribedLaws, Released());
  module.def("law_curves", &CurvesOf, py::arg("law"), py::arg("parameters"),
             py::arg("stretches"), Released());
  module.def(
      "check_law",
      [](const std::shared_ptr<PythonLaw>& law) { return CheckLaw(*law); },
      py::arg("law"), Released());
  module.def(
      "register_law",
      [](const std::shared_ptr<PythonLaw>& law) { RegisterLaw(law); },
      py::arg("law"), Released());
}

}  // namespace elastimate
