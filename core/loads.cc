#include "elastimate/core/loads.h"

#include <Eigen/Geometry>

#include "elastimate/core/tetrahedron.h"

namespace elastimate {
namespace {

// Twice the area times the normal of a triangle.
Eigen::Vector3d DoubleAreaNormal(const Mesh& mesh,
                                 const Eigen::MatrixXi& facets,
                                 Eigen::Index facet) {
  const Eigen::Vector3d origin = mesh.nodes.col(facets(0, facet));
  const Eigen::Vector3d e1 = mesh.nodes.col(facets(1, facet)) - origin;
  const Eigen::Vector3d e2 = mesh.nodes.col(facets(2, facet)) - origin;
  return e1.cross(e2);
}

// Adds each load's nodal forces; one overload per kind of load.
class LoadAssembler {
 public:
  LoadAssembler(const Mesh& mesh, Eigen::Matrix3Xd& force)
      : mesh_(mesh), force_(force) {}

  void operator()(const NodalForces& load) { force_ += load.force; }

  void operator()(const BodyForce& load) {
    for (Eigen::Index element = 0; element < mesh_.NumElements(); ++element) {
      const double volume =
          TetrahedronVolume(GatherTetrahedron(mesh_, element));
      Distribute(mesh_.elements.col(element), volume * load.force_density);
    }
  }

  void operator()(const Traction& load) {
    for (Eigen::Index facet = 0; facet < load.facets.cols(); ++facet) {
      const double area =
          DoubleAreaNormal(mesh_, load.facets, facet).norm() / 2;
      Distribute(load.facets.col(facet), area * load.traction);
    }
  }

  void operator()(const Pressure& load) {
    for (Eigen::Index facet = 0; facet < load.facets.cols(); ++facet) {
      Distribute(
          load.facets.col(facet),
          -load.pressure / 2 * DoubleAreaNormal(mesh_, load.facets, facet));
    }
  }

 private:
  // Equal parts of `total` on each of `nodes`.
  void Distribute(Eigen::Ref<const Eigen::VectorXi> nodes,
                  const Eigen::Vector3d& total) {
    for (const int node : nodes) {
      force_.col(node) += total / static_cast<double>(nodes.size());
    }
  }

  const Mesh& mesh_;
  Eigen::Matrix3Xd& force_;
};

}  // namespace

Eigen::Matrix3Xd AssembleLoads(const Mesh& mesh,
                               const std::vector<Load>& loads) {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.NumNodes());
  LoadAssembler assembler(mesh, force);
  for (const Load& load : loads) {
    std::visit(assembler, load);
  }
  return force;
}

Eigen::MatrixXd AssembleLoadCases(const Scene& scene) {
  Eigen::MatrixXd force(3 * scene.mesh.NumNodes(), scene.load_cases.size());
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    force.col(i) =
        AssembleLoads(scene.mesh, scene.load_cases[i].loads).reshaped();
  }
  return force;
}

}  // namespace elastimate
