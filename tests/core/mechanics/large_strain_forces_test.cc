// Tests of the internal forces of large strains, on every element kind in every
// section.

#include "elastimate/core/mechanics/large_strain_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>
#include <tuple>

#include "elastimate/core/large_strain/homogeneous_deformation.h"
#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/shape_functions.h"
#include "tests/anisotropy.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::RandomMatrix;

Material MaterialOf(const std::string& law) {
  Material material;
  material.law = law;
  return material;
}

Eigen::MatrixXd DenseOf(const Eigen::MatrixXd& blocks, const NodeGraph& graph) {
  const Eigen::Index d = blocks.rows();
  const Eigen::Index num_nodes = Eigen::Index(graph.start.size()) - 1;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(d * num_nodes, d * num_nodes);
  for (Eigen::Index j = 0; j < num_nodes; ++j) {
    for (Eigen::Index pair = graph.start[j]; pair < graph.start[j + 1];
         ++pair) {
      const Eigen::Index i = graph.row[pair];
      const auto block = blocks.middleCols(d * pair, d);
      dense.block(d * i, d * j, d, d) = block;
      dense.block(d * j, d * i, d, d) = block.transpose();
    }
  }
  return dense;
}

class LargeStrainKinds
    : public ::testing::TestWithParam<std::tuple<KindOfSection, Dilatation>> {
 protected:
  LargeStrainKinds()
      : mesh_(testing::MeshOfKind(std::get<0>(GetParam()), 2)),
        forces_(mesh_, {MaterialOf("neo_hookean")}, std::get<1>(GetParam())) {}

  Eigen::Index Dimension() const { return mesh_.Dimension(); }

  // A field of strains of some tens of per cent, the smoother the better.
  Eigen::VectorXd Displacement() const {
    const Eigen::MatrixXd slope =
        0.25 * RandomMatrix(Dimension(), Dimension(), 4);
    const double extent =
        (mesh_.nodes.rowwise().maxCoeff() - mesh_.nodes.rowwise().minCoeff())
            .maxCoeff();
    Eigen::MatrixXd u = slope * mesh_.nodes;
    u += 0.05 * extent * (3 / extent * mesh_.nodes.array()).sin().matrix();
    return u.reshaped();
  }

  // Turns the mesh and what moved with it.
  Eigen::MatrixXd Turn(double angle) const {
    if (Dimension() == 2) {
      return Eigen::Rotation2Dd(angle).toRotationMatrix();
    }
    return Eigen::AngleAxisd(angle, Eigen::Vector3d(2, 1, 2) / 3)
        .toRotationMatrix();
  }
  Eigen::VectorXd Turned(const Eigen::MatrixXd& turn,
                         const Eigen::VectorXd& u) const {
    const Eigen::MatrixXd moved =
        turn * (mesh_.nodes + u.reshaped(Dimension(), mesh_.NumNodes()));
    return (moved - mesh_.nodes).reshaped();
  }

  Mesh mesh_;
  LargeStrainForces forces_;
  Eigen::Vector2d moduli_ = {1.5, 4};
};

TEST_P(LargeStrainKinds, HaveTheDerivativeOfTheirForcesAsTangent) {
  const Eigen::VectorXd u = Displacement();
  ASSERT_GT(forces_.SmallestVolumeRatio(u).value, 0.3);
  const Eigen::VectorXd v = RandomMatrix(u.size(), 1, 2);
  constexpr double kStep = 1e-6;
  const Eigen::VectorXd expected = (forces_.Forces(moduli_, u + kStep * v) -
                                    forces_.Forces(moduli_, u - kStep * v)) /
                                   (2 * kStep);
  const Eigen::MatrixXd products = forces_.TangentProducts(moduli_, u, v);
  EXPECT_TRUE(products.isApprox(expected, 1e-8));
  const NodeGraph graph(mesh_);
  const Eigen::MatrixXd tangent =
      DenseOf(forces_.TangentBlocks(moduli_, u, graph), graph);
  EXPECT_TRUE((tangent * v).isApprox(products, 1e-12));
}

TEST_P(LargeStrainKinds, HaveASymmetricTangent) {
  const Eigen::VectorXd u = Displacement();
  const Eigen::MatrixXd v = RandomMatrix(u.size(), 2, 3);
  const Eigen::MatrixXd products = forces_.TangentProducts(moduli_, u, v);
  EXPECT_NEAR(v.col(0).dot(products.col(1)), v.col(1).dot(products.col(0)),
              1e-12 * products.norm());
}

TEST_P(LargeStrainKinds, AreLinearInTheirModuli) {
  // In plane stress the columns are those at the stretch of the moduli, which
  // a factor leaves as it is.
  const Eigen::VectorXd u = Displacement();
  const Eigen::MatrixXd columns = forces_.Columns(moduli_, u);
  EXPECT_TRUE(
      forces_.Forces(3 * moduli_, u).isApprox(3 * columns * moduli_, 1e-12));
  if (mesh_.section.model != SectionModel::kPlaneStress) {
    EXPECT_TRUE(
        forces_.Columns(Eigen::Vector2d(2, 0.1), u).isApprox(columns, 1e-14));
  }
}

TEST_P(LargeStrainKinds, HaveTheirDerivativesByTheModuli) {
  const Eigen::VectorXd u = Displacement();
  const Eigen::MatrixXd derivatives = forces_.ModuliDerivatives(moduli_, u);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
    const Eigen::VectorXd expected = (forces_.Forces(moduli_ + step, u) -
                                      forces_.Forces(moduli_ - step, u)) /
                                     (2 * kStep);
    EXPECT_LT((derivatives.col(k) - expected).norm(),
              1e-8 * derivatives.norm());
  }
  const Eigen::MatrixXd columns = forces_.Columns(moduli_, u);
  if (mesh_.section.model == SectionModel::kPlaneStress) {
    EXPECT_GT((derivatives - columns).norm(), 0.01 * columns.norm());
  } else {
    EXPECT_EQ(derivatives, columns);
  }
}

TEST_P(LargeStrainKinds, TurnWithTheMesh) {
  const Eigen::VectorXd u = Displacement();
  const Eigen::MatrixXd turn = Turn(1.3);
  const Eigen::MatrixXd forces =
      forces_.Forces(moduli_, u).reshaped(Dimension(), mesh_.NumNodes());
  const Eigen::MatrixXd turned = forces_.Forces(moduli_, Turned(turn, u))
                                     .reshaped(Dimension(), mesh_.NumNodes());
  EXPECT_TRUE(turned.isApprox(turn * forces, 1e-11));
  EXPECT_LT(forces.rowwise().sum().norm(), 1e-12 * forces.norm());
}

TEST_P(LargeStrainKinds, HaveNoForcesWhereTheMeshIsTurnedBy90Degrees) {
  const Eigen::VectorXd u =
      Turned(Turn(std::acos(0.0)), Eigen::VectorXd::Zero(mesh_.NumDofs()));
  const double stiff =
      forces_.Forces(moduli_, Displacement()).cwiseAbs().maxCoeff();
  EXPECT_LT(forces_.Forces(moduli_, u).cwiseAbs().maxCoeff(), 1e-13 * stiff);
}

// The patch test: nodes inside are in equilibrium in any homogeneous
// deformation, and the forces on the surface are those of the stress.
TEST_P(LargeStrainKinds, PassThePatchTest) {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  h.topLeftCorner(Dimension(), Dimension()) =
      0.3 * RandomMatrix(Dimension(), Dimension(), 5);
  const Law& law = forces_.Parameters().LawOf(0);
  if (mesh_.section.model == SectionModel::kPlaneStress) {
    ASSERT_TRUE(ReleaseAxes(law, moduli_, {2}, h));
  }
  const Eigen::MatrixXd stress =
      (law.Stresses(h, SectionModel::kSolid) * moduli_)
          .reshaped(3, 3)
          .topLeftCorner(Dimension(), Dimension());
  const Eigen::VectorXd u =
      (h.topLeftCorner(Dimension(), Dimension()) * mesh_.nodes).reshaped();
  const Eigen::VectorXd forces = forces_.Forces(moduli_, u);
  // The work of these forces in any displacement is stress : mean gradient.
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(mesh_.NumDofs());
  VisitElementKind(mesh_.kind, [&](auto kind) {
    for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
      VisitPoints<kind>(mesh_, e, IntegrationRule<kind>(),
                        [&](const auto& point, const auto&) {
                          const Eigen::MatrixXd of_nodes =
                              point.volume * stress * point.gradient;
                          for (Eigen::Index i = 0; i < of_nodes.cols(); ++i) {
                            expected.segment(Dimension() * mesh_.elements(i, e),
                                             Dimension()) += of_nodes.col(i);
                          }
                        });
    }
  });
  EXPECT_TRUE(forces.isApprox(expected, 1e-12));
  std::vector<bool> is_inside(mesh_.NumNodes(), true);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
  for (const int node : facets.reshaped()) {
    is_inside[node] = false;
  }
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    if (is_inside[node]) {
      EXPECT_LT(forces.segment(Dimension() * node, Dimension()).norm(),
                1e-12 * forces.norm());
    }
  }
}

// With the mean of the dilatation, the elements differ from those of small
// strains, but not in fields whose dilatation is the same everywhere.
TEST_P(LargeStrainKinds, AreSmallStrainsNearRest) {
  const double size = 1e-7;
  Eigen::VectorXd u = size * Displacement();
  if (std::get<1>(GetParam()) == Dilatation::kMeanOfElement) {
    u = (size * RandomMatrix(Dimension(), Dimension(), 8) * mesh_.nodes)
            .reshaped();
  }
  const InternalForces linear(mesh_, {});
  const double mu = moduli_(0);
  const double lambda = moduli_(1);
  const Eigen::Vector2d parameters(mu * (3 * lambda + 2 * mu) / (lambda + mu),
                                   lambda / (2 * (lambda + mu)));
  const Eigen::VectorXd expected =
      linear.Multiply(linear.Parameters().Moduli(parameters), u);
  EXPECT_LT((forces_.Forces(moduli_, u) - expected).norm(),
            10 * size * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, LargeStrainKinds,
    ::testing::Combine(::testing::ValuesIn(testing::AllKindsOfSections()),
                       ::testing::Values(Dilatation::kOfPoints,
                                         Dilatation::kMeanOfElement)),
    [](const auto& info) {
      return testing::NameOf(std::get<0>(info.param)) +
             (std::get<1>(info.param) == Dilatation::kOfPoints ? "_points"
                                                               : "_mean");
    });

// The energy of an element that smooths its dilatation is that of
// Fbar = (Theta / J)^(1/3) F, where Theta is the mean of J or, in elements of
// order 2, its linear least-squares fit.
TEST(MeanOfElement, HasTheForcesOfItsEnergy) {
  for (const KindOfSection kind :
       {KindOfSection{ElementKind::kHex8, SectionModel::kSolid},
        KindOfSection{ElementKind::kQuad4, SectionModel::kPlaneStrain},
        KindOfSection{ElementKind::kHex27, SectionModel::kSolid},
        KindOfSection{ElementKind::kQuad9, SectionModel::kPlaneStrain}}) {
    const Mesh mesh = testing::MeshOfKind(kind, 1);
    const LargeStrainForces forces(mesh, {MaterialOf("neo_hookean")});
    const Law& law = forces.Parameters().LawOf(0);
    const Eigen::Vector2d moduli(1.5, 40);
    const auto energy = [&](const Eigen::VectorXd& u) {
      double sum = 0;
      VisitElementKind(mesh.kind, [&](auto element_kind) {
        std::vector<Eigen::Matrix3d> f;
        std::vector<double> volumes;
        std::vector<Eigen::VectorXd> polynomials;
        const auto nodes = GatherNodes<element_kind>(mesh, 0, u.data());
        const auto places =
            GatherNodes<element_kind>(mesh, 0, mesh.nodes.data());
        VisitPoints<element_kind>(
            mesh, 0, StiffnessRule<element_kind>(),
            [&](const auto& point, const auto& shape) {
              Eigen::Matrix3d at = Eigen::Matrix3d::Identity();
              at.topLeftCorner(mesh.Dimension(), mesh.Dimension()) +=
                  nodes * point.gradient.transpose();
              f.push_back(at);
              volumes.push_back(point.volume);
              Eigen::VectorXd values(mesh.Dimension() + 1);
              values << places * shape.value, 1;
              polynomials.push_back(
                  mesh.Order() == 2 ? values : Eigen::VectorXd(values.tail(1)));
            });
        const Eigen::Index size = polynomials[0].size();
        Eigen::MatrixXd products = Eigen::MatrixXd::Zero(size, size);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
        for (std::size_t i = 0; i < f.size(); ++i) {
          products += volumes[i] * polynomials[i] * polynomials[i].transpose();
          right += volumes[i] * f[i].determinant() * polynomials[i];
        }
        const Eigen::VectorXd coefficients = products.inverse() * right;
        for (std::size_t i = 0; i < f.size(); ++i) {
          const Eigen::Matrix3d h =
              std::cbrt(coefficients.dot(polynomials[i]) / f[i].determinant()) *
                  f[i] -
              Eigen::Matrix3d::Identity();
          sum += volumes[i] * law.Energies(h, SectionModel::kSolid).dot(moduli);
        }
      });
      return sum;
    };
    const Eigen::VectorXd u = 0.1 / mesh.Order() *
                              RandomMatrix(mesh.NumDofs(), 1, 9) *
                              mesh.nodes.maxCoeff();
    ASSERT_GT(forces.SmallestVolumeRatio(u).value, 0);
    const Eigen::VectorXd actual = forces.Forces(moduli, u);
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(u.size(), i);
      EXPECT_NEAR(actual(i), (energy(u + step) - energy(u - step)) / 2e-6,
                  1e-7 * actual.norm());
    }
  }
}

TEST(LargeStrainForces, TakeEachLawAndSeveralMaterials) {
  Mesh mesh =
      testing::MeshOfKind({ElementKind::kTet4, SectionModel::kSolid}, 3);
  mesh.regions = Eigen::VectorXi::Ones(mesh.NumElements());
  mesh.regions.tail(mesh.NumElements() / 3).setConstant(2);
  Material first = MaterialOf("corotated");
  first.regions = {1};
  Material second = MaterialOf("yeoh");
  second.regions = {2};
  const LargeStrainForces both(mesh, {first, second});
  const LargeStrainForces one(mesh, {MaterialOf("corotated")});
  const Eigen::VectorXd u =
      0.02 * mesh.nodes.maxCoeff() * RandomMatrix(mesh.NumDofs(), 1, 6);
  Eigen::VectorXd moduli(6);
  moduli << 1, 2, 1, -0.1, 0.01, 5;
  ASSERT_EQ(both.Parameters().NumModuli(), 6);
  // Where the second material is not, all is as in the first alone.
  const Eigen::VectorXd of_both = both.Forces(moduli, u);
  const Eigen::VectorXd of_one = one.Forces(moduli.head<2>(), u);
  std::vector<bool> is_shared(mesh.NumNodes(), false);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (const int node : mesh.elements.col(e)) {
      is_shared[node] = is_shared[node] || mesh.regions(e) == 2;
    }
  }
  int count = 0;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (!is_shared[node]) {
      ++count;
      EXPECT_TRUE(of_both.segment<3>(3 * node).isApprox(
          of_one.segment<3>(3 * node), 1e-12));
    }
  }
  EXPECT_GT(count, 5);
  const Eigen::VectorXd v = RandomMatrix(u.size(), 1, 2);
  const Eigen::VectorXd slope =
      (both.Forces(moduli, u + 1e-7 * v) - both.Forces(moduli, u - 1e-7 * v)) /
      2e-7;
  EXPECT_TRUE(both.TangentProducts(moduli, u, v).isApprox(slope, 1e-6));
}

// A material that is stiffer along its axes, which are others in each element.
TEST(LargeStrainForces, SeeAMaterialInItsFrame) {
  for (const auto& [kind, dilatation] :
       {std::pair(ElementKind::kTet4, Dilatation::kOfPoints),
        std::pair(ElementKind::kTet10, Dilatation::kOfPoints),
        std::pair(ElementKind::kHex8, Dilatation::kOfPoints),
        std::pair(ElementKind::kHex8, Dilatation::kMeanOfElement)}) {
    const Mesh mesh = testing::MeshOfKind({kind, SectionModel::kSolid}, 2);
    Material material = MaterialOf("st_venant_kirchhoff_orthotropic");
    material.axes.assign(2, Eigen::MatrixXd(3, mesh.NumElements()));
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      const Eigen::MatrixXd frame = testing::RandomFrame(3, unsigned(e));
      material.axes[0].col(e) = frame.col(0);
      material.axes[1].col(e) = frame.col(1);
    }
    const LargeStrainForces forces(mesh, {material}, dilatation);
    const Law& law = forces.Parameters().LawOf(0);
    const Eigen::VectorXd moduli =
        forces.Parameters().Moduli(testing::UnlikeTypical(law, 3));
    const double size = mesh.nodes.maxCoeff();
    const Eigen::VectorXd u = 0.03 * size * RandomMatrix(mesh.NumDofs(), 1, 6);
    const Eigen::VectorXd v = RandomMatrix(u.size(), 1, 2);
    const double step = 1e-6 * size;
    const Eigen::VectorXd slope = (forces.Forces(moduli, u + step * v) -
                                   forces.Forces(moduli, u - step * v)) /
                                  (2 * step);
    EXPECT_TRUE(forces.TangentProducts(moduli, u, v).isApprox(slope, 1e-7));
    const NodeGraph graph(mesh);
    EXPECT_TRUE((DenseOf(forces.TangentBlocks(moduli, u, graph), graph) * v)
                    .isApprox(slope, 1e-7));
    // A turn of the whole changes nothing.
    const Eigen::Matrix3d turn(
        Eigen::AngleAxisd(1.3, Eigen::Vector3d(2, 1, 2) / 3));
    const Eigen::MatrixXd turned =
        turn * (mesh.nodes + u.reshaped(3, mesh.NumNodes())) - mesh.nodes;
    EXPECT_TRUE(forces.Forces(moduli, turned.reshaped())
                    .reshaped(3, mesh.NumNodes())
                    .isApprox(turn * forces.Forces(moduli, u).reshaped(
                                         3, mesh.NumNodes()),
                              1e-10));
    if (dilatation == Dilatation::kOfPoints) {
      material.law = "orthotropic";
      const InternalForces linear(mesh, {material});
      EXPECT_TRUE((1e7 * forces.Forces(moduli, 1e-7 * u))
                      .isApprox(linear.Multiply(moduli, u), 1e-5));
    }
  }
}

TEST(LargeStrainForces, FindTheInvertedElement) {
  const Mesh mesh =
      testing::MeshOfKind({ElementKind::kTet4, SectionModel::kSolid}, 2);
  const LargeStrainForces forces(mesh, {MaterialOf("corotated")});
  Eigen::VectorXd u = Eigen::VectorXd::Zero(mesh.NumDofs());
  EXPECT_NEAR(forces.SmallestVolumeRatio(u).value, 1, 1e-12);
  // The first node of the last element goes beyond the middle of the others.
  const auto nodes = mesh.elements.col(mesh.NumElements() - 1);
  const Eigen::Vector3d middle =
      (mesh.nodes.col(nodes(1)) + mesh.nodes.col(nodes(2)) +
       mesh.nodes.col(nodes(3))) /
      3;
  u.segment<3>(3 * nodes(0)) = 1.5 * (middle - mesh.nodes.col(nodes(0)));
  const VolumeRatio ratio = forces.SmallestVolumeRatio(u);
  EXPECT_LE(ratio.value, -0.5 + 1e-12);
}

TEST(LargeStrainForces, RefuseSmallStrains) {
  const Mesh mesh =
      testing::MeshOfKind({ElementKind::kTet4, SectionModel::kSolid}, 1);
  EXPECT_TRUE(testing::ThrowsWith(
      [&] { LargeStrainForces(mesh, {MaterialOf("isotropic")}); },
      "the law isotropic is for small strains"));
}

}  // namespace
}  // namespace elastimate
