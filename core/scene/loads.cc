#include "elastimate/core/scene/loads.h"

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

// Returns the column that all share, or column i where each has its own.
auto ColumnOf(const Eigen::MatrixXd& density, Eigen::Index i) {
  return density.col(density.cols() == 1 ? 0 : i);
}

// Adds each load's nodal forces; one overload per kind of load.
class LoadAssembler {
 public:
  /// `force` is dimension x num_nodes.
  LoadAssembler(const Mesh& mesh, Eigen::Ref<Eigen::MatrixXd> force)
      : mesh_(mesh), force_(force) {}

  void operator()(const NodalForces& load) { force_ += load.force; }

  void operator()(const BodyForce& load) {
    VisitElementKind(mesh_.kind, [&](auto kind) {
      for (Eigen::Index element = 0; element < mesh_.NumElements(); ++element) {
        VisitPoints<kind>(mesh_, element, StiffnessRule<kind>(),
                          [&](const auto& point, const auto& at) {
                            for (Eigen::Index i = 0; i < at.value.size(); ++i) {
                              force_.col(mesh_.elements(i, element)) +=
                                  point.volume * at.value(i) *
                                  ColumnOf(load.force_density, element);
                            }
                          });
      }
    });
  }

  void operator()(const Traction& load) {
    for (Eigen::Index j = 0; j < load.facets.cols(); ++j) {
      const auto facet = load.facets.col(j);
      const Eigen::VectorXd area = WeightsOfFacet(mesh_, facet).area;
      for (Eigen::Index i = 0; i < facet.size(); ++i) {
        force_.col(facet(i)) += area(i) * ColumnOf(load.traction, j);
      }
    }
  }

  void operator()(const Pressure& load) {
    for (const auto& facet : load.facets.colwise()) {
      const Eigen::MatrixXd area = WeightsOfFacet(mesh_, facet).area_vector;
      for (Eigen::Index i = 0; i < facet.size(); ++i) {
        force_.col(facet(i)) -= load.pressure * area.col(i);
      }
    }
  }

  void operator()(const SurfaceForce& load) {
    (*this)(Traction{load.facets, load.force / FacetArea(mesh_, load.facets)});
  }

 private:
  const Mesh& mesh_;
  Eigen::Ref<Eigen::MatrixXd> force_;
};

// Sums up each kind of load.
struct Summation {
  const Mesh& mesh;

  LoadResultant operator()(const NodalForces& load) const {
    return {"nodal_force", load.force.rowwise().sum(), std::nullopt};
  }
  LoadResultant operator()(const BodyForce& load) const {
    const Eigen::VectorXd volumes = ElementVolumes(mesh);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(mesh.Dimension());
    for (Eigen::Index i = 0; i < volumes.size(); ++i) {
      force += volumes(i) * ColumnOf(load.force_density, i);
    }
    return {"body_force", force, std::nullopt};
  }
  LoadResultant operator()(const Traction& load) const {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(mesh.Dimension());
    for (Eigen::Index i = 0; i < load.facets.cols(); ++i) {
      force += FacetArea(mesh, load.facets.col(i)) * ColumnOf(load.traction, i);
    }
    return {"traction", force, FacetArea(mesh, load.facets)};
  }
  LoadResultant operator()(const Pressure& load) const {
    Eigen::VectorXd area_vector = Eigen::VectorXd::Zero(mesh.Dimension());
    for (const auto& facet : load.facets.colwise()) {
      area_vector += WeightsOfFacet(mesh, facet).area_vector.rowwise().sum();
    }
    return {"pressure", -load.pressure * area_vector,
            FacetArea(mesh, load.facets)};
  }
  LoadResultant operator()(const SurfaceForce& load) const {
    return {"force", load.force, FacetArea(mesh, load.facets)};
  }
};

struct Scaling {
  double factor;

  Load operator()(NodalForces load) const {
    load.force *= factor;
    return load;
  }
  Load operator()(BodyForce load) const {
    load.force_density *= factor;
    return load;
  }
  Load operator()(Traction load) const {
    load.traction *= factor;
    return load;
  }
  Load operator()(Pressure load) const {
    load.pressure *= factor;
    return load;
  }
  Load operator()(SurfaceForce load) const {
    load.force *= factor;
    return load;
  }
};

void AddLoads(const Mesh& mesh, const std::vector<Load>& loads,
              Eigen::Ref<Eigen::MatrixXd> force) {
  if (loads.size() == 1) {
    std::visit(LoadAssembler(mesh, force), loads[0]);
    return;
  }
  // Where loads cancel, only rounding is left, which must not count as a load.
  constexpr double kRounding = 1e-13;
  Eigen::ArrayXXd sizes = Eigen::ArrayXXd::Zero(force.rows(), force.cols());
  Eigen::MatrixXd own(force.rows(), force.cols());
  for (const Load& load : loads) {
    own.setZero();
    std::visit(LoadAssembler(mesh, own), load);
    force += own;
    sizes += own.array().abs();
  }
  force = (force.array().abs() > kRounding * sizes)
              .select(force.array(), 0.0)
              .matrix()
              .eval();
}

}  // namespace

Eigen::MatrixXd AssembleLoads(const Mesh& mesh,
                              const std::vector<Load>& loads) {
  Eigen::MatrixXd force =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.NumNodes());
  AddLoads(mesh, loads, force);
  return force;
}

Eigen::MatrixXd AssembleLoadCases(const Scene& scene) {
  Eigen::MatrixXd force(scene.mesh.NumDofs(), scene.load_cases.size());
  AssembleLoadCases(scene, force);
  return force;
}

void AssembleLoadCases(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> force) {
  force.setZero();
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    AddLoads(
        scene.mesh, scene.load_cases[i].loads,
        Eigen::Map<Eigen::MatrixXd>(force.col(i).data(), scene.mesh.Dimension(),
                                    scene.mesh.NumNodes()));
  }
}

bool Follows(const Load& load) {
  const Pressure* const pressure = std::get_if<Pressure>(&load);
  return pressure != nullptr && pressure->follows;
}

Load Scaled(const Load& load, double factor) {
  return std::visit(Scaling{factor}, load);
}

LoadResultant ResultantOf(const Mesh& mesh, const Load& load) {
  return std::visit(Summation{mesh}, load);
}

}  // namespace elastimate
