// SPDX-License-Identifier: BSD-3-Clause
#include "baking/texel_owners.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::deliverables {
Eigen::Matrix<double, 2, 3> cornersInPicture(const TexturedMesh& model, Index face, const PictureSize& size)
{
  Eigen::Matrix<double, 2, 3> corners;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d at = model.texcoords.col(model.texcoord_faces(k, face)).cast<double>();
    corners.col(k) << at.x() * size.width, (1 - at.y()) * size.height;
  }
  return corners;
}

Eigen::Vector3d weightsAt(const Eigen::Matrix<double, 2, 3>& corners, const Eigen::Vector2d& place)
{
  const Eigen::Vector2d u = corners.col(1) - corners.col(0), v = corners.col(2) - corners.col(0);
  const Eigen::Vector2d p = place - corners.col(0);
  const double area = u.x() * v.y() - u.y() * v.x();
  const double second = (p.x() * v.y() - p.y() * v.x()) / area, third = (u.x() * p.y() - u.y() * p.x()) / area;
  return {1 - second - third, second, third};
}

namespace {
void draw(const Eigen::Matrix<double, 2, 3>& corners, int face, const PictureSize& size, std::vector<int>& owners)
{
  constexpr double least = -1e-6; // of a weight: edges belong to both sides
  const auto first = [](double low) { return std::max(0, int(std::ceil(low - 0.5))); };
  const auto last = [](double high, int length) { return std::min(length - 1, int(std::floor(high - 0.5))); };
  for (int y = first(corners.row(1).minCoeff()), end = last(corners.row(1).maxCoeff(), size.height); y <= end; ++y)
    for (int x = first(corners.row(0).minCoeff()), stop = last(corners.row(0).maxCoeff(), size.width); x <= stop; ++x)
      if (weightsAt(corners, {x + 0.5, y + 0.5}).minCoeff() >= least)
        owners[std::size_t(y) * size.width + x] = face;
}

void grow(const PictureSize& size, std::vector<int>& owners)
{
  constexpr int offsets[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  const std::vector<int> before = owners;
  parallelFor(size.height, 0, [&](Index row) {
    int* own = owners.data() + row * size.width;
    for (int x = 0; x < size.width; ++x)
      for (int k = 0; k < 8 && own[x] < 0; ++k) {
        const int from = x + offsets[k][0];
        const Index y = row + offsets[k][1];
        if (from >= 0 && y >= 0 && from < size.width && y < size.height)
          own[x] = before[std::size_t(y) * size.width + from];
      }
  });
}
} // namespace

std::vector<int> texelOwners(const TexturedMesh& model, const std::vector<int>& faces, const PictureSize& size,
                             int border)
{
  std::vector<int> owners(std::size_t(size.width) * size.height, -1);
  for (const int face : faces)
    draw(cornersInPicture(model, face, size), face, size, owners);
  for (int round = 0; round < border; ++round)
    grow(size, owners);
  return owners;
}
} // namespace fresco::deliverables
