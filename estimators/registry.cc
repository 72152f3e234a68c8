#include "elastimate/estimators/registry.h"

#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/estimators/auto.h"
#include "elastimate/estimators/force_balance/bounded.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/material_fit/iterative_fe.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"

namespace elastimate {
namespace {

using Estimators = std::vector<std::shared_ptr<const Estimator>>;

// All estimators, for one thread at a time.
struct EstimatorRegistry {
  std::mutex mutex;
  Estimators estimators = {
      std::make_shared<ClosedForm>(),    std::make_shared<Bounded>(),
      std::make_shared<VirtualFields>(), std::make_shared<ReducedFe>(),
      std::make_shared<IterativeFe>(),   std::make_shared<Auto>()};
};

EstimatorRegistry& RegistryOfEstimators() {
  static EstimatorRegistry registry;
  return registry;
}

Estimators AllEstimators() {
  EstimatorRegistry& registry = RegistryOfEstimators();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  return registry.estimators;
}

std::shared_ptr<const Estimator> FindEstimator(const Estimators& estimators,
                                               std::string_view name) {
  for (const auto& estimator : estimators) {
    if (estimator->Name() == name) {
      return estimator;
    }
  }
  return nullptr;
}

}  // namespace

std::vector<std::string_view> EstimatorNames() {
  std::vector<std::string_view> names;
  for (const auto& estimator : AllEstimators()) {
    names.push_back(estimator->Name());
  }
  return names;
}

std::shared_ptr<const Estimator> MakeEstimator(std::string_view name) {
  std::shared_ptr<const Estimator> estimator =
      FindEstimator(AllEstimators(), name);
  if (estimator) {
    return estimator;
  }
  std::string known;
  for (const std::string_view one : EstimatorNames()) {
    known += (known.empty() ? "" : ", ") + std::string(one);
  }
  throw std::invalid_argument("unknown estimator '" + std::string(name) +
                              "'; the estimators are " + known);
}

void RegisterEstimator(std::shared_ptr<const Estimator> estimator) {
  if (!estimator) {
    throw std::invalid_argument(
        "the estimator to be registered is a null pointer; give one of "
        "std::make_shared");
  }
  if (estimator->Name().empty()) {
    throw std::invalid_argument(
        "the estimator to be registered has no name; return one from Name()");
  }
  EstimatorRegistry& registry = RegistryOfEstimators();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  if (FindEstimator(registry.estimators, estimator->Name())) {
    throw std::invalid_argument("there is an estimator '" +
                                std::string(estimator->Name()) +
                                "' already; give the new one another name");
  }
  registry.estimators.push_back(std::move(estimator));
}

}  // namespace elastimate
