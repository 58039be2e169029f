// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/crease_normals.h"
#include "experiments/normals_sample.h"
#include "support/tool.h"
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/io/file.h>
/// What smoothNormals() chooses from beside creases, with the truth: the input of candidate_score.py.
using namespace fresco;
using namespace fresco::filters;

namespace {
/// A row of the file.
struct Row {
  float point, place, cosine; ///< column, NormalSample::place, to the true normal
  float features[NormalCandidateFeatures::count];
};

std::vector<Row> rowsOf(const NormalSample& sample, int threads)
{
  PointSet set;
  set.points = sample.points;
  set.viewpoints = sample.viewpoints;
  NormalOptions estimation;
  estimation.threads = threads;
  BilateralOptions smoothing;
  smoothing.threads = threads;
  smoothing.rounds = 1;
  smoothing.edges = false;
  const Points smooth = smoothNormals(set.points, estimateNormals(set, estimation).normals, smoothing).normals;
  const SmoothingField field = makeSmoothingField(set.points, smooth, smoothing);
  std::vector<Row> rows;
  forCreaseCandidates(field, set.viewpoints, field.normals, 1,
                      [&](Index i, const std::vector<NormalCandidate>& candidates, NormalCandidateFeatures& features) {
                        const int column = field.tree->columns()[i];
                        if (!sample.truth.col(column).allFinite())
                          return;
                        for (const NormalCandidate& candidate : candidates) {
                          Row row{static_cast<float>(column),
                                  static_cast<float>(sample.place[column]),
                                  candidate.direction.dot(sample.truth.col(column)),
                                  {}};
                          NormalCandidateFeatures::Features::Map(row.features) = features.of(candidate);
                          rows.push_back(row);
                        }
                      });
  return rows;
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_normal_candidates", [&] {
    NormalMeasure options;
    CommonOptions common;
    LaserOptions laser;
    laser.points = 1000000;
    std::string output;
    int seed = 1;
    bool closed = false;
    Args args(
        "fresco_benchmark_normal_candidates -o OUT [options]",
        "Writes the features of the directions that points beside creases are candidates, of generated laser scans: "
        "rows of floats, point, place, cosine to the true normal, features.");
    args.option("o", output, "file to write");
    args.option("scene", options.scene, "conference_room, apartment or a mesh file");
    args.flag("closed", closed, "a mesh is a closed room in metres, its floor at z = 0");
    args.flag("merged", options.merged, "all stations in one cloud; else each station for itself");
    args.option("stations", options.stations, "laser stations");
    args.option("points", laser.points, "laser points per station, about");
    args.option("noise", laser.noise, "deviation of the ranges, metres");
    args.option("seed", seed, "of the noise");
    common.declare(args);
    args.parse(argc, argv, 0);
    laser.seed = static_cast<std::uint64_t>(seed);
    if (output.empty())
      throw UsageError("no -o OUT");
    const ScannedRoom room(options.scene, options.stations, common.threads, closed);
    const Creases creases(room.scene.mesh, options, common.threads);
    OutputFile file(output);
    for (const NormalSample& sample : takeSamples(room, creases, laser, options.merged)) {
      const std::vector<Row> rows = rowsOf(sample, common.threads);
      file.write(rows.data(), rows.size() * sizeof(Row));
    }
    file.commit();
  });
}
