// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/noise.h"
#include <algorithm>
#include <fresco/simulation/sensors/material.h>
namespace fresco::simulation {
namespace {
using Eigen::Vector3f;

/// A point of the surface laid flat.
struct Flat {
  float x = 0, y = 0; ///< metres
  float footprint = 0;
  std::uint32_t seed = 0;
};

/// Projects along the axis that the normal is closest to; `along` becomes x where it lies in the surface.
Flat flatten(const Material& material, const SurfacePoint& at)
{
  int drop = 0;
  at.normal.cwiseAbs().maxCoeff(&drop);
  int first = (drop + 1) % 3, second = (drop + 2) % 3;
  if (second == material.along)
    std::swap(first, second);
  return {at.position[first], at.position[second], at.footprint, 8u * material.seed + drop};
}

float fractal(const Flat& at, float stretch, const NoiseSpectrum& spectrum, std::uint32_t salt)
{
  return fractalNoise({at.x / stretch, at.y, at.seed * 131u + salt, at.footprint}, spectrum);
}

/// 1 within `half_width` of a line of the grid with the given spacing, 0 away from it; faded by the footprint.
float gridLine(float x, float spacing, float half_width, float footprint)
{
  const float distance = std::fabs(x - spacing * floorOf(x / spacing + 0.5f));
  const float soft = std::max(footprint, 0.25f * half_width);
  const float covered = std::min(1.f, 2.f * half_width / std::max(footprint, 2.f * half_width));
  return covered * (1.f - smoothStep(half_width - 0.5f * soft, half_width + 0.5f * soft, distance));
}

Vector3f plain(const Material& m, const Flat& at)
{
  const float speckle = fractal(at, 1.f, {0.016f, 3, 0.7f}, 1), uneven = fractal(at, 1.f, {0.6f, 2, 0.5f}, 2);
  return m.color * (1.f + m.contrast * (0.025f * speckle + 0.02f * uneven));
}

Vector3f plaster(const Material& m, const Flat& at)
{
  const float grain = fractal(at, 1.f, {0.024f, 3, 0.75f}, 1);
  const float roller = fractal(at, 0.25f, {0.09f, 2, 0.5f}, 2), stain = fractal(at, 1.f, {1.7f, 4, 0.6f}, 3);
  return m.color * (1.f + m.contrast * (0.05f * grain + 0.02f * roller + 0.035f * stain));
}

Vector3f carpet(const Material& m, const Flat& at)
{
  constexpr float size = 0.5f;
  const int ix = floorOf(at.x / size), iy = floorOf(at.y / size);
  const bool turned = ((ix + iy) & 1) != 0;
  Flat yarn = at;
  if (turned)
    std::swap(yarn.x, yarn.y);
  const float loops = fractal(yarn, 2.2f, {0.012f, 2, 0.7f}, 1), clumps = fractal(yarn, 2.f, {0.028f, 2, 0.7f}, 2);
  const float shade = 1.f + 0.09f * (cellNoise(ix, iy, at.seed) - 0.5f) + (turned ? 0.03f : -0.03f);
  const float mixed = std::clamp(0.35f + 0.4f * m.contrast * (0.9f * loops + 0.45f * clumps), 0.f, 1.f);
  const float joint =
      std::max(gridLine(at.x, size, 0.0015f, at.footprint), gridLine(at.y, size, 0.0015f, at.footprint));
  return (m.color + mixed * (m.accent - m.color)) * shade * (1.f - 0.25f * joint);
}

/// Grain of sawn wood: rings drawn out along x, pores on top.
Vector3f grain(const Material& m, const Flat& at, float tone)
{
  const float bend = fractal(at, 5.f, {0.35f, 3, 0.5f}, 1);
  Flat rings = at;
  rings.y = at.y + 0.05f * bend;
  const float broad = fractal(rings, 14.f, {0.07f, 3, 0.6f}, 2), fine = fractal(rings, 24.f, {0.013f, 3, 0.7f}, 3);
  const float mixed = std::clamp(0.4f + tone + m.contrast * (0.38f * broad + 0.24f * fine), 0.f, 1.f);
  return m.color + mixed * (m.accent - m.color);
}

Vector3f planks(const Material& m, const Flat& at)
{
  constexpr float width = 0.14f, length = 9.f * width;
  const int row = floorOf(at.y / width);
  const float shifted = at.x + length * cellNoise(row, 3, at.seed);
  const int board = floorOf(shifted / length);
  Flat local = at;
  local.x = shifted + 17.f * cellNoise(row, board, at.seed + 5);
  local.y += 11.f * cellNoise(board, row, at.seed + 9);
  const float tone = 0.35f * (cellNoise(row, board, at.seed + 2) - 0.5f);
  const float joint =
      std::max(gridLine(at.y, width, 0.0012f, at.footprint), gridLine(shifted, length, 0.0012f, at.footprint));
  return grain(m, local, tone) * (1.f - 0.55f * joint);
}

Vector3f fabric(const Material& m, const Flat& at)
{
  constexpr float thread = 0.008f;
  const float kept = detailKept(thread, at.footprint);
  const float weave = std::sin(6.2832f * at.x / thread) * std::sin(6.2832f * at.y / thread);
  const float fuzz = fractal(at, 1.f, {0.02f, 3, 0.7f}, 1), fold = fractal(at, 1.f, {0.3f, 3, 0.5f}, 2);
  const float mixed = std::clamp(0.4f + m.contrast * (0.22f * kept * weave + 0.24f * fuzz), 0.f, 1.f);
  return (m.color + mixed * (m.accent - m.color)) * (1.f + 0.05f * m.contrast * fold);
}

Vector3f ceilingTile(const Material& m, const Flat& at)
{
  constexpr float size = 0.6f;
  const int ix = floorOf(at.x / size), iy = floorOf(at.y / size);
  const float rail = std::max(gridLine(at.x, size, 0.012f, at.footprint), gridLine(at.y, size, 0.012f, at.footprint));
  const float edge = std::max(
      gridLine(at.x - 0.014f, size, 0.002f, at.footprint) + gridLine(at.x + 0.014f, size, 0.002f, at.footprint),
      gridLine(at.y - 0.014f, size, 0.002f, at.footprint) + gridLine(at.y + 0.014f, size, 0.002f, at.footprint));
  const float worms = fractal(at, 1.f, {0.02f, 2, 0.6f}, 1);
  const float holes =
      smoothStep(0.45f, 0.75f, worms) + 0.5f * smoothStep(0.3f, 0.9f, fractal(at, 1.f, {0.05f, 3, 0.7f}, 2));
  const float tone = 0.97f + 0.04f * cellNoise(ix, iy, at.seed);
  const Vector3f board = m.color * tone * (1.f - 0.14f * m.contrast * std::min(holes, 1.f));
  return (board + rail * (m.accent - board)) * (1.f - 0.3f * std::min(1.f, edge));
}

Vector3f metal(const Material& m, const Flat& at)
{
  const float brushed = fractal(at, 30.f, {0.006f, 2, 0.7f}, 1), wear = fractal(at, 1.f, {0.15f, 3, 0.6f}, 2);
  return m.color * (1.f + m.contrast * (0.05f * brushed + 0.05f * wear));
}

Vector3f cardboard(const Material& m, const Flat& at)
{
  const float wave = detailKept(0.009f, at.footprint) * std::sin(6.2832f * at.y / 0.009f);
  const float fibres = fractal(at, 2.f, {0.012f, 3, 0.7f}, 1), dirt = fractal(at, 1.f, {0.2f, 4, 0.6f}, 2);
  return m.color * (1.f + m.contrast * (0.02f * wave + 0.06f * fibres + 0.06f * dirt));
}

Vector3f leaf(const Material& m, const Flat& at)
{
  const float veins = fractal(at, 0.2f, {0.02f, 3, 0.7f}, 1), patch = fractal(at, 1.f, {0.1f, 3, 0.6f}, 2);
  const float mixed = std::clamp(0.4f + m.contrast * (0.35f * veins + 0.4f * patch), 0.f, 1.f);
  return m.color + mixed * (m.accent - m.color);
}

Vector3f wood(const Material& m, const Flat& at) { return grain(m, at, 0.f); }

Vector3f printed(const Material& m, const SurfacePoint& at)
{
  const Vector3f d = at.position - m.corner;
  const float wide = m.right.squaredNorm(), high = m.down.squaredNorm();
  const float pixels_per_metre = static_cast<float>(m.picture->width()) / std::sqrt(wide);
  return m.picture->sample(d.dot(m.right) / wide, d.dot(m.down) / high, at.footprint * pixels_per_metre);
}

/// In the order of Finish, up to `picture`.
constexpr Vector3f (*patterns[])(const Material&, const Flat&) = {plain,  plaster,     carpet, planks,    wood,
                                                                  fabric, ceilingTile, metal,  cardboard, leaf};
static_assert(std::size(patterns) == static_cast<std::size_t>(Finish::picture));
} // namespace

Vector3f albedo(const Material& material, const SurfacePoint& at)
{
  const Vector3f color = material.finish == Finish::picture
                             ? printed(material, at)
                             : patterns[static_cast<int>(material.finish)](material, flatten(material, at));
  return color.cwiseMax(0.02f).cwiseMin(0.98f);
}
} // namespace fresco::simulation
