#include "python/python_law.h"

#include <pybind11/eigen.h>

#include <algorithm>
#include <utility>

namespace py = pybind11;

namespace elastimate {
namespace {

template <class Result, class... Arguments>
Result Call(const py::handle& object, const char* method, SectionModel model,
            const Arguments&... arguments) {
  const py::gil_scoped_acquire acquire;
  return object.attr(method)(arguments..., std::string(SectionModelName(model)))
      .template cast<Result>();
}

}  // namespace

PythonLaw::PythonLaw(const py::object& object, std::string name,
                     std::string description,
                     std::vector<PythonLawParameter> parameters, int num_moduli,
                     std::vector<SectionModel> sections)
    : object_(object),
      name_(std::move(name)),
      description_(std::move(description)),
      names_(std::move(parameters)),
      num_moduli_(num_moduli),
      sections_(std::move(sections)) {
  object_.inc_ref();
  for (const PythonLawParameter& parameter : names_) {
    parameters_.push_back({parameter.name, parameter.symbol,
                           parameter.is_modulus, parameter.lower,
                           parameter.upper, parameter.typical});
  }
}

bool PythonLaw::Takes(SectionModel model) const {
  return std::find(sections_.begin(), sections_.end(), model) !=
         sections_.end();
}

Eigen::VectorXd PythonLaw::Energies(const Eigen::MatrixXd& gradient,
                                    SectionModel model) const {
  return Call<Eigen::VectorXd>(object_, "energies", model, gradient);
}

Eigen::MatrixXd PythonLaw::Stresses(const Eigen::MatrixXd& gradient,
                                    SectionModel model) const {
  return Call<Eigen::MatrixXd>(object_, "_stress_columns", model, gradient);
}

Eigen::MatrixXd PythonLaw::Tangent(const Eigen::VectorXd& moduli,
                                   const Eigen::MatrixXd& gradient,
                                   SectionModel model) const {
  return Call<Eigen::MatrixXd>(object_, "_tangent_columns", model, moduli,
                               gradient);
}

Eigen::VectorXd PythonLaw::Moduli(const Eigen::VectorXd& parameters,
                                  SectionModel model) const {
  return Call<Eigen::VectorXd>(object_, "moduli", model, parameters);
}

Eigen::MatrixXd PythonLaw::ModuliJacobian(const Eigen::VectorXd& parameters,
                                          SectionModel model) const {
  return Call<Eigen::MatrixXd>(object_, "moduli_jacobian", model, parameters);
}

Eigen::VectorXd PythonLaw::ParametersOf(const Eigen::VectorXd& moduli,
                                        SectionModel model) const {
  return Call<Eigen::VectorXd>(object_, "parameters_of", model, moduli);
}

}  // namespace elastimate
