// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <fresco/core/image.h>
#include <opencv2/imgproc.hpp>
namespace fresco::texture {
/// The same pixels, not to be written.
inline cv::Mat matOf(const Image& image)
{
  return {image.height, image.width, CV_8UC(image.channels), const_cast<std::uint8_t*>(image.data.data())};
}

/// Distances of an image's pixels from a set of pixels.
class DistanceField {
public:
  /// @param set 255 where in it, else 0; connected parts of it get labels
  explicit DistanceField(const cv::Mat& set)
  {
    cv::distanceTransform(~set, distance_, labels_, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_CCOMP);
  }

  float at(const cv::Point& p) const { return distance_.at<float>(p); }
  /// Of the nearest part of the set, > 0.
  int label(const cv::Point& p) const { return labels_.at<int>(p); }
  int mostLabel() const
  {
    double most = 0;
    cv::minMaxLoc(labels_, nullptr, &most);
    return static_cast<int>(most);
  }

  /// The pixel that lies so much further away; outside of the image if there is none.
  cv::Point further(const cv::Point& p, int way) const
  {
    const auto clamped = [&](int x, int y) {
      return distance_.at<float>(std::clamp(y, 0, distance_.rows - 1), std::clamp(x, 0, distance_.cols - 1));
    };
    const cv::Point2f slope(clamped(p.x + 1, p.y) - clamped(p.x - 1, p.y),
                            clamped(p.x, p.y + 1) - clamped(p.x, p.y - 1));
    const float length = std::max(1e-6f, std::hypot(slope.x, slope.y));
    const cv::Point q(std::lround(p.x + way * slope.x / length), std::lround(p.y + way * slope.y / length));
    const bool inside = q.inside({0, 0, distance_.cols, distance_.rows});
    return inside && at(q) > at(p) + 0.5f * way ? q : cv::Point(-1, -1);
  }

  /// visit(pixel, its distance in whole pixels) for those outside of the set and at most so far away
  template <typename Visit>
  void forNear(int most, const Visit& visit) const
  {
    for (int y = 0; y < distance_.rows; ++y)
      for (int x = 0; x < distance_.cols; ++x)
        if (const float d = distance_.at<float>(y, x); d > 0 && d < most + 0.5f)
          visit(cv::Point(x, y), std::max(1, static_cast<int>(std::lround(d))));
  }

private:
  cv::Mat distance_, labels_;
};
} // namespace fresco::texture
