#include "elastimate/core/mechanics/element_stiffness_product.h"

#include <vector>

#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

template <ElementKind kKind>
using NodeVectors = Eigen::Matrix<double, ElementSizes<kKind>::kDimension,
                                  ElementSizes<kKind>::kNodes>;

// Adds `of_element` to the values of the nodes of an element.
template <ElementKind kKind>
void Scatter(const NodeVectors<kKind>& of_element, const int* nodes,
             double* values) {
  constexpr int kDimension = ElementSizes<kKind>::kDimension;
  for (int i = 0; i < ElementSizes<kKind>::kNodes; ++i) {
    Eigen::Map<Eigen::Matrix<double, kDimension, 1>>(
        values + kDimension * Eigen::Index(nodes[i])) += of_element.col(i);
  }
}

// The contributions of one column to the nodes of an element.
template <ElementKind kKind>
struct ElementProducts {
  NodeVectors<kKind> of_strain = NodeVectors<kKind>::Zero();
  NodeVectors<kKind> of_trace = NodeVectors<kKind>::Zero();

  void Add(const ElementPoint<kKind>& point, const NodeVectors<kKind>& u) {
    constexpr int kDimension = ElementSizes<kKind>::kDimension;
    Eigen::Matrix<double, kDimension, kDimension> gradient;
    gradient.noalias() = u * point.gradient.transpose();
    const double trace = point.volume * gradient.trace();
    const Eigen::Matrix<double, kDimension, kDimension> strain =
        (point.volume / 2) * (gradient + gradient.transpose());
    of_strain.noalias() += strain * point.gradient;
    of_trace.noalias() += trace * point.gradient;
  }
};

// Adds the products of one column, for which the points need not be kept.
template <ElementKind kKind>
void AddColumnOfKind(const Mesh& mesh, const double* displacement, double* a,
                     double* p) {
  const auto& rule = StiffnessRule<kKind>();
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const NodeVectors<kKind> u = GatherNodes<kKind>(mesh, e, displacement);
    ElementProducts<kKind> products;
    VisitPoints<kKind>(mesh, e, rule, [&](const auto& point, const auto&) {
      products.Add(point, u);
    });
    const int* const nodes = mesh.elements.col(e).data();
    Scatter<kKind>(products.of_strain, nodes, a);
    Scatter<kKind>(products.of_trace, nodes, p);
  }
}

template <ElementKind kKind>
void AddColumnsOfKind(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                      Eigen::MatrixXd& a, Eigen::MatrixXd& p) {
  const auto& rule = StiffnessRule<kKind>();
  std::vector<ElementPoint<kKind>> points;
  points.reserve(rule.size());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    points.clear();
    VisitPoints<kKind>(mesh, e, rule, [&](const auto& point, const auto&) {
      points.push_back(point);
    });
    const int* const nodes = mesh.elements.col(e).data();
    for (Eigen::Index column = 0; column < displacement.cols(); ++column) {
      const NodeVectors<kKind> u =
          GatherNodes<kKind>(mesh, e, displacement.col(column).data());
      ElementProducts<kKind> products;
      for (const ElementPoint<kKind>& point : points) {
        products.Add(point, u);
      }
      Scatter<kKind>(products.of_strain, nodes, a.col(column).data());
      Scatter<kKind>(products.of_trace, nodes, p.col(column).data());
    }
  }
}

}  // namespace

void AddStrainProducts(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                       Eigen::MatrixXd& a, Eigen::MatrixXd& p) {
  VisitElementKind(mesh.kind, [&](auto kind) {
    if (displacement.cols() == 1) {
      AddColumnOfKind<kind>(mesh, displacement.data(), a.data(), p.data());
    } else {
      AddColumnsOfKind<kind>(mesh, displacement, a, p);
    }
  });
}

}  // namespace elastimate
