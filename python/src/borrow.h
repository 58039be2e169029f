// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/types.h>
/// Matrices that stand on the memory of others. The core takes sets and meshes whose matrices own their memory, and Eigen
/// has no public way to lend them some. Its private members are reached as the standard allows: names in an explicit
/// instantiation are not checked for access ([temp.spec]). A change in Eigen is an error of the compiler, not of the run.
namespace fresco::python {
namespace detail {
template <typename Matrix>
using Storage = Eigen::DenseStorage<typename Matrix::Scalar, Matrix::MaxSizeAtCompileTime, Matrix::RowsAtCompileTime,
                                    Matrix::ColsAtCompileTime, Matrix::Options>;

template <typename Matrix>
struct StorageOf : Matrix {
  static Storage<Matrix>& of(Matrix& matrix) { return matrix.*(&StorageOf::m_storage); }
};

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wnon-template-friend" // that they are functions, not templates, is meant
#endif
template <typename Matrix>
struct Members {
  using Data = typename Matrix::Scalar* Storage<Matrix>::*;
  using Count = Index Storage<Matrix>::*;
  friend Data dataOf(Members);
  friend Count countOf(Members);
};

template <typename Matrix, typename Members<Matrix>::Data data, typename Members<Matrix>::Count count>
struct Expose {
  friend typename Members<Matrix>::Data dataOf(Members<Matrix>) { return data; }
  friend typename Members<Matrix>::Count countOf(Members<Matrix>) { return count; }
};
template struct Expose<Points, &Storage<Points>::m_data, &Storage<Points>::m_cols>;
template struct Expose<Colors, &Storage<Colors>::m_data, &Storage<Colors>::m_cols>;
template struct Expose<Faces, &Storage<Faces>::m_data, &Storage<Faces>::m_cols>;
template struct Expose<Eigen::Matrix2Xf, &Storage<Eigen::Matrix2Xf>::m_data, &Storage<Eigen::Matrix2Xf>::m_cols>;
template struct Expose<Eigen::Matrix2Xd, &Storage<Eigen::Matrix2Xd>::m_data, &Storage<Eigen::Matrix2Xd>::m_cols>;
template struct Expose<Eigen::VectorXf, &Storage<Eigen::VectorXf>::m_data, &Storage<Eigen::VectorXf>::m_rows>;
template struct Expose<Eigen::VectorXi, &Storage<Eigen::VectorXi>::m_data, &Storage<Eigen::VectorXi>::m_rows>;

template <typename Matrix>
void setStorage(Matrix& matrix, typename Matrix::Scalar* data, Index count)
{
  Storage<Matrix>& storage = StorageOf<Matrix>::of(matrix);
  storage.*dataOf(Members<Matrix>()) = data;
  storage.*countOf(Members<Matrix>()) = count;
}
} // namespace detail

/// Where Eigen takes the memory of a matrix to begin: at a multiple of so many bytes.
inline constexpr std::size_t matrix_alignment = EIGEN_DEFAULT_ALIGN_BYTES;

/// Lets an empty matrix stand on `count` columns (rows of a vector) at `data`, until giveBack(). It must be read only.
/// @param data aligned to matrix_alignment
template <typename Matrix>
void borrow(Matrix& matrix, const void* data, Index count)
{
  using Scalar = typename Matrix::Scalar;
  detail::setStorage(matrix, const_cast<Scalar*>(static_cast<const Scalar*>(data)), count);
}

/// Empties a matrix that has borrowed its memory, which stays.
template <typename Matrix>
void giveBack(Matrix& matrix)
{
  detail::setStorage<Matrix>(matrix, nullptr, 0);
}
} // namespace fresco::python
