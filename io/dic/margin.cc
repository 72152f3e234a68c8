#include "elastimate/io/dic/margin.h"

#include <cmath>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

struct FreeEdges {
  double length = 0;
  double mean_length = 0;
};

FreeEdges FreeEdgesOf(const Scene& scene) {
  const ComponentMask& held = SupportsOf(scene, 0).held;
  const Eigen::MatrixXi edges = BoundaryFacets(scene.mesh);
  FreeEdges free;
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < edges.cols(); ++i) {
    const int a = edges(0, i);
    const int b = edges(1, i);
    if (!(held.col(a).any() && held.col(b).any())) {
      free.length += (scene.mesh.nodes.col(a) - scene.mesh.nodes.col(b)).norm();
      ++count;
    }
  }
  free.mean_length = count == 0 ? 0 : free.length / static_cast<double>(count);
  return free;
}

// Returns the area by the shoelace formula.
double AreaOf(const Mesh& mesh) {
  double twice = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    double of_element = 0;
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      const Eigen::Vector2d a = mesh.nodes.col(mesh.elements(i, e));
      const Eigen::Vector2d b =
          mesh.nodes.col(mesh.elements((i + 1) % mesh.elements.rows(), e));
      of_element += a(0) * b(1) - a(1) * b(0);
    }
    twice += std::abs(of_element);
  }
  return twice / 2;
}

}  // namespace

void AllowForMargin(std::optional<double> margin, Scene& scene,
                    std::vector<std::string>& notices) {
  const FreeEdges free = FreeEdgesOf(scene);
  const double share_of_length = free.length / AreaOf(scene.mesh);
  if (!margin) {
    scene.mesh.section.thickness_relative_sd =
        free.mean_length / 2 * share_of_length;
  } else if (*margin > 0) {
    scene.mesh.section.thickness *= 1 + *margin * share_of_length;
    notices.push_back("the margin of " + NumberText(*margin) + " adds " +
                      Percent(*margin * share_of_length) +
                      " to the cross section, as if the specimen were so much "
                      "thicker");
  }
}

}  // namespace elastimate
