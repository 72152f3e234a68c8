#ifndef ELASTIMATE_APPS_OUTLIER_LINES_H_
#define ELASTIMATE_APPS_OUTLIER_LINES_H_

#include <string>
#include <vector>

#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {

/// Returns a sentence for each file with outliers: "points.csv: 3 outliers are
/// on the lines 6, 10, 11" or, where measurements are no lines of text,
/// "mesh.msh: 2 outliers are at the nodes 12, 17 of Gmsh".  Where there are
/// many, it names the first.
std::vector<std::string> OutlierLines(const std::vector<Outlier>& outliers,
                                      const SceneReading& reading);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_OUTLIER_LINES_H_
