// SPDX-License-Identifier: BSD-3-Clause
#include "scene/artwork.h"
#include "scene/artwork_parts.h"
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

Picture drawWhiteboard(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.9f, 0.91f, 0.92f});
  const std::uint32_t salt = seed;
  paint(picture, [&](float u, float v) -> Vector3f { // wiped ink stays as faint clouds
    const float wiped = smoothStep(0.1f, 0.9f, noiseAt({u * 2.f, v * 3.f}, salt, {0.5f, 6, 0.6f}));
    return Vector3f(0.91f, 0.92f, 0.93f) - wiped * Vector3f(0.05f, 0.045f, 0.035f);
  });
  Drawing draw(picture, seed);
  const float w = size.width, h = size.height, letter = 0.052f * h;
  const Pen black{{0.12f, 0.12f, 0.14f}, 0.009f * h, 0.005f * h}, blue{{0.12f, 0.22f, 0.6f}, 0.008f * h, 0.005f * h};
  const Pen red{{0.75f, 0.13f, 0.12f}, 0.009f * h, 0.005f * h}, green{{0.1f, 0.45f, 0.22f}, 0.008f * h, 0.005f * h};
  draw.text("MONDAY 10:30  ROOM SURVEY", {0.04f * w, 0.06f * h}, 1.25f * letter, black);
  draw.line({{0.04f * w, 0.155f * h}, {0.5f * w, 0.16f * h}}, red);
  draw.text("1 SCAN FROM 6 PLACES\n2 REGISTER, CHECK LOOPS\n3 SURFACE: 2 CM CELLS\n4 EDGES SHARP?\n5 TEXTURE 60 VIEWS",
            {0.05f * w, 0.22f * h}, letter, blue);
  draw.text("E = F + 0.2 S + T", {0.06f * w, 0.68f * h}, 1.2f * letter, green);
  draw.text("DUE 14 / 5  CALL ANNA", {0.05f * w, 0.85f * h}, letter, black);
  drawChart(draw, {{0.56f * w, 0.1f * h}, {0.93f * w, 0.45f * h}, 0}, black);
  const Vector2f boxes[] = {{0.58f, 0.56f}, {0.76f, 0.56f}, {0.67f, 0.78f}, {0.86f, 0.78f}};
  for (const Vector2f& box : boxes) {
    const Vector2f a = box.cwiseProduct(Vector2f(w, h)), b = a + Vector2f(0.12f * w, 0.11f * h);
    draw.line({a, {b.x(), a.y()}, b, {a.x(), b.y()}, a}, blue);
    draw.text(word(draw.random()), a + Vector2f(0.012f * w, 0.03f * h), 0.7f * letter, black);
  }
  draw.line({{0.7f * w, 0.61f * h}, {0.76f * w, 0.61f * h}}, red);
  draw.line({{0.64f * w, 0.67f * h}, {0.7f * w, 0.78f * h}}, red);
  draw.line({{0.82f * w, 0.67f * h}, {0.9f * w, 0.78f * h}}, red);
  return picture;
}

Picture drawFlipChart(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.93f, 0.93f, 0.9f});
  Drawing draw(picture, seed);
  const float w = size.width, h = size.height;
  for (int k = 1; k < 24; ++k)
    draw.line({{0, h * k / 24}, {w, h * k / 24}}, {{0.8f, 0.84f, 0.88f}, 1.5f, 0});
  const Pen marker{{0.1f, 0.12f, 0.35f}, 0.011f * h, 0.005f * h};
  draw.text("IDEAS", {0.1f * w, 0.06f * h}, 0.075f * h, {{0.7f, 0.15f, 0.1f}, 0.014f * h, 0.004f * h});
  for (int k = 0; k < 5; ++k) {
    const float y = (0.2f + 0.085f * k) * h;
    draw.disc({0.12f * w, y + 0.02f * h}, 0.012f * h, {0.1f, 0.12f, 0.35f});
    draw.text(word(draw.random()) + " " + word(draw.random()), {0.18f * w, y}, 0.04f * h, marker);
  }
  drawChart(draw, {{0.15f * w, 0.68f * h}, {0.85f * w, 0.93f * h}, 0}, marker);
  return picture;
}

Picture drawLandscape(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0, 0, 0});
  const std::uint32_t salt = seed;
  const float aspect = static_cast<float>(size.width) / size.height;
  paint(picture, [&](float u, float v) -> Vector3f {
    const float x = u * aspect;
    const float cloud = smoothStep(0.f, 0.9f, noiseAt({x, 2.5f * v}, salt, {0.6f, 6, 0.55f}));
    Vector3f color = Vector3f(0.35f, 0.55f, 0.8f) + v * Vector3f(0.7f, 0.4f, 0.1f);
    color += cloud * (Vector3f(0.92f, 0.9f, 0.88f) - color);
    for (int hill = 0; hill < 4; ++hill) {
      const float depth = hill / 3.f, base = 0.42f + 0.13f * hill;
      const auto own = salt + 11u * hill;
      const float ridge = base + (0.13f - 0.07f * depth) * noiseAt({x, 0.3f}, own, {0.9f, 7, 0.5f});
      const float texture = noiseAt({x, v * 1.6f}, own + 3u, {0.12f, 5, 0.65f});
      const Vector3f near(0.2f, 0.34f, 0.1f), far(0.45f, 0.55f, 0.68f);
      const Vector3f body = (far + depth * (near - far)) * (1.f + 0.35f * depth * texture);
      color += smoothStep(0.f, 0.004f, v - ridge) * (body - color);
    }
    const float shore = 0.86f + 0.015f * noiseAt({x, 0.7f}, salt + 5u, {0.4f, 4, 0.5f});
    const float ripple = noiseAt({0.12f * x, v}, salt + 8u, {0.02f, 3, 0.6f});
    color += smoothStep(0.f, 0.004f, v - shore) * (Vector3f(0.25f, 0.42f, 0.55f) * (1.f + 0.3f * ripple) - color);
    return color;
  });
  return picture;
}

Picture drawAbstract(const PictureSize& size, std::uint64_t seed)
{
  CounterRandom random(seed, 5, 0);
  Picture picture(size.width, size.height, hue(random, 0.08f, 0.82f));
  const float w = size.width, h = size.height;
  Drawing draw(picture, seed);
  for (int k = 0; k < 26; ++k) {
    const Vector2f center(random.uniformFloat(0, w), random.uniformFloat(0, h));
    const float extent = random.uniformFloat(0.04, 0.2) * w;
    const Vector3f color = hue(random, 0.22f, random.uniformFloat(0.3, 0.65));
    if (k % 3 == 0)
      draw.disc(center, 0.7f * extent, color);
    else if (k % 3 == 1)
      draw.rectangle(center - Vector2f(extent, 0.4f * extent), center + Vector2f(extent, 0.4f * extent), color);
    else
      draw.line({center, center + Vector2f(3 * extent, extent), center + Vector2f(extent, 2.5f * extent)},
                {color, 0.012f * w, 0});
  }
  const std::uint32_t salt = seed;
  for (int y = 0; y < size.height; ++y) // canvas and brush
    for (int x = 0; x < size.width; ++x)
      picture.pixel(x, y) *= 1.f + 0.1f * noiseAt({x / w, 3.f * y / w}, salt, {0.08f, 5, 0.7f});
  return picture;
}
} // namespace fresco::simulation
