// SPDX-License-Identifier: BSD-3-Clause
#include "scene/artwork_parts.h"
#include <algorithm>
#include <cmath>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
const char* const words[] = {"SCAN",   "ROOM",  "LIGHT",   "MESH",   "POINT", "PLAN",   "TEAM",  "WALL",
                             "COLOUR", "MODEL", "NORTH",   "MARKET", "RIVER", "GRID",   "NOISE", "EDGE",
                             "DEPTH",  "VIEW",  "SURFACE", "REPORT", "APRIL", "BUDGET", "TEST",  "START",
                             "OPEN",   "HOUSE", "GARDEN",  "SEAM",   "ATLAS", "WORLD"};
} // namespace

std::string word(CounterRandom& random) { return words[random.integer(30)]; }

Vector3f hue(CounterRandom& random, float strength, float value)
{
  const float h = random.uniform(0, 6.2832);
  const Vector3f wave(std::cos(h), std::cos(h - 2.0944f), std::cos(h + 2.0944f));
  return (Vector3f::Constant(value) + strength * wave).cwiseMax(0.04f).cwiseMin(0.95f);
}

float noiseAt(const Vector2f& at, std::uint32_t seed, const NoiseSpectrum& spectrum)
{
  return fractalNoise({at.x(), at.y(), seed, 1e-4f}, spectrum);
}

void writeText(Drawing& draw, const Sheet& sheet, const Pen& pen)
{
  for (float y = sheet.min.y(); y + sheet.height < sheet.max.y(); y += 1.7f * sheet.height) {
    float x = sheet.min.x();
    while (true) {
      const std::string next = word(draw.random());
      const float width = (next.size() + 1) * 0.933f * sheet.height;
      if (x + width > sheet.max.x() || draw.random().uniform() < 0.04)
        break;
      draw.text(next, {x, y}, sheet.height, pen);
      x += width;
    }
  }
}

void drawChart(Drawing& draw, const Sheet& at, const Pen& pen)
{
  const Vector2f size = at.max - at.min;
  draw.line({at.min, {at.min.x(), at.max.y()}, at.max}, pen);
  std::vector<Vector2f> curve;
  for (int k = 0; k < 8; ++k) {
    const float x = at.min.x() + size.x() * (0.06f + 0.115f * k);
    const float high = size.y() * draw.random().uniformFloat(0.15, 0.9);
    draw.rectangle({x, at.max.y() - high}, {x + 0.07f * size.x(), at.max.y() - pen.width},
                   hue(draw.random(), 0.25f, 0.55f));
    curve.push_back({x, at.max.y() - size.y() * draw.random().uniformFloat(0.3, 0.95)});
  }
  draw.line(curve, {{0.75f, 0.15f, 0.12f}, pen.width, pen.shake});
}
} // namespace fresco::simulation
