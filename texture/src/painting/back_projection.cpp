// SPDX-License-Identifier: BSD-3-Clause
#include "painting/back_projection.h"
#include "painting/patch_frame.h"
#include "painting/photo_residual.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
class BackProjection {
public:
  BackProjection(const PaintScene& scene, const PaintSources& sources, const std::vector<float>& errors,
                 std::vector<Image>& atlases)
      : scene_(scene), sources_(sources), errors_(errors), atlases_(atlases),
        weights_(sources.candidates.list.size(), 0.f)
  {
    parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
      if (scene.isSeen(i))
        normalizeWeights(i);
    });
    listPatches();
  }

  /// @param gain of what the photographs show more than predicted
  void round(float gain)
  {
    constexpr std::size_t group_pixels = 1u << 25; // of residuals held at a time; results depend on it
    const Index n = sources_.views.size();
    const auto pixelsOf = [&](Index v) {
      const CameraModel& camera = sources_.views[v].camera();
      return cellCount(camera.width, camera.height);
    };
    for (Index first = 0, last = 0; first < n; first = last) {
      std::size_t pixels = 0;
      do
        pixels += pixelsOf(last++);
      while (last < n && pixels + pixelsOf(last) <= group_pixels);
      computeResiduals(first, last);
      backProjectResidual({first, last, gain / PhotoResidual::per_level});
    }
  }

private:
  /// Shares of a patch's views in what is corrected: by the square of their quality, which is how many pixels they have
  /// there.
  void normalizeWeights(Index patch)
  {
    const Candidates& all = sources_.candidates;
    constexpr float least_weight = 0.1f; // of the best view's: less than a third of its resolution adds only blur
    float best = 0, sum = 0;
    for (Index c = all.begin[patch]; c < all.begin[patch + 1]; ++c) {
      const float quality = all.list[c].quality * std::exp2(-sources_.penalties[c]);
      weights_[c] = quality * quality;
      best = std::max(best, weights_[c]);
    }
    for (Index c = all.begin[patch]; c < all.begin[patch + 1]; ++c)
      sum += weights_[c] = weights_[c] >= least_weight * best ? weights_[c] : 0.f;
    for (Index c = all.begin[patch]; c < all.begin[patch + 1] && sum > 0; ++c)
      weights_[c] /= sum;
  }

  void listPatches()
  {
    const Candidates& all = sources_.candidates;
    shown_.resize(sources_.views.size());
    for (Index i = 0; i < scene_.patches.size(); ++i)
      for (Index c = all.begin[i]; c < all.begin[i + 1] && scene_.isSeen(i); ++c)
        shown_[all.list[c].view].push_back(i);
  }

  void computeResiduals(Index first, Index last)
  {
    residuals_.clear();
    residuals_.resize(sources_.views.size());
    const auto compute = [&](Index i) {
      const Index v = first + i;
      if (!shown_[v].empty())
        residuals_[v] = residualOf({scene_, atlases_, sources_.views[v], shown_[v]}, *sources_.photos.get(v),
                                   {sources_.photometry, static_cast<int>(v), sources_.views[v].camera()}, errors_[v]);
    };
    parallelFor(last - first, scene_.threads, compute, 1);
  }

  /// Views whose residuals are at hand, and the factor of these.
  struct Group {
    Index first, last;
    float gain;
  };

  void backProjectResidual(const Group& group)
  {
    parallelRanges(scene_.patches.size(), scene_.threads, [&](Index begin, Index end) {
      Sums sums;
      for (Index i = begin; i < end; ++i)
        if (scene_.isSeen(i))
          correct(i, group, sums);
    });
  }

  /// Work space: changes of a patch's texels.
  struct Sums {
    std::vector<Eigen::Vector4f> values;
    std::vector<TexelSpan> inside; ///< of each span, what lies in the patch
    float weight = 0;              ///< factor of the view in work
  };

  /// Adds one view's residual to each texel of the patch.
  void addView(const PatchFrame& frame, const Eigen::Vector3f& least, const PhotoResidual& residual, Sums& sums) const
  {
    std::size_t next = 0;
    const int together = texelsPerPixel(frame.map.middleSteps()); // as they were drawn
    const auto add = [&](int texels, const simd::Float4& mean) {
      const simd::Float4 more = sums.weight * mean;
      for (const std::size_t end = next + texels; next < end; ++next)
        simd::store(simd::load<simd::Float4>(sums.values[next].data()) + more, sums.values[next].data());
    };
    std::size_t number = 0;
    frame.forSpans([&](const TexelSpan& span) {
      const TexelSpan& own = sums.inside[number++];
      const auto addBeyond = [&](int begin, int end) { // what lies beyond may be another surface
        for (int x = begin; x < end; ++x) {
          const Eigen::Vector2f at = frame.place(x, span.y);
          const Eigen::Vector3f inside = frame.map.weights(at.x(), at.y()).cwiseMax(least);
          const Eigen::Vector2f nearest = frame.map.place(inside / inside.sum());
          const Eigen::Vector2f pixel = frame.map.pixel(nearest.x(), nearest.y());
          residual.at({simd::Float4{pixel.x()}, simd::Float4{pixel.y()}}, 1,
                      [&](int, const simd::Float4& mean) { add(1, mean); });
        }
      };
      addBeyond(span.x, own.x);
      frame.forGroups(own, together, [&](int first, int groups, const Pixels& pixels) {
        residual.at(pixels, groups, [&](int lane, const simd::Float4& mean) {
          add(std::min(together, own.length - first - lane * together), mean);
        });
      });
      addBeyond(own.x + own.length, span.x + span.length);
    });
  }

  void start(const PatchFrame& frame, Sums& sums) const
  {
    sums.values.assign(frame.texels(), Eigen::Vector4f::Zero());
    sums.inside.clear();
    const Image& atlas = atlases_[frame.chart.atlas];
    frame.forSpans([&](const TexelSpan& span) {
      sums.inside.push_back(frame.insideOf(span, 0.f));
      __builtin_prefetch(atlas.pixel(frame.chart.x + span.x, frame.chart.y + span.y)); // for change()
    });
  }

  void correct(Index patch, const Group& group, Sums& sums)
  {
    PatchFrame frame(scene_, patch);
    Eigen::Vector3f least; // of the corners' weights
    for (int k = 0; k < 3; ++k)
      least[k] = goesOn(scene_, patch, (k + 1) % 3) ? -HUGE_VALF : 0.f;
    sums.values.clear();
    const Candidates& all = sources_.candidates;
    for (Index c = all.begin[patch]; c < all.begin[patch + 1]; ++c) {
      const int view = all.list[c].view;
      if (!(weights_[c] > 0) || view < group.first || view >= group.last || !frame.map.look(sources_.views[view]))
        continue;
      if (sums.values.empty())
        start(frame, sums);
      sums.weight = group.gain * weights_[c];
      addView(frame, least, residuals_[view], sums);
    }
    if (!sums.values.empty())
      change(frame, sums.values);
  }

  void change(const PatchFrame& frame, const std::vector<Eigen::Vector4f>& values)
  {
    std::size_t next = 0;
    Image& atlas = atlases_[frame.chart.atlas];
    frame.forTexels([&](const Eigen::Vector2f&, int x, int y) {
      std::uint8_t* p = atlas.pixel(frame.chart.x + x, frame.chart.y + y);
      storeColor(Eigen::Vector3f(p[0], p[1], p[2]) + values[next++].head<3>(), p);
    });
  }

  const PaintScene& scene_;
  const PaintSources& sources_;
  const std::vector<float>& errors_;
  std::vector<Image>& atlases_;
  std::vector<float> weights_;           ///< of each candidate, 0..1; those of a patch sum to 1
  std::vector<std::vector<int>> shown_;  ///< by view, patches in their order
  std::vector<PhotoResidual> residuals_; ///< by view, of those in work
};

/// Gains of the rounds after Golub & Varga 1961 (Chebyshev's semi-iteration), for changes of the texels of which
/// photographs show a share between `least` and all: pixels average what is fine, and spread it over many texels.
float gainOf(int round, int rounds)
{
  constexpr double least = 0.38;
  return 2 / (1 + least + (1 - least) * std::cos(pi * (round + 0.5) / rounds));
}
} // namespace

void backProject(const PaintScene& scene, const PaintSources& sources, const BackProjectionOptions& options,
                 std::vector<Image>& atlases)
{
  if (options.rounds == 0 || options.errors.empty())
    return;
  BackProjection projection(scene, sources, options.errors, atlases);
  for (int round = 0; round < options.rounds; ++round)
    projection.round(gainOf(round, options.rounds));
}
} // namespace fresco::texture
