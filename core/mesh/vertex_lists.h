#ifndef ELASTIMATE_CORE_MESH_VERTEX_LISTS_H_
#define ELASTIMATE_CORE_MESH_VERTEX_LISTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// Some lists of vertices of a mesh, such as the two ends of each edge.
class VertexLists {
 public:
  Eigen::Index Size() const { return Eigen::Index(start_.size()) - 1; }
  Eigen::Map<const Eigen::VectorXi> operator[](Eigen::Index i) const {
    return {vertices_.data() + start_[i], start_[i + 1] - start_[i]};
  }

  template <class List>
  void Add(const List& list) {
    vertices_.insert(vertices_.end(), list.begin(), list.end());
    start_.push_back(Eigen::Index(vertices_.size()));
  }

  /// Returns the mean over each list, one column for each, of values that are
  /// columns for each vertex.
  Eigen::MatrixXd MeansOf(const Eigen::MatrixXd& values) const {
    Eigen::MatrixXd means(values.rows(), Size());
    for (Eigen::Index i = 0; i < Size(); ++i) {
      means.col(i) = values(Eigen::all, (*this)[i]).rowwise().mean();
    }
    return means;
  }

 private:
  std::vector<Eigen::Index> start_ = {0};
  std::vector<int> vertices_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_VERTEX_LISTS_H_
