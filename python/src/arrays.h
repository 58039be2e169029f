// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "borrow.h"
#include <fresco/core/image.h>
#include <functional>
#include <memory>
#include <pybind11/numpy.h>
#include <string>
#include <vector>
namespace fresco::python {
namespace py = pybind11;

/// Keeps what a call borrows from Python until the call is over. Made and destroyed with the GIL held.
class Lender {
public:
  Lender() = default;
  ~Lender();
  Lender(const Lender&) = delete;
  Lender& operator=(const Lender&) = delete;

  /// `matrix`, which is empty and stays where it is, stands on the memory of `array`; on a copy where that is not aligned.
  /// @param array C-contiguous, of the matrix's scalar, a row per column of the matrix
  template <typename Matrix>
  void lend(Matrix& matrix, const py::array& array)
  {
    const Index count = array.shape(0);
    if (reinterpret_cast<std::uintptr_t>(array.data()) % matrix_alignment != 0) {
      matrix = Eigen::Map<const Matrix, Eigen::Unaligned>(static_cast<const typename Matrix::Scalar*>(array.data()),
                                                          matrix.rows(), count);
      return;
    }
    borrow(matrix, array.data(), count);
    kept_.push_back(array);
    returns_.emplace_back([&matrix] { giveBack(matrix); });
  }

private:
  std::vector<py::object> kept_;
  std::vector<std::function<void()>> returns_;
};

/// `value` as an array of that type in C order that can be written: without a copy where it is one. Numbers of other types
/// are converted where the type holds them; fractions of 0..1 become bytes of 0..255. None is an array without rows.
/// @param name  of the argument, for messages
/// @param width values per row; 1 = a flat array
/// @throws py::type_error if it holds no numbers, or fractions where whole ones are wanted
/// @throws py::value_error if its shape is another, or a value is out of range
py::array checkedArray(py::handle value, const std::string& name, const py::dtype& type, Index width);

/// An array that owns `matrix`, without a copy: a row per column.
template <typename Matrix>
py::array toArray(Matrix&& matrix)
{
  using Plain = std::decay_t<Matrix>;
  using Scalar = typename Plain::Scalar;
  std::vector<py::ssize_t> shape{matrix.cols(), matrix.rows()};
  if constexpr (Plain::ColsAtCompileTime == 1)
    shape = {matrix.rows()};
  auto owned = std::make_unique<Plain>(std::forward<Matrix>(matrix));
  const Scalar* const data = owned->data();
  const py::capsule owner(owned.release(), [](void* kept) { delete static_cast<Plain*>(kept); });
  return py::array(py::dtype::of<Scalar>(), std::move(shape), data, owner);
}

/// An array of int64 that owns `values`, without a copy.
py::array toArray(std::vector<Index>&& values);

/// (height, width, channels), or (height, width) for grey, uint8, without a copy.
py::array toArray(Image&& image);

/// A copy; None is an empty image.
/// @param value uint8 (height, width) grey, or (height, width, 1, 3 or 4)
Image toImage(py::handle value, const std::string& name);

/// A matrix of doubles from anything that numpy takes for one.
/// @throws py::value_error if the shape is another
Eigen::MatrixXd toMatrix(py::handle value, const std::string& name, Index rows, Index columns);

/// (rows, columns) float64, or (rows) of a vector.
py::array fromMatrix(const Eigen::MatrixXd& matrix);
} // namespace fresco::python
