#ifndef ELASTIMATE_IO_REPORT_SUMMARY_LINES_H_
#define ELASTIMATE_IO_REPORT_SUMMARY_LINES_H_

#include <Eigen/Core>
#include <sstream>
#include <string>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Adds a line of a table: a name, and a value from a fixed column on.
void AddLine(const std::string& name, const std::string& value,
             std::ostringstream& text);

/// Returns "(0, 0, -5)"; values below `rounding` are shown as zero.
std::string VectorText(const Eigen::VectorXd& values, double rounding = 0);

/// Adds the number and the kind of the elements, the number of nodes, and the
/// bounding box of `nodes`, dimension x n.
void AddMeshLine(const ElementTopology& topology, Eigen::Index num_elements,
                 Eigen::Index num_nodes, const Eigen::MatrixXd& nodes,
                 std::ostringstream& text);

/// Adds the resultants of the loads of each case, and their areas: each on a
/// line, or all on one where they are many.
void AddLoadLines(const Scene& scene, std::ostringstream& text);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_SUMMARY_LINES_H_
