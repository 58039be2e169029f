// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/noise.h"
namespace fresco::simulation {
float valueNoise(float x, float y, std::uint32_t seed)
{
  const int ix = floorOf(x), iy = floorOf(y);
  const float tx = x - ix, ty = y - iy;
  const float sx = tx * tx * (3.f - 2.f * tx), sy = ty * ty * (3.f - 2.f * ty);
  const float a = cellNoise(ix, iy, seed), b = cellNoise(ix + 1, iy, seed);
  const float c = cellNoise(ix, iy + 1, seed), d = cellNoise(ix + 1, iy + 1, seed);
  const float low = a + (b - a) * sx, high = c + (d - c) * sx;
  return 2.f * (low + (high - low) * sy) - 1.f;
}

float fractalNoise(const NoisePoint& at, const NoiseSpectrum& spectrum)
{
  float sum = 0.f, amplitude = 1.f, total = 0.f, wavelength = spectrum.wavelength;
  for (int octave = 0; octave < spectrum.octaves; ++octave) {
    const float kept = detailKept(wavelength, at.footprint);
    if (kept > 0.f)
      sum += amplitude * kept * valueNoise(at.x / wavelength, at.y / wavelength, at.seed + 0x9e37u * octave);
    total += amplitude;
    amplitude *= spectrum.gain;
    wavelength *= 0.5f;
  }
  return sum / total * 1.6f; // octaves rarely add up: bring the usual range back to about -1..1
}
} // namespace fresco::simulation
