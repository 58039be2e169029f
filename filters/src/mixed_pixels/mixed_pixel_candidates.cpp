// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/mixed_pixel_candidates.h"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
namespace fresco::filters {
namespace {
constexpr float beyond_noise = 3; // deviations: what noise hardly reaches

/// Whether a point has nearer and farther ones beside it, and few that a surface could join it with.
bool isBetween(const BeamWindow& window, float noise, float slope)
{
  constexpr float most_joined = 0.75f; // share of the nearer half of the beams around
  bool front = false, behind = false;
  for (std::size_t k = 0; k < window.beams.size() && k < nearby_beams; ++k) {
    front |= window.beams[k].range < window.range - beyond_noise * noise;
    behind |= window.beams[k].range > window.range + beyond_noise * noise;
  }
  return front && behind && joinedShare(window, noise, slope) <= most_joined;
}

/// The windows of one beam after the other.
class BeamWindows {
public:
  BeamWindows(const BeamScan& scan, const MixedPixelOptions& options)
      : scan_(scan), k_(options.k), slope_(1 / std::tan(options.angle * static_cast<float>(radians_per_degree)))
  {}

  /// @return whether it is a candidate
  bool fill(Index i)
  {
    noise_ = scan_.noise.at(scan_.ranges[i]);
    BeamWindow& listed = scan_.thinned ? wide_ : near_;
    fillWindow(scan_, i, scan_.lists.first(i), scan_.lists.last(i), listed);
    if (listed.beams.size() < nearby_beams)
      return false;
    if (!scan_.thinned)
      return isBetween(near_, noise_, slope_);
    if (!canBeBetween())
      return false;
    listNearest(i, k_);
    fillFromList(i, near_);
    return near_.beams.size() >= nearby_beams && (isBetween(wide_, noise_, slope_) || isBetween(near_, noise_, slope_));
  }

  /// Without beams of positive scores, where enough others are there.
  void fillWithout(Index i, const std::vector<float>& scores)
  {
    const auto leaveOut = [&] {
      const auto high = [&](int j) { return j != i && scores[j] > 0; };
      list_.erase(std::remove_if(list_.begin(), list_.end(), high), list_.end());
      list_.resize(std::min<std::size_t>(list_.size(), k_ + 1));
      return list_.size() > nearby_beams;
    };
    listNearest(i, most_beams);
    if (leaveOut())
      fillFromList(i, near_);
    if (!scan_.thinned)
      return;
    list_.assign(scan_.lists.first(i), scan_.lists.last(i));
    if (leaveOut())
      fillFromList(i, wide_);
  }
  BeamSurroundings around() const { return {near_, scan_.thinned ? wide_ : near_, noise_}; }
  /// ringsAround() over farther beams than those of around().
  auto rings(Index i, const std::vector<float>& scores)
  {
    listNearest(i, most_beams);
    fillFromList(i, far_);
    return ringsAround(far_, noise_, scores);
  }

private:
  /// Nearest first.
  void listNearest(Index i, Index count)
  {
    scan_.tree->nearestKeys(scan_.directions.col(i), count + 1, found_);
    std::sort(found_.begin(), found_.end());
    list_.clear();
    for (const PointTree::Key key : found_)
      list_.push_back(PointTree::position(key));
  }
  void fillFromList(Index i, BeamWindow& window) const
  {
    fillWindow(scan_, i, list_.data(), list_.data() + list_.size(), window);
  }

  /// Whether anything of the wide window is nearer and anything farther.
  bool canBeBetween() const
  {
    float least = wide_.range, most = wide_.range;
    for (const BeamWindow::Beam& beam : wide_.beams) {
      least = std::min(least, beam.range);
      most = std::max(most, beam.range);
    }
    return least < wide_.range - beyond_noise * noise_ && most > wide_.range + beyond_noise * noise_;
  }

  const BeamScan& scan_;
  Index k_;
  float slope_, noise_ = 0;
  BeamWindow near_, wide_, far_;
  std::vector<PointTree::Key> found_;
  std::vector<int> list_;
};

/// How many neighbours of a mixed pixel are mixed pixels: beams that score above 0 among the nearest in 8 directions, of
/// `near`, then of `wide`, on average over the beams that do so themselves. Where these are few, mostly what is usual.
Eigen::Vector2f mixedNeighborCounts(const BeamScan& scan, const MixedPixelOptions& options,
                                    const std::vector<float>& scores)
{
  constexpr int half = mixed_pixel_features::bearings;
  constexpr float usual = 2, as_many = 4;
  std::atomic<Index> near{0}, wide{0}, beams{0};
  parallelRanges(scan.ranges.size(), options.threads, [&](Index begin, Index end) {
    BeamWindows windows(scan, options);
    for (Index i = begin; i < end; ++i)
      if (scores[i] > 0 && windows.fill(i)) {
        const auto around = scoresAround(windows.around(), scores);
        near += (around.head<half>().array() > 0).count();
        wide += (around.tail<half>().array() > 0).count();
        ++beams;
      }
  });
  const Eigen::Vector2f sums(near, wide);
  return (sums.array() + usual * as_many) / (beams + as_many);
}
} // namespace

void forMixedPixelCandidates(const BeamScan& scan, const MixedPixelOptions& options, const UseMixedPixelCandidate& use)
{
  parallelRanges(scan.ranges.size(), options.threads, [&](Index begin, Index end) {
    BeamWindows windows(scan, options);
    for (Index i = begin; i < end; ++i)
      if (windows.fill(i))
        use(i, windows.around());
  });
}

void forSecondStage(const BeamScan& scan, const MixedPixelOptions& options, const std::vector<float>& scores,
                    const UseSecondStage& use)
{
  const Eigen::Vector2f width = mixedNeighborCounts(scan, options, scores);
  parallelRanges(scan.ranges.size(), options.threads, [&](Index begin, Index end) {
    BeamWindows windows(scan, options);
    for (Index i = begin; i < end; ++i) {
      const float score = scores[i];
      if (!(score > least_second_stage) || !windows.fill(i))
        continue;
      const MixedPixelFeatures before = mixedPixelFeatures(windows.around());
      const auto around = scoresAround(windows.around(), scores);
      const auto rings = windows.rings(i, scores);
      windows.fillWithout(i, scores);
      SecondStageFeatures features;
      features << before, mixedPixelFeatures(windows.around()), std::max(score, mixed_pixel_features::least_score),
          around, rings, width;
      use(i, features);
    }
  });
}
} // namespace fresco::filters
