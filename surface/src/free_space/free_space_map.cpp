// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/surface/core/free_space_map.h>

#include "free_space/direction_bins.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/require.h>
#include <limits>
#include <map>
namespace fresco {
namespace {
constexpr int finest_side = 256; ///< bins of 0.35 degrees: 3 MB a station
constexpr float none = std::numeric_limits<float>::infinity();

std::array<double, 3> keyOf(const Eigen::Vector3d& place) { return {place.x(), place.y(), place.z()}; }

template <typename Lengths>
Index countFilled(const std::vector<Lengths>& bins)
{
  return std::count_if(bins.begin(), bins.end(), [](const Lengths& b) { return b.shortest < none; });
}

/// Half as many bins a side.
template <typename Lengths>
std::vector<Lengths> coarsen(const std::vector<Lengths>& fine, int side)
{
  const int half = side / 2;
  std::vector<Lengths> coarse(fine.size() / 4, {none, 0.f});
  for (Index i = 0; i < Index(fine.size()); ++i) {
    const Index face_row = i / side, column = i % side; // sides are even, so rows of two faces do not mix
    Lengths& to = coarse[face_row / 2 * half + column / 2];
    to = {std::min(to.shortest, fine[i].shortest), std::max(to.longest, fine[i].longest)};
  }
  return coarse;
}
} // namespace

FreeSpaceMap::Station FreeSpaceMap::stationOf(const Eigen::Vector3d& viewpoint, std::vector<Lengths>&& bins)
{
  constexpr int least_filled = 5; // of nine
  Station station{viewpoint, finest_side, {}};
  int& side = station.side;
  for (; side > 2; side /= 2) { // until half of four bins have beams where one of them has
    std::vector<Lengths> coarse = coarsen(bins, side);
    if (countFilled(bins) >= 2 * countFilled(coarse))
      break;
    bins.swap(coarse);
  }
  station.bins.resize(bins.size());
  for (Index i = 0; i < Index(bins.size()); ++i) {
    Lengths around{none, 0.f};
    int filled = 0;
    forEachBinAround<double>(i, side, [&](Index k) {
      const Lengths& bin = bins[k];
      filled += bin.shortest < none;
      around = {std::min(around.shortest, bin.shortest), std::max(around.longest, bin.longest)};
    });
    station.bins[i] = filled < least_filled ? Lengths{none, 0.f} : around;
  }
  return station;
}

FreeSpaceMap::FreeSpaceMap(const PointStream& beams)
{
  constexpr std::size_t most_stations = 1000;
  std::map<std::array<double, 3>, std::vector<Lengths>> bins_by_viewpoint;
  beams.read([&](const PointSet& set) {
    validatePointSet(set);
    require(set.viewpoints.cols() > 0 || set.size() == 0, "free space: the points have no viewpoints");
    const auto seenFrom = [&](Index i) { return set.viewpoints.col(set.viewpoints.cols() == 1 ? 0 : i); };
    for (Index i = 0; i < set.viewpoints.cols() && bins_by_viewpoint.size() <= most_stations; ++i)
      if (seenFrom(i).allFinite())
        bins_by_viewpoint[keyOf(set.origin + seenFrom(i).cast<double>())];
    require(bins_by_viewpoint.size() <= most_stations, "free space: more than ", most_stations,
            " viewpoints, which are no stations of a scanner");
    for (Index i = 0; i < set.size(); ++i) {
      const Eigen::Vector3d beam = set.points.col(i).cast<double>() - seenFrom(i).cast<double>();
      const double length = beam.norm();
      if (!(std::isfinite(length) && length > 0))
        continue;
      std::vector<Lengths>& bins = bins_by_viewpoint[keyOf(set.origin + seenFrom(i).cast<double>())];
      bins.resize(6 * finest_side * finest_side, {none, 0.f});
      Lengths& bin = bins[binOf(beam, finest_side)];
      bin = {std::min<float>(bin.shortest, length), std::max<float>(bin.longest, length)};
    }
  });
  for (auto& [viewpoint, bins] : bins_by_viewpoint)
    if (!bins.empty())
      stations_.push_back(stationOf(Eigen::Vector3d(viewpoint[0], viewpoint[1], viewpoint[2]), std::move(bins)));
}

FreeSpaceMap::Answer FreeSpaceMap::ask(const Station& station, const Eigen::Vector3d& place, double tolerance)
{
  const Eigen::Vector3d to = place - station.viewpoint;
  const double distance = to.norm();
  const Lengths& beams = station.bins[binOf(to, station.side)];
  if (!(distance > 0) || beams.longest == 0)
    return Answer::Unknown;
  if (distance > beams.longest + tolerance)
    return Answer::Hidden;
  return beams.shortest > distance + tolerance ? Answer::Through : Answer::There;
}

bool FreeSpaceMap::hidesByWhatMoved(const Station& station, const Eigen::Vector3d& place, double tolerance) const
{
  const Eigen::Vector3d to = place - station.viewpoint;
  const Eigen::Vector3d end = station.viewpoint + station.bins[binOf(to, station.side)].longest * to.normalized();
  return std::any_of(stations_.begin(), stations_.end(), [&](const Station& other) {
    return &other != &station && ask(other, end, tolerance) == Answer::Through;
  });
}

bool FreeSpaceMap::isFree(const Eigen::Vector3d& place, double tolerance) const
{
  int through = 0, there = 0;
  for (const Station& station : stations_) {
    const Answer answer = ask(station, place, tolerance);
    through += answer == Answer::Through;
    there += answer == Answer::There;
  }
  for (auto s = stations_.begin(); s != stations_.end() && through > 2 * there; ++s)
    there += ask(*s, place, tolerance) == Answer::Hidden && hidesByWhatMoved(*s, place, tolerance);
  return through > 2 * there;
}
} // namespace fresco
