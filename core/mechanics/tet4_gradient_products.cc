#include "elastimate/core/mechanics/tet4_gradient_products.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "elastimate/core/mesh/tet4.h"

// The rest of this file is compiled once for each kind of processor, and the
// best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/mechanics/tet4_gradient_products.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

#ifndef ELASTIMATE_CORE_LINEAR_FACTORS_
#define ELASTIMATE_CORE_LINEAR_FACTORS_
namespace elastimate {
namespace {

struct LinearFactors {
  Eigen::Matrix4d cofactor;  // c_i above zero, to be loaded whole.
  double scale;              // 1 / (6 |det J|).
};

// Elements, the first of which has these corners and pairs.
struct Elements {
  const LinearFactors* factors;
  const int* corners;
  const int* pairs;
  std::ptrdiff_t count;
};

}  // namespace
}  // namespace elastimate
#endif

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void AddOuterProducts(const Elements& elements, std::ptrdiff_t pair_mask,
                      double* products) {
  const hn::CappedTag<double, 4> d;
  const std::ptrdiff_t lanes = std::ptrdiff_t(hn::Lanes(d));
  const int* nodes = elements.corners;
  const int* pair = elements.pairs;
  for (std::ptrdiff_t e = 0; e < elements.count; ++e, nodes += 4) {
    const double* const cofactor = elements.factors[e].cofactor.data();
    const auto scale = hn::Set(d, elements.factors[e].scale);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j, ++pair) {
        // There is no branch here, since the order is as good as random.
        const int row = nodes[i] >= nodes[j] ? i : j;
        const int column = i + j - row;
        double* const block = products + 12 * (*pair & pair_mask);
        for (int component = 0; component < 3; ++component) {
          const auto weight =
              hn::Mul(scale, hn::Set(d, cofactor[4 * column + component]));
          for (std::ptrdiff_t k = 0; k < 4; k += lanes) {
            double* const sum = block + 4 * component + k;
            hn::StoreU(hn::MulAdd(hn::LoadU(d, cofactor + 4 * row + k), weight,
                                  hn::LoadU(d, sum)),
                       d, sum);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace elastimate {
namespace {

HWY_EXPORT(AddOuterProducts);

LinearFactors FactorsOf(const TetrahedronNodes& x) {
  const Eigen::Vector3d e1 = x.col(1) - x.col(0);
  const Eigen::Vector3d e2 = x.col(2) - x.col(0);
  const Eigen::Vector3d e3 = x.col(3) - x.col(0);
  const Eigen::Vector3d c1 = e2.cross(e3);
  const Eigen::Vector3d c2 = e3.cross(e1);
  const Eigen::Vector3d c3 = e1.cross(e2);
  LinearFactors factors;
  factors.cofactor << -(c1 + c2 + c3), c1, c2, c3, Eigen::RowVector4d::Zero();
  factors.scale = 1 / (6 * std::abs(e1.dot(c1)));
  return factors;
}

}  // namespace

void AddLinearGradientProducts(const Mesh& mesh, const NodeGraph& graph,
                               Eigen::Index first, Eigen::Index end,
                               Eigen::Index pair_mask,
                               Eigen::MatrixXd& products) {
  // In batches of this size the processor never waits for a value that it has
  // just written.
  constexpr Eigen::Index kElementsAtATime = 64;
  std::array<LinearFactors, kElementsAtATime> factors;
  const auto add_outer_products = HWY_DYNAMIC_DISPATCH(AddOuterProducts);
  for (; first < end; first += kElementsAtATime) {
    const Eigen::Index count = std::min(kElementsAtATime, end - first);
    for (Eigen::Index i = 0; i < count; ++i) {
      factors[i] = FactorsOf(GatherTetrahedron(mesh, first + i));
    }
    add_outer_products({factors.data(), mesh.elements.col(first).data(),
                        graph.element_pairs.col(first).data(), count},
                       pair_mask, products.data());
  }
}

}  // namespace elastimate
#endif
