// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/color_fringe.h"
#include "photographs/distance_field.h"
#include "photographs/photo_store.h"
#include <Eigen/Core>
#include <algorithm>
namespace fresco::texture {
namespace {
using Color = cv::Vec3b;

/// How much more red and blue there are than green.
int violet(const Color& c) { return std::min(c[0], c[2]) - c[1]; }

/// 255 where all channels are; nothing where it is gloss, which has hardly any fringe.
cv::Mat clippedOf(const cv::Mat& photo)
{
  constexpr int clipped = 250; // grey level
  cv::Mat out;
  cv::inRange(photo, cv::Scalar::all(clipped), cv::Scalar::all(255), out);
  if (cv::countNonZero(out) > 0)
    cv::morphologyEx(out, out, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  return out;
}
} // namespace

int fringeWidth(const Image& given)
{
  constexpr int dark = 140, fringed = 10; // grey levels of green; of violet
  constexpr double many = 0.05;           // without a fringe 0.02 of real edges are violet
  const cv::Mat photo = matOf(given);
  const cv::Mat clipped = clippedOf(photo);
  if (cv::countNonZero(clipped) == 0)
    return 0;
  const DistanceField around(clipped);
  const int widest = std::max(6, given.width / 160); // lenses are off by such a share of the image at most
  Eigen::ArrayXi all = Eigen::ArrayXi::Zero(2 * widest + 1), found = all; // of strong edges, by distance; violet ones
  around.forNear(2 * widest, [&](const cv::Point& p, int distance) {
    const cv::Point q = around.further(p, widest + 2 - std::min(distance, widest) / 2);
    if (q.x < 0 || photo.at<Color>(q)[1] >= dark)
      return;
    const int here = violet(photo.at<Color>(p)), beyond = violet(photo.at<Color>(q));
    ++all[distance];
    found[distance] += here - std::max(0, beyond) > fringed;
  });
  const Eigen::ArrayXd share = (all < 100).select(0.0, found.cast<double>() / all.cast<double>()); // few tell nothing
  const double most = share.maxCoeff();
  int width = 0;
  for (int k = 1; k <= 2 * widest && most > many; ++k)
    width = share[k] > 0.5 * most ? k : width;
  return width <= widest ? width : 0; // a fringe ends; what is violet further away is a thing
}

Image withoutFringe(const Image& given, int width)
{
  Image out = given;
  const cv::Mat photo = matOf(given);
  const DistanceField around(clippedOf(photo));
  around.forNear(width + interpolation_reach, [&](const cv::Point& p, int distance) {
    const Color& color = photo.at<Color>(p);
    const cv::Point q = around.further(p, width + interpolation_reach + 1 - distance / 2);
    const Color beyond = q.x >= 0 ? photo.at<Color>(q) : Color(0, 0, 0); // unknown: grey
    if (violet(color) > std::max(0, violet(beyond)))
      for (const int c : {0, 2})
        out.pixel(p.x, p.y)[c] = std::clamp(color[1] + beyond[c] - beyond[1], 0, static_cast<int>(color[c]));
  });
  return out;
}
} // namespace fresco::texture
