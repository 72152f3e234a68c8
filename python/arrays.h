#ifndef ELASTIMATE_PYTHON_ARRAYS_H_
#define ELASTIMATE_PYTHON_ARRAYS_H_

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>
#include <string>

namespace elastimate {

// numpy's arrays of shape (n, d) in the order of rows have the bytes of Eigen's
// d x n matrices in the order of columns, so that neither is rearranged.

/// An array of the caller; numpy converts others to it.
template <class T>
using Array =
    pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// Returns the d x n matrix that has the bytes of an array of shape (n, d).
/// The array has to outlive it.
template <class T>
auto ColumnsOf(const Array<T>& rows) {
  if (rows.ndim() != 2) {
    throw std::invalid_argument(
        "an array has " + std::to_string(rows.ndim()) +
        " dimensions where it needs two; give one row for each node, element, "
        "facet or point");
  }
  return Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>>(
      rows.data(), rows.shape(1), rows.shape(0));
}

/// Returns a matrix d x n as a read-only array of shape (n, d) that shares its
/// memory.  `owner` keeps that memory.
template <class Matrix>
pybind11::array RowsOf(const Matrix& columns, const pybind11::handle& owner) {
  using T = typename Matrix::Scalar;
  pybind11::array_t<T> rows({columns.cols(), columns.rows()}, columns.data(),
                            owner);
  pybind11::detail::array_proxy(rows.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return std::move(rows);
}

/// Returns a copy of a matrix d x n as an array of shape (n, d).
inline pybind11::array CopiedRows(const Eigen::MatrixXd& columns) {
  pybind11::array_t<double> rows({columns.cols(), columns.rows()});
  std::copy_n(columns.data(), columns.size(), rows.mutable_data());
  return std::move(rows);
}

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_ARRAYS_H_
