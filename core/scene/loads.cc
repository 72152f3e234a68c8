#include "elastimate/core/scene/loads.h"

#include <Eigen/Geometry>

#include "elastimate/core/mesh/tet4.h"

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
  LoadAssembler(const Mesh& mesh, Eigen::Ref<Eigen::Matrix3Xd> force)
      : mesh_(mesh), force_(force) {}

  void operator()(const NodalForces& load) { force_ += load.force; }

  void operator()(const BodyForce& load) {
    for (Eigen::Index element = 0; element < mesh_.NumElements(); ++element) {
      const double volume =
          TetrahedronVolume(GatherTetrahedron(mesh_, element));
      const Eigen::Vector3d total = volume * load.force_density;
      if (mesh_.Order() == 1) {
        Add(mesh_.elements.col(element), total / 4);
      } else {
        Add(mesh_.elements.col(element).head<4>(), -total / 20);
        Add(mesh_.elements.col(element).tail<6>(), total / 5);
      }
    }
  }

  void operator()(const Traction& load) {
    for (Eigen::Index facet = 0; facet < load.facets.cols(); ++facet) {
      const double area =
          DoubleAreaNormal(mesh_, load.facets, facet).norm() / 2;
      AddToFacet(load.facets.col(facet), area * load.traction);
    }
  }

  void operator()(const Pressure& load) {
    for (Eigen::Index facet = 0; facet < load.facets.cols(); ++facet) {
      AddToFacet(
          load.facets.col(facet),
          -load.pressure / 2 * DoubleAreaNormal(mesh_, load.facets, facet));
    }
  }

  void operator()(const SurfaceForce& load) {
    (*this)(Traction{load.facets, load.force / FacetArea(mesh_, load.facets)});
  }

 private:
  void Add(const Eigen::Ref<const Eigen::VectorXi>& nodes,
           const Eigen::Vector3d& share) {
    for (const int node : nodes) {
      force_.col(node) += share;
    }
  }

  // The vertices of a quadratic triangle get nothing.
  void AddToFacet(const Eigen::Ref<const Eigen::VectorXi>& nodes,
                  const Eigen::Vector3d& total) {
    Add(nodes.tail<3>(), total / 3);
  }

  const Mesh& mesh_;
  Eigen::Ref<Eigen::Matrix3Xd> force_;
};

// The resultant of each kind of load.
struct Summation {
  const Mesh& mesh;

  LoadResultant operator()(const NodalForces& load) const {
    return {"nodal_force", load.force.rowwise().sum(), std::nullopt};
  }
  LoadResultant operator()(const BodyForce& load) const {
    double volume = 0;
    for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
      volume += TetrahedronVolume(GatherTetrahedron(mesh, element));
    }
    return {"body_force", volume * load.force_density, std::nullopt};
  }
  LoadResultant operator()(const Traction& load) const {
    const double area = FacetArea(mesh, load.facets);
    return {"traction", area * load.traction, area};
  }
  LoadResultant operator()(const Pressure& load) const {
    Eigen::Vector3d double_area_normal = Eigen::Vector3d::Zero();
    for (Eigen::Index facet = 0; facet < load.facets.cols(); ++facet) {
      double_area_normal += DoubleAreaNormal(mesh, load.facets, facet);
    }
    return {"pressure", -load.pressure / 2 * double_area_normal,
            FacetArea(mesh, load.facets)};
  }
  LoadResultant operator()(const SurfaceForce& load) const {
    return {"force", load.force, FacetArea(mesh, load.facets)};
  }
};

void AddLoads(const Mesh& mesh, const std::vector<Load>& loads,
              Eigen::Ref<Eigen::Matrix3Xd> force) {
  LoadAssembler assembler(mesh, force);
  for (const Load& load : loads) {
    std::visit(assembler, load);
  }
}

}  // namespace

Eigen::Matrix3Xd AssembleLoads(const Mesh& mesh,
                               const std::vector<Load>& loads) {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, mesh.NumNodes());
  AddLoads(mesh, loads, force);
  return force;
}

Eigen::MatrixXd AssembleLoadCases(const Scene& scene) {
  Eigen::MatrixXd force(3 * scene.mesh.NumNodes(), scene.load_cases.size());
  AssembleLoadCases(scene, force);
  return force;
}

void AssembleLoadCases(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> force) {
  force.setZero();
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    AddLoads(scene.mesh, scene.load_cases[i].loads,
             Eigen::Map<Eigen::Matrix3Xd>(force.col(i).data(), 3,
                                          scene.mesh.NumNodes()));
  }
}

double FacetArea(const Mesh& mesh, const Eigen::MatrixXi& facets) {
  double double_area = 0;
  for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
    double_area += DoubleAreaNormal(mesh, facets, facet).norm();
  }
  return double_area / 2;
}

LoadResultant ResultantOf(const Mesh& mesh, const Load& load) {
  return std::visit(Summation{mesh}, load);
}

}  // namespace elastimate
