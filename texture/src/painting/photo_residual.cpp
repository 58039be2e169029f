// SPDX-License-Identifier: BSD-3-Clause
#include "painting/photo_residual.h"
#include "painting/patch_frame.h"
#include "photographs/grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/robust_weights.h>
#include <fresco/core/simd.h>
namespace fresco::texture {
namespace {
constexpr int largest_box = 6;       // pixels: beyond, the photograph shows more than the texture can hold
constexpr float nearly_pixel = 1.2f; // width of a box that is taken as one pixel, which touches four at most

/// What was drawn of each pixel: colours times area, and the area.
struct Drawing {
  int width, height;
  std::vector<Eigen::Vector4f> pixels;
};

/// Adds texels' values to the pixels under their boxes, by the area of each in them.
class Canvas {
public:
  /// @param size of the boxes, pixels
  Canvas(Drawing& sums, const Eigen::Vector2f& size) : sums_(sums), small_(size.maxCoeff() <= nearly_pixel)
  {
    const Eigen::Vector2f box = small_ ? Eigen::Vector2f(size.cwiseMin(1.f)) : size;
    half_ = 0.5f * box;
    per_size_ = box.cwiseInverse();
  }

  /// @param valueOf valueOf(lane), for the first `count` lanes in their order
  template <typename ValueOf>
  void add(const Pixels& centers, int count, const ValueOf& valueOf)
  {
    const simd::Float4 low_x = centers.x - half_.x(), low_y = centers.y - half_.y(), high_x = centers.x + half_.x(),
                       high_y = centers.y + half_.y(), right = high_x - float(sums_.width - 1),
                       bottom = high_y - float(sums_.height - 1);
    const simd::Int4 inside = (low_x >= 0.f) & (low_y >= 0.f) & (right < 0.f) & (bottom < 0.f);
    const simd::Float4 nowhere{};
    const simd::Int4 x = __builtin_convertvector(inside ? low_x : nowhere, simd::Int4),
                     y = __builtin_convertvector(inside ? low_y : nowhere, simd::Int4);
    const simd::Float4 next_x = __builtin_convertvector(x + 1, simd::Float4),
                       next_y = __builtin_convertvector(y + 1, simd::Float4);
    const simd::Float4 across = simd::larger(high_x - next_x, nowhere) * per_size_.x(),
                       down = simd::larger(high_y - next_y, nowhere) * per_size_.y(), both = across * down;
    const simd::Float4 weights[4] = {1 - across - down + both, across - both, down - both, both};
    simd::Float4 values[4]; // all read before any is written: measured as faster
    for (int lane = 0; lane < count; ++lane)
      values[lane] = valueOf(lane);
    for (int lane = 0; lane < count; ++lane) {
      const simd::Float4& value = values[lane];
      if (!inside[lane])
        continue;
      if (small_)
        addSmall(cellAt(x[lane], y[lane], sums_.width), value,
                 simd::Float4{weights[0][lane], weights[1][lane], weights[2][lane], weights[3][lane]});
      else
        addLarge({low_x[lane], low_y[lane]}, {high_x[lane], high_y[lane]}, value);
    }
  }

private:
  static void increase(Eigen::Vector4f& pixel, const simd::Float4& value)
  {
    simd::store(simd::load<simd::Float4>(pixel.data()) + value, pixel.data());
  }

  /// To a pixel, the one to the right, and those below. @param weights of the four
  void addSmall(std::size_t cell, const simd::Float4& value, const simd::Float4& weights)
  {
    Eigen::Vector4f *p = sums_.pixels.data() + cell, *q = p + sums_.width;
    increase(p[0], weights[0] * value);
    increase(p[1], weights[1] * value);
    increase(q[0], weights[2] * value);
    increase(q[1], weights[3] * value);
  }

  void addLarge(const Eigen::Vector2f& low, const Eigen::Vector2f& high, const simd::Float4& value)
  {
    const int left = low.x(), top = low.y(), columns = int(high.x()) - left + 1, bottom = high.y();
    float across[largest_box + 2]; // of the box in each column
    for (int k = 0; k < columns; ++k)
      across[k] = std::min<float>(high.x(), left + k + 1) - std::max<float>(low.x(), left + k);
    const simd::Float4 share = value * per_size_.prod();
    for (int y = top; y <= bottom; ++y) {
      const simd::Float4 in_row = (std::min<float>(high.y(), y + 1) - std::max<float>(low.y(), y)) * share;
      Eigen::Vector4f* row = sums_.pixels.data() + cellAt(left, y, sums_.width);
      for (int k = 0; k < columns; ++k)
        increase(row[k], across[k] * in_row);
    }
  }

  Drawing& sums_;
  Eigen::Vector2f half_, per_size_;
  bool small_;
};

/// Sum of texels side by side, and their number. @param end of the image's data
simd::Float4 sumOf(const std::uint8_t* texel, int texels, const std::uint8_t* end)
{
  constexpr simd::Float4 colors = {1, 1, 1, 0}, one = {0, 0, 0, 1};
  simd::Float4 sum{};
  for (; texels > 0; --texels, texel += 3)
    sum += end - texel >= 4 ? simd::floatsOf(texel) * colors + one
                            : simd::Float4{float(texel[0]), float(texel[1]), float(texel[2]), 1};
  return sum;
}

/// Box in the photograph, pixels, of so many texels of a row: as wide as their bilinear interpolation by its deviation.
/// @param steps of one texel, see PatchMap::steps()
Eigen::Vector2f boxOf(const Eigen::Matrix2f& steps, int texels)
{
  return (2 * steps.rowwise().squaredNorm() + (texels * texels - 1) * steps.col(0).cwiseAbs2()).cwiseSqrt();
}

/// The rows of a patch lie far apart in memory: to be asked for before they are needed.
void prefetch(const Prediction& p, Index patch)
{
  const Chart& chart = p.scene.chartOf(patch);
  const Image& atlas = p.atlases[chart.atlas];
  const int slot = p.scene.slots[patch].number;
  for (int s = chart.texels.begin[slot]; s < chart.texels.begin[slot + 1]; ++s) {
    const TexelSpan& span = chart.texels.spans[s];
    for (const int x : {0, span.length - 1})
      __builtin_prefetch(atlas.pixel(chart.x + span.x + x, chart.y + span.y));
  }
}

/// Adds a patch's colours, each texel times the area it covers in the photograph, and the areas.
void draw(const Prediction& p, Index patch, Drawing& sums)
{
  PatchFrame frame(p.scene, patch);
  const Image& atlas = p.atlases[frame.chart.atlas];
  if (!frame.map.look(p.view))
    return;
  const Eigen::Matrix2f steps = frame.map.middleSteps();
  const Eigen::Vector2f texel = boxOf(steps, 1);
  if (!(texel.maxCoeff() <= largest_box && texel.minCoeff() > 0))
    return;
  constexpr float edge = 1e-3f, least = 0.05f;
  const int together = texelsPerPixel(steps);
  Canvas canvas(sums, boxOf(steps, together).cwiseMax(least));
  const float area = std::abs(steps.determinant());
  frame.forSpans([&](const TexelSpan& span) {
    const TexelSpan own = frame.insideOf(span, edge);
    const std::uint8_t *c = atlas.pixel(frame.chart.x + own.x, frame.chart.y + own.y),
                       *end = atlas.data.data() + atlas.data.size();
    frame.forGroups(own, together, [&](int first, int groups, const Pixels& pixels) {
      canvas.add(pixels, groups, [&](int lane) {
        const int at = first + lane * together;
        return area * sumOf(c + 3 * at, std::min(together, own.length - at), end);
      });
    });
  });
}

/// 0..1 by how much of a pixel is covered.
float coverageWeight(float covered)
{
  constexpr float none_below = 0.5f, all_from = 0.8f, all_to = 1.3f, none_above = 1.6f;
  return std::clamp(
      std::min((covered - none_below) / (all_from - none_below), (none_above - covered) / (none_above - all_to)), 0.f,
      1.f);
}

/// 0..1, weight of Geman & McClure 1987: what a photograph that is off shows otherwise is its being off.
/// @param difference grey levels
/// @param error of the photograph's place, pixels
float agreementWeight(float difference, float error)
{
  constexpr float steepness = 12; // grey levels per pixel: what is steeper differs by the error
  const float x = difference * error / steepness;
  return gemanMcClureWeight(x * x);
}
} // namespace

int texelsPerPixel(const Eigen::Matrix2f& steps)
{
  constexpr int most = 4;
  int texels = 1;
  while (texels < most && boxOf(steps, texels + 1).maxCoeff() <= nearly_pixel)
    ++texels;
  return texels;
}

PhotoResidual residualOf(const Prediction& prediction, const Image& photo, const PixelGain& gain, float error)
{
  const std::size_t count = cellCount(photo.width, photo.height);
  Drawing drawn{photo.width, photo.height, std::vector<Eigen::Vector4f>(count, Eigen::Vector4f::Zero())};
  const std::vector<int>& patches = prediction.patches;
  constexpr std::size_t ahead = 4;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    prefetch(prediction, patches[std::min(i + ahead, patches.size() - 1)]);
    draw(prediction, patches[i], drawn);
  }
  PhotoResidual out{photo.width, photo.height, std::vector<PhotoResidual::Pixel>(count)};
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x) {
      const std::size_t i = cellAt(x, y, photo.width);
      const Eigen::Vector4f& pixel = drawn.pixels[i];
      const std::uint8_t* p = photo.pixel(x, y);
      const float trust = coverageWeight(pixel.w());
      if (!(trust > 0))
        continue;
      Eigen::Vector3f more =
          gain({x + 0.5f, y + 0.5f}, Eigen::Vector3f(p[0], p[1], p[2])) - pixel.head<3>() / pixel.w();
      for (int c = 0; c < 3; ++c)
        more[c] *= more[c] < 0 ? 1 - clippedShare(p[c]) : 1.f; // the light may have been any brighter
      const float weight = PhotoResidual::per_level * trust * agreementWeight(more.cwiseAbs().maxCoeff(), error);
      const simd::Int4 rounded = simd::rounded(weight * simd::Float4{more[0], more[1], more[2], 0});
      for (int c = 0; c < 3; ++c)
        out.pixels[i][c] = std::clamp(rounded[c], -INT8_MAX, INT8_MAX);
    }
  return out;
}
} // namespace fresco::texture
