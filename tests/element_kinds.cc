#include "tests/element_kinds.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/dense_reference.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"

namespace elastimate::testing {
namespace {

// Returns a grid of hexahedra that fills the unit cube.
Mesh HexahedronGrid(int cells) {
  Mesh mesh;
  mesh.kind = ElementKind::kHex8;
  const int n = cells + 1;
  mesh.nodes.resize(3, n * n * n);
  for (int i = 0; i < mesh.nodes.cols(); ++i) {
    mesh.nodes.col(i) =
        Eigen::Vector3d(i % n, i / n % n, i / (n * n)) / double(cells);
  }
  mesh.elements.resize(8, cells * cells * cells);
  for (int e = 0; e < mesh.elements.cols(); ++e) {
    const int first =
        e % cells + n * (e / cells % cells) + n * n * (e / (cells * cells));
    const int up = n * n;
    mesh.elements.col(e) << first, first + 1, first + n + 1, first + n,
        first + up, first + up + 1, first + up + n + 1, first + up + n;
    if (e % 2 == 1) {
      const Eigen::VectorXi nodes = mesh.elements.col(e);
      mesh.elements.col(e) << nodes.tail(4), nodes.head(4);
    }
  }
  return mesh;
}

Mesh QuadrilateralGrid(int cells) {
  Mesh mesh;
  mesh.kind = ElementKind::kQuad4;
  const int n = cells + 1;
  mesh.nodes.resize(2, n * n);
  for (int i = 0; i < mesh.nodes.cols(); ++i) {
    mesh.nodes.col(i) = Eigen::Vector2d(i % n, i / n) / double(cells);
  }
  mesh.elements.resize(4, cells * cells);
  for (int e = 0; e < mesh.elements.cols(); ++e) {
    const int first = e % cells + n * (e / cells);
    mesh.elements.col(e) << first, first + 1, first + n + 1, first + n;
    if (e % 2 == 1) {
      std::swap(mesh.elements(1, e), mesh.elements(3, e));
    }
  }
  return mesh;
}

Mesh TriangleGrid(int cells) {
  const Mesh grid = QuadrilateralGrid(cells);
  Mesh mesh;
  mesh.kind = ElementKind::kTri3;
  mesh.nodes = grid.nodes;
  mesh.elements.resize(3, 2 * grid.NumElements());
  for (Eigen::Index e = 0; e < grid.NumElements(); ++e) {
    const Eigen::Vector4i q = grid.elements.col(e);
    mesh.elements.col(2 * e) << q(0), q(1), q(2);
    mesh.elements.col(2 * e + 1) << q(0), q(3), q(2);
  }
  return mesh;
}

// Moves the nodes by a smooth map of the unit square or cube.
void Distort(Mesh& mesh) {
  for (auto x : mesh.nodes.colwise()) {
    const Eigen::VectorXd y = x;
    x(0) = y(0) * (1 + 0.2 * y(1)) + 0.1 * std::sin(2 * y(1));
    x(1) = y(1) * (0.9 - 0.15 * y(0));
    if (x.size() == 3) {
      x(2) = y(2) * (1.2 + 0.1 * y(0)) + 0.08 * y(0) * y(1);
      x(0) += 0.1 * y(2) * y(2);
    }
  }
}

Mesh UndistortedMesh(const KindOfSection& parameter, int cells) {
  Mesh mesh;
  switch (parameter.kind) {
    case ElementKind::kTet4:
    case ElementKind::kTet10:
    case ElementKind::kCurvedTet10:
      mesh = BoxMesh({cells, cells, cells}, {1, 1, 1});
      break;
    case ElementKind::kHex8:
    case ElementKind::kHex27:
      mesh = HexahedronGrid(cells);
      break;
    case ElementKind::kTri3:
    case ElementKind::kTri6:
    case ElementKind::kCurvedTri6:
      mesh = TriangleGrid(cells);
      break;
    case ElementKind::kQuad4:
    case ElementKind::kQuad9:
      mesh = QuadrilateralGrid(cells);
      break;
  }
  mesh.section.model = parameter.model;
  mesh.section.thickness = mesh.Dimension() == 2 ? 0.7 : 1;
  return mesh;
}

// Raises the scene to order 2 if the parameter says so.  Every node is
// measured, mid-edge nodes too.
Scene RaisedScene(const KindOfSection& parameter, int cells,
                  const Scene& scene) {
  if (TopologyOf(parameter.kind).order == 1) {
    return scene;
  }
  Scene raised = QuadraticScene(scene);
  raised.load_cases[0].observed.resize(0, 0);
  if (IsCurved(parameter.kind)) {
    // The map bends the edges too, as it bends the block.
    Scene straight = scene;
    straight.mesh = UndistortedMesh(parameter, cells);
    raised.mesh = QuadraticScene(straight).mesh;
    raised.mesh.kind = parameter.kind;
    Distort(raised.mesh);
  }
  return raised;
}

// Returns the scene without measurements, before its order is raised.
Scene VertexScene(const KindOfSection& parameter, int cells) {
  Scene scene;
  const Mesh reference = UndistortedMesh(parameter, cells);
  scene.mesh = reference;
  Distort(scene.mesh);
  const int dimension = scene.mesh.Dimension();
  scene.supports.held =
      ComponentMask::Constant(dimension, scene.mesh.NumNodes(), false);
  scene.supports.displacement =
      Eigen::MatrixXd::Zero(dimension, scene.mesh.NumNodes());
  NodalForces forces{Eigen::MatrixXd::Zero(dimension, scene.mesh.NumNodes())};
  for (Eigen::Index i = 0; i < scene.mesh.NumNodes(); ++i) {
    const Eigen::VectorXd x = reference.nodes.col(i);
    scene.supports.held.col(i).setConstant(x(dimension - 1) == 0);
    forces.force(dimension - 1, i) = 3 * x(0) - 1;
    forces.force(0, i) = x(dimension - 1) == 1 ? 2 : 0;
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {forces};
  return scene;
}

// The reference element has these nodes, and these exponents of monomials.  The
// map of an element with straight edges takes the vertices alone.
struct Reference {
  Eigen::MatrixXd nodes;
  std::vector<std::array<int, 3>> exponents;
};

// Returns where VTK has the nodes of a quadratic cube, or those of a square,
// which are the first four of each list.
Eigen::MatrixXd NodesOfCube(int dimension, int num_nodes) {
  constexpr double kVertices[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},
                                      {-1, 1, -1},  {-1, -1, 1}, {1, -1, 1},
                                      {1, 1, 1},    {-1, 1, 1}};
  constexpr double kMiddles[19][3] = {
      {0, -1, -1}, {1, 0, -1}, {0, 1, -1}, {-1, 0, -1}, {0, -1, 1},
      {1, 0, 1},   {0, 1, 1},  {-1, 0, 1}, {-1, -1, 0}, {1, -1, 0},
      {1, 1, 0},   {-1, 1, 0}, {-1, 0, 0}, {1, 0, 0},   {0, -1, 0},
      {0, 1, 0},   {0, 0, -1}, {0, 0, 1},  {0, 0, 0}};
  const int num_vertices = dimension == 3 ? 8 : 4;
  Eigen::MatrixXd nodes(dimension, num_nodes);
  for (int i = 0; i < num_nodes; ++i) {
    const int middle = i - num_vertices;
    const double* const x = middle < 0                     ? kVertices[i]
                            : dimension == 3 || middle < 4 ? kMiddles[middle]
                                                           : kMiddles[18];
    nodes.col(i) = Eigen::Map<const Eigen::VectorXd>(x, dimension);
  }
  return nodes;
}

Reference ReferenceOf(ElementKind kind) {
  const ElementTopology& topology = TopologyOf(kind);
  const int d = topology.dimension;
  Reference reference;
  reference.nodes = Eigen::MatrixXd::Zero(d, topology.num_nodes);
  if (IsSimplex(kind)) {
    reference.nodes.block(0, 1, d, d).setIdentity();
    // Mid-edge nodes are in the order of VTK.
    const int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
      const auto& [a, b] = ends[i - topology.num_vertices];
      reference.nodes.col(i) =
          (reference.nodes.col(a) + reference.nodes.col(b)) / 2;
    }
  } else {
    reference.nodes = NodesOfCube(d, topology.num_nodes);
  }
  for (int a = 0; a <= 2; ++a) {
    for (int b = 0; b <= 2; ++b) {
      for (int c = 0; c <= (d == 3 ? 2 : 0); ++c) {
        const bool is_used = IsSimplex(kind)
                                 ? a + b + c <= topology.order
                                 : std::max({a, b, c}) <= topology.order;
        if (is_used) {
          reference.exponents.push_back({a, b, c});
        }
      }
    }
  }
  return reference;
}

double Power(double x, int exponent) {
  return exponent == 0 ? 1 : exponent == 1 ? x : x * x;
}

// Returns the monomials at a point, or their derivatives along an axis.
Eigen::RowVectorXd Monomials(const Reference& reference,
                             const Eigen::VectorXd& xi, int derivative) {
  Eigen::RowVectorXd row(reference.exponents.size());
  for (std::size_t m = 0; m < reference.exponents.size(); ++m) {
    double value = 1;
    for (int k = 0; k < xi.size(); ++k) {
      const int exponent = reference.exponents[m][k];
      value *= k != derivative ? Power(xi(k), exponent)
               : exponent == 0 ? 0
                               : exponent * Power(xi(k), exponent - 1);
    }
    row(Eigen::Index(m)) = value;
  }
  return row;
}

// Visits the integration points of the library.  They are part of the
// definition of a curved element, whose stiffness is no integral of a
// polynomial.  Tests of their own check how exact they are.
void ForEachPointOfCurved(
    ElementKind kind,
    const std::function<void(const Eigen::VectorXd&, double)>& visit) {
  VisitElementKind(kind, [&](auto constant) {
    constexpr int kDimension = ElementSizes<constant>::kDimension;
    for (const auto& at : IntegrationRule<constant>()) {
      visit(at.vertex_value.template tail<kDimension>(), at.weight);
    }
  });
}

// Calls visit(xi, weight) at Gauss points.  There are two along each axis of a
// square or a cube, three if its order is 2; for a simplex, four along each
// axis of a cube that is collapsed onto it.
void ForEachPoint(
    ElementKind kind,
    const std::function<void(const Eigen::VectorXd&, double)>& visit) {
  if (IsCurved(kind)) {
    ForEachPointOfCurved(kind, visit);
    return;
  }
  const int d = TopologyOf(kind).dimension;
  std::vector<double> points = {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)};
  std::vector<double> weights = {1, 1};
  if (TopologyOf(kind).order == 2) {
    points = {-std::sqrt(0.6), 0, std::sqrt(0.6)};
    weights = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  }
  if (IsSimplex(kind)) {
    const GaussPoints gauss;
    points.assign(gauss.point.begin(), gauss.point.end());
    weights.assign(gauss.weight.begin(), gauss.weight.end());
  }
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < (d == 3 ? n : 1); ++k) {
        Eigen::VectorXd xi(d);
        double weight = weights[i] * weights[j] * (d == 3 ? weights[k] : 1);
        xi(0) = points[i];
        xi(1) = points[j];
        if (d == 3) {
          xi(2) = points[k];
        }
        if (IsSimplex(kind)) {
          weight *=
              d == 3 ? (1 - xi(0)) * (1 - xi(0)) * (1 - xi(1)) : 1 - xi(0);
          if (d == 3) {
            xi(2) *= (1 - xi(0)) * (1 - xi(1));
          }
          xi(1) *= 1 - xi(0);
        }
        visit(xi, weight);
      }
    }
  }
}

// Calls visit(values (n), gradients (d x n), volume) at the points of an
// element.
void ForEachPointOf(
    const Mesh& mesh, Eigen::Index element,
    const std::function<void(const Eigen::VectorXd&, const Eigen::MatrixXd&,
                             double)>& visit) {
  const Reference reference = ReferenceOf(mesh.kind);
  const Eigen::Index n = reference.nodes.cols();
  const Eigen::Index d = reference.nodes.rows();
  Eigen::MatrixXd vandermonde(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    vandermonde.row(i) = Monomials(reference, reference.nodes.col(i), -1);
  }
  const Eigen::MatrixXd coefficients = InvertDensely(vandermonde);
  const Eigen::MatrixXd x = mesh.nodes(Eigen::all, mesh.elements.col(element));
  ForEachPoint(mesh.kind, [&](const Eigen::VectorXd& xi, double weight) {
    Eigen::MatrixXd local(d, n);
    for (int k = 0; k < d; ++k) {
      local.row(k) = Monomials(reference, xi, k) * coefficients;
    }
    const Eigen::MatrixXd jacobian = x * local.transpose();
    visit((Monomials(reference, xi, -1) * coefficients).transpose(),
          InvertDensely(jacobian).transpose() * local,
          weight * std::abs(jacobian.determinant()) * mesh.section.thickness);
  });
}

// Returns the matrix B, whose shear strains are engineering strains.
Eigen::MatrixXd StrainDisplacementOf(const Eigen::MatrixXd& gradients) {
  const Eigen::Index d = gradients.rows();
  Eigen::MatrixXd b =
      Eigen::MatrixXd::Zero(d == 3 ? 6 : 3, d * gradients.cols());
  for (Eigen::Index i = 0; i < gradients.cols(); ++i) {
    const auto g = gradients.col(i);
    for (Eigen::Index k = 0; k < d; ++k) {
      b(k, d * i + k) = g(k);
    }
    for (Eigen::Index k = 0; k < (d == 3 ? 3 : 1); ++k) {
      const Eigen::Index l = (k + 1) % d;
      b(d + k, d * i + k) = g(l);
      b(d + k, d * i + l) = g(k);
    }
  }
  return b;
}

}  // namespace

std::vector<KindOfSection> AllKindsOfSections() {
  std::vector<KindOfSection> all;
  for (const ElementKind kind : kElementKinds) {
    if (TopologyOf(kind).dimension == 3) {
      all.push_back({kind, SectionModel::kSolid});
    } else {
      all.push_back({kind, SectionModel::kPlaneStrain});
      all.push_back({kind, SectionModel::kPlaneStress});
    }
  }
  return all;
}

std::vector<KindOfSection> KindsOf(int dimension, int order) {
  std::vector<KindOfSection> kinds;
  for (const KindOfSection& kind : AllKindsOfSections()) {
    const ElementTopology& topology = TopologyOf(kind.kind);
    if (topology.dimension == dimension && topology.order == order) {
      kinds.push_back(kind);
    }
  }
  return kinds;
}

std::string NameOf(const KindOfSection& parameter) {
  return std::string(TopologyOf(parameter.kind).name) +
         (parameter.model == SectionModel::kSolid
              ? ""
              : "_" + std::string(SectionModelName(parameter.model)));
}

Scene SceneOfKind(const KindOfSection& parameter, int cells) {
  return RaisedScene(parameter, cells, VertexScene(parameter, cells));
}

Mesh MeshOfKind(const KindOfSection& parameter, int cells) {
  return SceneOfKind(parameter, cells).mesh;
}

void DisplaceSupports(Scene& scene) {
  for (Eigen::Index i = 0; i < scene.supports.held.size(); ++i) {
    if (scene.supports.held(i)) {
      scene.supports.displacement(i) = 0.001 * double(i % 5);
    }
  }
}

Eigen::MatrixXd HookeMatrixOf(const IsotropicElasticity& elasticity,
                              SectionModel model) {
  const Eigen::Matrix<double, 6, 6> solid =
      HookeMatrix(elasticity.youngs_modulus, elasticity.poisson_ratio);
  const std::vector<int> in_plane = {0, 1, 3};
  switch (model) {
    case SectionModel::kPlaneStrain:
      return solid(in_plane, in_plane);
    case SectionModel::kPlaneStress: {
      const Eigen::MatrixXd compliance = InvertDensely(solid);
      return InvertDensely(compliance(in_plane, in_plane));
    }
    case SectionModel::kSolid:
      break;
  }
  return solid;
}

Eigen::MatrixXd TextbookStiffness(const Mesh& mesh, const Eigen::MatrixXd& d) {
  Eigen::MatrixXd stiffness =
      Eigen::MatrixXd::Zero(mesh.NumDofs(), mesh.NumDofs());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    std::vector<Eigen::Index> dofs;
    for (const int node : mesh.elements.col(e)) {
      for (int k = 0; k < mesh.nodes.rows(); ++k) {
        dofs.push_back(mesh.nodes.rows() * node + k);
      }
    }
    ForEachPointOf(mesh, e,
                   [&](const Eigen::VectorXd&, const Eigen::MatrixXd& gradients,
                       double volume) {
                     const Eigen::MatrixXd b = StrainDisplacementOf(gradients);
                     stiffness(dofs, dofs) += volume * b.transpose() * d * b;
                   });
  }
  return stiffness;
}

Eigen::VectorXd TextbookVolumes(const Mesh& mesh) {
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(mesh.NumNodes());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    ForEachPointOf(mesh, e,
                   [&](const Eigen::VectorXd& values, const Eigen::MatrixXd&,
                       double volume) {
                     for (Eigen::Index i = 0; i < values.size(); ++i) {
                       volumes(mesh.elements(i, e)) += volume * values(i);
                     }
                   });
  }
  return volumes;
}

void MeasureByTextbook(const IsotropicElasticity& elasticity, Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const Eigen::MatrixXd stiffness =
      TextbookStiffness(mesh, HookeMatrixOf(elasticity, mesh.section.model));
  const auto held = scene.supports.held.reshaped();
  std::vector<Eigen::Index> free;
  for (Eigen::Index dof = 0; dof < mesh.NumDofs(); ++dof) {
    if (!held(dof)) {
      free.push_back(dof);
    }
  }
  const Eigen::VectorXd prescribed =
      held.select(scene.supports.displacement.reshaped(), 0.0);
  const Eigen::MatrixXd force =
      AssembleLoadCases(scene).colwise() - stiffness * prescribed;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    Eigen::VectorXd u = prescribed;
    u(free) =
        SolveDensely(stiffness(free, free), force.col(Eigen::Index(k))(free));
    scene.load_cases[k].displacement =
        u.reshaped(mesh.nodes.rows(), mesh.NumNodes());
    scene.origin = Origin::kComputed;
  }
}

void MeasureInCutWorld(const IsotropicElasticity& elasticity, Scene& scene) {
  Scene finer = FinerScene(scene);
  finer = FinerScene(finer);
  Measure(elasticity, finer);
  TakeDisplacements(finer, scene);
}

}  // namespace elastimate::testing
