#include "benchmarks/naive_stiffness_product.h"

#include <cmath>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

template <ElementKind kKind>
class Textbook {
 public:
  static constexpr int kDimension = ElementSizes<kKind>::kDimension;
  static constexpr int kNodes = ElementSizes<kKind>::kNodes;
  static constexpr int kStrains = kDimension == 3 ? 6 : 3;
  static constexpr int kDofs = kDimension * kNodes;
  using ElasticityMatrix = Eigen::Matrix<double, kStrains, kStrains>;
  using StrainDisplacement = Eigen::Matrix<double, kStrains, kDofs>;
  using ElementMatrix = Eigen::Matrix<double, kDofs, kDofs>;
  using ElementVector = Eigen::Matrix<double, kDofs, 1>;

  explicit Textbook(const Mesh& mesh) : mesh_(mesh) {
    constexpr int kShears = kStrains - kDimension;
    const double c = ShearShareOfJ(mesh.section.model);
    d_h_.setIdentity();
    d_h_.template bottomRightCorner<kShears, kShears>() *= 0.5;
    d_j_ = -c * d_h_;
    d_j_.template topLeftCorner<kDimension, kDimension>().array() += 1;
  }

  StiffnessProducts Multiply(const Eigen::VectorXd& displacement) const {
    StiffnessProducts products;
    products.h = Eigen::VectorXd::Zero(displacement.size());
    products.j = Eigen::VectorXd::Zero(displacement.size());
    for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
      ElementMatrix h;
      ElementMatrix j;
      bool is_first = true;
      VisitPoints<kKind>(mesh_, e, StiffnessRule<kKind>(),
                         [&](const ElementPoint<kKind>& point, const auto&) {
                           const StrainDisplacement b =
                               StrainDisplacementOf(point);
                           AddElementMatrix(b, d_h_, point.volume, is_first, h);
                           AddElementMatrix(b, d_j_, point.volume, is_first, j);
                           is_first = false;
                         });
      ElementVector q;
      for (int i = 0; i < kNodes; ++i) {
        q.template segment<kDimension>(kDimension * i) =
            displacement.segment<kDimension>(RowOf(e, i));
      }
      const ElementVector a = h * q;
      const ElementVector p = j * q;
      for (int i = 0; i < kNodes; ++i) {
        products.h.middleRows<kDimension>(RowOf(e, i)) +=
            a.template segment<kDimension>(kDimension * i);
        products.j.middleRows<kDimension>(RowOf(e, i)) +=
            p.template segment<kDimension>(kDimension * i);
      }
    }
    return products;
  }

 private:
  Eigen::Index RowOf(Eigen::Index element, int i) const {
    return kDimension * Eigen::Index(mesh_.elements(i, element));
  }

  static StrainDisplacement StrainDisplacementOf(
      const ElementPoint<kKind>& point) {
    StrainDisplacement b = StrainDisplacement::Zero();
    for (int i = 0; i < kNodes; ++i) {
      for (int k = 0; k < kDimension; ++k) {
        b(k, kDimension * i + k) = point.gradient(k, i);
      }
      for (int k = 0; k < kStrains - kDimension; ++k) {
        const int l = (k + 1) % kDimension;
        b(kDimension + k, kDimension * i + k) = point.gradient(l, i);
        b(kDimension + k, kDimension * i + l) = point.gradient(k, i);
      }
    }
    return b;
  }

  // V B^T D B.  The lazy products are those that Eigen unrolls; for small sizes
  // it would otherwise pack blocks as for large matrices, which takes longer.
  static void AddElementMatrix(const StrainDisplacement& b,
                               const ElasticityMatrix& d, double volume,
                               bool is_first, ElementMatrix& matrix) {
    const StrainDisplacement stress = volume * d.lazyProduct(b);
    if (is_first) {
      matrix = b.transpose().lazyProduct(stress);
    } else if constexpr (kDofs <= 12) {
      matrix += b.transpose().lazyProduct(stress);
    } else {
      matrix.noalias() += b.transpose() * stress;
    }
  }

  const Mesh& mesh_;
  ElasticityMatrix d_h_;
  ElasticityMatrix d_j_;
};

}  // namespace

StiffnessProducts MultiplyNaively(const Mesh& mesh,
                                  const Eigen::VectorXd& displacement) {
  return VisitElementKind(mesh.kind, [&](auto kind) {
    return Textbook<kind>(mesh).Multiply(displacement);
  });
}

}  // namespace elastimate
