// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/mixed_pixel_features.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
namespace fresco::filters {
using namespace mixed_pixel_features;
namespace {
constexpr float clear = 4.f;          // deviations that noise does not reach: one normal value in 16,000
constexpr float most_counted = 8.f;   // deviations, where directions are sought: no single jump decides
constexpr float shortest_way = 1e-9f; // across beams, length: against division by zero

/// Grows with the value near 0 and with its logarithm far from it.
float flattened(float value) { return std::asinh(std::clamp(value, -1e4f, 1e4f)); }

/// Directions around a beam.
class Compass {
public:
  Compass(const BeamWindow& window, float noise) : forward_(forwardOf(window, noise))
  {
    const Eigen::Vector2f across(-forward_.y(), forward_.x());
    float sides = 0;
    for (const BeamWindow::Beam& beam : window.beams)
      sides +=
          std::min(std::abs(beam.range - window.range) / noise, most_counted) * (beam.way.dot(across) > 0 ? 1.f : -1.f);
    sideways_ = sides < 0 ? Eigen::Vector2f(-across) : across;
  }
  const Eigen::Vector2f& forward() const { return forward_; } ///< where ranges grow, unit
  /// The k-th of so many directions.
  Eigen::Vector2f way(int k, int count = bearings) const
  {
    const float angle = k * float(2 * pi) / count;
    return std::cos(angle) * forward_ + std::sin(angle) * sideways_;
  }

private:
  static Eigen::Vector2f forwardOf(const BeamWindow& window, float noise)
  {
    Eigen::Vector2f sum = Eigen::Vector2f::Zero();
    for (std::size_t k = 0; k < window.beams.size() && k < beside; ++k)
      sum +=
          std::clamp((window.beams[k].range - window.range) / noise, -most_counted, most_counted) * window.beams[k].way;
    return sum.squaredNorm() > 0 ? Eigen::Vector2f(sum.normalized()) : Eigen::Vector2f(Eigen::Vector2f::UnitX());
  }

  Eigen::Vector2f forward_;
  Eigen::Vector2f sideways_; ///< to the side with the larger differences, unit
};

/// @param radius in units of the window's spacing
const BeamWindow::Beam& beamAt(const BeamWindow& window, const Eigen::Vector2f& way, float radius)
{
  const Eigen::Vector2f place = radius * way;
  return *std::min_element(window.beams.begin(), window.beams.end(), [&](const auto& a, const auto& b) {
    return (a.place - place).squaredNorm() < (b.place - place).squaredNorm();
  });
}

/// What lies in one direction: ranges at three distances, and where surfaces continued from there meet the beam.
float* measureWay(const BeamWindow& window, float noise, const Eigen::Vector2f& way, float* at)
{
  constexpr float half_disc = 0.16997f, quarter_disc = 0.65998f; // cosines to the middle: 80 and 49 degrees
  for (const float radius : {1.f, 2.f, 3.f}) {
    const BeamWindow::Beam& beam = beamAt(window, way, radius);
    *at++ = flattened((beam.range - window.range) / noise);
    if (radius == 1.f)
      *at++ = flattened((beam.range - window.range) / std::max(beam.sideways, shortest_way));
  }
  for (const WindowSide& part : {WindowSide{way, half_disc, 12}, WindowSide{way, quarter_disc, 6}}) {
    const auto side = continueSide(window, part, noise);
    *at++ = side ? flattened((side->range - window.range) / side->deviation) : 0.f;
    *at++ = side ? 1.f : 0.f;
  }
  return at;
}

float* measureWindow(const BeamWindow& window, float noise, const Compass& compass, float* at)
{
  constexpr float slope = 2.7474774f; // of surfaces that join points: 1 / tan(20 degrees), as in training
  for (int b = 0; b < bearings; ++b)
    at = measureWay(window, noise, compass.way(b), at);
  float front = 0, behind = 0, same = 0, gap = 1e9f, second = 1e9f;
  for (std::size_t k = 0; k < window.beams.size(); ++k) {
    const BeamWindow::Beam& beam = window.beams[k];
    const float ahead = beam.range - window.range, off = ahead / noise, distance = std::hypot(ahead, beam.sideways);
    if (k < beside) {
      front += off < -clear ? 1.f : 0.f;
      behind += off > clear ? 1.f : 0.f;
      same += std::abs(off) <= clear ? 1.f : 0.f;
    }
    second = std::min(second, std::max(gap, distance));
    gap = std::min(gap, distance);
  }
  const float across = std::max(window.spacing * window.range, shortest_way);
  for (const float feature :
       {front, behind, same, joinedShare(window, noise, slope), std::log(gap / across + 0.1f),
        std::log(second / across + 0.1f), std::log(window.spacing + 1e-5f), std::log(across / noise + 0.01f)})
    *at++ = feature;
  return at;
}

/// Differences between ranges, in deviations: the least, and those to the nearest clearly in front and behind.
float* measureDifferences(const BeamSurroundings& around, float* at)
{
  constexpr std::size_t least_differences = 6; // of ranges
  std::vector<float> differences;
  for (const BeamWindow::Beam& beam : around.near.beams)
    differences.push_back(std::abs(beam.range - around.near.range) / around.noise);
  differences.resize(std::max(least_differences, differences.size()), 1e4f);
  std::partial_sort(differences.begin(), differences.begin() + least_differences, differences.end());
  for (std::size_t k = 0; k < least_differences; ++k)
    *at++ = flattened(differences[k]);
  float front = -1e4f, behind = 1e4f;
  for (std::size_t k = 0; k < around.wide.beams.size() && k < beside; ++k) {
    const float off = (around.wide.beams[k].range - around.wide.range) / around.noise;
    if (off < -clear)
      front = std::max(front, off);
    if (off > clear)
      behind = std::min(behind, off);
  }
  *at++ = flattened(front);
  *at++ = flattened(behind);
  return at;
}
} // namespace

float joinedShare(const BeamWindow& window, float noise, float slope)
{
  const std::size_t half = (window.beams.size() + 1) / 2;
  const auto joined =
      std::count_if(window.beams.begin(), window.beams.begin() + half, [&](const BeamWindow::Beam& beam) {
        return std::abs(beam.range - window.range) <= std::max(beam.sideways * slope, clear * noise);
      });
  return 1.f * joined / std::max<std::size_t>(1, half);
}

MixedPixelFeatures mixedPixelFeatures(const BeamSurroundings& around)
{
  MixedPixelFeatures features;
  const Compass near(around.near, around.noise), wide(around.wide, around.noise);
  float* at = measureWindow(around.near, around.noise, near, features.data());
  if (&around.wide == &around.near)
    at = std::copy_n(features.data(), of_window, at);
  else
    at = measureWindow(around.wide, around.noise, wide, at);
  at = measureDifferences(around, at);
  *at++ = std::log(around.noise / around.near.range);
  *at++ = std::acos(std::clamp(near.forward().dot(wide.forward()), -1.f, 1.f));
  return features;
}

Eigen::Matrix<float, 2 * bearings, 1> scoresAround(const BeamSurroundings& around, const std::vector<float>& scores)
{
  Eigen::Matrix<float, 2 * bearings, 1> found;
  int at = 0;
  for (const BeamWindow* window : {&around.near, &around.wide}) {
    const Compass compass(*window, around.noise);
    for (int b = 0; b < bearings; ++b)
      found[at++] = std::max(scores[beamAt(*window, compass.way(b), 1).position], least_score);
  }
  return found;
}

Eigen::Matrix<float, of_rings, 1> ringsAround(const BeamWindow& window, float noise, const std::vector<float>& scores)
{
  Eigen::Matrix<float, of_rings, 1> found;
  const Compass compass(window, noise);
  int at = 0;
  for (int ring = 1; ring <= rings; ++ring)
    for (int k = 0; k < of_ring; ++k) {
      const Eigen::Vector2f way = compass.way(k, of_ring);
      const BeamWindow::Beam& beam = beamAt(window, way, ring);
      found[at] = flattened((beam.range - window.range) / noise);
      found[at + rings * of_ring] = std::max(scores[beam.position], least_score);
      ++at;
    }
  return found;
}
} // namespace fresco::filters
