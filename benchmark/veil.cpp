// SPDX-License-Identifier: BSD-3-Clause
#include "scanned_room.h"
#include "support/tool.h"
#include "virtual/labels.h"
#include <cstdio>
#include <fresco/filters/core/neighbors.h>
#include <fresco/filters/core/veil_points.h>
#include <fresco/surface/core/triangle_tree.h>
/// Veil points of laser scans of a generated room that withoutVeil() finds, and what else it takes, against the labels
/// of the generator.
using namespace fresco;

namespace {
struct Counts {
  Index points = 0, several = 0, taken = 0, taken_several = 0;
  static constexpr double off[4] = {0.01, 0.02, 0.04, 1e30}; ///< metres to the nearest surface: upper bounds
  Index veil[4] = {0, 0, 0, 0}, found[4] = {0, 0, 0, 0};
  Index clear[2] = {0, 0}, clear_found[2] = {0, 0}; ///< off by more than 1, 2 spacings
};

void printRow(const Counts& c)
{
  const auto share = [](Index part, Index whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  Index veil = 0, found = 0;
  for (int b = 0; b < 4; ++b)
    veil += c.veil[b], found += c.found[b];
  std::printf("| %ld | %ld | %.3f ", static_cast<long>(c.points), static_cast<long>(veil), share(found, veil));
  for (int b = 0; b < 4; ++b)
    std::printf("| %.2f of %ld ", share(c.found[b], c.veil[b]), static_cast<long>(c.veil[b]));
  for (int b = 0; b < 2; ++b)
    std::printf("| %.2f of %ld ", share(c.clear_found[b], c.clear[b]), static_cast<long>(c.clear[b]));
  std::printf("| %.3f of %ld |\n", share(c.taken_several, c.taken), static_cast<long>(c.taken));
  std::fflush(stdout);
}

void count(const LaserScan& scan, const TriangleTree& surfaces, const Eigen::Matrix4d& T_truth_scan, Counts& counts)
{
  const std::vector<PointLabel> labels = labelPoints(scan, surfaces, T_truth_scan);
  std::vector<char> stays(labels.size(), 0);
  for (const Index i : withoutVeil(scan.points.points, scan.points.viewpoints))
    stays[static_cast<std::size_t>(i)] = 1;
  const auto n = static_cast<double>(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool taken = stays[i] == 0, several = labels[i] != PointLabel::surface;
    ++counts.points;
    counts.several += several;
    counts.taken += taken;
    counts.taken_several += taken && several;
    if (labels[i] != PointLabel::veil)
      continue;
    const Eigen::Vector3d point = scan.points.points.col(static_cast<Index>(i)).cast<double>();
    const double off = surfaces.closest((T_truth_scan * point.homogeneous()).head<3>()).distance;
    // directions from 60 degrees below the horizon to the zenith: 2 pi (1 + sin 60)
    const double spacing = point.norm() * std::sqrt(2 * 3.14159265 * 1.8660254 / n);
    int b = 0;
    while (off > Counts::off[b])
      ++b;
    ++counts.veil[b];
    counts.found[b] += taken;
    for (int m = 0; m < 2; ++m)
      if (off > (m + 1) * spacing) {
        ++counts.clear[m];
        counts.clear_found[m] += taken;
      }
  }
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_veil", [&] {
    std::string name = "conference_room";
    int stations = 1;
    LaserOptions laser;
    CommonOptions common;
    Args args("fresco_benchmark_veil [options]",
              "Veil points of generated laser scans: how many withoutVeil() finds, and what else it takes.");
    args.option("scene", name, "conference_room, apartment or a mesh file");
    args.option("stations", stations, "laser stations");
    args.option("points", laser.points, "laser points per station, about");
    args.option("noise", laser.noise, "deviation of the range at 4 m, metres");
    args.option("beam", laser.beam_radius, "radius of the beam at the exit, metres");
    args.option("divergence", laser.divergence, "growth of the radius, radians");
    common.declare(args);
    args.parse(argc, argv, 0);
    const ScannedRoom room(name, stations, common.threads);
    const TriangleTree surfaces(room.scene.mesh, common.threads);
    Counts counts;
    for (Index s = 0; s < room.stations.cols(); ++s) {
      const Eigen::Vector3d station = room.stations.col(s).cast<double>() + room.scene.mesh.origin;
      const Eigen::Matrix4d pose = randomPose(station, laser.seed, static_cast<int>(s));
      Eigen::Matrix4d T_truth_scan = pose;
      T_truth_scan.topRightCorner<3, 1>() -= room.scene.mesh.origin;
      count(scanScene(room.lit(), pose, laser, static_cast<int>(s)), surfaces, T_truth_scan, counts);
    }
    std::printf("| points | veil | recall | off by 4 deviations - 1 cm | - 2 cm | - 4 cm | more | > 1 spacing | > 2 "
                "spacings | precision |\n|---|---|---|---|---|---|---|---|---|---|\n");
    printRow(counts);
  });
}
