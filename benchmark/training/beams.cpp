// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/scanned_room.h"
#include "mixed_pixels/mixed_pixel_score.h"
#include "support/tool.h"
#include <algorithm>
#include <fresco/io/file.h>
#include <fresco/search/triangle_tree.h>
#include <fresco/simulation/scene/labels.h>
#include <fresco/simulation/sensors/random.h>
#include <mutex>
#include <numeric>
/// What withoutMixedPixels() judges, with the truth: the input of mixed_pixels.py.
using namespace fresco;
using namespace fresco::simulation;
using namespace fresco::filters;

namespace {
/// What stands before the features of a row.
struct Head {
  float column, label, weight; ///< PointLabel; points of the scan that it stands for
};

struct Rows {
  struct Row {
    Index column;
    Head head;
    Eigen::VectorXf features;
  };
  std::vector<Row> rows;
  void write(OutputFile& file)
  {
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.column < b.column; });
    for (const Row& row : rows) {
      file.write(&row.head, sizeof(Head));
      file.write(row.features.data(), static_cast<std::size_t>(row.features.size()) * sizeof(float));
    }
  }
};

/// Some of the beams, at random.
LaserScan thinned(const LaserScan& scan, double share)
{
  LaserScan some;
  std::vector<Index> kept;
  for (Index i = 0; i < scan.points.size(); ++i)
    if (CounterRandom(9, 9, static_cast<std::uint64_t>(i)).uniform() < share)
      kept.push_back(i);
  some.points = selectPoints(scan.points, kept);
  for (const Index i : kept) {
    some.faces.push_back(scan.faces[i]);
    some.mixed.push_back(scan.mixed[i]);
    some.deviations.push_back(scan.deviations[i]);
  }
  return some;
}

struct Choice {
  bool second_stage = false; ///< those that the second network judges
  double part = 1;           ///< of the points of surfaces
};

BeamScan beamScan(const LaserScan& scan, const MixedPixelOptions& options)
{
  std::vector<Index> columns(scan.points.size());
  std::iota(columns.begin(), columns.end(), 0);
  BeamScan beams = makeBeamScan(scan.points.points, scan.points.viewpoints.col(0), columns, options);
  beams.noise = measureNoise(beams, options.threads);
  return beams;
}

Rows rowsOf(const BeamScan& beams, const std::vector<PointLabel>& labels, const Choice& choice,
            const MixedPixelOptions& options)
{
  Rows rows;
  std::vector<char> seen(labels.size(), 0);
  std::mutex mutex;
  const auto columnOf = [&](Index i) { return beams.columns[i]; };
  const auto leftOut = [&](std::size_t column) {
    return labels[column] == PointLabel::surface && CounterRandom(7, 7, column).uniform() >= choice.part;
  };
  const auto add = [&](Index i, const auto& features) { // () -> features
    const std::size_t column = columnOf(i);
    seen[column] = 1;
    if (leftOut(column))
      return;
    const Head head{static_cast<float>(column), static_cast<float>(labels[column]),
                    labels[column] == PointLabel::surface ? static_cast<float>(1 / choice.part) : 1.f};
    Rows::Row row{static_cast<Index>(column), head, features()};
    const std::lock_guard lock(mutex);
    rows.rows.push_back(std::move(row));
  };
  if (choice.second_stage)
    forSecondStage(beams, options, firstStageScores(beams, options),
                   [&](Index i, const SecondStageFeatures& features) { add(i, [&] { return features; }); });
  else
    forMixedPixelCandidates(beams, options, [&](Index i, const BeamSurroundings& around) {
      add(i, [&] { return mixedPixelFeatures(around); });
    });
  Head others{-1, static_cast<float>(PointLabel::mixed_pixel), 0};
  for (std::size_t i = 0; i < labels.size(); ++i)
    others.weight += seen[i] == 0 && labels[i] == PointLabel::mixed_pixel ? 1.f : 0.f;
  const Index width = choice.second_stage ? mixed_pixel_features::second_stage_count : mixed_pixel_features::count;
  rows.rows.push_back({-1, others, Eigen::VectorXf::Zero(width)});
  return rows;
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_beams", [&] {
    CommonOptions common;
    LaserOptions laser;
    std::string output, name = "conference_room";
    int seed = 1, stations = 1;
    bool closed = false;
    Choice choice;
    double keep = 1;
    Args args(
        "fresco_benchmark_beams -o OUT [options]",
        "Writes the features of beams that have nearer and farther ones beside them, of generated laser scans: rows "
        "of floats, point, label, weight, features. The first row of a scan has point -1; its weight is the number "
        "of mixed pixels that are not among them.");
    args.flag("second_stage", choice.second_stage, "only those that the second network judges, with its features");
    args.option("o", output, "file to write");
    args.option("scene", name, "conference_room, apartment or a mesh file");
    args.flag("closed", closed, "a mesh is a closed room in metres, its floor at z = 0");
    args.option("stations", stations, "laser stations");
    args.option("points", laser.points, "laser points per station, about");
    args.option("noise", laser.noise, "deviation of the ranges at 4 m, metres");
    args.option("beam", laser.beam_radius, "radius of the beam at the exit, metres");
    args.option("divergence", laser.divergence, "growth of the radius, radians");
    args.option("pulse", laser.pulse, "metres within which ranges mix");
    args.option("rings", laser.rings, "rings of rays around the middle of a beam");
    args.option("keep", keep, "share of the beams that stays, at random, 0..1");
    args.option("part", choice.part, "share of the points of surfaces that is written, 0..1");
    args.option("seed", seed, "of noise and poses");
    common.declare(args);
    args.parse(argc, argv, 0);
    laser.seed = static_cast<std::uint64_t>(seed);
    if (output.empty())
      throw UsageError("no -o OUT");
    if (!(choice.part > 0 && choice.part <= 1 && keep > 0 && keep <= 1))
      throw UsageError("-part or -keep is not in 0..1");
    const ScannedRoom room(name, stations, common.threads, closed);
    const TriangleTree surfaces(room.scene.mesh, common.threads);
    MixedPixelOptions options;
    options.threads = common.threads;
    OutputFile file(output);
    for (Index s = 0; s < room.stations.cols(); ++s) {
      auto [scan, T_room_scan] = room.scanFrom(s, laser);
      if (keep < 1)
        scan = thinned(scan, keep);
      rowsOf(beamScan(scan, options), labelPoints(scan, surfaces, T_room_scan), choice, options).write(file);
    }
    file.commit();
  });
}
