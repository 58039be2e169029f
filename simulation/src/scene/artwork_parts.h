// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scene/artwork.h"
#include "scene/drawing.h"
#include "sensors/noise.h"
namespace fresco::simulation {
/// What the pictures are made of.
std::string word(CounterRandom& random);

/// A random colour. @param strength 0 grey .. 0.4 vivid  @param value mean brightness
Eigen::Vector3f hue(CounterRandom& random, float strength, float value);

/// Octaves of noise at picture coordinates.
float noiseAt(const Eigen::Vector2f& at, std::uint32_t seed, const NoiseSpectrum& spectrum);

/// Sets each pixel to color(u, v), u and v in 0..1.
template <typename Color>
void paint(Picture& picture, const Color& color)
{
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      picture.pixel(x, y) = color((x + 0.5f) / picture.width(), (y + 0.5f) / picture.height());
}

struct Sheet {
  Eigen::Vector2f min, max; ///< pixels
  float height = 10;        ///< of a letter
};

/// Lines of words, ragged at the right.
void writeText(Drawing& draw, const Sheet& sheet, const Pen& pen);

/// Axes, bars and a curve.
void drawChart(Drawing& draw, const Sheet& at, const Pen& pen);

// Pictures that others are made of, or that are long; see drawPicture().
Picture drawWhiteboard(const PictureSize& size, std::uint64_t seed);
Picture drawFlipChart(const PictureSize& size, std::uint64_t seed);
Picture drawLandscape(const PictureSize& size, std::uint64_t seed);
Picture drawAbstract(const PictureSize& size, std::uint64_t seed);
} // namespace fresco::simulation
