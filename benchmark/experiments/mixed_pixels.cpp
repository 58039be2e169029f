// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/scanned_room.h"
#include "support/tool.h"
#include <cstdio>
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/search/neighbors.h>
#include <fresco/search/triangle_tree.h>
#include <fresco/simulation/scene/labels.h>
/// Mixed pixels of laser scans of a generated room that withoutMixedPixels() finds, and what else it takes, against the labels
/// of the generator.
using namespace fresco;
using namespace fresco::simulation;

namespace {
/// How well whoever knows the surfaces finds mixed pixels: those farther off than `deviations` of the noise of the beam.
struct KnownSurfaces {
  double deviations;
  Index taken = 0, taken_several = 0, taken_mixed = 0;
};

struct Counts {
  Index points = 0, several = 0, taken = 0, taken_several = 0;
  KnownSurfaces known[3] = {{2}, {3}, {4}};
  static constexpr double off[4] = {0.01, 0.02, 0.04, 1e30}; ///< metres to the nearest surface: upper bounds
  Index mixed[4] = {0, 0, 0, 0}, found[4] = {0, 0, 0, 0};
  Index clear[2] = {0, 0}, clear_found[2] = {0, 0}; ///< off by more than 1, 2 spacings
};

double share(Index part, Index whole)
{
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

void printRow(const Counts& c)
{
  Index mixed = 0, found = 0;
  for (int b = 0; b < 4; ++b)
    mixed += c.mixed[b], found += c.found[b];
  std::printf("| %ld | %ld | %.3f ", static_cast<long>(c.points), static_cast<long>(mixed), share(found, mixed));
  for (int b = 0; b < 4; ++b)
    std::printf("| %.2f of %ld ", share(c.found[b], c.mixed[b]), static_cast<long>(c.mixed[b]));
  for (int b = 0; b < 2; ++b)
    std::printf("| %.2f of %ld ", share(c.clear_found[b], c.clear[b]), static_cast<long>(c.clear[b]));
  std::printf("| %.3f of %ld ", share(c.taken_several, c.taken), static_cast<long>(c.taken));
  std::printf("| %.3f of %ld |\n", share(c.taken_several, c.several), static_cast<long>(c.several));
  std::fflush(stdout);
}

void printKnown(const Counts& c)
{
  Index mixed = 0;
  for (const Index points : c.mixed)
    mixed += points;
  std::printf("\n| surfaces known, off by more than | recall | precision | recall of all mixed |\n|---|---|---|---|\n");
  for (const KnownSurfaces& known : c.known)
    std::printf("| %g deviations | %.3f | %.3f | %.3f |\n", known.deviations, share(known.taken_mixed, mixed),
                share(known.taken_several, known.taken), share(known.taken_several, c.several));
}

/// Adds a mixed pixel. @param range, off from the scanner and the nearest surface @param n points of the scan
void addMixedPixel(Counts& counts, double range, double off, double n, bool taken)
{
  // directions from 60 degrees below the horizon to the zenith: 2 pi (1 + sin 60)
  const double spacing = range * std::sqrt(2 * 3.14159265 * 1.8660254 / n);
  int b = 0;
  while (off > Counts::off[b])
    ++b;
  ++counts.mixed[b];
  counts.found[b] += taken;
  for (int m = 0; m < 2; ++m)
    if (off > (m + 1) * spacing) {
      ++counts.clear[m];
      counts.clear_found[m] += taken;
    }
}

void count(const LaserScan& scan, const TriangleTree& surfaces, const Eigen::Matrix4d& T_truth_scan, Counts& counts)
{
  const std::vector<PointLabel> labels = labelPoints(scan, surfaces, T_truth_scan);
  const Points& points = scan.points.points;
  std::vector<char> stays(labels.size(), 0);
  for (const Index i : withoutMixedPixels(points, scan.points.viewpoints))
    stays[i] = 1;
  const Eigen::Matrix3Xd placed =
      (T_truth_scan.topLeftCorner<3, 3>() * points.cast<double>()).colwise() + T_truth_scan.topRightCorner<3, 1>();
  const std::vector<ClosestPoint> closest = closestPoints(surfaces, placed, 0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool taken = stays[i] == 0, several = labels[i] != PointLabel::surface,
               mixed = labels[i] == PointLabel::mixed_pixel;
    ++counts.points;
    counts.several += several;
    counts.taken += taken;
    counts.taken_several += taken && several;
    const double off = closest[i].distance;
    for (KnownSurfaces& known : counts.known)
      if (off > known.deviations * scan.deviations[i]) {
        ++known.taken;
        known.taken_several += several;
        known.taken_mixed += mixed;
      }
    if (mixed)
      addMixedPixel(counts, points.col(static_cast<Index>(i)).norm(), off, static_cast<double>(labels.size()), taken);
  }
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_mixed_pixels", [&] {
    std::string name = "conference_room";
    int stations = 1;
    LaserOptions laser;
    CommonOptions common;
    Args args("fresco_benchmark_mixed_pixels [options]",
              "Mixed pixels of generated laser scans: how many withoutMixedPixels() finds and what else it takes, and "
              "how many one "
              "would find who knows the surfaces.");
    args.option("scene", name, "conference_room, apartment or a mesh file");
    args.option("stations", stations, Range::atLeast(1), "laser stations");
    args.option("points", laser.points, Range::atLeast(100), "laser points per station, about");
    args.option("noise", laser.noise, Range::atLeast(0), "deviation of the range at 4 m, metres");
    args.option("beam", laser.beam_radius, Range::atLeast(0), "radius of the beam at the exit, metres");
    args.option("divergence", laser.divergence, Range::atLeast(0), "growth of the radius, radians");
    common.declare(args);
    args.parse(argc, argv, 0);
    const ScannedRoom room(name, stations, common.threads);
    const TriangleTree surfaces(room.scene.mesh, common.threads);
    Counts counts;
    for (Index s = 0; s < room.stations.cols(); ++s) {
      const auto [scan, T_room_scan] = room.scanFrom(s, laser);
      count(scan, surfaces, T_room_scan, counts);
    }
    std::printf(
        "| points | mixed pixels | recall | off by 4 deviations - 1 cm | - 2 cm | - 4 cm | more | > 1 spacing | > 2 "
        "spacings | precision | recall of all mixed |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    printRow(counts);
    printKnown(counts);
  });
}
