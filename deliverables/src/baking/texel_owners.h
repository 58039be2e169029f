// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/textured_mesh.h>
#include <vector>
namespace fresco::deliverables {
/// Pictures are larger than float can number.
struct PictureSize {
  int width, height;
};

/// Corners of a face in a picture, pixels from the upper left corner, of texture coordinates whose v points up.
Eigen::Matrix<double, 2, 3> cornersInPicture(const TexturedMesh& model, Index face, const PictureSize& size);

/// Weights of the corners at a place; they sum to 1, negative ones outside. Not finite for corners on a line.
Eigen::Vector3d weightsAt(const Eigen::Matrix<double, 2, 3>& corners, const Eigen::Vector2d& place);

/// Rows from the top: the face that covers each texel's centre, or is at most `border` texels away; -1 = none.
/// @param faces that lie in this picture
std::vector<int> texelOwners(const TexturedMesh& model, const std::vector<int>& faces, const PictureSize& size,
                             int border);
} // namespace fresco::deliverables
