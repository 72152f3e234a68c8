// Tests of the internal forces of materials whose stiffness depends on the
// direction.

#include <gtest/gtest.h>

#include "elastimate/core/materials/laws.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/linear_scene.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/anisotropy.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::RandomMatrix;

// Permutes to the order (xx, yy, zz, xy, yz, zx) of TextbookStiffness.
Eigen::MatrixXd InTextbookOrder(const Eigen::MatrixXd& voigt) {
  const std::vector<int> order = voigt.rows() == 6
                                     ? std::vector<int>{0, 1, 2, 5, 3, 4}
                                     : std::vector<int>{0, 1, 2};
  return voigt(order, order);
}

// Returns the first columns of a frame, as many as the law has axes.  They need
// no unit length.
std::vector<Eigen::MatrixXd> AxesOf(const Law& law,
                                    const Eigen::MatrixXd& frame) {
  std::vector<Eigen::MatrixXd> axes;
  for (int i = 0; i < law.NumAxes(); ++i) {
    axes.emplace_back((i + 2.0) * frame.col(i));
  }
  return axes;
}

struct LawOfKind {
  const Law* law;
  KindOfSection kind;
};

std::vector<LawOfKind> AllLawsOfKinds() {
  std::vector<LawOfKind> all;
  for (const KindOfSection& kind : testing::AllKindsOfSections()) {
    for (const Law* const law : Laws()) {
      if (!law->BlockEntries().empty() && law->Takes(kind.model) &&
          law->ForLargeStrains() == nullptr) {
        all.push_back({law, kind});
      }
    }
  }
  return all;
}

class AnisotropicForces : public ::testing::TestWithParam<LawOfKind> {
 protected:
  const Law& law_ = *GetParam().law;
  Mesh mesh_ = testing::MeshOfKind(GetParam().kind, 2);
  Eigen::MatrixXd frame_ = testing::RandomFrame(mesh_.Dimension(), 1);
  Material material_ = {
      std::string(law_.Name()), {}, {}, {}, AxesOf(law_, frame_)};
  Eigen::VectorXd parameters_ = testing::UnlikeTypical(law_, 3);
  Eigen::MatrixXd u_ = RandomMatrix(mesh_.NumDofs(), 2, 1);

  Eigen::MatrixXd Textbook(const Mesh& mesh,
                           const Eigen::MatrixXd& frame) const {
    return testing::TextbookStiffness(
        mesh, InTextbookOrder(testing::SeenFromOutside(
                  testing::TextbookStiffnessOf(law_, parameters_), frame)));
  }
};

TEST_P(AnisotropicForces, AreThoseOfTheTextbookInTheirFrame) {
  const InternalForces forces(mesh_, {material_});
  const Eigen::VectorXd moduli = forces.Parameters().Moduli(parameters_);
  const Eigen::MatrixXd stiffness = Textbook(mesh_, frame_);
  const Eigen::MatrixXd expected = stiffness * u_;
  EXPECT_LT((forces.Multiply(moduli, u_) - expected).norm(),
            1e-12 * expected.norm());
  EXPECT_LT((forces.Columns(u_.col(0)) * moduli - expected.col(0)).norm(),
            1e-12 * expected.norm());
  const double work = u_.col(0).dot(expected.col(0)) / 2;
  EXPECT_NEAR(
      forces.EnergyDensity(moduli, u_.col(0)).dot(ElementVolumes(mesh_)) / work,
      1, 1e-12);
  const NodeGraph graph(mesh_);
  const Eigen::MatrixXd blocks = forces.Blocks(moduli, graph);
  const Eigen::Index d = mesh_.Dimension();
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    for (Eigen::Index k = graph.start[node]; k < graph.start[node + 1]; ++k) {
      EXPECT_LT((blocks.middleCols(d * k, d) -
                 stiffness.block(d * graph.row[k], d * node, d, d))
                    .norm(),
                1e-12 * stiffness.norm());
    }
  }
  const Eigen::MatrixXd diagonal = forces.DiagonalBlocks(moduli);
  for (Eigen::Index i = 0; i < mesh_.NumDofs(); i += d) {
    EXPECT_LT((diagonal.middleCols(i, d) - stiffness.block(i, i, d, d)).norm(),
              1e-12 * stiffness.norm());
  }
}

// Each element has other axes, and some elements are of an isotropic material.
TEST_P(AnisotropicForces, AreThoseOfTheAxesOfEachElement) {
  mesh_.regions.setOnes(mesh_.NumElements());
  mesh_.regions.head(2).setZero();
  const int dimension = mesh_.Dimension();
  material_.regions = {1};
  material_.axes.assign(law_.NumAxes(),
                        Eigen::MatrixXd::Zero(dimension, mesh_.NumElements()));
  Eigen::MatrixXd stiffness =
      Eigen::MatrixXd::Zero(mesh_.NumDofs(), mesh_.NumDofs());
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    Mesh part = mesh_;
    part.elements = mesh_.elements.col(e);
    if (mesh_.regions(e) == 0) {
      stiffness += testing::TextbookStiffness(
          part, testing::HookeMatrixOf({2, 0.1}, mesh_.section.model));
      continue;
    }
    const Eigen::MatrixXd frame = testing::RandomFrame(dimension, unsigned(e));
    for (int i = 0; i < law_.NumAxes(); ++i) {
      material_.axes[i].col(e) = frame.col(i);
    }
    stiffness += Textbook(part, frame);
  }
  const InternalForces forces(mesh_, {{"isotropic", {0}, {}, {}}, material_});
  Eigen::VectorXd all(2 + parameters_.size());
  all << 2, 0.1, parameters_;
  const Eigen::VectorXd moduli = forces.Parameters().Moduli(all);
  const Eigen::MatrixXd expected = stiffness * u_;
  EXPECT_LT((forces.Multiply(moduli, u_) - expected).norm(),
            1e-12 * expected.norm());
  EXPECT_LT((forces.Columns(u_.col(0)) * moduli - expected.col(0)).norm(),
            1e-12 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(Laws, AnisotropicForces,
                         ::testing::ValuesIn(AllLawsOfKinds()),
                         [](const auto& info) {
                           return std::string(info.param.law->Name()) + "_" +
                                  testing::NameOf(info.param.kind);
                         });

// The parts that an element is divided into, and a quadratic element on its
// nodes, keep its axis.
TEST(AnisotropicScenes, KeepTheAxesOfElements) {
  Scene scene =
      testing::SceneOfKind({ElementKind::kHex27, SectionModel::kSolid}, 2);
  Eigen::MatrixXd axis(3, scene.mesh.NumElements());
  for (Eigen::Index e = 0; e < axis.cols(); ++e) {
    axis.col(e) = testing::RandomFrame(3, unsigned(e)).col(0);
  }
  scene.materials = {{"transversely_isotropic", {}, {}, {}, {axis}}};
  const Scene divided = LinearScene(scene);
  ValidateScene(divided);
  const Eigen::Index cuts =
      divided.mesh.NumElements() / scene.mesh.NumElements();
  ASSERT_GT(cuts, 1);
  for (Eigen::Index e = 0; e < divided.mesh.NumElements(); ++e) {
    EXPECT_EQ(divided.materials[0].axes[0].col(e), axis.col(e / cuts));
    const Eigen::VectorXi& nodes = divided.mesh.elements.col(e);
    for (const int node : nodes) {
      EXPECT_TRUE((scene.mesh.elements.col(e / cuts).array() == node).any());
    }
  }
  EXPECT_EQ(QuadraticScene(divided).materials[0].axes[0],
            divided.materials[0].axes[0]);
}

}  // namespace
}  // namespace elastimate
