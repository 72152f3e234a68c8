#include "elastimate/core/mesh/finer_nodes.h"

#include <algorithm>
#include <vector>

#include "elastimate/core/algebra/tall_columns.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

// Adds the weights of the nodes of an element at the middle of some of its
// nodes.
void AddWeights(const Mesh& mesh, Eigen::Index element,
                const std::vector<int>& around, Eigen::Index row,
                Entries& weights) {
  if (mesh.Order() == 1) {
    for (const int node : around) {
      weights.emplace_back(int(row), node, 1 / double(around.size()));
    }
    return;
  }
  const auto nodes = mesh.elements.col(element);
  const Eigen::MatrixXd reference = ReferenceNodes(mesh.kind);
  Eigen::VectorXd middle = Eigen::VectorXd::Zero(reference.rows());
  for (const int node : around) {
    middle += reference.col(std::find(nodes.begin(), nodes.end(), node) -
                            nodes.begin()) /
              double(around.size());
  }
  const Eigen::VectorXd values = ShapeFunctionsOf(
      mesh, {Eigen::VectorXi::Constant(1, int(element)), middle});
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values(i) != 0) {
      weights.emplace_back(int(row), nodes(i), values(i));
    }
  }
}

}  // namespace

FinerNodes::FinerNodes(const Mesh& mesh, const Mesh& finer)
    : dimension_(mesh.Dimension()),
      weights_(finer.NumNodes() - mesh.NumNodes(), mesh.NumNodes()) {
  const ElementTopology& topology = finer.Topology();
  const Eigen::Index num_cuts = finer.NumElements() / mesh.NumElements();
  std::vector<bool> is_known(std::size_t(weights_.rows()), false);
  Entries weights;
  std::vector<int> around;
  for (Eigen::Index e = 0; e < finer.NumElements(); ++e) {
    for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
      const Eigen::Index row = finer.elements(i, e) - mesh.NumNodes();
      if (!is_known[row]) {
        is_known[row] = true;
        around.clear();
        for (const int place : topology.middles[i - topology.num_vertices]) {
          around.push_back(finer.elements(place, e));
        }
        AddWeights(mesh, e / num_cuts, around, row, weights);
      }
    }
  }
  weights_.setFromTriplets(weights.begin(), weights.end());
}

// These loops run by rows, since Eigen spreads products of matrices over
// threads that wait for each other longer than they work.

namespace {

template <int kDimension>
void InterpolateColumn(const FinerNodes::Weights& weights,
                       const double* at_nodes, double* at_middles) {
  using Values = Eigen::Matrix<double, kDimension, 1>;
  ForRowBlocks(weights.rows(), [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index row = first; row < first + count; ++row) {
      Values sum = Values::Zero();
      for (FinerNodes::Weights::InnerIterator weight(weights, row); weight;
           ++weight) {
        sum += weight.value() *
               Eigen::Map<const Values>(at_nodes + kDimension * weight.col());
      }
      Eigen::Map<Values>(at_middles + kDimension * row) = sum;
    }
  });
}

template <int kDimension>
void RestrictColumn(const FinerNodes::Weights& weights,
                    const double* at_middles, double* on_nodes) {
  using Values = Eigen::Matrix<double, kDimension, 1>;
  for (Eigen::Index row = 0; row < weights.rows(); ++row) {
    const Values of_row =
        Eigen::Map<const Values>(at_middles + kDimension * row);
    for (FinerNodes::Weights::InnerIterator weight(weights, row); weight;
         ++weight) {
      Eigen::Map<Values>(on_nodes + kDimension * weight.col()) +=
          weight.value() * of_row;
    }
  }
}

}  // namespace

Eigen::MatrixXd FinerNodes::Interpolate(const Eigen::MatrixXd& at_nodes) const {
  const Eigen::Index first = dimension_ * NumNodes();
  Eigen::MatrixXd all(first + dimension_ * NumMiddles(), at_nodes.cols());
  all.topRows(first) = at_nodes;
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    double* const values = all.col(k).data();
    if (dimension_ == 3) {
      InterpolateColumn<3>(weights_, values, values + first);
    } else {
      InterpolateColumn<2>(weights_, values, values + first);
    }
  }
  return all;
}

Eigen::MatrixXd FinerNodes::Restrict(const Eigen::MatrixXd& forces) const {
  const Eigen::Index first = dimension_ * NumNodes();
  Eigen::MatrixXd on_nodes = forces.topRows(first);
  for (Eigen::Index k = 0; k < forces.cols(); ++k) {
    const double* const at_middles = forces.col(k).data() + first;
    if (dimension_ == 3) {
      RestrictColumn<3>(weights_, at_middles, on_nodes.col(k).data());
    } else {
      RestrictColumn<2>(weights_, at_middles, on_nodes.col(k).data());
    }
  }
  return on_nodes;
}

}  // namespace elastimate
