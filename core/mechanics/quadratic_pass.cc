#include "elastimate/core/mechanics/quadratic_pass.h"

#include <hwy/aligned_allocator.h>

#include <new>

#include "elastimate/core/laws/elasticity.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kMostLanes = 8;

using Records = hwy::AlignedFreeUniquePtr<double[]>;

Records AllocateRecords(Eigen::Index size) {
  Records records = hwy::AllocateAligned<double>(std::size_t(size));
  if (!records) {
    throw std::bad_alloc();
  }
  return records;
}

// Copies the values of each node to the first of its record, with zeros behind.
// Loops of a length that the compiler knows become vectors rather than calls.
template <int kDimension, Eigen::Index kSize>
void FillNodeRecords(const double* values, Eigen::Index num_nodes,
                     double* records) {
  for (Eigen::Index i = 0; i < num_nodes;
       ++i, records += kSize, values += kDimension) {
    double first[kDimension];
    for (int k = 0; k < kDimension; ++k) {
      first[k] = values[k];
    }
    for (int k = 0; k < kDimension; ++k) {
      records[k] = first[k];
    }
    for (Eigen::Index k = kDimension; k < kSize; ++k) {
      records[k] = 0;
    }
  }
}

// Calls collect(column, records) for one column after the other.
template <int kDimension, Eigen::Index kSize, class Collect>
void RunInColumns(const Mesh& mesh, const double* coefficients_of_a,
                  const double* coefficients_of_p,
                  const Eigen::MatrixXd& displacement, const RunPass& run,
                  const Collect& collect) {
  const Eigen::Index num_nodes = mesh.NumNodes();
  const Records records = AllocateRecords(kSize * num_nodes);
  QuadraticPass pass;
  pass.elements = mesh.elements.data();
  pass.num_elements = mesh.NumElements();
  pass.positions = mesh.nodes.data();
  pass.thickness = mesh.section.thickness;
  pass.coefficients_of_a = coefficients_of_a;
  pass.coefficients_of_p = coefficients_of_p;
  pass.records = records.get();
  for (Eigen::Index column = 0; column < displacement.cols(); ++column) {
    FillNodeRecords<kDimension, kSize>(displacement.col(column).data(),
                                       num_nodes, records.get());
    run(pass);
    collect(column, records.get());
  }
}

template <int kDimension>
void SetProducts(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                 const RunPass& run, StiffnessProducts& products) {
  const double share = ShearShareOfJ(mesh.section.model);
  RunInColumns<kDimension, kSizeForProducts>(
      mesh, nullptr, nullptr, displacement, run,
      [&](Eigen::Index column, const double* record) {
        double* h = products.h.col(column).data();
        double* j = products.j.col(column).data();
        for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
          for (int k = 0; k < kDimension; ++k) {
            const double a = record[kFour + k];
            h[k] = a;
            j[k] = record[2 * kFour + k] - share * a;
          }
          record += kSizeForProducts;
          h += kDimension;
          j += kDimension;
        }
      });
}

template <int kDimension>
void SetSum(const Mesh& mesh, const Eigen::VectorXd& of_a,
            const Eigen::VectorXd& of_p, const Eigen::MatrixXd& displacement,
            const RunPass& run, Eigen::MatrixXd& forces) {
  RunInColumns<kDimension, kSizeForSum>(
      mesh, of_a.data(), of_p.data(), displacement, run,
      [&](Eigen::Index column, const double* record) {
        double* force = forces.col(column).data();
        for (Eigen::Index i = 0; i < mesh.NumNodes(); ++i) {
          for (int k = 0; k < kDimension; ++k) {
            force[k] = record[kFour + k];
          }
          record += kSizeForSum;
          force += kDimension;
        }
      });
}

}  // namespace

void MultiplyByPass(const Mesh& mesh, const Eigen::MatrixXd& displacement,
                    const RunPass& run, StiffnessProducts& products) {
  products.h.resize(displacement.rows(), displacement.cols());
  products.j.resize(displacement.rows(), displacement.cols());
  if (mesh.Dimension() == 3) {
    SetProducts<3>(mesh, displacement, run, products);
  } else {
    SetProducts<2>(mesh, displacement, run, products);
  }
}

Eigen::MatrixXd MultiplyByPass(const Mesh& mesh,
                               const Eigen::Matrix2Xd& coefficients,
                               const Eigen::MatrixXd& displacement,
                               const RunPass& run) {
  // J q = p - share a.
  Eigen::VectorXd of_a = Eigen::VectorXd::Zero(mesh.NumElements() + kMostLanes);
  Eigen::VectorXd of_p = of_a;
  of_a.head(mesh.NumElements()) =
      coefficients.row(0) -
      ShearShareOfJ(mesh.section.model) * coefficients.row(1);
  of_p.head(mesh.NumElements()) = coefficients.row(1);
  Eigen::MatrixXd forces(displacement.rows(), displacement.cols());
  if (mesh.Dimension() == 3) {
    SetSum<3>(mesh, of_a, of_p, displacement, run, forces);
  } else {
    SetSum<2>(mesh, of_a, of_p, displacement, run, forces);
  }
  return forces;
}

}  // namespace elastimate
