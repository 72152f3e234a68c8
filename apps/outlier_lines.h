#ifndef ELASTIMATE_APPS_OUTLIER_LINES_H_
#define ELASTIMATE_APPS_OUTLIER_LINES_H_

#include <string>
#include <vector>

#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/io/text/file_lines.h"

namespace elastimate {

/// Returns a sentence for each file with outliers, as far as measurements are
/// lines of text (SceneReading): "points.csv: 3 outliers are on the lines 6,
/// 10, 11".  Where there are many, it names the first.
std::vector<std::string> OutlierLines(
    const std::vector<Outlier>& outliers,
    const std::vector<std::vector<FileLines>>& measured_lines);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_OUTLIER_LINES_H_
