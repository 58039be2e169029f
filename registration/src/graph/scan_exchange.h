// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
#include "pair/pair_ranking.h"
#include "scan/lists.h"
#include <fresco/io/packing.h>
namespace fresco {
template <typename Archive>
void fields(Archive& archive, Refusal& refusal)
{
  archive(refusal.reason, refusal.scan, refusal.agree, refusal.contradict);
}
} // namespace fresco
namespace fresco::registration {
// What ranks tell each other of scans and pairs, see Packer.

/// All but the caller's own search and the tree, which its receiver makes anew: shareScans().
template <typename Archive>
void fields(Archive& archive, ScanLevel& level)
{
  archive(level.voxel, level.points, level.viewpoints, level.colors, level.normals, level.around,
          level.surface_variation, level.samples);
}

template <typename Archive>
void fields(Archive& archive, ScanAlias& alias)
{
  archive(alias.T, alias.certain, alias.partial);
}

template <typename Archive>
void fields(Archive& archive, PreparedScan& scan)
{
  archive(scan.problem, scan.duplicate_of, scan.center, scan.viewpoint_given, scan.viewpoint_found, scan.blind,
          scan.viewpoint_problem, scan.size, scan.oriented, scan.levels, scan.free_space, scan.aliases);
}

template <typename Archive>
void fields(Archive& archive, PlaneHistogram& histogram)
{
  archive(histogram.first, histogram.weights);
}

template <typename Archive>
void fields(Archive& archive, ScanPlanes& planes)
{
  archive(planes.axes, planes.bin, planes.histograms);
}

template <typename Archive>
void fields(Archive& archive, ScanFeatures& features)
{
  archive(features.points, features.normals, features.descriptors, features.planes);
}

template <typename Archive>
void fields(Archive& archive, PairCheck& check)
{
  archive(check.overlap, check.violation, check.violation_a, check.violation_b, check.violating_points, check.color);
}

template <typename Archive>
void fields(Archive& archive, VerifiedHypothesis& hypothesis)
{
  archive(hypothesis.T_a_b, hypothesis.check, hypothesis.votes, hypothesis.support, hypothesis.score,
          hypothesis.has_free_motion, hypothesis.has_alias);
}

template <typename Archive>
void fields(Archive& archive, PairAlignment& pair)
{
  archive(pair.a, pair.b, pair.hypotheses, pair.ambiguous, pair.rejected);
}

template <typename Archive>
void fields(Archive& archive, ScanCluster& cluster)
{
  archive(cluster.scans, cluster.poses, cluster.refusal);
}

template <typename Archive>
void fields(Archive& archive, PlanPlace& place)
{
  archive(place.a, place.b, place.T_a_b);
}

template <typename Archive>
void fields(Archive& archive, ScanGraph& graph)
{
  archive(graph.clusters, graph.places);
}

/// What make(k) gives for k = 0..n-1, each a task of one rank; all ranks get it.
template <typename Make>
auto mapShared(Exchange& ranks, int threads, Index n, const Make& make)
{
  std::vector<std::decay_t<decltype(make(n))>> made(n);
  const Index step = ranks.size(), first = ranks.rank();
  forEachTask((n - first + step - 1) / step, threads,
              [&](Index k) { made[first + k * step] = make(first + k * step); });
  shareItems(ranks, made);
  return made;
}

/// Aligns pairs likewise. @param align align(a, b), of two scans
template <typename Align>
std::vector<PairAlignment> alignAll(Exchange& ranks, int threads, const std::vector<RankedPair>& pairs,
                                    const Align& align)
{
  return mapShared(ranks, threads, pairs.size(), [&](Index k) {
    PairAlignment pair = align(pairs[k].a, pairs[k].b);
    pair.a = pairs[k].a;
    pair.b = pairs[k].b;
    return pair;
  });
}

/// Adds pairs to those that are there, ordered by (a, b).
void addPairs(const std::vector<PairAlignment>& more, std::vector<PairAlignment>& pairs);

/// As shareItems().
void shareScans(Exchange& ranks, std::vector<PreparedScan>& scans, int threads);
} // namespace fresco::registration
