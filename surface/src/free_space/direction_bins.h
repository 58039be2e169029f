// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <fresco/core/mesh.h>
namespace fresco {
/// Bins of directions on the six faces of a cube around a place, side x side each.
/// Bin of a direction: its largest coordinate names the face, the others the place there.
template <typename Scalar>
Index binOf(const Eigen::Matrix<Scalar, 3, 1>& direction, int side)
{
  int axis;
  const Scalar largest = direction.cwiseAbs().maxCoeff(&axis);
  const auto on = [&](int other) {
    return std::clamp<Index>((direction[other] / largest + 1) * Scalar(0.5) * side, 0, side - 1);
  };
  const Index face = 2 * axis + (direction[axis] < 0);
  return (face * side + on((axis + 1) % 3)) * side + on((axis + 2) % 3);
}

/// Bin of a place on a face, in bins; places beside the face belong to the next one.
template <typename Scalar>
Index binOn(Index face, Scalar row, Scalar column, int side)
{
  const int axis = face / 2;
  Eigen::Matrix<Scalar, 3, 1> direction;
  direction[axis] = face % 2 ? -1 : 1;
  direction[(axis + 1) % 3] = 2 * row / side - 1;
  direction[(axis + 2) % 3] = 2 * column / side - 1;
  return binOf(direction, side);
}

/// visit(bin) for the nine bins around one, itself included.
template <typename Scalar, typename Visit>
void forEachBinAround(Index bin, int side, const Visit& visit)
{
  const Index face = bin / (side * side), row = bin / side % side, column = bin % side;
  for (int k = 0; k < 9; ++k)
    visit(binOn<Scalar>(face, row + k / 3 - Scalar(0.5), column + k % 3 - Scalar(0.5), side));
}
} // namespace fresco
