// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/response_curve.h"
#include "photographs/view_parts.h"
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <fresco/core/camera.h>
#include <vector>
namespace fresco::texture {
/// Squared distance of a pixel from the principal point, in squared half diagonals of the image: 1 in the corners of a
/// centred camera.
inline float squaredRadius(const CameraModel& camera, const Eigen::Vector2f& pixel)
{
  const float x = pixel.x() - static_cast<float>(camera.cx), y = pixel.y() - static_cast<float>(camera.cy);
  const auto w = static_cast<float>(camera.width), h = static_cast<float>(camera.height);
  return 4 * (x * x + y * y) / (w * w + h * h);
}

/// Squared radii in one byte.
constexpr float radius_steps = 128;
inline std::uint8_t storedRadius(float squared_radius) { return std::min(squared_radius * radius_steps, 255.f); }

/// What a lens lets through: log T(r) = a_1 r^2 + a_2 r^4 + a_3 r^6.
struct LensFalloff {
  Eigen::Vector3f a = Eigen::Vector3f::Zero();

  float logTransmission(float squared_radius) const
  {
    return squared_radius * (a[0] + squared_radius * (a[1] + squared_radius * a[2]));
  }
};

/// How photographs answer to light: light of the value = light of the colour * T(r) / gain. Of a straight response the light
/// is the value.
struct Photometry {
  Eigen::Matrix3Xf gains;              ///< 3xV
  std::vector<int> lens;               ///< V, into `falloff`; -1 where all is let through
  std::vector<LensFalloff> falloff;    ///< of each lens
  std::vector<ResponseCurve> response; ///< of each lens
  Eigen::VectorXf sharpness;           ///< V, octaves of the contrast that fine texture has; empty: not known

  float sharpnessOf(int view) const { return sharpness.size() == 0 ? 0.f : sharpness[view]; }
  LensFalloff falloffOf(int view) const { return lens.empty() || lens[view] < 0 ? LensFalloff{} : falloff[lens[view]]; }

  /// Null where it is straight.
  const ResponseCurve* responseOf(int view) const
  {
    return lens.empty() || lens[view] < 0 || response[lens[view]].isLinear() ? nullptr : &response[lens[view]];
  }

  /// Factors on the light of RGB at a place of a photograph.
  Eigen::Vector3f factor(int view, float squared_radius) const
  {
    const float log_t = falloffOf(view).logTransmission(squared_radius);
    return log_t == 0.f ? Eigen::Vector3f(gains.col(view)) : Eigen::Vector3f(std::exp(-log_t) * gains.col(view));
  }

  /// A colour at a place of a photograph as a photograph of the middle of the lens and of gain 1 would show it.
  Eigen::Vector3f corrected(int view, float squared_radius, const Eigen::Vector3f& color) const
  {
    const ResponseCurve* curve = responseOf(view);
    const Eigen::Vector3f f = factor(view, squared_radius);
    return curve ? curve->relight(color, f) : Eigen::Vector3f(color.cwiseProduct(f));
  }
};

/// 0..1, how likely a grey level as it was read is clipped: the light may have been any brighter. Of clipped values, JPEG
/// of quality 90 moves 5 % below 250 and 1 % below 242.
inline float clippedShare(float level) { return std::clamp((level - 242) / 8, 0.f, 1.f); }

/// One photograph's part of it, quick to evaluate for many pixels.
class PixelGain {
public:
  PixelGain(const Photometry& photometry, int view, const CameraModel& camera);

  /// A colour at a pixel, see Photometry::corrected().
  Eigen::Vector3f operator()(const Eigen::Vector2f& pixel, const Eigen::Vector3f& color) const
  {
    const Eigen::Vector3f f = factor(pixel);
    return curve_ ? curve_->relight(color, f) : Eigen::Vector3f(f.cwiseProduct(color));
  }

private:
  Eigen::Vector3f factor(const Eigen::Vector2f& pixel) const
  {
    if (table_.empty())
      return gain_;
    const int last = static_cast<int>(table_.size()) - 1;
    const float at = std::min(squaredRadius(camera_, pixel) * radius_steps, static_cast<float>(last));
    const int i = std::min(static_cast<int>(at), last - 1);
    return (table_[i] + (at - static_cast<float>(i)) * (table_[i + 1] - table_[i])) * gain_;
  }

  const CameraModel& camera_;
  const ResponseCurve* curve_; ///< null: straight
  Eigen::Vector3f gain_;
  std::vector<float> table_; ///< 1 / T by stored radius; empty where it is 1 everywhere
};

/// For each view the number of its lens: cameras of one size of image and nearly one focal length share it; -1 for
/// parts of panoramas, which are evened when they are put together.
std::vector<int> lensNumbers(const std::vector<ViewPart>& views);
} // namespace fresco::texture
