// SPDX-License-Identifier: BSD-3-Clause
#include "views/photo_consistency.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
namespace fresco::texture {
namespace {
/// Median per channel over the views with a vote; false if they are too few.
bool consensus(const Candidates& candidates, Index patch, const Photometry& photometry, Eigen::Vector3f& color)
{
  constexpr std::size_t least_views = 3; // for a majority
  constexpr float trusted = 0.1f;        // of the best quality: views that show much less blur the colour
  const Candidate* list = candidates.of(patch);
  const Index n = candidates.count(patch);
  const float best = candidates.bestQuality(patch);
  std::vector<float> values[3];
  for (Index i = 0; i < n; ++i)
    if (list[i].quality() >= trusted * best && !list[i].clipped)
      for (int c = 0; c < 3; ++c)
        values[c].push_back(list[i].corrected(photometry)[c]);
  if (values[0].size() < least_views)
    return false;
  for (int c = 0; c < 3; ++c)
    color[c] = median(values[c]);
  return true;
}

/// Mean with the same view's values on neighbouring patches.
std::vector<float> smoothed(const PatchMesh& patches, const Candidates& candidates, const std::vector<float>& value,
                            int threads)
{
  std::vector<float> out(value.size());
  parallelFor(patches.size(), threads, [&](Index i) {
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c) {
      float sum = value[c], count = 1;
      for (int side = 0; side < 3; ++side)
        if (const int other = patches.neighbors(side, i); other >= 0)
          if (const Candidate* same = candidates.find(other, candidates.list[c].view)) {
            sum += value[same - candidates.list.data()];
            ++count;
          }
      out[c] = sum / count;
    }
  });
  return out;
}
} // namespace

std::vector<float> photoConsistencyPenalties(const PatchMesh& patches, const Candidates& candidates,
                                             const Photometry& photometry, int threads)
{
  constexpr int smoothing_rounds = 2; // what differs is a region; single patches differ by small errors of alignment
  constexpr float one_octave = 20;    // grey levels of difference that cost an octave: well above noise
  constexpr float most_octaves = 5;   // by difference: a view that alone shows the patch well keeps a chance
  constexpr float clipped_octaves = 6; // loses to all that are not
  std::vector<float> difference(candidates.list.size(), 0.f);
  parallelFor(patches.size(), threads, [&](Index i) {
    Eigen::Vector3f usual;
    if (!consensus(candidates, i, photometry, usual))
      return;
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c)
      difference[c] = (candidates.list[c].corrected(photometry) - usual).cwiseAbs().maxCoeff();
  });
  for (int round = 0; round < smoothing_rounds; ++round)
    difference = smoothed(patches, candidates, difference, threads);
  std::vector<float> cost(difference.size());
  parallelFor(cost.size(), threads, [&](Index c) {
    const float octaves = difference[c] / one_octave;
    cost[c] = std::min(octaves * octaves, most_octaves) +
              (candidates.list[c].clipped ? clipped_octaves : 0.f);
  });
  return cost;
}
} // namespace fresco::texture
