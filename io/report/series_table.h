#ifndef ELASTIMATE_IO_REPORT_SERIES_TABLE_H_
#define ELASTIMATE_IO_REPORT_SERIES_TABLE_H_

#include <string>
#include <vector>

#include "elastimate/estimators/series/joint_estimate.h"
#include "elastimate/io/scene/frame_series.h"

namespace elastimate {

/// Returns a CSV with a row for each frame and one, "joint", for all of them.
/// A row has the number of the frame from 1 on, its file, load and status, each
/// parameter and its standard error (of several materials with their regions:
/// "youngs_modulus_3"), the shear modulus and its standard error if that of any
/// row is known better than E and nu, the noise, the number of outliers, the
/// codes of findings, separated by spaces, and the reason why a frame is not
/// usable. What is unknown is empty; numbers round-trip.  `frames` has an
/// estimate for each file of `series`.
[[nodiscard]] std::string SeriesTable(const FrameSeries& series,
                                      const std::vector<FrameEstimate>& frames,
                                      const Estimate& joint);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_SERIES_TABLE_H_
