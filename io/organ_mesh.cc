#include "elastimate/io/organ_mesh.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "elastimate/io/gmsh_module.h"

namespace elastimate {
namespace {

constexpr double kDegree = 0.017453292519943295;

/// The edge length that gave `tetrahedra` tetrahedra, by a fit to meshes of
/// 200 to 2 000 000.
double EstimatedEdgeLength(double tetrahedra) {
  double edge_length = 0.1;
  for (int i = 0; i < 20; ++i) {
    edge_length = std::cbrt((0.475 + 1.5 * edge_length) / tetrahedra);
  }
  return edge_length;
}

}  // namespace

Mesh OrganMesh(int tetrahedra) {
  constexpr int kMaxTrials = 30;
  constexpr double kTolerance = 0.05;
  constexpr double kGoodAngle = 15.0 * kDegree;
  // Beyond, another mesh takes too long, and is as likely to have a sliver.
  constexpr int kMaxTetrahedraToRepeat = 100000;
  const GmshModule& module = LoadGmshModule();
  const int max_fitting = tetrahedra <= kMaxTetrahedraToRepeat ? 8 : 1;
  Mesh best;
  double best_angle = -1.0;
  int num_fitting = 0;
  double edge_length = EstimatedEdgeLength(tetrahedra);
  for (int trial = 0; trial < kMaxTrials; ++trial) {
    Mesh mesh;
    module.mesh_organ(edge_length, mesh);
    const double ratio = static_cast<double>(mesh.NumElements()) / tetrahedra;
    if (std::abs(ratio - 1.0) <= kTolerance) {
      const double angle = SmallestDihedralAngles(mesh).minCoeff();
      if (angle > best_angle) {
        best = std::move(mesh);
        best_angle = angle;
      }
      if (best_angle >= kGoodAngle || ++num_fitting == max_fitting) {
        return best;
      }
    }
    // The number goes about as the inverse cube of the edge length.  A small
    // step more, so that no edge length is tried twice.
    edge_length *= 0.999 * std::cbrt(ratio);
  }
  if (num_fitting > 0) {
    return best;
  }
  throw std::runtime_error("No mesh of the organ has " +
                           std::to_string(tetrahedra) +
                           " tetrahedra within 5 %.");
}

}  // namespace elastimate
