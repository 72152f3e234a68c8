#include <glog/logging.h>

#include "elastimate/core/package/version.h"
#include "elastimate/petsc/start_petsc.h"
#include "python/bindings.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "What the package elastimate calls in the C++ libraries.";
  module.attr("__version__") = std::string(elastimate::Version());
  // The status of an estimate says what Ceres would have warned of.
  FLAGS_minloglevel = google::GLOG_FATAL;
  elastimate::StartPetscWhenNeeded();
  elastimate::BindScene(module);
  elastimate::BindOptions(module);
  elastimate::BindEstimate(module);
  elastimate::BindLaws(module);
}
