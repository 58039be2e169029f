// SPDX-License-Identifier: BSD-3-Clause
#include "views/photo_consistency.h"
#include "views/picture_evidence.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
/// Difference of two colours, grey levels.
float differenceOf(const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// Weight of a vote by the difference that the view's own photograph lets expect.
float trustOf(float expected) { return 1 / (1 + (expected / one_octave) * (expected / one_octave)); }

/// A view's opinion of a patch.
struct Vote {
  Eigen::Vector3f color, towards; ///< towards the camera
  float weight;
  bool clipped; ///< the light is as bright as the colour at least
};

/// What votes are taken from.
struct VoteInput {
  const PatchMesh& patches;
  const Candidates& candidates;
  const Photometry& photometry;
  const VisibilityInput& input;
};

/// Views from nearly one direction are one witness: what stands before the patch and is not in the mesh hides it from all
/// of them.
/// @param expected differences of the candidates; empty: not known
std::vector<Vote> votesOf(const VoteInput& of, Index patch, const std::vector<float>& expected)
{
  constexpr float trusted = 0.1f; // of the best quality: views that show much less blur the colour
  constexpr float apart = 0.03f;  // 1 - cosine, 14 degrees: of an arm rest's width and height above its seat
  const auto& [patches, candidates, photometry, input] = of;
  const float best = candidates.bestQuality(patch);
  const Eigen::Vector3f middle = patches.middle(patch);
  std::vector<Vote> out;
  for (Index c = candidates.begin[patch]; c < candidates.begin[patch + 1]; ++c)
    if (const Candidate& candidate = candidates.list[c]; candidate.quality >= trusted * best)
      out.push_back({candidate.corrected(photometry),
                     (input.views.projectors[candidate.view].center() - middle).normalized(),
                     expected.empty() ? 1.f : trustOf(expected[c]), candidate.clipped != 0});
  for (Vote& v : out) {
    float alike = 1;
    for (const Vote& other : out)
      alike += &other == &v ? 0 : std::max(0.f, 1 - (1 - v.towards.dot(other.towards)) / apart);
    v.weight /= alike;
  }
  return out;
}

/// Weighted median per channel.
Eigen::Vector3f medianOf(std::vector<Vote>& votes)
{
  float half = 0;
  for (const Vote& v : votes)
    half += 0.5f * v.weight;
  Eigen::Vector3f out;
  for (int c = 0; c < 3; ++c) {
    std::sort(votes.begin(), votes.end(), [c](const Vote& a, const Vote& b) { return a.color[c] < b.color[c]; });
    float below = 0;
    std::size_t k = 0;
    while (k + 1 < votes.size() && below + votes[k].weight <= half)
      below += votes[k++].weight;
    out[c] = votes[k].color[c];
  }
  return out;
}

/// What the views say of a patch.
struct Consensus {
  Eigen::Vector3f color;
  int margin = 0;        ///< views that agree more than that differ; 0 = they are too few, or two that disagree
  bool at_least = false; ///< nearly all are overexposed: it is at least as bright

  float differenceOf(const Candidate& candidate, const Photometry& photometry) const
  {
    const Eigen::Vector3f apart = candidate.corrected(photometry) - color;
    return at_least ? std::max(0.f, -apart.minCoeff()) : apart.cwiseAbs().maxCoeff();
  }
};

/// Of overexposed views. Where they outvote the others and say that it is brighter than these show, it is.
Consensus leastLight(const std::vector<Vote>& clipped, const std::vector<Vote>& others, const Eigen::Vector3f& color)
{
  std::vector<Vote> brighter;
  float more = 0;
  for (const Vote& v : clipped)
    if ((v.color - color).maxCoeff() > one_octave) {
      brighter.push_back(v);
      more += v.weight;
    }
  for (const Vote& v : others)
    more -= v.weight;
  if (brighter.size() < 2 || more <= 0)
    return {};
  return {medianOf(brighter), std::max(1, int(brighter.size()) - int(others.size())), true};
}

Consensus consensusOf(const std::vector<Vote>& all)
{
  std::vector<Vote> votes, clipped;
  for (const Vote& v : all)
    (v.clipped ? clipped : votes).push_back(v);
  if (votes.empty())
    return {};
  Consensus out{medianOf(votes), 0};
  if (const Consensus least = leastLight(clipped, votes, out.color); least.at_least)
    return least;
  if (votes.size() < 2)
    return {};
  int agreeing = 0;
  for (const Vote& v : votes)
    agreeing += differenceOf(v.color, out.color) < one_octave;
  const int margin = 2 * agreeing - int(votes.size());
  if (votes.size() > 2 || margin == 2)
    out.margin = std::max(margin, 1);
  return out;
}

/// Means with the same view's values on neighbouring patches: what differs is a region; single patches differ by small
/// errors of alignment.
std::vector<float> smoothed(const VoteInput& of, std::vector<float> value)
{
  const PatchMesh& patches = of.patches;
  const Candidates& candidates = of.candidates;
  for (int round = 0; round < 2; ++round) {
    const std::vector<float> before = value;
    parallelFor(patches.size(), of.input.options.threads, [&](Index i) {
      for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c) {
        float count = 1;
        for (int side = 0; side < 3; ++side)
          if (const int other = patches.neighbors(side, i); other >= 0)
            if (const Candidate* same = candidates.find(other, candidates.list[c].view)) {
              value[c] += before[same - candidates.list.data()];
              ++count;
            }
        value[c] /= count;
      }
    });
  }
  return value;
}

/// @param expected differences of the candidates; empty: not known
ColorDifferences differencesFromConsensus(const VoteInput& of, const std::vector<float>& expected)
{
  const Candidates& candidates = of.candidates;
  const Index patches = of.patches.size();
  ColorDifferences out{std::vector<float>(candidates.list.size(), -1.f), std::vector<float>(patches, 0.f),
                       std::vector<char>(patches, 0)};
  constexpr float none = 1, all = 3; // margins: two against one may show the same wrong thing
  parallelFor(patches, of.input.options.threads, [&](Index i) {
    const Consensus consensus = consensusOf(votesOf(of, i, expected));
    if (consensus.margin == 0)
      return;
    out.certainty[i] = std::clamp((consensus.margin - none) / (all - none), 0.f, 1.f);
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c)
      out.values[c] = consensus.differenceOf(candidates.list[c], of.photometry);
    out.at_least[i] = consensus.at_least;
  });
  return out;
}

/// Of a candidate that no consensus judges. Where two views contradict each other, their difference is that of the one
/// whose own photograph speaks against it.
float inferredDifference(const VoteInput& of, Index patch, Index candidate, const std::vector<float>& expected)
{
  const Candidates& candidates = of.candidates;
  if (candidates.count(patch) != 2)
    return expected[candidate];
  const Index other = 2 * candidates.begin[patch] + 1 - candidate;
  const float own = trustOf(expected[candidate]), others = trustOf(expected[other]);
  const float apart = differenceOf(candidates.list[candidate].corrected(of.photometry),
                                   candidates.list[other].corrected(of.photometry));
  return expected[candidate] + apart * std::max(0.f, (others - own) / (others + own));
}
} // namespace

PhotoConsistency photoConsistency(const PatchMesh& patches, const Candidates& candidates, const Photometry& photometry,
                                  const VisibilityInput& input)
{
  constexpr float most_octaves = 5; // by difference: a view that alone shows the patch well keeps a chance
  // What is clipped loses to all that is not; of it, the darkest says most.
  const float darkest = photometry.gains.cols() > 0 ? photometry.gains.row(1).maxCoeff() : 1;
  constexpr float certain = 50; // grey levels: few surfaces differ so by the light alone
  const VoteInput of{patches, candidates, photometry, input};
  const ColorDifferences first = differencesFromConsensus(of, {});
  const std::vector<float> expected = differencesInPictures(patches, candidates, first, input);
  ColorDifferences second = differencesFromConsensus(of, expected);
  std::vector<float> difference = std::move(second.values);
  const std::vector<float> around = smoothed(of, expected);
  PhotoConsistency out;
  out.foreign.resize(difference.size());
  for (Index i = 0; i < patches.size(); ++i)
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c) {
      if (difference[c] < 0)
        difference[c] = inferredDifference(of, i, c, expected);
      out.foreign[c] = first.certainty[i] < 1 && std::max(expected[c], around[c]) > certain;
    }
  difference = smoothed(of, std::move(difference));
  out.penalties.resize(difference.size());
  // below 0.4 octaves, contrast differs by the directions seen from
  parallelFor(patches.size(), input.options.threads, [&](Index i) {
    const auto at = [&](Index c) { return photometry.sharpnessOf(candidates.list[c].view); };
    float sharpest = -HUGE_VALF;
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c)
      sharpest = std::max(sharpest, at(c));
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c) {
      const float octaves = difference[c] / one_octave;
      const Candidate& shown = candidates.list[c];
      out.penalties[c] = std::min(octaves * octaves, most_octaves) + std::max(0.f, sharpest - at(c) - 0.4f) +
                         (shown.clipped && !second.at_least[i]
                              ? most_octaves + 1 + 2 * std::log2(darkest / photometry.gains(1, shown.view))
                              : 0);
    }
  });
  return out;
}
} // namespace fresco::texture
