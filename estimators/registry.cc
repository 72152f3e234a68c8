#include "elastimate/estimators/registry.h"

#include <stdexcept>
#include <string>

#include "elastimate/estimators/auto.h"
#include "elastimate/estimators/force_balance/bounded.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/material_fit/iterative_fe.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"

namespace elastimate {
namespace {

template <typename T>
std::unique_ptr<Estimator> Make() {
  return std::make_unique<T>();
}

constexpr std::unique_ptr<Estimator> (*kEstimators[])() = {
    Make<ClosedForm>, Make<Bounded>,     Make<VirtualFields>,
    Make<ReducedFe>,  Make<IterativeFe>, Make<Auto>,
};

}  // namespace

std::vector<std::string_view> EstimatorNames() {
  std::vector<std::string_view> names;
  for (const auto make : kEstimators) {
    names.push_back(make()->Name());
  }
  return names;
}

std::unique_ptr<Estimator> MakeEstimator(std::string_view name) {
  std::string known;
  for (const auto make : kEstimators) {
    std::unique_ptr<Estimator> estimator = make();
    if (estimator->Name() == name) {
      return estimator;
    }
    known += (known.empty() ? "" : ", ") + std::string(estimator->Name());
  }
  throw std::invalid_argument("unknown estimator '" + std::string(name) +
                              "'; the estimators are " + known);
}

}  // namespace elastimate
