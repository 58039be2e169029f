// SPDX-License-Identifier: BSD-3-Clause
#include "views/picture_evidence.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/simd.h>
namespace fresco::texture {
namespace {
/// exp(-x) within 0.02, x >= 0.
simd::Float4 bell(const simd::Float4& x)
{
  simd::Float4 y = simd::larger(1 - x / 16, simd::Float4{});
  for (int k = 0; k < 4; ++k)
    y *= y;
  return y;
}

/// What one photograph shows of the patches, by place.
class PictureEvidence {
public:
  explicit PictureEvidence(const CameraModel& camera)
      : cell_(std::max(camera.width, camera.height) / cells_across), columns_(camera.width / cell_ + 1),
        rows_(camera.height / cell_ + 1), cells_(columns_ * rows_)
  {}

  struct Place {
    Eigen::Vector2f pixel;
    Eigen::Vector3f color;
  };

  struct Difference {
    float value;     ///< grey levels, from what other photographs show
    float certainty; ///< 0..1
  };

  void add(const Place& place, const Difference& difference)
  {
    if (Cell& cell = cells_[column(place.pixel) + columns_ * row(place.pixel)]; cell.count < most) {
      const int k = cell.count++;
      for (int axis = 0; axis < 2; ++axis)
        cell.pixel[axis][k] = place.pixel[axis];
      for (int c = 0; c < 3; ++c)
        cell.color[c][k] = place.color[c];
      cell.value[k] = difference.value;
      cell.certainty[k] = difference.certainty;
    }
  }

  /// Of a place: that of places nearby which look like it.
  Difference expected(const Place& place) const
  {
    constexpr float innocence = 0.5f; // weight of no difference: of half a sample at the place itself
    simd::Float4 sum{}, weights{};
    const int x = column(place.pixel), y = row(place.pixel);
    for (int j = std::max(y - reach, 0); j <= std::min(y + reach, rows_ - 1); ++j)
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, columns_ - 1); ++i) {
        const Cell& cell = cells_[i + columns_ * j];
        for (int k = 0; k < cell.count; k += 4) {
          const simd::Float4 w = weightsOf(cell, k, place);
          sum += w * simd::load<simd::Float4>(cell.value + k);
          weights += w;
        }
      }
    const float all = innocence + weights[0] + weights[1] + weights[2] + weights[3];
    return {(sum[0] + sum[1] + sum[2] + sum[3]) / all, 1 - innocence / all};
  }

private:
  static constexpr float cells_across = 40; // a cell is some patches wide
  static constexpr int reach = 4;           // cells: two deviations of the Gaussian
  static constexpr int most = 12;           // samples of a cell: what is beside looks alike

  struct Cell {
    int count = 0;
    float pixel[2][most] = {}, color[3][most] = {}, value[most] = {}, certainty[most] = {};
  };

  /// Of four samples; those that are not there have none.
  simd::Float4 weightsOf(const Cell& cell, int first, const Place& place) const
  {
    const auto squared = [&](const float* values, float own) {
      const simd::Float4 apart = simd::load<simd::Float4>(values + first) - own;
      return apart * apart;
    };
    const simd::Float4 pixels = squared(cell.pixel[0], place.pixel[0]) + squared(cell.pixel[1], place.pixel[1]),
                       colors = squared(cell.color[0], place.color[0]) + squared(cell.color[1], place.color[1]) +
                                squared(cell.color[2], place.color[2]);
    const simd::Float4 w = simd::load<simd::Float4>(cell.certainty + first) *
                           bell(pixels * (0.125f / (cell_ * cell_)) + colors * (0.5f / (one_octave * one_octave)));
    return colors > 9 * one_octave * one_octave ? simd::Float4{} : w; // three deviations of the Gaussian
  }

  int column(const Eigen::Vector2f& p) const { return std::clamp<int>(p.x() / cell_, 0, columns_ - 1); }
  int row(const Eigen::Vector2f& p) const { return std::clamp<int>(p.y() / cell_, 0, rows_ - 1); }

  float cell_;
  int columns_, rows_;
  std::vector<Cell> cells_;
};

/// Patch and candidate of a view.
struct Shown {
  Index patch, candidate;
};

std::vector<std::vector<Shown>> shownByView(const PatchMesh& patches, const Candidates& candidates, Index views)
{
  std::vector<std::vector<Shown>> out(views);
  for (Index i = 0; i < patches.size(); ++i)
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c)
      out[candidates.list[c].view].push_back({i, c});
  return out;
}

/// Sets the differences of one view's candidates.
class PictureInference {
public:
  using Place = PictureEvidence::Place;
  using Difference = PictureEvidence::Difference;

  PictureInference(const PatchMesh& patches, const Candidates& candidates, const Projector& view)
      : patches_(patches), candidates_(candidates), view_(view), evidence_(view.camera())
  {}

  void run(const std::vector<Shown>& shown, const ColorDifferences& known, std::vector<float>& values)
  {
    constexpr float hearsay = 0.5f; // certainty of what was inferred itself
    std::vector<Shown> open;
    for (const Shown& s : shown) {
      const float certainty = known.certainty[s.patch];
      if (certainty > 0)
        evidence_.add(placeOf(s), {known.values[s.candidate], certainty});
      if (certainty < 1)
        open.push_back(s);
    }
    std::vector<Difference> inferred;
    for (const Shown& s : open)
      inferred.push_back(evidence_.expected(placeOf(s)));
    for (std::size_t k = 0; k < open.size(); ++k) // so that it spreads over what shades off
      evidence_.add(placeOf(open[k]), {inferred[k].value, hearsay * inferred[k].certainty});
    for (const Shown& s : open)
      values[s.candidate] = evidence_.expected(placeOf(s)).value;
  }

private:
  Place placeOf(const Shown& s) const
  {
    const auto& color = candidates_.list[s.candidate].color;
    return {view_(patches_.middle(s.patch)).head<2>(), Eigen::Vector3f(color[0], color[1], color[2])};
  }

  const PatchMesh& patches_;
  const Candidates& candidates_;
  const Projector& view_;
  PictureEvidence evidence_;
};
} // namespace

std::vector<float> differencesInPictures(const PatchMesh& patches, const Candidates& candidates,
                                         const ColorDifferences& known, const VisibilityInput& input)
{
  std::vector<float> out = known.values;
  const std::vector<Projector>& views = input.views.projectors;
  const auto shown = shownByView(patches, candidates, views.size());
  const auto infer = [&](Index v) { PictureInference(patches, candidates, views[v]).run(shown[v], known, out); };
  parallelFor(shown.size(), input.options.threads, infer, 1);
  return out;
}
} // namespace fresco::texture
