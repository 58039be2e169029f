// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
namespace fresco::filters {
/// Named matrices of a trained network: a file of filters/data, which the build
/// embeds into the library. All numbers are little endian:
///
///   8 bytes                "FRESCO", 26, "W"
///   uint32                 number of matrices
///   per matrix, 32 bytes   name (24 bytes, the rest zero), uint32 rows, uint32 columns
///   float32                values of all matrices in this order, row by row
class Weights {
public:
  /// @param data a whole file; it must outlive this object and start at a multiple of 4 bytes
  /// @throws std::runtime_error if it is no such file
  explicit Weights(std::string_view data);

  struct Shape {
    std::uint32_t rows, columns;
  };
  /// @return the values of a matrix, row by row
  /// @throws std::runtime_error if no matrix has this name and shape
  const float* values(const std::string& name, Shape shape) const;

private:
  struct Matrix {
    char name[24];
    std::uint32_t rows, columns;
  };
  std::vector<Matrix> matrices_;
  const char* values_; ///< of the first
};

/// The files, as they are embedded.
std::string_view candidateScoreData();
std::string_view mixedPixelData();
std::string_view secondStageData();
} // namespace fresco::filters
