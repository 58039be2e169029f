// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "simulation/sensors/lighting.h"
#include <fresco/core/camera.h>
#include <fresco/core/image.h>
namespace fresco::simulation {
/// How a photograph differs from the truth.
struct Exposure {
  Eigen::Vector3f gain = Eigen::Vector3f::Ones(); ///< factor on display values per channel
  float noise = 0.f;                              ///< deviation per pixel and channel, grey levels of 0..255
  std::uint64_t seed = 1, number = 0;             ///< of the noise; number of the photograph
};

/// Gains of photograph `number`: brightness 1 +- `spread`, red and blue 1 +- `spread` / 4 beside.
/// @param spread 0..0.9
Exposure randomExposure(std::uint64_t seed, std::uint64_t number, float spread);

struct Shot {
  const CameraModel& camera;
  const View& view;
  Exposure exposure;
};

/// What the camera sees: 4 rays a pixel; a pixel is their mean times the gain.
/// @param threads 0 = all cores; the result does not depend on it
Image takePhotograph(const LitScene& lit, const Shot& shot, int threads);
} // namespace fresco::simulation
