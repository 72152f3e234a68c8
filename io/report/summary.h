#ifndef ELASTIMATE_IO_REPORT_SUMMARY_H_
#define ELASTIMATE_IO_REPORT_SUMMARY_H_

#include <string>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/io/report/report.h"

namespace elastimate {

/// A short table for people: the estimate with its standard errors, the
/// status, what the diagnostics advise, and the times.  `scene` is the one that
/// was estimated, of either element order.
std::string Summary(const Estimate& estimate, const Scene& scene,
                    const ReportTimes& times);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_SUMMARY_H_
