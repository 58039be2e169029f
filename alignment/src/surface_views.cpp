// SPDX-License-Identifier: BSD-3-Clause
#include "surface_views.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <opencv2/imgproc.hpp>
namespace fresco::alignment {
namespace {
using Eigen::Vector3d;

/// Intensities as grey colours, so that one in fifty is white.
PointSet withGrays(const PointSet& scans)
{
  constexpr double white_rank = 0.98;
  PointSet set = scans;
  if (scans.colors.cols() > 0 || scans.intensities.size() == 0)
    return set;
  std::vector<float> values;
  for (const float value : scans.intensities)
    if (std::isfinite(value))
      values.push_back(value);
  if (values.empty())
    return set;
  const float white = rankedValue(values, static_cast<std::ptrdiff_t>(white_rank * (values.size() - 1)));
  set.colors.resize(3, scans.size());
  for (Index i = 0; i < scans.size(); ++i) {
    const float share = white > 0 && std::isfinite(scans.intensities[i]) ? scans.intensities[i] / white : 0.f;
    set.colors.col(i).setConstant(static_cast<std::uint8_t>(255 * std::clamp(share, 0.f, 1.f)));
  }
  return set;
}

/// Fills pixels of weight 0 from those around, from fine to coarse.
void fillHoles(cv::Mat1f& sums, cv::Mat1f& weights)
{
  if (std::min(sums.rows, sums.cols) < 2)
    return;
  cv::Mat1f half_sums, half_weights, smooth;
  cv::resize(sums, half_sums, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(weights, half_weights, {}, 0.5, 0.5, cv::INTER_AREA);
  fillHoles(half_sums, half_weights);
  cv::Mat1f quotient = half_sums / cv::max(half_weights, 1e-6f);
  cv::resize(quotient, smooth, sums.size(), 0, 0, cv::INTER_LINEAR);
  const cv::Mat holes = weights <= 0.f;
  smooth.copyTo(sums, holes);
  weights.setTo(1.f, holes);
}

/// A point in the image, and how far around it is drawn.
struct Splat {
  float u, v, z, radius; // pixels, length
};
} // namespace

SurfacePainter::SurfacePainter(const PointSet& scans, const ScanSurface& surface)
{
  constexpr double finer = 0.5; // than what is compared by shape
  registration::RawScan raw = registration::finitePoints(withGrays(scans), surface.center());
  if (raw.colors.cols() == 0)
    return;
  raw = registration::thin(raw, static_cast<float>(finer * surface.grain()));
  points_ = raw.points;
  const Eigen::RowVectorXf grays = 0.299f * raw.colors.row(0) + 0.587f * raw.colors.row(1) + 0.114f * raw.colors.row(2);
  grays_.assign(grays.begin(), grays.end());
  spacing_ = surface.grain() * std::max(finer, std::sqrt(double(surface.level().points.cols()) / points_.cols()));
  focal_ = std::clamp(2 * surface.radius() / spacing_, 150.0, 1000.0);
}

SurfaceView SurfacePainter::draw(const CameraModel& camera, const Eigen::Isometry3d& T_camera_surface) const
{
  constexpr float nearest = 4;      // spacings
  constexpr float least_radius = 1; // pixels: the four around a point
  constexpr float same = 1.02f;     // depths of one surface
  const Eigen::Isometry3f T = T_camera_surface.cast<float>();
  const float width = camera.width, height = camera.height, spacing = static_cast<float>(spacing_);
  std::vector<std::pair<Splat, float>> splats;
  for (Index i = 0; i < points_.cols(); ++i) {
    const Eigen::Vector3f p = T * points_.col(i);
    if (!(p.z() > nearest * spacing))
      continue;
    const Splat s{static_cast<float>(p.x() / p.z() * camera.fx + camera.cx),
                  static_cast<float>(p.y() / p.z() * camera.fy + camera.cy), p.z(),
                  std::max(least_radius, spacing / p.z() * static_cast<float>(camera.fx))};
    if (s.u > -s.radius && s.v > -s.radius && s.u < width + s.radius && s.v < height + s.radius)
      splats.emplace_back(s, grays_[i]);
  }
  const auto each = [&](const Splat& s, const auto& use) {
    const int left = std::max(0, cvCeil(s.u - s.radius - 0.5f)), top = std::max(0, cvCeil(s.v - s.radius - 0.5f)),
              right = std::min(camera.width - 1, cvFloor(s.u + s.radius - 0.5f)),
              bottom = std::min(camera.height - 1, cvFloor(s.v + s.radius - 0.5f));
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x)
        use(y, x);
  };
  cv::Mat1f front(camera.height, camera.width, std::numeric_limits<float>::infinity());
  for (const auto& [splat, gray] : splats)
    each(splat, [&, &s = splat](int y, int x) { front(y, x) = std::min(front(y, x), s.z); });
  cv::Mat1f sums(front.size(), 0.f), weights(front.size(), 0.f), depths(front.size(), 0.f);
  for (const auto& [splat, gray] : splats)
    each(splat, [&, &s = splat, g = gray](int y, int x) {
      if (s.z > same * front(y, x) + spacing)
        return;
      const float dx = (x + 0.5f - s.u) / s.radius, dy = (y + 0.5f - s.v) / s.radius,
                  weight = std::exp(-4 * (dx * dx + dy * dy));
      sums(y, x) += weight * g;
      depths(y, x) += weight * s.z;
      weights(y, x) += weight;
    });
  SurfaceView view;
  view.depth = depths / cv::max(weights, 1e-6f);
  fillHoles(sums, weights);
  cv::Mat1f gray = sums / cv::max(weights, 1e-6f);
  gray.convertTo(view.gray, CV_8U);
  return view;
}

std::vector<Vector3d> freePlaces(const ScanSurface& surface, std::size_t most)
{
  constexpr double spacing = 0.3; // of the surface's radius
  const double step = spacing * surface.radius();
  const Eigen::Array3i low = (surface.low().cast<double>().array() / step).ceil().cast<int>(),
                       high = (surface.high().cast<double>().array() / step).floor().cast<int>();
  std::vector<Vector3d> places;
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x)
        if (const Vector3d place = step * Vector3d(x, y, z);
            surface.level().tree->nearest(place.cast<float>(), static_cast<float>(step)).index < 0)
          places.push_back(place);
  std::stable_sort(places.begin(), places.end(),
                   [](const Vector3d& a, const Vector3d& b) { return a.squaredNorm() < b.squaredNorm(); });
  std::vector<Vector3d> chosen; // from the midst outwards
  for (const Vector3d& place : places)
    if (chosen.size() < most && std::none_of(chosen.begin(), chosen.end(),
                                             [&](const Vector3d& other) { return (place - other).norm() < 2 * step; }))
      chosen.push_back(place);
  return chosen;
}
} // namespace fresco::alignment
