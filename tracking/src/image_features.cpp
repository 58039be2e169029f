// SPDX-License-Identifier: BSD-3-Clause
#include "image_features.h"
#include "reference_frame.h"
#include <cstring>
#include <opencv2/features2d.hpp>
namespace fresco::tracking {
namespace {
constexpr int most_features = 600;

cv::Mat grayImage(const Plane& plane)
{
  cv::Mat image(plane.height, plane.width, CV_8U);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(plane.row(y)[x] + 0.5f);
  return image;
}

/// The surface that a pixel of the colour image shows: its depth is searched for where the surface would be seen by the
/// depth camera.
SmoothDepth surfaceAt(const RgbdLevel& level, const RgbdCameras& cameras, const cv::Point2f& pixel,
                      Eigen::Vector3f& point)
{
  constexpr int radius = 1, rounds = 4; // the offset of the cameras is small against the depth: each round a digit
  const Pinhole K = halved(cameras.depth, level.depth_halvings), C = halved(cameras.color, level.gray_halvings);
  const Eigen::Vector3f ray((pixel.x - C.cx) / C.fx, (pixel.y - C.cy) / C.fy, 1.f);
  float z = 2.f;
  SmoothDepth found;
  for (int k = 0; k < rounds; ++k) {
    const Eigen::Vector3f q = z * ray - cameras.color_from_depth;
    const float u = q.x() / q.z() * K.fx + K.cx, v = q.y() / q.z() * K.fy + K.cy;
    if (!(u >= radius && v >= radius && u < level.depth.width - radius - 1 && v < level.depth.height - radius - 1))
      return {};
    found = smoothDepth(level.depth, K, static_cast<int>(u + 0.5f), static_cast<int>(v + 0.5f), radius);
    if (!(found.z > 0.f))
      return {};
    z = found.z + cameras.color_from_depth.z();
  }
  point = z * ray - cameras.color_from_depth;
  return found;
}

int distance(const std::uint8_t* a, const std::uint8_t* b)
{
  int bits = 0;
  for (int k = 0; k < ImageFeatures::bytes; k += 8) {
    std::uint64_t x, y;
    std::memcpy(&x, a + k, 8);
    std::memcpy(&y, b + k, 8);
    bits += __builtin_popcountll(x ^ y);
  }
  return bits;
}

struct Best {
  int distance = 1000, second = 1000;
  Index index = -1;
  void offer(int d, Index i)
  {
    if (d < distance) {
      second = distance;
      distance = d;
      index = i;
    } else if (d < second) {
      second = d;
    }
  }
};

/// Features that choose each other and are alike.
std::vector<registration::Correspondence> mutualMatches(const ImageFeatures& a, const ImageFeatures& b)
{
  constexpr int most_bits = 80; // of 256: unrelated surroundings differ in some 128
  std::vector<Best> best_a(a.size()), best_b(b.size());
  for (Index i = 0; i < a.size(); ++i)
    for (Index j = 0; j < b.size(); ++j) {
      const int d = distance(&a.descriptors[i * ImageFeatures::bytes], &b.descriptors[j * ImageFeatures::bytes]);
      best_a[i].offer(d, j);
      best_b[j].offer(d, i);
    }
  std::vector<registration::Correspondence> matches;
  for (Index i = 0; i < a.size(); ++i)
    if (best_a[i].index >= 0 && best_b[best_a[i].index].index == i && best_a[i].distance <= most_bits)
      matches.push_back({i, best_a[i].index});
  return matches;
}
} // namespace

ImageFeatures findFeatures(const RgbdPyramid& pyramid, const RgbdCameras& cameras)
{
  ImageFeatures features;
  const RgbdLevel& level = pyramid.levels[0];
  if (level.gray.width == 0)
    return features;
  std::vector<cv::KeyPoint> corners;
  cv::Mat descriptors;
  constexpr int threshold = 10; // grey levels: walls of rooms have faint texture
  cv::ORB::create(most_features, 1.2f, 6, 15, 0, 2, cv::ORB::HARRIS_SCORE, 31, threshold)
      ->detectAndCompute(grayImage(level.gray), {}, corners, descriptors);
  Points points(3, corners.size()), normals(3, corners.size());
  Index count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Eigen::Vector3f point;
    const SmoothDepth surface = surfaceAt(level, cameras, corners[i].pt, point);
    if (!(surface.z > 0.f))
      continue;
    points.col(count) = point;
    normals.col(count++) = -surface.normal;
    const std::uint8_t* row = descriptors.ptr<std::uint8_t>(static_cast<int>(i));
    features.descriptors.insert(features.descriptors.end(), row, row + ImageFeatures::bytes);
  }
  features.places.points = points.leftCols(count);
  features.places.normals = normals.leftCols(count);
  return features;
}

registration::PoseHypotheses matchFrames(const ImageFeatures& a, const ImageFeatures& b)
{
  registration::Sc2PcrOptions options;
  options.tolerance = 0.04f; // metres: the error of a depth at 3 m, and of a corner
  options.size = 2.f;
  options.most = 1;
  return registration::runSc2Pcr(a.places, b.places, mutualMatches(a, b), options);
}
} // namespace fresco::tracking
