// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <cstdint>
namespace fresco::simulation {
/// Largest whole number <= x, without a call into the library.
inline int floorOf(float x)
{
  const int whole = x;
  return whole - (whole > x ? 1 : 0);
}

/// 0 <= value < 1, a function of the cell and the seed.
inline float cellNoise(int x, int y, std::uint32_t seed)
{
  std::uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ (seed + 1u) * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return ((h ^ (h >> 16)) >> 8) * 0x1.0p-24f;
}

/// 0 at and below `low`, 1 at and above `high`, smooth in between.
inline float smoothStep(float low, float high, float x)
{
  const float share = (x - low) / (high - low);
  const float t = share < 0.f ? 0.f : share > 1.f ? 1.f : share;
  return t * t * (3.f - 2.f * t);
}

/// Smoothly interpolated lattice of random values, -1..1; the lattice spacing is 1.
float valueNoise(float x, float y, std::uint32_t seed);

/// How much of a detail of the given wavelength is left when seen through pixels of size `footprint`: 1 kept, 0 gone.
inline float detailKept(float wavelength, float footprint)
{
  return smoothStep(1.5f, 3.5f, wavelength / (footprint > 1e-6f ? footprint : 1e-6f));
}

/// Octaves of value noise, about -1..1, without those too fine for the footprint.
struct NoiseSpectrum {
  float wavelength = 0.1f; ///< metres, of the first octave
  int octaves = 4;         ///< each has half the wavelength of the one before
  float gain = 0.5f;       ///< amplitude of an octave / of the one before
};

struct NoisePoint {
  float x = 0, y = 0; ///< metres
  std::uint32_t seed = 0;
  float footprint = 1e-3f; ///< metres, size of a pixel on the surface
};

float fractalNoise(const NoisePoint& at, const NoiseSpectrum& spectrum);
} // namespace fresco::simulation
