// SPDX-License-Identifier: BSD-3-Clause
#include "photograph_matches.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel_batches.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
namespace fresco::alignment {
namespace {
using Descriptors = Eigen::Matrix<float, 128, Eigen::Dynamic>; ///< unit columns
using Eigen::Vector3d;

/// SIFT with the square root of each element, so that the dot product is Hellinger's (Arandjelovic & Zisserman 2012).
Descriptors findFeatures(const cv::Mat1b& gray, std::vector<cv::KeyPoint>& corners)
{
  constexpr double contrast = 0.02; // half of the usual: walls of rooms have faint texture
  constexpr int most = 4000;        // the strongest: bounds time and memory
  cv::Mat found;
  cv::SIFT::create(most, 3, contrast)->detectAndCompute(gray, {}, corners, found);
  if (corners.empty())
    return {};
  Descriptors all = Eigen::Map<Descriptors>(found.ptr<float>(), 128, static_cast<Index>(corners.size()));
  for (Index i = 0; i < all.cols(); ++i)
    all.col(i) = (all.col(i) / std::max(1e-9f, all.col(i).sum())).cwiseSqrt();
  return all;
}

/// The features of one photograph next to its observations of sparse points.
struct PhotographFeatures {
  Descriptors descriptors;
  std::vector<Index> points;
};

using Observed = std::vector<std::pair<Eigen::Vector2d, Index>>; ///< pixels and points of one photograph

PhotographFeatures featuresOf(const Image& photograph, const CameraModel& camera, const Observed& observed)
{
  constexpr double most_pixels = 1e6, near = 1.5; // pixels
  cv::Mat1b gray = grayOf(photograph);
  const double scale = std::min(1.0, std::sqrt(most_pixels / gray.total()));
  if (scale < 1)
    cv::resize(cv::Mat(gray), gray, {}, scale, scale, cv::INTER_AREA);
  std::vector<cv::KeyPoint> corners;
  const Descriptors all = findFeatures(gray, corners);
  const Eigen::Array2d pixel(double(gray.cols) / camera.width, double(gray.rows) / camera.height);
  PhotographFeatures features;
  std::vector<Index> kept;
  for (Index i = 0; i < all.cols(); ++i) {
    const Eigen::Vector2d at(corners[i].pt.x + 0.5, corners[i].pt.y + 0.5);
    double best = near * near;
    Index point = -1;
    for (const auto& [place, index] : observed)
      if (const double squared = ((place.array() * pixel).matrix() - at).squaredNorm(); squared < best) {
        best = squared;
        point = index;
      }
    if (point >= 0) {
      kept.push_back(i);
      features.points.push_back(point);
    }
  }
  features.descriptors = all(Eigen::all, kept);
  return features;
}

/// Mean descriptors of the sparse points.
struct PointFeatures {
  Descriptors descriptors;
  std::vector<Index> points;
};

PointFeatures featuresOfPoints(const CameraSet& set, const SparsePoints& points, const CameraAlignmentOptions& options,
                               const Progress& progress)
{
  constexpr Index most_photographs = 100;
  constexpr std::size_t most_points = 20000;
  std::vector<Observed> observed(set.views.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const Observation& observation : points[i].track)
      if (observation.pixel.allFinite())
        observed[observation.view].emplace_back(observation.pixel, i);
  const Index count = set.views.size(), used = std::min(count, most_photographs);
  std::vector<PhotographFeatures> found(used);
  parallelBatches(used, options.threads, progress, "photographs", [&](Index k) {
    const Index v = k * count / used;
    found[k] = featuresOf(options.photograph(v), set.cameras[set.views[v].camera], observed[v]);
  });
  std::vector<Index> times(points.size(), 0), column(points.size(), -1);
  for (const PhotographFeatures& of_one : found)
    for (const Index point : of_one.points)
      ++times[point];
  PointFeatures out;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (times[i] > 0)
      out.points.push_back(i);
  std::stable_sort(out.points.begin(), out.points.end(), [&](Index a, Index b) { return times[a] > times[b]; });
  out.points.resize(std::min(out.points.size(), most_points));
  for (std::size_t k = 0; k < out.points.size(); ++k)
    column[out.points[k]] = k;
  out.descriptors = Descriptors::Zero(128, static_cast<Index>(out.points.size()));
  for (const PhotographFeatures& of_one : found)
    for (std::size_t i = 0; i < of_one.points.size(); ++i)
      if (const Index k = column[of_one.points[i]]; k >= 0)
        out.descriptors.col(k) += of_one.descriptors.col(i);
  out.descriptors.colwise().normalize();
  return out;
}

/// Of features of one view those that look like one point and no other.
void matchView(const PointFeatures& features, const Descriptors& view, std::vector<std::pair<Index, Index>>& matches)
{
  constexpr float most = 0.8f; // distance to the best, of that to the second (Lowe 2004)
  constexpr Index block = 256;
  for (Index begin = 0; begin < view.cols(); begin += block) {
    const Index n = std::min(block, view.cols() - begin);
    const Eigen::MatrixXf likeness = features.descriptors.transpose() * view.middleCols(begin, n);
    for (Index i = 0; i < n; ++i) {
      Index best = 0;
      const float first = likeness.col(i).maxCoeff(&best);
      float second = -1;
      for (Index k = 0; k < likeness.rows(); ++k)
        if (k != best)
          second = std::max(second, likeness(k, i));
      if (1 - first < most * most * (1 - second))
        matches.emplace_back(begin + i, features.points[best]);
    }
  }
}

/// Camera from surface, for the six sides of a cube.
Eigen::Isometry3d sideOf(const Vector3d& eye, int side)
{
  const Vector3d z = (side < 3 ? 1 : -1) * Vector3d::Unit(side % 3), x = Vector3d::Unit((side + 1) % 3);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x.transpose(), z.cross(x).transpose(), z.transpose();
  T.translation() = -(T.linear() * eye);
  return T;
}
} // namespace

cv::Mat1b grayOf(const Image& image)
{
  cv::Mat1b gray(image.height, image.width);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* const p = image.pixel(x, y);
      gray(y, x) =
          image.channels < 3 ? *p : static_cast<std::uint8_t>(0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2] + 0.5);
    }
  return gray;
}

std::vector<SurfaceMatch> matchPhotographs(const CameraSet& set, const SparsePoints& points,
                                           const SurfacePainter& painter, const ScanSurface& surface,
                                           const CameraAlignmentOptions& options, const Progress& progress)
{
  constexpr std::size_t most_places = 24;
  const PointFeatures features = featuresOfPoints(set, points, options, subProgress(progress, 0.0, 0.4));
  if (features.points.empty())
    return {};
  CameraModel camera; // a right angle
  camera.width = camera.height = static_cast<int>(painter.focal());
  camera.fx = camera.fy = camera.cx = camera.cy = 0.5 * camera.width;
  const std::vector<Vector3d> places = freePlaces(surface, most_places);
  std::vector<SurfaceMatch> all;
  for (std::size_t p = 0; p < places.size(); ++p) {
    report(progress, "views of the scans", 0.4 + 0.6 * p / places.size());
    std::vector<std::vector<SurfaceMatch>> found(6);
    parallelFor(
        6, options.threads,
        [&](Index side) {
          const Eigen::Isometry3d T = sideOf(places[p], static_cast<int>(side));
          const SurfaceView view = painter.draw(camera, T);
          std::vector<cv::KeyPoint> corners;
          std::vector<std::pair<Index, Index>> matches;
          matchView(features, findFeatures(view.gray, corners), matches);
          for (const auto& [corner, point] : matches) {
            const cv::Point2f at = corners[corner].pt + cv::Point2f(0.5f, 0.5f);
            const float z = view.depth(static_cast<int>(at.y), static_cast<int>(at.x));
            if (z > 0)
              found[side].push_back({T.inverse() * (z * unproject(camera, {at.x, at.y})), point});
          }
        },
        1);
    for (const auto& some : found)
      all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}
} // namespace fresco::alignment
