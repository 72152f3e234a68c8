#include "elastimate/io/report/summary_lines.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <string>
#include <vector>

#include "elastimate/core/scene/loads.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

// Adds the loads of one case: each on a line, or all on one where they are
// many.
void AddLoads(const std::string& name, const Mesh& mesh,
              const std::vector<Load>& loads, std::ostringstream& text) {
  constexpr std::size_t kMany = 4;
  std::vector<LoadResultant> resultants;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.Dimension());
  double largest = 0;
  for (const Load& load : loads) {
    resultants.push_back(ResultantOf(mesh, load));
    sum += resultants.back().force;
    largest = std::max(largest, resultants.back().force.cwiseAbs().maxCoeff());
  }
  const double rounding = 1e-12 * largest;
  for (const LoadResultant& resultant : resultants) {
    if (loads.size() <= kMany) {
      AddLine(name,
              std::string(resultant.type) + ", resultant " +
                  VectorText(resultant.force, rounding) +
                  (resultant.area
                       ? " on an area of " + NumberText(*resultant.area, 4)
                       : ""),
              text);
    }
  }
  if (loads.size() > kMany) {
    AddLine(name,
            std::to_string(loads.size()) + " loads, resultant " +
                VectorText(sum, rounding),
            text);
  }
}

}  // namespace

std::string VectorText(const Eigen::VectorXd& values, double rounding) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "(" : ", ") +
            NumberText(std::abs(value) > rounding ? value : 0, 4);
  }
  return text + ")";
}

void AddLine(const std::string& name, const std::string& value,
             std::ostringstream& text) {
  constexpr std::size_t kWidth = 22;
  text << std::left << std::setw(int(kWidth)) << name
       << (name.size() < kWidth ? "" : " ") << value << "\n";
}

void AddMeshLine(const ElementTopology& topology, Eigen::Index num_elements,
                 Eigen::Index num_nodes, const Eigen::MatrixXd& nodes,
                 std::ostringstream& text) {
  AddLine("mesh",
          std::to_string(num_elements) + " " +
              std::string(topology.ShapeName(num_elements)) + " (" +
              std::string(topology.name) + "), " +
              Counted(std::size_t(num_nodes), "node") + ", from " +
              VectorText(nodes.rowwise().minCoeff()) + " to " +
              VectorText(nodes.rowwise().maxCoeff()),
          text);
}

void AddLoadLines(const Scene& scene, std::ostringstream& text) {
  constexpr std::size_t kMany = 8;
  const std::size_t num_cases = scene.load_cases.size();
  const std::size_t num_shown = num_cases > kMany ? kMany - 1 : num_cases;
  for (std::size_t i = 0; i < num_shown; ++i) {
    AddLoads(num_cases == 1 ? "load" : "load case " + std::to_string(i + 1),
             scene.mesh, scene.load_cases[i].loads, text);
  }
  if (num_shown < num_cases) {
    AddLine("load cases",
            "and " + std::to_string(num_cases - num_shown) +
                " more; --json has the loads of all",
            text);
  }
}

}  // namespace elastimate
