// Estimates, and estimators that are prepared for many measurements.

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/estimators/material_fit/fitted_scene.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/report/html_report.h"
#include "elastimate/io/report/report.h"
#include "elastimate/io/report/scene_results.h"
#include "elastimate/io/report/summary.h"
#include "elastimate/io/text/file_output.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_scene.h"

namespace py = pybind11;

namespace elastimate {
namespace {

using Released = py::call_guard<py::gil_scoped_release>;

/// An estimate with what a report on it needs.
struct PythonEstimate {
  SharedScene modelled;
  EstimatorOptions options;
  Estimate estimate;
  double seconds;
  /// The displacements of a later measurement than that of the scene, for each
  /// load case; empty for that of the scene.
  std::vector<Eigen::MatrixXd> displacements = {};

  ReportTimes Times() const {
    return {modelled->read_seconds, modelled->read_seconds + seconds};
  }
  std::string Summary() const {
    return elastimate::Summary(estimate, Reported(), Times());
  }
  std::string Json() const {
    return JsonReport(estimate, Reported(), options, Times(),
                      modelled->notices);
  }
  void WritePage(const std::string& path, const std::string& title,
                 const std::string& command) const {
    const std::string page = ReadPage();
    Scene scene = Measured();
    const std::optional<Scene> fitted = FittedScene(scene, estimate);
    if (!estimate.large_strain_law.empty()) {
      scene.materials = fitted->materials;
    }
    const SceneResults results =
        ResultsOf(scene, fitted ? *fitted : scene, estimate, options.solver);
    StagedFiles files;
    files.Add(path, HtmlReport(page, scene, estimate, results,
                               {title, command, Json(), ""}));
    files.Commit();
  }

 private:
  Scene Measured() const {
    Scene scene = modelled->scene;
    for (std::size_t k = 0; k < displacements.size(); ++k) {
      LoadCase& load_case = scene.load_cases[k];
      if (load_case.points.points.Size() == 0) {
        load_case.displacement = displacements[k];
      } else {
        load_case.points.displacement = displacements[k];
      }
    }
    return scene;
  }
  Scene Reported() const {
    return FittedScene(modelled->scene, estimate).value_or(modelled->scene);
  }
};

template <class Function>
PythonEstimate Timed(const SharedScene& scene, const EstimatorOptions& options,
                     const Function& run) {
  const auto start = std::chrono::steady_clock::now();
  Estimate estimate = run();
  const std::chrono::duration<double> seconds =
      std::chrono::steady_clock::now() - start;
  return {scene, options, std::move(estimate), seconds.count()};
}

PythonEstimate Run(const std::shared_ptr<PythonScene>& scene,
                   const std::string& estimator,
                   const EstimatorOptions& options) {
  return Timed(scene, options, [&] {
    return MakeEstimator(estimator)->Run(scene->scene, options);
  });
}

/// An estimator for many measurements, which threads of Python may share.
class PythonPrepared {
 public:
  PythonPrepared(const std::shared_ptr<PythonScene>& scene,
                 const std::string& estimator, const EstimatorOptions& options)
      : scene_(scene),
        options_(options),
        prepared_(MakeEstimator(estimator)->Prepare(scene->scene, options)) {}

  PythonEstimate Run(const std::vector<Array<double>>& displacements) {
    std::vector<Eigen::MatrixXd> columns;
    columns.reserve(displacements.size());
    for (const Array<double>& rows : displacements) {
      columns.emplace_back(OfScene(columns.size(), ColumnsOf(rows)));
    }
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    PythonEstimate estimate =
        Timed(scene_, options_, [&] { return prepared_.Run(columns); });
    estimate.displacements = std::move(columns);
    return estimate;
  }

 private:
  /// Returns the displacements of the nodes of the scene, or of its points, in
  /// a load case.
  Eigen::MatrixXd OfScene(std::size_t k, const Eigen::MatrixXd& given) const {
    const std::vector<LoadCase>& load_cases = scene_->scene.load_cases;
    const bool is_at_nodes =
        k < load_cases.size() && load_cases[k].points.points.Size() == 0;
    return is_at_nodes && scene_->given != nullptr
               ? scene_->given->ToScene(given)
               : given;
  }

  SharedScene scene_;
  EstimatorOptions options_;
  PreparedEstimator prepared_;
  std::mutex mutex_;
};

std::vector<std::pair<std::string, std::string>> Estimators() {
  std::vector<std::pair<std::string, std::string>> described;
  for (const std::string_view name : EstimatorNames()) {
    described.emplace_back(name, MakeEstimator(name)->Description());
  }
  return described;
}

void BindFinding(py::module_& module) {
  py::class_<Finding>(module, "Finding", "One thing to say about an estimate.")
      .def_property_readonly(
          "code",
          [](const Finding& self) {
            return std::string(FindingCodeName(self.code));
          },
          "Such as \"smooth_residual\"; docs/findings.md explains each.")
      .def_property_readonly(
          "severity",
          [](const Finding& self) {
            return std::string(SeverityName(self.severity));
          },
          "\"notice\", \"warning\" or \"error\".")
      .def_readonly("text", &Finding::text, "What was found.")
      .def_readonly("advice", &Finding::advice, "What to do.")
      .def("__repr__", [](const Finding& self) {
        return "<Finding " + std::string(FindingCodeName(self.code)) + ": " +
               Sentence(self) + ">";
      });
}

}  // namespace

void BindEstimate(py::module_& module) {
  BindFinding(module);
  py::class_<PythonEstimate>(module, "Estimate")
      .def_property_readonly(
          "estimator",
          [](const PythonEstimate& self) { return self.estimate.estimator; })
      .def_property_readonly(
          "status",
          [](const PythonEstimate& self) {
            return std::string(StatusName(self.estimate.status));
          })
      .def_property_readonly(
          "message",
          [](const PythonEstimate& self) { return self.estimate.message; })
      .def_property_readonly(
          "is_usable",
          [](const PythonEstimate& self) { return self.estimate.IsUsable(); })
      .def_property_readonly(
          "parameters",
          [](const PythonEstimate& self) { return self.estimate.parameters; })
      .def_property_readonly(
          "findings",
          [](const PythonEstimate& self) { return self.estimate.findings; })
      .def_property_readonly("covariance",
                             [](const py::object& self) {
                               return RowsOf(self.cast<const PythonEstimate&>()
                                                 .estimate.parameter_covariance,
                                             self);
                             })
      .def("summary", &PythonEstimate::Summary, Released())
      .def("json", &PythonEstimate::Json, Released())
      .def("write_page", &PythonEstimate::WritePage, py::arg("path"),
           py::arg("title"), py::arg("command"), Released());

  py::class_<PythonPrepared>(module, "Prepared")
      .def(py::init<const std::shared_ptr<PythonScene>&, const std::string&,
                    const EstimatorOptions&>(),
           py::arg("scene"), py::arg("estimator"), py::arg("options"),
           Released())
      .def("run", &PythonPrepared::Run, py::arg("displacements"));

  module.def("run", &Run, py::arg("scene"), py::arg("estimator"),
             py::arg("options"), Released());
  module.def("estimators", &Estimators, Released());
}

}  // namespace elastimate
