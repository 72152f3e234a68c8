#include "elastimate/core/mechanics/tet10_stiffness_product.h"

#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/mesh/tet10.h"

namespace elastimate {
namespace {

// One column of one element.
void AddColumn(const Mesh& mesh, Eigen::Index e,
               const TetrahedronGradients& element, const double* q, double* a,
               double* p) {
  const Eigen::Matrix<double, 3, 4>& g = element.gradient;
  const QuadraticDisplacementGradient gradient(
      GatherNodes<ElementKind::kTet10>(mesh, e, q), g);
  const auto node = [&](double* values, int i) {
    return Eigen::Map<Eigen::Vector3d>(values +
                                       3 * Eigen::Index(mesh.elements(i, e)));
  };
  const Eigen::Matrix3d mean =
      (element.volume / 2) * (gradient.mean + gradient.mean.transpose());
  const double mean_trace = mean.trace();
  std::array<Eigen::Matrix3d, 4> t;
  std::array<double, 4> trace;
  for (int i = 0; i < 4; ++i) {
    t[i] = 0.8 * mean +
           (element.volume / 10) *
               (gradient.at_vertex[i] + gradient.at_vertex[i].transpose());
    trace[i] = t[i].trace();
    node(a, i) += (t[i] - mean) * g.col(i);
    node(p, i) += (trace[i] - mean_trace) * g.col(i);
  }
  for (int i = 0; i < 6; ++i) {
    const int k = kTetrahedronEdges[i][0];
    const int l = kTetrahedronEdges[i][1];
    node(a, 4 + i) += t[k] * g.col(l) + t[l] * g.col(k);
    node(p, 4 + i) += trace[k] * g.col(l) + trace[l] * g.col(k);
  }
}

}  // namespace

void AddQuadraticStrainProducts(const Mesh& mesh,
                                const Eigen::MatrixXd& displacement,
                                Eigen::MatrixXd& a, Eigen::MatrixXd& p) {
  const Eigen::Index rows = displacement.rows();
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const TetrahedronGradients element(GatherTetrahedron(mesh, e));
    for (Eigen::Index column = 0; column < displacement.cols(); ++column) {
      const Eigen::Index offset = column * rows;
      AddColumn(mesh, e, element, displacement.data() + offset,
                a.data() + offset, p.data() + offset);
    }
  }
}

}  // namespace elastimate
