#include "tests/regions.h"

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/loads.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate::testing {

Scene TwoRegionScene(const KindOfSection& parameter, int cells) {
  Scene scene = SceneOfKind(parameter, cells);
  Mesh& mesh = scene.mesh;
  const double middle =
      (mesh.nodes.row(0).minCoeff() + mesh.nodes.row(0).maxCoeff()) / 2;
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const double x = mesh.nodes(0, mesh.elements.col(e)).mean();
    mesh.regions(e) = x < middle ? 7 : 3;
  }
  scene.materials = IsotropicMaterialOfEachRegion(mesh);
  return scene;
}

void DivideIntoRegions(const Eigen::Vector3i& boxes,
                       const Eigen::Vector3d& size, Scene& scene) {
  Mesh& mesh = scene.mesh;
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const Eigen::Vector3d centre =
        mesh.nodes(Eigen::all, mesh.elements.col(e)).rowwise().mean();
    const Eigen::Array3i box =
        (boxes.cast<double>().cwiseProduct(centre).cwiseQuotient(size))
            .cast<int>()
            .cwiseMin(boxes - Eigen::Vector3i::Ones())
            .cwiseMax(0);
    mesh.regions(e) = 1 + box(0) + boxes(0) * (box(1) + boxes(1) * box(2));
  }
  scene.materials = IsotropicMaterialOfEachRegion(mesh);
}

Scene BlockUnderTraction(const Eigen::Vector3i& cells,
                         const Eigen::Vector3d& size) {
  const Mesh mesh = BoxMesh(cells, size);
  Scene scene = HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  std::vector<Eigen::Index> top;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    if (mesh.nodes(2, facets.col(i)).minCoeff() > 0.999 * size(2)) {
      top.push_back(i);
    }
  }
  scene.load_cases[0].loads = {
      Traction{facets(Eigen::all, top), Eigen::Vector3d(40, 20, -100)}};
  return scene;
}

Eigen::MatrixXd TextbookStiffness(
    const Scene& scene, const std::vector<IsotropicElasticity>& elasticities) {
  Eigen::MatrixXd stiffness =
      Eigen::MatrixXd::Zero(scene.mesh.NumDofs(), scene.mesh.NumDofs());
  for (std::size_t i = 0; i < elasticities.size(); ++i) {
    std::vector<Eigen::Index> elements;
    for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
      if (scene.mesh.regions(e) == scene.materials[i].regions[0]) {
        elements.push_back(e);
      }
    }
    Mesh part = scene.mesh;
    part.elements = scene.mesh.elements(Eigen::all, elements);
    stiffness += TextbookStiffness(
        part, HookeMatrixOf(elasticities[i], part.section.model));
  }
  return stiffness;
}

Eigen::MatrixXd SolveByTextbook(
    const Scene& scene, const std::vector<IsotropicElasticity>& elasticities) {
  const Eigen::MatrixXd stiffness = TextbookStiffness(scene, elasticities);
  std::vector<Eigen::Index> free;
  Eigen::VectorXd given = Eigen::VectorXd::Zero(scene.mesh.NumDofs());
  for (Eigen::Index dof = 0; dof < scene.mesh.NumDofs(); ++dof) {
    if (scene.supports.held.data()[dof]) {
      given(dof) = scene.supports.displacement.data()[dof];
    } else {
      free.push_back(dof);
    }
  }
  Eigen::MatrixXd u = given.replicate(1, Eigen::Index(scene.load_cases.size()));
  const Eigen::MatrixXd force = AssembleLoadCases(scene) - stiffness * u;
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    u.col(k)(free) = SolveDensely(stiffness(free, free), force.col(k)(free));
  }
  return u;
}

void MeasureByTextbook(const std::vector<IsotropicElasticity>& elasticities,
                       Scene& scene) {
  const Eigen::MatrixXd u = SolveByTextbook(scene, elasticities);
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    scene.load_cases[k].displacement =
        u.col(k).reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
    scene.origin = Origin::kComputed;
  }
}

}  // namespace elastimate::testing
