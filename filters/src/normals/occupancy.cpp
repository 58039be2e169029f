// SPDX-License-Identifier: BSD-3-Clause
#include "normals/occupancy.h"
#include <algorithm>
#include <cmath>
namespace fresco::filters {
namespace {
constexpr float step = 0.5f;    ///< cells
constexpr float skipped = 2.5f; ///< cells at the start of a way: the surface itself, and its noise
} // namespace

Occupancy::Occupancy(const Points& points, float spacing, bool endless)
    : low_(points.rowwise().minCoeff()), endless_(endless)
{
  constexpr float cells_a_side = 600; // 27 MB
  const Eigen::Vector3f extent = points.rowwise().maxCoeff() - low_;
  cell_ = std::max({2 * spacing, extent.maxCoeff() / cells_a_side, 1e-30f});
  size_ = (extent / cell_).array().cast<int>() + 1;
  occupied_.resize(std::size_t(size_[0]) * size_[1] * size_[2]);
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i at = ((points.col(i) - low_) / cell_).array().cast<int>().min(size_ - 1);
    occupied_[(std::size_t(at[2]) * size_[1] + at[1]) * size_[0] + at[0]] = true;
  }
}

float Occupancy::freeWay(const Eigen::Vector3f& from, const Eigen::Vector3f& direction, float most) const
{
  const float length = direction.norm(), end = most > 0 ? most * length - skipped * cell_ : INFINITY;
  const Eigen::Vector3f unit = direction / length;
  float way = skipped * cell_;
  for (; way < end; way += step * cell_) {
    const Eigen::Array3f at = (from + way * unit - low_).array() / cell_;
    if ((at < 0).any() || (at >= size_.cast<float>()).any())
      return most > 0 ? most * length : endless_ ? cell_ * float(size_.maxCoeff()) : 0;
    const Eigen::Array3i cell = at.cast<int>();
    if (occupied_[(std::size_t(cell[2]) * size_[1] + cell[1]) * size_[0] + cell[0]])
      return way;
  }
  return most * length;
}
} // namespace fresco::filters
