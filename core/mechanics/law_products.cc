#include "elastimate/core/mechanics/law_products.h"

#include <array>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

template <ElementKind kKind>
constexpr int kGradientSize =
    ElementSizes<kKind>::kDimension* ElementSizes<kKind>::kDimension;

template <ElementKind kKind>
using TangentMatrix =
    Eigen::Matrix<double, kGradientSize<kKind>, kGradientSize<kKind>>;

template <ElementKind kKind>
using Frame = Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
                            ElementSizes<kKind>::kDimension>;

// Returns the point as it is seen in a frame.
template <ElementKind kKind>
ElementPoint<kKind> SeenIn(const Frame<kKind>& frame,
                           ElementPoint<kKind> point) {
  point.gradient = frame.transpose().lazyProduct(point.gradient).eval();
  return point;
}

template <ElementKind kKind>
using ElementVectors = Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
                                     ElementSizes<kKind>::kNodes>;

// Returns the forces on the nodes of an element, as seen in its frame, for
// displacement gradients at its points and a tangent.
template <ElementKind kKind>
ElementVectors<kKind> ForcesOf(const std::vector<ElementPoint<kKind>>& points,
                               const std::vector<Frame<kKind>>& gradients,
                               const Eigen::MatrixXd& tangent) {
  using Values = Eigen::Matrix<double, kGradientSize<kKind>, 1>;
  const Eigen::Map<const TangentMatrix<kKind>> c(tangent.data());
  ElementVectors<kKind> forces = ElementVectors<kKind>::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    Frame<kKind> stress;
    Eigen::Map<Values>(stress.data()) =
        points[i].volume *
        c.lazyProduct(Eigen::Map<const Values>(gradients[i].data()));
    forces += stress.lazyProduct(points[i].gradient);
  }
  return forces;
}

template <ElementKind kKind>
void AddOfKind(const Mesh& mesh, const std::vector<int>& material_of_element,
               const MaterialFrames& frames,
               const std::vector<std::vector<Eigen::MatrixXd>>& tangents,
               const Eigen::MatrixXd& displacement,
               std::vector<Eigen::MatrixXd>& products) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  std::vector<ElementPoint<kKind>> points;
  std::vector<Frame<kKind>> gradients(StiffnessRule<kKind>().size());
  points.reserve(gradients.size());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int material = material_of_element[e];
    const Frame<kKind> frame = frames.Of<kDimension>(material, e);
    points.clear();
    VisitPoints<kKind>(mesh, e, StiffnessRule<kKind>(),
                       [&](const auto& point, const auto&) {
                         points.push_back(SeenIn<kKind>(frame, point));
                       });
    for (Eigen::Index column = 0; column < displacement.cols(); ++column) {
      const ElementVectors<kKind> u = frame.transpose().lazyProduct(
          GatherNodes<kKind>(mesh, e, displacement.col(column).data()));
      for (std::size_t i = 0; i < points.size(); ++i) {
        gradients[i] = u.lazyProduct(points[i].gradient.transpose());
      }
      for (std::size_t k = 0; k < tangents[material].size(); ++k) {
        const ElementVectors<kKind> forces = frame.lazyProduct(
            ForcesOf<kKind>(points, gradients, tangents[material][k]));
        double* const values = products[k].col(column).data();
        for (int i = 0; i < ElementSizes<kKind>::kNodes; ++i) {
          Eigen::Map<Eigen::Matrix<double, kDimension, 1>>(
              values + kDimension * Eigen::Index(mesh.elements(i, e))) +=
              forces.col(i);
        }
      }
    }
  }
}

template <ElementKind kKind>
void AddBlocksOfKind(const Mesh& mesh, const NodeGraph& graph,
                     const std::vector<int>& material_of_element,
                     const MaterialFrames& frames,
                     const std::vector<Eigen::MatrixXd>& tangents,
                     Eigen::MatrixXd& blocks) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  constexpr int kNodes = ElementSizes<kKind>::kNodes;
  using Block = Eigen::Matrix<double, kDimension, kDimension>;
  // K(i, j)_ab = sum_cd g_i,c C_(ac)(bd) g_j,d: by columns (c, d) of C, each a
  // dimension x dimension block over (a, b).
  const auto add = [&](const ElementPoint<kKind>& point,
                       const Frame<kKind>& frame,
                       const Eigen::MatrixXd& tangent, Eigen::Index e) {
    const int* const nodes = mesh.elements.col(e).data();
    for (int j = 0; j < kNodes; ++j) {
      Eigen::Matrix<double, kGradientSize<kKind>, kDimension> of_column =
          Eigen::Matrix<double, kGradientSize<kKind>, kDimension>::Zero();
      for (int d = 0; d < kDimension; ++d) {
        of_column += point.volume * point.gradient(d, j) *
                     tangent.middleCols<kDimension>(kDimension * d);
      }
      for (int i = 0; i < kNodes; ++i) {
        if (nodes[i] < nodes[j]) {
          continue;
        }
        Block block = Block::Zero();
        for (int c = 0; c < kDimension; ++c) {
          block += point.gradient(c, i) *
                   of_column.template middleRows<kDimension>(kDimension * c);
        }
        blocks.middleCols<kDimension>(
            kDimension *
            Eigen::Index(graph.element_pairs(NodeGraph::LocalPair(i, j), e))) +=
            frame * block * frame.transpose();
      }
    }
  };
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int material = material_of_element[e];
    const Frame<kKind> frame = frames.Of<kDimension>(material, e);
    VisitPoints<kKind>(
        mesh, e, StiffnessRule<kKind>(), [&](const auto& point, const auto&) {
          add(SeenIn<kKind>(frame, point), frame, tangents[material], e);
        });
  }
}

// A combination of H and J as one of H and M: c_0 H + c_1 J = of_h H + of_m M.
struct IsotropicCombination {
  IsotropicCombination(const Mesh& mesh, const Eigen::Vector2d& coefficients)
      : of_h(coefficients(0) -
             ShearShareOfJ(mesh.section.model) * coefficients(1)),
        of_m(coefficients(1)) {}

  // Adds the block that follows from a block of M.
  template <class Products, class Block>
  void Add(const Products& products, Block block) const {
    block += of_h / 2 * products.transpose() + of_m * products;
    block.diagonal().array() += of_h / 2 * products.trace();
  }

  double of_h;
  double of_m;
};

template <ElementKind kKind>
void AddIsotropicBlocksOfKind(const Mesh& mesh, const NodeGraph& graph,
                              const Eigen::Matrix2Xd& coefficients,
                              Eigen::MatrixXd& blocks) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  constexpr int kNodes = ElementSizes<kKind>::kNodes;
  constexpr int kRows = kDimension * kNodes;
  const auto& rule = StiffnessRule<kKind>();
  // The gradients at each point of an element, and their products M.
  Eigen::Matrix<double, kRows, Eigen::Dynamic> gradients(kRows, rule.size());
  Eigen::VectorXd volumes(rule.size());
  Eigen::Matrix<double, kRows, kRows> products;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    Eigen::Index next = 0;
    VisitPoints<kKind>(mesh, e, rule, [&](const auto& point, const auto&) {
      gradients.col(next) = point.gradient.reshaped();
      volumes(next++) = point.volume;
    });
    products.noalias() =
        (gradients * volumes.asDiagonal()).lazyProduct(gradients.transpose());
    const IsotropicCombination combination(mesh, coefficients.col(e));
    const int* const nodes = mesh.elements.col(e).data();
    for (int i = 0; i < kNodes; ++i) {
      for (int j = 0; j <= i; ++j) {
        const int row = nodes[i] >= nodes[j] ? i : j;
        const int column = i + j - row;
        combination.Add(products.template block<kDimension, kDimension>(
                            kDimension * row, kDimension * column),
                        blocks.middleCols<kDimension>(
                            kDimension * Eigen::Index(graph.element_pairs(
                                             NodeGraph::LocalPair(i, j), e))));
      }
    }
  }
}

// Calls visit(e, i, M) with M = integral of grad(N_i) grad(N_i)^T over element
// e, for each of its nodes i.
template <ElementKind kKind, class Visitor>
void VisitOwnProducts(const Mesh& mesh, const Visitor& visit) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  constexpr int kNodes = ElementSizes<kKind>::kNodes;
  std::array<Frame<kKind>, kNodes> products;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    products.fill(Frame<kKind>::Zero());
    VisitPoints<kKind>(
        mesh, e, StiffnessRule<kKind>(), [&](const auto& point, const auto&) {
          for (int i = 0; i < kNodes; ++i) {
            const Eigen::Matrix<double, kDimension, 1> scaled =
                point.volume * point.gradient.col(i);
            products[i].noalias() += scaled * point.gradient.col(i).transpose();
          }
        });
    for (int i = 0; i < kNodes; ++i) {
      visit(e, i, products[i]);
    }
  }
}

// Adds K_ii,ab = sum_cd M_cd C_(ac)(bd), with M as seen in the frame.
template <ElementKind kKind>
void AddDiagonalOfKind(const Mesh& mesh,
                       const std::vector<int>& material_of_element,
                       const MaterialFrames& frames,
                       const std::vector<Eigen::MatrixXd>& tangents,
                       Eigen::MatrixXd& blocks) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  VisitOwnProducts<kKind>(mesh, [&](Eigen::Index e, int i,
                                    const Frame<kKind>& products) {
    const int material = material_of_element[e];
    const Frame<kKind> frame = frames.Of<kDimension>(material, e);
    const Frame<kKind> seen = frame.transpose() * products * frame;
    Frame<kKind> block = Frame<kKind>::Zero();
    for (int c = 0; c < kDimension; ++c) {
      for (int d = 0; d < kDimension; ++d) {
        block += seen(c, d) * tangents[material].block<kDimension, kDimension>(
                                  kDimension * c, kDimension * d);
      }
    }
    blocks.middleCols<kDimension>(kDimension *
                                  Eigen::Index(mesh.elements(i, e))) +=
        frame * block * frame.transpose();
  });
}

template <ElementKind kKind>
void AddIsotropicDiagonalOfKind(const Mesh& mesh,
                                const Eigen::Matrix2Xd& coefficients,
                                Eigen::MatrixXd& blocks) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  VisitOwnProducts<kKind>(
      mesh, [&](Eigen::Index e, int i, const Frame<kKind>& products) {
        IsotropicCombination(mesh, coefficients.col(e))
            .Add(products, blocks.middleCols<kDimension>(
                               kDimension * Eigen::Index(mesh.elements(i, e))));
      });
}

template <ElementKind kKind>
Eigen::VectorXd EnergyDensityOfKind(
    const Mesh& mesh, const std::vector<int>& material_of_element,
    const MaterialFrames& frames, const std::vector<Eigen::MatrixXd>& tangents,
    const Eigen::VectorXd& displacement) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  Eigen::VectorXd density(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int material = material_of_element[e];
    const Frame<kKind> frame = frames.Of<kDimension>(material, e);
    const auto u = GatherNodes<kKind>(mesh, e, displacement.data());
    const Eigen::Map<const TangentMatrix<kKind>> tangent(
        tangents[material].data());
    double energy = 0;
    double volume = 0;
    VisitPoints<kKind>(
        mesh, e, StiffnessRule<kKind>(), [&](const auto& point, const auto&) {
          const Eigen::Matrix<double, kDimension, kDimension> gradient =
              frame.transpose() * u * point.gradient.transpose() * frame;
          const Eigen::Map<const Eigen::Matrix<double, kGradientSize<kKind>, 1>>
              h(gradient.data());
          energy += point.volume / 2 * h.dot(tangent * h);
          volume += point.volume;
        });
    density(e) = energy / volume;
  }
  return density;
}

}  // namespace

void AddLawProducts(const Mesh& mesh,
                    const std::vector<int>& material_of_element,
                    const MaterialFrames& frames,
                    const std::vector<std::vector<Eigen::MatrixXd>>& tangents,
                    const Eigen::MatrixXd& displacement,
                    std::vector<Eigen::MatrixXd>& products) {
  VisitElementKind(mesh.kind, [&](auto kind) {
    AddOfKind<kind>(mesh, material_of_element, frames, tangents, displacement,
                    products);
  });
}

Eigen::VectorXd LawEnergyDensity(const Mesh& mesh,
                                 const std::vector<int>& material_of_element,
                                 const MaterialFrames& frames,
                                 const std::vector<Eigen::MatrixXd>& tangents,
                                 const Eigen::VectorXd& displacement) {
  return VisitElementKind(mesh.kind, [&](auto kind) {
    return EnergyDensityOfKind<kind>(mesh, material_of_element, frames,
                                     tangents, displacement);
  });
}

Eigen::MatrixXd StiffnessBlocks(const Mesh& mesh, const NodeGraph& graph,
                                const std::vector<int>& material_of_element,
                                const MaterialFrames& frames,
                                const std::vector<Eigen::MatrixXd>& tangents) {
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(
      mesh.Dimension(), mesh.Dimension() * graph.NumPairs());
  VisitElementKind(mesh.kind, [&](auto kind) {
    AddBlocksOfKind<kind>(mesh, graph, material_of_element, frames, tangents,
                          blocks);
  });
  return blocks;
}

Eigen::MatrixXd StiffnessBlocks(const Mesh& mesh, const NodeGraph& graph,
                                const Eigen::Matrix2Xd& coefficients) {
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(
      mesh.Dimension(), mesh.Dimension() * graph.NumPairs());
  VisitElementKind(mesh.kind, [&](auto kind) {
    AddIsotropicBlocksOfKind<kind>(mesh, graph, coefficients, blocks);
  });
  return blocks;
}

Eigen::MatrixXd DiagonalStiffnessBlocks(const Mesh& mesh,
                                        const Eigen::Matrix2Xd& coefficients) {
  Eigen::MatrixXd blocks =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.NumDofs());
  VisitElementKind(mesh.kind, [&](auto kind) {
    AddIsotropicDiagonalOfKind<kind>(mesh, coefficients, blocks);
  });
  return blocks;
}

Eigen::MatrixXd DiagonalStiffnessBlocks(
    const Mesh& mesh, const std::vector<int>& material_of_element,
    const MaterialFrames& frames,
    const std::vector<Eigen::MatrixXd>& tangents) {
  Eigen::MatrixXd blocks =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.NumDofs());
  VisitElementKind(mesh.kind, [&](auto kind) {
    AddDiagonalOfKind<kind>(mesh, material_of_element, frames, tangents,
                            blocks);
  });
  return blocks;
}

}  // namespace elastimate
