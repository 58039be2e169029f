// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
#include <fresco/simulation/sensors/lighting.h>
#include <optional>
namespace fresco::simulation {
/// How a photograph differs from the truth.
struct Exposure {
  Eigen::Vector3f gain = Eigen::Vector3f::Ones(); ///< factor on display values per channel
  float noise = 0.f;                              ///< deviation per pixel and channel, grey levels of 0..255
  float corner = 1.f;                             ///< light in the image's corners / in its middle (vignetting), 0.1..1
  float blur = 0.f;                               ///< deviation of the blur (Gaussian), pixels, >= 0
  /// Strength s of an S-shaped tone curve, 0..1: value v of 0..1 becomes (1 - s) v + s (3 v^2 - 2 v^3).
  float response = 0.f;
  std::uint64_t seed = 1, number = 0; ///< of the noise; number of the photograph
};

/// Gains of photograph `number`: brightness 1 +- `spread`, red and blue 1 +- `spread` / 4 beside.
/// @param spread 0..0.9
Exposure randomExposure(std::uint64_t seed, std::uint64_t number, float spread);

/// Somebody who stands in the picture: an upright ellipsoid with stripes.
struct Intruder {
  Eigen::Vector3f center, radii; ///< metres, in the coordinates of the scene's mesh

  /// Distance along the ray and colour there; nothing where it passes by.
  std::optional<std::pair<float, Eigen::Vector3f>> hit(const Ray& ray) const;
};

struct Shot {
  const CameraModel& camera;
  const View& view;
  Exposure exposure;
  std::optional<Intruder> intruder = {};
};

/// Somebody on the floor, in the middle of the picture and nearer than what it shows there.
/// @return nothing where there is no room before the camera
std::optional<Intruder> intruderBefore(const LitScene& lit, const View& view);

/// What the camera sees: 4 rays a pixel; a pixel is their mean, blurred, times vignetting and gain, through the tone curve.
/// @param threads 0 = all cores; the result does not depend on it
Image takePhotograph(const LitScene& lit, const Shot& shot, int threads);
} // namespace fresco::simulation
