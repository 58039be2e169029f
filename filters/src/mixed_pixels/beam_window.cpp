// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/beam_window.h"
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
namespace fresco::filters {
namespace {
constexpr float largest_leverage = 9.f; // variance of a continuation / variance of a range
constexpr float smallest = 1e-6f;       // against division by zero

using Places = std::array<const BeamWindow::Beam*, most_beams>;

struct DepthPlane {
  Eigen::Vector3d inverse_depth; ///< at the middle, and per unit of place
  double leverage = 0;           ///< variance of its value at the middle / variance of a beam's
};

DepthPlane fitInverseDepth(const Places& beams, int count)
{
  Eigen::Matrix3d A = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector3d row(1, beams[k]->place.x(), beams[k]->place.y());
    A += row * row.transpose();
    b += static_cast<double>(beams[k]->inverse_depth) * row;
  }
  const Eigen::Matrix3d inverse = A.inverse();
  return {inverse * b, inverse(0, 0)};
}

struct Misfit {
  double rms = 0; ///< of depths, length
  int worst = 0;
};

Misfit misfitOf(const DepthPlane& plane, const Places& beams, int count)
{
  Misfit misfit;
  double largest = -1;
  for (int k = 0; k < count; ++k) {
    const double on_plane = plane.inverse_depth.dot(Eigen::Vector3d(1, beams[k]->place.x(), beams[k]->place.y()));
    const double off = std::abs(1.0 / beams[k]->inverse_depth - 1 / on_plane);
    misfit.rms += off * off;
    if (off > largest) {
      largest = off;
      misfit.worst = k;
    }
  }
  misfit.rms = std::sqrt(misfit.rms / std::max(1, count - 3));
  return misfit;
}

/// The value below which `share` of the values lie; not empty.
float quantile(std::vector<float>& values, double share) { return rankedValue(values, share * (values.size() - 1)); }

/// What measures too much is held down by the others, since noise neither falls with the range nor grows faster than
/// its square: groups between the ranges of surfaces, whose planes all cross a jump.
RangeNoise plausible(const RangeNoise& measured)
{
  RangeNoise noise = measured;
  for (std::size_t k = 0; k < noise.ranges.size(); ++k)
    for (std::size_t j = 0; j < noise.ranges.size(); ++j) {
      const float farther = std::max(1.f, measured.ranges[k] / measured.ranges[j]);
      noise.deviations[k] = std::min(noise.deviations[k], farther * farther * measured.deviations[j]);
    }
  return noise;
}

/// Radians between the beams of a grid that is as dense, whatever the nearest beam is.
float spacingOf(const std::vector<BeamWindow::Beam>& beams)
{
  const std::size_t diagonal = std::min<std::size_t>(beside, beams.size()) - 1;
  return beams.empty() ? 0.f : std::max(beams[diagonal].place.norm() * 0.70710678f, smallest);
}

/// Leaves out beams that are much nearer to the middle than others: in a grid none is.
void leaveOutTwins(std::vector<BeamWindow::Beam>& beams)
{
  constexpr float twin = 0.3f; // of the distance of the diagonal beam: nearer ones are left out
  if (beams.size() < beside)
    return;
  const auto diagonal = beams.begin() + (beside - 1);
  const float least = twin * diagonal->place.norm();
  beams.erase(beams.begin(), std::find_if(beams.begin(), diagonal,
                                          [&](const BeamWindow::Beam& beam) { return beam.place.norm() >= least; }));
}
} // namespace

void fillWindow(const BeamScan& scan, Index i, const int* first, const int* last, BeamWindow& window)
{
  const Eigen::Vector3f middle = scan.directions.col(i), e1 = middle.unitOrthogonal(), e2 = middle.cross(e1);
  window.beams.clear();
  window.range = scan.ranges[i];
  for (const int* j = first; j != last; ++j) {
    const Eigen::Vector3f beam = scan.directions.col(*j);
    const float forward = beam.dot(middle);
    if (*j == i || !(forward > 0.5f) || window.beams.size() == most_beams)
      continue;
    const Eigen::Vector2f place(beam.dot(e1) / forward, beam.dot(e2) / forward);
    const float range = scan.ranges[*j];
    window.beams.push_back(
        {place, place.normalized(), 1 / (range * forward), range, *j, place.norm() * std::min(range, window.range)});
  }
  leaveOutTwins(window.beams);
  window.spacing = spacingOf(window.beams);
  for (BeamWindow::Beam& beam : window.beams)
    beam.place /= window.spacing;
}

std::optional<Continuation> continueSide(const BeamWindow& window, const WindowSide& side, float noise)
{
  constexpr float largest_rms = 1.6f; // deviations, of beams that lie on a plane
  constexpr float grazing = 0.05f;    // cosine of the incidence beyond which ranges tell nothing
  Places beams{};
  int count = 0;
  for (const BeamWindow::Beam& beam : window.beams)
    if (count < side.most && beam.way.dot(side.way) >= side.least_cosine)
      beams[count++] = &beam;
  const int fewest = std::max(4, count * 2 / 3);
  for (; count >= fewest; --count) {
    const DepthPlane plane = fitInverseDepth(beams, count);
    const Eigen::Vector3d& at = plane.inverse_depth;
    if (!(at[0] * window.range > 1e-3))
      return {};
    const double cosine = at[0] / Eigen::Vector3d(at[0], at[1] / window.spacing, at[2] / window.spacing).norm();
    if (cosine < grazing)
      return {};
    const auto scaled = noise / static_cast<float>(std::sqrt(cosine));
    const Misfit misfit = misfitOf(plane, beams, count);
    if (misfit.rms <= largest_rms * scaled)
      return Continuation{float(1 / at[0]), scaled * std::sqrt(1 + std::min(largest_leverage, float(plane.leverage)))};
    std::swap(beams[misfit.worst], beams[count - 1]);
  }
  return {};
}

RangeNoise measureNoise(const BeamScan& scan, int threads)
{
  constexpr std::size_t groups = 16, fewest = 500;                       // beams of a group
  std::vector<std::pair<float, float>> differences(scan.columns.size()); // range on the plane, difference
  parallelRanges(scan.ranges.size(), threads, [&](Index begin, Index end) {
    BeamWindow window;
    Places beams{};
    for (Index i = begin; i < end; ++i) {
      fillWindow(scan, i, scan.lists.first(i), scan.lists.last(i), window);
      const int count = std::min<int>(nearby_beams, window.beams.size());
      for (int k = 0; k < count; ++k)
        beams[k] = &window.beams[k];
      const DepthPlane plane = fitInverseDepth(beams, count);
      const float at = 1 / plane.inverse_depth[0]; // unlike the range free of the beam's own noise
      const float off = std::abs(window.range - at) / std::sqrt(1 + std::min(largest_leverage, float(plane.leverage)));
      const bool known = count >= 4 && std::isfinite(off) && at > 0;
      differences[i] = {known ? at : window.range, known ? off : 0.f};
    }
  });
  std::sort(differences.begin(), differences.end());
  const std::size_t parts = std::clamp<std::size_t>(differences.size() / fewest, 1, groups);
  RangeNoise noise;
  std::vector<float> group;
  for (std::size_t part = 0; part < parts; ++part) {
    group.clear();
    const std::size_t begin = part * differences.size() / parts, end = (part + 1) * differences.size() / parts;
    for (std::size_t k = begin; k < end; ++k)
      group.push_back(differences[k].second);
    const float range = differences[(begin + end) / 2].first, middle = quantile(group, 0.5) / 0.6745f;
    const float deviation = std::max({middle, 0.5f * quantile(group, 0.75) / 1.15f, smallest * range});
    if (!noise.ranges.empty() && !(range > noise.ranges.back()))
      continue;
    noise.ranges.push_back(range);
    noise.deviations.push_back(deviation);
  }
  return plausible(noise);
}
} // namespace fresco::filters
