// The options of an estimator, by the names of the command line.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "elastimate/estimators/interface/estimator.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace elastimate {
namespace {

template <class T>
T Choose(const std::string& option, const std::string& name,
         const std::map<std::string, T>& choices) {
  const auto chosen = choices.find(name);
  if (chosen != choices.end()) {
    return chosen->second;
  }
  std::string names;
  for (const auto& choice : choices) {
    names += (names.empty() ? "" : ", ") + choice.first;
  }
  throw std::invalid_argument(option + "=\"" + name + "\"; it must be one of " +
                              names);
}

// Ends an estimate with KeyboardInterrupt after Ctrl-C, and with what the
// caller's function raises.  Estimators keep copies of what this returns, and
// drop them without the lock of the interpreter.
std::function<void(int)> OnFactorization(
    const std::optional<py::function>& called) {
  std::shared_ptr<py::function> kept;
  if (called) {
    kept = std::shared_ptr<py::function>(new py::function(*called),
                                         [](py::function* function) {
                                           const py::gil_scoped_acquire acquire;
                                           delete function;
                                         });
  }
  return [kept](int count) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
    if (kept) {
      (*kept)(count);
    }
  };
}

EstimatorOptions MakeOptions(
    std::optional<double> nu, std::optional<double> nu_min,
    std::optional<double> nu_max, std::optional<double> youngs_min,
    std::optional<double> youngs_max, const std::string& loss,
    const std::string& refine, const std::string& kinematics,
    std::optional<int> degree, const std::string& solver, int max_iterations,
    const std::optional<py::function>& on_factorization) {
  EstimatorOptions options;
  options.known_poisson_ratio = nu;
  options.poisson_ratio = {nu_min, nu_max};
  options.youngs_modulus = {youngs_min, youngs_max};
  options.loss = Choose<Loss>("loss", loss,
                              {{"none", Loss::kNone},
                               {"huber", Loss::kHuber},
                               {"cauchy", Loss::kCauchy}});
  options.refinement = Choose<Refine>("refine", refine,
                                      {{"auto", Refine::kAutomatic},
                                       {"0", Refine::kNever},
                                       {"1", Refine::kAlways}});
  options.kinematics = Choose<Kinematics>("kinematics", kinematics,
                                          {{"auto", Kinematics::kAutomatic},
                                           {"small", Kinematics::kSmall},
                                           {"large", Kinematics::kLarge}});
  options.virtual_field_degree = degree;
  options.solver = Choose<SolverKind>("solver", solver,
                                      {{"automatic", SolverKind::kAutomatic},
                                       {"cholesky", SolverKind::kCholesky},
                                       {"multigrid", SolverKind::kMultigrid}});
  if (options.solver == SolverKind::kMultigrid && !HasMultigrid()) {
    throw std::invalid_argument("solver=\"multigrid\"; it is not available (" +
                                WhyNoMultigrid() +
                                "), so use solver=\"cholesky\"");
  }
  options.max_iterations = max_iterations;
  options.on_factorization = OnFactorization(on_factorization);
  const std::string why_invalid = options.WhyInvalid();
  if (!why_invalid.empty()) {
    throw std::invalid_argument(why_invalid);
  }
  return options;
}

}  // namespace

void BindOptions(py::module_& module) {
  py::class_<EstimatorOptions>(module, "Options",
                               R"(The options of an estimator, as keywords.

nu              Poisson's ratio of one isotropic material, if it is known [1]
nu_min, nu_max  bounds on Poisson's ratio [1], within [-1, 1/2]
youngs_min, youngs_max
                bounds on Young's modulus [pressure], positive
loss            "none", "huber" or "cauchy": the treatment of outliers
refine          "auto", "0" or "1": how often fits divide the mesh
kinematics      "auto", "small" or "large" strains and rotations
degree          of virtual fields, 1 to 3
solver          "automatic", "cholesky" or "multigrid"
max_iterations  after which an iterative estimator gives up
on_factorization
                called with the number of each factorisation, from 1 on, before
                it begins; what it raises ends the estimate

Raises ValueError, with one sentence, for a value out of its range.)")
      .def(py::init(&MakeOptions), py::kw_only(), py::arg("nu") = py::none(),
           py::arg("nu_min") = py::none(), py::arg("nu_max") = py::none(),
           py::arg("youngs_min") = py::none(),
           py::arg("youngs_max") = py::none(), py::arg("loss") = "none",
           py::arg("refine") = "auto", py::arg("kinematics") = "auto",
           py::arg("degree") = py::none(), py::arg("solver") = "automatic",
           py::arg("max_iterations") = EstimatorOptions().max_iterations,
           py::arg("on_factorization") = py::none());
}

}  // namespace elastimate
