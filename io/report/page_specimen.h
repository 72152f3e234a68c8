#ifndef ELASTIMATE_IO_REPORT_PAGE_SPECIMEN_H_
#define ELASTIMATE_IO_REPORT_PAGE_SPECIMEN_H_

#include <nlohmann/json.hpp>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/io/report/scene_results.h"

namespace elastimate {

/// Returns what the page of a report draws of a scene (HtmlReport).  Arrays are
/// base64 of little-endian floats (`held`: bytes, `facets`: 32-bit integers),
/// and all vectors have three components.  O(num_elements + num_points).
[[nodiscard]] nlohmann::ordered_json PageSpecimen(const Scene& scene,
                                                  const Estimate& estimate,
                                                  const SceneResults& results);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_PAGE_SPECIMEN_H_
