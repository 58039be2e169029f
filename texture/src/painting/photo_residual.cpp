// SPDX-License-Identifier: BSD-3-Clause
#include "painting/photo_residual.h"
#include "charts/patch_frame.h"
#include "grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/simd.h>
namespace fresco::texture {
namespace {
constexpr float nearly_pixel = 1.2f; // width of a box that is taken as one pixel, which touches four at most

/// What was drawn of each pixel: colours times area, and the area.
struct Drawing {
  int width, height;
  std::vector<Eigen::Vector4f> pixels;
};

/// Adds a texel's value to the pixels under its box, by the area of each in it.
class Canvas {
public:
  /// @param size of the box, pixels
  Canvas(Drawing& sums, const Eigen::Vector2f& size) : sums_(sums), small_(size.maxCoeff() <= nearly_pixel)
  {
    const Eigen::Vector2f box = small_ ? Eigen::Vector2f(size.cwiseMin(1.f)) : size;
    half_ = 0.5f * box;
    per_size_ = box.cwiseInverse();
  }

  void add(const Eigen::Vector2f& center, const Eigen::Vector4f& value)
  {
    const Eigen::Vector2f low = center - half_, high = center + half_;
    if (!(low.x() >= 0 && low.y() >= 0 && high.x() < sums_.width - 1 && high.y() < sums_.height - 1))
      return;
    const int x = low.x(), y = low.y();
    if (!small_)
      return addLarge(low, high, value);
    const float right = std::max(0.f, high.x() - (x + 1)) * per_size_.x(),
                down = std::max(0.f, high.y() - (y + 1)) * per_size_.y();
    Eigen::Vector4f *p = sums_.pixels.data() + cellAt(x, y, sums_.width), *q = p + sums_.width;
    const Eigen::Vector4f upper = (1 - down) * value, lower = down * value;
    p[0] += (1 - right) * upper;
    p[1] += right * upper;
    q[0] += (1 - right) * lower;
    q[1] += right * lower;
  }

private:
  void addLarge(const Eigen::Vector2f& low, const Eigen::Vector2f& high, const Eigen::Vector4f& value)
  {
    const Eigen::Vector4f share = value * per_size_.prod();
    const int right = high.x(), bottom = high.y();
    for (int y = low.y(); y <= bottom; ++y) {
      const float down = std::min<float>(high.y(), y + 1) - std::max<float>(low.y(), y);
      Eigen::Vector4f* row = sums_.pixels.data() + cellAt(0, y, sums_.width);
      for (int x = low.x(); x <= right; ++x)
        row[x] += (down * (std::min<float>(high.x(), x + 1) - std::max<float>(low.x(), x))) * share;
    }
  }

  Drawing& sums_;
  Eigen::Vector2f half_, per_size_;
  bool small_;
};

/// In registers. Written to memory number by number, they would be waited for when read as one.
Eigen::Vector4f vectorOf(const simd::Int4& numbers)
{
  Eigen::Vector4f out;
  simd::store(__builtin_convertvector(numbers, simd::Float4), out.data());
  return out;
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
  constexpr float largest_box = 6; // pixels: beyond, the photograph shows more than the texture can hold
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
    const std::uint8_t* c = atlas.pixel(frame.chart.x + own.x, frame.chart.y + own.y);
    frame.forGroups(own, together, [&](int texels, const Eigen::Vector2f& pixel) {
      int red = 0, green = 0, blue = 0;
      for (const std::uint8_t* end = c + 3 * texels; c < end; c += 3) {
        red += c[0];
        green += c[1];
        blue += c[2];
      }
      canvas.add(pixel, area * vectorOf(simd::Int4{red, green, blue, texels}));
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
  const float x = difference * error / steepness, w = 1 / (1 + x * x);
  return w * w;
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
  constexpr std::uint8_t overexposed = 254; // grey level: the light may have been any brighter
  constexpr float largest = 127;            // of what is stored
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
      const float trust = std::max({p[0], p[1], p[2]}) < overexposed ? coverageWeight(pixel.w()) : 0.f;
      if (!(trust > 0))
        continue;
      const Eigen::Vector3f more =
          gain({x + 0.5f, y + 0.5f}, Eigen::Vector3f(p[0], p[1], p[2])) - pixel.head<3>() / pixel.w();
      const float weight = PhotoResidual::per_level * trust * agreementWeight(more.cwiseAbs().maxCoeff(), error);
      const Eigen::Vector3f stored = (weight * more).cwiseMax(-largest).cwiseMin(largest);
      const simd::Int4 rounded = simd::rounded(simd::Float4{stored[0], stored[1], stored[2], 0});
      for (int c = 0; c < 3; ++c)
        out.pixels[i][c] = rounded[c];
    }
  return out;
}
} // namespace fresco::texture
