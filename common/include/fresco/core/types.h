// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cstdint>
namespace fresco {
using Index = Eigen::Index; ///< signed, for counts and loops

using Points = Eigen::Matrix3Xf;                               ///< 3xN positions or directions
using Colors = Eigen::Matrix<std::uint8_t, 3, Eigen::Dynamic>; ///< 3xN, RGB, 0..255
using Faces = Eigen::Matrix3Xi;                                ///< 3xF vertex indices, counter-clockwise from outside
} // namespace fresco
