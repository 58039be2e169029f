// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::plan {
/// Samples sorted by where they lie in the plan.
class PlanePoints {
public:
  explicit PlanePoints(const std::vector<Eigen::Vector3f>& points) : points_(points.size())
  {
    Eigen::Vector2f high(0, 0);
    if (!points.empty())
      low_ = high = points.front().head<2>();
    for (const Eigen::Vector3f& p : points) {
      low_ = low_.cwiseMin(p.head<2>());
      high = high.cwiseMax(p.head<2>());
    }
    width_ = bucket(high.x() - low_.x()) + 1;
    height_ = bucket(high.y() - low_.y()) + 1;
    starts_.assign(static_cast<std::size_t>(width_) * height_ + 1, 0);
    for (const Eigen::Vector3f& p : points)
      ++starts_[place(p) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i)
      starts_[i] += starts_[i - 1];
    std::vector<Index> next(starts_.begin(), starts_.end() - 1);
    for (const Eigen::Vector3f& p : points)
      points_[next[place(p)]++] = p;
  }

  /// visit(point) for all that may lie within `reach` of the line from `a` to `b`, and some others.
  template <typename Visit>
  void near(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double reach, const Visit& visit) const
  {
    const Eigen::Vector2d d = (b - a).normalized(), normal(-d.y(), d.x());
    const Eigen::Vector2d low = a.cwiseMin(b).array() - reach, high = a.cwiseMax(b).array() + reach;
    const int x0 = std::max(0, bucket(low.x() - low_.x())), x1 = std::min(width_ - 1, bucket(high.x() - low_.x()));
    const int y0 = std::max(0, bucket(low.y() - low_.y())), y1 = std::min(height_ - 1, bucket(high.y() - low_.y()));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Eigen::Vector2d middle = low_.cast<double>() + side * Eigen::Vector2d(x + 0.5, y + 0.5);
        if (std::abs(normal.dot(middle - a)) > reach + side)
          continue;
        const std::size_t at = static_cast<std::size_t>(y) * width_ + x;
        for (Index i = starts_[at]; i < starts_[at + 1]; ++i)
          visit(points_[i]);
      }
  }

private:
  static constexpr double side = 0.1; // metres
  static int bucket(double offset) { return static_cast<int>(std::floor(offset / side)); }
  std::size_t place(const Eigen::Vector3f& p) const
  {
    return static_cast<std::size_t>(bucket(p.y() - low_.y())) * width_ + bucket(p.x() - low_.x());
  }
  Eigen::Vector2f low_{0, 0};
  int width_ = 0, height_ = 0;
  std::vector<Index> starts_;
  std::vector<Eigen::Vector3f> points_;
};
} // namespace fresco::plan
