#ifndef ELASTIMATE_IO_REPORT_REPORT_H_
#define ELASTIMATE_IO_REPORT_REPORT_H_

#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The wall-clock seconds around an estimate.
struct ReportTimes {
  double read;   ///< Reading the scene.
  double total;  ///< From the start of the program to the report.
};

/// Returns the report of an estimate as a JSON text, described in
/// docs/report.md.  `scene` is the one that was estimated, of either element
/// order; its nodes are counted without those in the middle of edges.
/// `notices` are what the reader had to say about it.  Numbers round-trip; what
/// the estimator cannot know is null.
std::string JsonReport(const Estimate& estimate, const Scene& scene,
                       const EstimatorOptions& options,
                       const ReportTimes& times,
                       const std::vector<std::string>& notices = {});

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_REPORT_H_
