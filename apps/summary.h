#ifndef ELASTIMATE_APPS_SUMMARY_H_
#define ELASTIMATE_APPS_SUMMARY_H_

#include <string>

#include "elastimate/core/scene.h"
#include "elastimate/estimators/estimate.h"

namespace elastimate {

/// A short table for people: the estimate with its standard errors, the
/// status, and what the diagnostics advise.  `scene` is the one that was
/// estimated, of either element order.
std::string Summary(const Estimate& estimate, const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SUMMARY_H_
