// SPDX-License-Identifier: BSD-3-Clause
#include "scene/artwork_parts.h"
#include <algorithm>
#include <cmath>
#include <fresco/simulation/sensors/material.h>
#include <map>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
const Vector3f ink(0.12f, 0.12f, 0.14f);

Vector2f extent(const PictureSize& size) { return {size.width, size.height}; }

Picture drawPoster(const PictureSize& size, std::uint64_t seed)
{
  CounterRandom random(seed, 6, 0);
  const Vector3f ground = hue(random, 0.12f, 0.75f), strong = hue(random, 0.3f, 0.35f);
  Picture picture(size.width, size.height, ground);
  paint(picture,
        [&](float u, float v) -> Vector3f { return ground * (1.08f - 0.25f * v) + Vector3f(0.05f, 0, -0.03f) * u; });
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  draw.rectangle({0, 0}, {s.x(), 0.13f * s.y()}, strong);
  draw.text(word(random) + " " + word(random), {0.06f * s.x(), 0.035f * s.y()}, 0.055f * s.y(),
            {{0.92f, 0.92f, 0.88f}, 0.009f * s.y(), 0});
  for (int k = 0; k < 7; ++k)
    draw.disc({s.x() * random.uniformFloat(0.2, 0.8), s.y() * random.uniformFloat(0.25, 0.5)},
              s.x() * random.uniformFloat(0.04, 0.16), hue(random, 0.3f, 0.55f));
  drawChart(draw, {{0.1f * s.x(), 0.57f * s.y()}, {0.5f * s.x(), 0.78f * s.y()}, 0}, {ink, 0.004f * s.y(), 0});
  writeText(draw, {{0.56f * s.x(), 0.57f * s.y()}, {0.94f * s.x(), 0.8f * s.y()}, 0.012f * s.y()},
            {ink, 0.002f * s.y(), 0});
  writeText(draw, {{0.08f * s.x(), 0.84f * s.y()}, {0.94f * s.x(), 0.97f * s.y()}, 0.014f * s.y()},
            {ink, 0.0025f * s.y(), 0});
  return picture;
}

Picture drawMap(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.6f, 0.75f, 0.85f});
  const std::uint32_t salt = seed;
  const Vector2f s = extent(size);
  paint(picture, [&](float u, float v) -> Vector3f {
    const Vector2f at(u * s.x() / s.y(), v);
    const float land = noiseAt(at, salt, {0.7f, 7, 0.55f}) + 0.12f, hills = noiseAt(at, salt + 4u, {0.2f, 6, 0.6f});
    const Vector3f low(0.72f, 0.8f, 0.58f), high(0.86f, 0.74f, 0.52f);
    const Vector3f ground = low + smoothStep(-0.3f, 0.8f, hills) * (high - low);
    const Vector3f water = Vector3f(0.55f, 0.72f, 0.86f) - 0.1f * smoothStep(0.f, 0.5f, -land) * Vector3f(1, 1, 0.6f);
    const Vector3f color = water + smoothStep(-0.01f, 0.01f, land) * (ground - water);
    return color * (1.f - 0.4f * (1.f - smoothStep(0.004f, 0.016f, std::fabs(land))));
  });
  Drawing draw(picture, seed);
  CounterRandom& random = draw.random();
  for (int road = 0; road < 9; ++road) {
    std::vector<Vector2f> line = {{s.x() * random.uniformFloat(), s.y() * random.uniformFloat()}};
    for (int k = 0; k < 12; ++k)
      line.push_back(line.back() + 0.06f * s.x() * Vector2f(random.uniformFloat(-0.4, 1), random.uniformFloat(-1, 1)));
    draw.line(line, {{0.75f, 0.25f, 0.2f}, 0.004f * s.y(), 0});
  }
  for (int town = 0; town < 24; ++town) {
    const Vector2f at(s.x() * random.uniformFloat(0.02, 0.9), s.y() * random.uniformFloat(0.02, 0.95));
    draw.disc(at, 0.006f * s.y(), ink);
    draw.text(word(random), at + Vector2f(0.01f, -0.008f) * s.y(), 0.018f * s.y(), {ink, 0.0025f * s.y(), 0});
  }
  draw.line({{2, 2}, {s.x() - 2, 2}, s - Vector2f(2, 2), {2, s.y() - 2}, {2, 2}},
            {{0.92f, 0.92f, 0.9f}, 0.04f * s.y(), 0});
  return picture;
}

Picture drawSheet(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.93f, 0.93f, 0.91f});
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  draw.text(word(draw.random()) + " " + word(draw.random()), {0.1f * s.x(), 0.06f * s.y()}, 0.03f * s.y(),
            {ink, 0.005f * s.y(), 0});
  writeText(draw, {{0.1f * s.x(), 0.13f * s.y()}, {0.92f * s.x(), 0.5f * s.y()}, 0.014f * s.y()},
            {{0.25f, 0.25f, 0.27f}, 0.0025f * s.y(), 0});
  drawChart(draw, {{0.15f * s.x(), 0.55f * s.y()}, {0.85f * s.x(), 0.75f * s.y()}, 0}, {ink, 0.004f * s.y(), 0});
  writeText(draw, {{0.1f * s.x(), 0.79f * s.y()}, {0.92f * s.x(), 0.94f * s.y()}, 0.014f * s.y()},
            {{0.25f, 0.25f, 0.27f}, 0.0025f * s.y(), 0});
  return picture;
}

Picture drawScreen(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.1f, 0.2f, 0.35f});
  paint(picture, [](float u, float v) -> Vector3f {
    return {0.1f + 0.15f * u, 0.25f + 0.2f * v, 0.45f + 0.2f * (1 - v)};
  });
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  draw.rectangle({0, 0.95f * s.y()}, s, {0.16f, 0.17f, 0.2f});
  draw.rectangle({0.05f * s.x(), 0.07f * s.y()}, {0.62f * s.x(), 0.87f * s.y()}, {0.13f, 0.14f, 0.16f});
  draw.rectangle({0.05f * s.x(), 0.03f * s.y()}, {0.62f * s.x(), 0.075f * s.y()}, {0.32f, 0.34f, 0.38f});
  writeText(draw, {{0.08f * s.x(), 0.11f * s.y()}, {0.58f * s.x(), 0.85f * s.y()}, 0.02f * s.y()},
            {{0.6f, 0.8f, 0.6f}, 0.005f * s.y(), 0});
  draw.rectangle({0.66f * s.x(), 0.1f * s.y()}, {0.96f * s.x(), 0.6f * s.y()}, {0.92f, 0.92f, 0.92f});
  drawChart(draw, {{0.69f * s.x(), 0.16f * s.y()}, {0.93f * s.x(), 0.55f * s.y()}, 0}, {ink, 0.005f * s.y(), 0});
  return picture;
}

Picture drawKeyboard(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.32f, 0.33f, 0.35f});
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  for (int row = 0; row < 5; ++row)
    for (int key = 0; key < 14; ++key) {
      const Vector2f a(s.x() * (0.02f + 0.0686f * key), s.y() * (0.05f + 0.185f * row));
      if (row == 4 && key > 3 && key < 9)
        continue;
      draw.rectangle(a, a + Vector2f(0.057f * s.x(), 0.15f * s.y()), {0.1f, 0.1f, 0.11f});
      draw.text(std::string(1, static_cast<char>('A' + draw.random().integer(26))),
                a + Vector2f(0.015f * s.x(), 0.04f * s.y()), 0.06f * s.y(), {{0.8f, 0.8f, 0.8f}, 0.01f * s.y(), 0});
    }
  draw.rectangle({0.295f * s.x(), 0.79f * s.y()}, {0.63f * s.x(), 0.94f * s.y()}, {0.1f, 0.1f, 0.11f});
  return picture;
}

Picture drawClock(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.93f, 0.92f, 0.88f});
  Drawing draw(picture, seed);
  const Vector2f s = extent(size), middle = 0.5f * s;
  const auto at = [&](float hours, float radius) -> Vector2f {
    const float angle = hours * 0.5235988f;
    return middle + radius * s.x() * Vector2f(std::sin(angle), -std::cos(angle));
  };
  for (int minute = 0; minute < 60; ++minute) {
    const float hours = minute / 5.f;
    draw.line({at(hours, 0.45f), at(hours, minute % 5 == 0 ? 0.38f : 0.43f)},
              {ink, (minute % 5 == 0 ? 0.016f : 0.006f) * s.x(), 0});
  }
  draw.line({middle, at(10.15f, 0.24f)}, {ink, 0.03f * s.x(), 0});
  draw.line({middle, at(1.8f, 0.37f)}, {ink, 0.02f * s.x(), 0});
  draw.line({at(9.5f, 0.08f), at(3.5f, 0.4f)}, {{0.8f, 0.1f, 0.1f}, 0.007f * s.x(), 0});
  return picture;
}

Picture drawCalendar(const PictureSize& size, std::uint64_t seed)
{
  const Picture top = drawLandscape({size.width, size.height / 2}, seed);
  Picture picture(size.width, size.height, {0.93f, 0.93f, 0.92f});
  for (int y = 0; y < size.height / 2; ++y)
    for (int x = 0; x < size.width; ++x)
      picture.pixel(x, y) = top.pixel(x, y);
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  draw.text("MAY", {0.08f * s.x(), 0.53f * s.y()}, 0.05f * s.y(), {{0.7f, 0.12f, 0.1f}, 0.01f * s.y(), 0});
  for (int day = 0; day < 31; ++day) {
    const Vector2f at(s.x() * (0.07f + 0.128f * ((day + 2) % 7)), s.y() * (0.63f + 0.07f * ((day + 2) / 7)));
    draw.text(std::to_string(day + 1), at, 0.03f * s.y(),
              {(day + 2) % 7 == 6 ? Vector3f(0.7f, 0.12f, 0.1f) : ink, 0.005f * s.y(), 0});
  }
  return picture;
}

Picture drawSpine(const PictureSize& size, std::uint64_t seed)
{
  CounterRandom random(seed, 8, 0);
  const Vector3f cover = hue(random, random.uniformFloat(0.02, 0.16), random.uniformFloat(0.18, 0.62))
                             .cwiseProduct(Vector3f(1.05f, 0.95f, 0.85f));
  const Vector3f print = cover.mean() > 0.5f ? ink : Vector3f(0.9f, 0.87f, 0.75f);
  Picture lying(size.height, size.width, cover); // title written along the spine, turned afterwards
  Drawing draw(lying, seed);
  const float w = size.height, h = size.width;
  const float band = random.uniformFloat(0.05, 0.12) * w;
  if (random.uniform() < 0.6) {
    draw.rectangle({band, 0}, {band + 0.02f * w, h}, print);
    draw.rectangle({w - band, 0}, {w - band + 0.02f * w, h}, print);
  }
  const float letter = std::min(0.42f * h, 0.06f * w);
  draw.text(word(random) + " " + word(random), {0.2f * w, 0.5f * (h - letter)}, letter, {print, 0.16f * letter, 0});
  Picture picture(size.width, size.height, cover);
  const std::uint32_t salt = seed;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      picture.pixel(x, y) =
          lying.pixel(y, size.width - 1 - x) * (1.f + 0.06f * noiseAt({x / w, y / w}, salt, {0.1f, 5, 0.7f}));
  return picture;
}

Picture drawView(const PictureSize& size, std::uint64_t seed)
{
  Picture picture = drawLandscape(size, seed);
  Drawing draw(picture, seed);
  CounterRandom& random = draw.random();
  const Vector2f s = extent(size);
  for (int house = 0; house < 9; ++house) {
    const float x = s.x() * (0.11f * house + random.uniformFloat(0, 0.04));
    const float wide = s.x() * random.uniformFloat(0.05, 0.1), top = s.y() * random.uniformFloat(0.45, 0.72);
    const Vector3f wall = hue(random, 0.05f, random.uniformFloat(0.55, 0.85));
    draw.rectangle({x, top}, {x + wide, s.y()}, wall);
    draw.rectangle({x - 3, top - 0.02f * s.y()}, {x + wide + 3, top}, {0.45f, 0.28f, 0.22f});
    for (float y = top + 0.04f * s.y(); y < s.y(); y += 0.07f * s.y())
      for (float u = x + 0.012f * s.x(); u + 0.012f * s.x() < x + wide; u += 0.022f * s.x())
        draw.rectangle({u, y}, {u + 0.011f * s.x(), y + 0.04f * s.y()}, {0.3f, 0.36f, 0.42f});
  }
  return picture;
}

Picture drawRug(const PictureSize& size, std::uint64_t seed)
{
  CounterRandom random(seed, 9, 0);
  const Vector3f ground = hue(random, 0.18f, 0.4f), light(0.82f, 0.76f, 0.62f), dark = hue(random, 0.12f, 0.22f);
  Picture picture(size.width, size.height, ground);
  const std::uint32_t salt = seed;
  const float aspect = static_cast<float>(size.width) / size.height;
  paint(picture, [&](float u, float v) -> Vector3f {
    const float x = u * aspect, border = std::min(std::min(x, aspect - x), std::min(v, 1.f - v));
    const float diamond =
        std::fabs(std::fmod(std::fabs(x - 0.5f * aspect) + std::fabs(v - 0.5f), 0.16f) / 0.16f - 0.5f);
    const float star = std::sin(40.f * x) * std::sin(40.f * v);
    Vector3f color = ground + smoothStep(0.22f, 0.26f, diamond) * (light - ground);
    color += smoothStep(0.35f, 0.5f, star) * (dark - color);
    const float stripe = smoothStep(0.03f, 0.034f, border) - smoothStep(0.05f, 0.054f, border) +
                         smoothStep(0.09f, 0.094f, border) - smoothStep(0.1f, 0.104f, border);
    if (border < 0.1f)
      color = dark;
    color += stripe * (light - color);
    return color * (1.f + 0.16f * noiseAt({x, v}, salt, {0.02f, 4, 0.75f}));
  });
  return picture;
}

Picture drawLabel(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0.92f, 0.91f, 0.88f});
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  draw.text(word(draw.random()), {0.06f * s.x(), 0.07f * s.y()}, 0.13f * s.y(), {ink, 0.025f * s.y(), 0});
  writeText(draw, {{0.06f * s.x(), 0.28f * s.y()}, {0.95f * s.x(), 0.58f * s.y()}, 0.06f * s.y()},
            {ink, 0.012f * s.y(), 0});
  float x = 0.06f * s.x();
  while (x < 0.9f * s.x()) {
    const float bar = s.x() * draw.random().uniformFloat(0.006, 0.02);
    draw.rectangle({x, 0.65f * s.y()}, {x + bar, 0.93f * s.y()}, ink);
    x += bar + s.x() * draw.random().uniformFloat(0.008, 0.02);
  }
  return picture;
}

Picture drawDoor(const PictureSize& size, std::uint64_t seed)
{
  Picture picture(size.width, size.height, {0, 0, 0});
  Material wood;
  wood.finish = Finish::wood;
  wood.color = {0.62f, 0.45f, 0.3f}, wood.accent = {0.74f, 0.58f, 0.42f};
  wood.along = 2;
  wood.seed = seed;
  const float metres = 2.1f / size.height;
  paint(picture, [&](float u, float v) -> Vector3f {
    const float x = u * size.width * metres, y = v * size.height * metres;
    const float shift = std::floor(3.f * u) * 2.7f + std::floor(2.f * v) * 5.3f;
    return albedo(wood, {{x + shift, 0.f, y + shift}, Vector3f::UnitY(), metres});
  });
  Drawing draw(picture, seed);
  const Vector2f s = extent(size);
  for (const float top : {0.07f, 0.55f}) {
    const Vector2f a(0.15f * s.x(), top * s.y()), b(0.85f * s.x(), (top + 0.38f) * s.y());
    draw.line({a, {b.x(), a.y()}}, {{0.3f, 0.2f, 0.12f}, 7, 0});
    draw.line({a, {a.x(), b.y()}}, {{0.35f, 0.23f, 0.14f}, 7, 0});
    draw.line({{b.x(), a.y()}, b, {a.x(), b.y()}}, {{0.82f, 0.68f, 0.52f}, 6, 0});
  }
  return picture;
}
} // namespace

PicturePtr drawPicture(const std::string& name, const PictureSize& size, std::uint64_t seed)
{
  using Draw = Picture (*)(const PictureSize&, std::uint64_t);
  static const std::map<std::string, Draw> known = {{"abstract", drawAbstract},
                                                    {"calendar", drawCalendar},
                                                    {"clock", drawClock},
                                                    {"door", drawDoor},
                                                    {"flip_chart", drawFlipChart},
                                                    {"keyboard", drawKeyboard},
                                                    {"label", drawLabel},
                                                    {"landscape", drawLandscape},
                                                    {"map", drawMap},
                                                    {"poster", drawPoster},
                                                    {"rug", drawRug},
                                                    {"screen", drawScreen},
                                                    {"sheet", drawSheet},
                                                    {"spine", drawSpine},
                                                    {"view", drawView},
                                                    {"whiteboard", drawWhiteboard}};
  Picture picture = known.at(name)(size, seed);
  picture.buildLevels();
  return std::make_shared<const Picture>(std::move(picture));
}
} // namespace fresco::simulation
