#include "elastimate/estimators/force_balance/virtual_work.h"

#include <algorithm>
#include <cassert>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/row_block_qr.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/estimators/force_balance/monomials.h"

namespace elastimate {
namespace {

// Relative to the largest, the forces of a motion without strain are rounding.
// What is not rounding is far larger.
constexpr double kRoundingOfWork = 1e-10;

// An orthonormal basis of the polynomials times each window on the nodes where
// `component` is free, zero elsewhere: num_nodes x m.
Eigen::MatrixXd OrthonormalPolynomials(const Mesh& mesh,
                                       const Supports& supports, int component,
                                       int degree,
                                       const Eigen::MatrixXd& windows) {
  std::vector<Eigen::Index> free_nodes;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if (!supports.held(component, node)) {
      free_nodes.push_back(node);
    }
  }
  if (free_nodes.empty()) {
    return Eigen::MatrixXd(mesh.NumNodes(), 0);
  }
  const Eigen::MatrixXd monomials =
      Monomials(mesh.nodes(Eigen::all, free_nodes), degree);
  const Eigen::Index count = monomials.cols();
  Eigen::MatrixXd all(monomials.rows(), count * windows.cols());
  for (Eigen::Index i = 0; i < windows.cols(); ++i) {
    all.middleCols(count * i, count) =
        windows(free_nodes, i).asDiagonal() * monomials;
  }
  const Eigen::MatrixXd on_free_nodes =
      OrthonormalBasis(all, kDependentMonomial);
  Eigen::MatrixXd basis =
      Eigen::MatrixXd::Zero(mesh.NumNodes(), on_free_nodes.cols());
  basis(free_nodes, Eigen::all) = on_free_nodes;
  return basis;
}

// A patch has so many inner nodes, whose numbers follow each other.
constexpr Eigen::Index kNodesPerPatch = 8192;

// Returns, for each patch, the elements that have one of its inner nodes.
std::vector<std::vector<int>> ElementsOfPatches(const Mesh& mesh) {
  std::vector<std::vector<int>> elements(
      (mesh.NumNodes() - 1) / kNodesPerPatch + 1);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (const int corner : mesh.elements.col(e)) {
      std::vector<int>& of_patch = elements[corner / kNodesPerPatch];
      if (of_patch.empty() || of_patch.back() != int(e)) {
        of_patch.push_back(int(e));
      }
    }
  }
  return elements;
}

// Some elements as a mesh of its own.
struct Patch {
  Mesh mesh;
  /// The node in the whole mesh of each node of the patch.
  std::vector<Eigen::Index> nodes;
};

// `place` has -1 for each node of the mesh and is left so, because to fill it
// anew for each patch would take as long as to visit the whole mesh.
Patch PatchOf(const Mesh& mesh, const std::vector<int>& elements,
              std::vector<int>& place) {
  Patch patch;
  patch.mesh.kind = mesh.kind;
  patch.mesh.section = mesh.section;
  patch.mesh.elements = mesh.elements(Eigen::all, elements);
  for (int& corner : patch.mesh.elements.reshaped()) {
    if (place[corner] < 0) {
      place[corner] = static_cast<int>(patch.nodes.size());
      patch.nodes.push_back(corner);
    }
    corner = place[corner];
  }
  for (const Eigen::Index node : patch.nodes) {
    place[node] = -1;
  }
  patch.mesh.nodes = mesh.nodes(Eigen::all, patch.nodes);
  return patch;
}

// k0.
Eigen::Index NumColumns(const std::vector<Eigen::MatrixXd>& polynomials) {
  Eigen::Index columns = 0;
  for (const Eigen::MatrixXd& of_component : polynomials) {
    columns += of_component.cols();
  }
  return columns;
}

// The rows of fields that are given by component, at some nodes:
// num_dofs x k0.
Eigen::MatrixXd RowsOf(const std::vector<Eigen::MatrixXd>& polynomials,
                       const std::vector<Eigen::Index>& nodes) {
  const Eigen::Index dimension = Eigen::Index(polynomials.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(
      dimension * Eigen::Index(nodes.size()), NumColumns(polynomials));
  Eigen::Index column = 0;
  for (Eigen::Index i = 0; i < dimension; ++i) {
    const Eigen::Index count = polynomials[i].cols();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      rows.row(dimension * Eigen::Index(n) + i).segment(column, count) =
          polynomials[i].row(nodes[n]);
    }
    column += count;
  }
  return rows;
}

// The triangle of a QR factorisation of the free rows of [H V, J V], by patches
// of the mesh, so that memory does not grow with the mesh times the fields.
Eigen::MatrixXd StiffenedTriangle(
    const Mesh& mesh, const Supports& supports,
    const std::vector<Eigen::MatrixXd>& polynomials) {
  const Eigen::Index columns = NumColumns(polynomials);
  RowBlockQr qr(2 * columns);
  const std::vector<std::vector<int>> elements = ElementsOfPatches(mesh);
  std::vector<int> place(mesh.NumNodes(), -1);
  for (Eigen::Index p = 0; p < Eigen::Index(elements.size()); ++p) {
    const Patch patch = PatchOf(mesh, elements[p], place);
    const StiffnessProducts products =
        MultiplyStiffnessBasis(patch.mesh, RowsOf(polynomials, patch.nodes));
    for (std::size_t n = 0; n < patch.nodes.size(); ++n) {
      const Eigen::Index node = patch.nodes[n];
      for (int i = 0; i < mesh.Dimension(); ++i) {
        if (node / kNodesPerPatch == p && !supports.held(i, node)) {
          const Eigen::Index row = mesh.Dimension() * Eigen::Index(n) + i;
          qr.NextRow() << products.h.row(row), products.j.row(row);
        }
      }
    }
  }
  return qr.Triangle();
}

// The rows of one of `dimension` components, num_nodes x n, of num_dofs x n.
Eigen::MatrixXd ComponentRows(const Eigen::MatrixXd& all, std::size_t component,
                              std::size_t dimension) {
  return all(Eigen::seq(component, Eigen::last, dimension), Eigen::all);
}

}  // namespace

VirtualWork::VirtualWork(const Mesh& mesh, const Supports& supports, int degree,
                         const Eigen::MatrixXd& windows) {
  assert(degree >= 1 && degree <= 3);
  const Eigen::MatrixXd all_windows =
      windows.cols() > 0 ? windows : Eigen::MatrixXd::Ones(mesh.NumNodes(), 1);
  for (int i = 0; i < mesh.Dimension(); ++i) {
    polynomials_.push_back(
        OrthonormalPolynomials(mesh, supports, i, degree, all_windows));
  }
  const Eigen::MatrixXd triangle =
      StiffenedTriangle(mesh, supports, polynomials_);
  const Eigen::Index columns = triangle.cols() / 2;
  // H alone is the stiffness of nu = 0, so that what it does not resist is a
  // motion without strain.
  const SingularValueDecomposition svd =
      DecomposeSingularValues(triangle.topLeftCorner(columns, columns));
  const Eigen::Index rank =
      (svd.values.array() > kRoundingOfWork * svd.values(0)).count();
  fields_ = svd.v.leftCols(rank);
  free_motions_ = svd.v.rightCols(columns - rank);
  h_ = triangle.leftCols(columns) * fields_;
  j_ = triangle.rightCols(columns) * fields_;
}

Eigen::MatrixXd VirtualWork::Fields() const {
  std::vector<Eigen::Index> all(polynomials_[0].rows());
  for (std::size_t node = 0; node < all.size(); ++node) {
    all[node] = Eigen::Index(node);
  }
  return RowsOf(polynomials_, all) * fields_;
}

Eigen::MatrixXd VirtualWork::Of(const Eigen::MatrixXd& nodal_forces) const {
  Eigen::MatrixXd work(fields_.rows(), nodal_forces.cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < polynomials_.size(); ++i) {
    const Eigen::Index count = polynomials_[i].cols();
    work.middleRows(row, count) = InnerProducts(
        polynomials_[i], ComponentRows(nodal_forces, i, polynomials_.size()));
    row += count;
  }
  return fields_.transpose() * work;
}

double VirtualWork::Imbalance(const Eigen::MatrixXd& nodal_forces) const {
  if (free_motions_.cols() == 0) {
    return 0;
  }
  Eigen::MatrixXd work =
      Eigen::MatrixXd::Zero(free_motions_.cols(), nodal_forces.cols());
  Eigen::MatrixXd absolute_work = work;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < polynomials_.size(); ++i) {
    const Eigen::Index count = polynomials_[i].cols();
    const Eigen::MatrixXd motions =
        polynomials_[i] * free_motions_.middleRows(row, count);
    const Eigen::MatrixXd forces =
        ComponentRows(nodal_forces, i, polynomials_.size());
    work += InnerProducts(motions, forces);
    absolute_work += InnerProducts(motions.cwiseAbs(), forces.cwiseAbs());
    row += count;
  }
  return (absolute_work.array() > 0)
      .select(work.array().abs() / absolute_work.array(), 0)
      .maxCoeff();
}

}  // namespace elastimate
