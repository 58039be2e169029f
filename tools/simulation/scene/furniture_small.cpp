// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/furniture.h"
#include <cmath>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
Box solid(const Vector3f& min, const Vector3f& max, int material) { return {min, max, allSides(material), true}; }

Eigen::Isometry3f turned(const Vector3f& at, float degrees, const Vector3f& axis)
{
  return Eigen::Translation3f(at) * Eigen::Isometry3f(Eigen::AngleAxisf(degrees * 0.01745329f, axis));
}
} // namespace

void laptop(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("laptop", spot.pose());
  const PictureBox base{{-0.17f, -0.12f, 0.002f}, {0.17f, 0.12f, 0.018f}, 5, nullptr, p.chrome};
  const PictureBox keys{
      {-0.15f, -0.02f, 0.018f}, {0.15f, 0.1f, 0.0185f}, 5, drawKeyboard({600, 240}, spot.seed), p.chrome};
  b.box(base.min, base.max, p.chrome);
  b.box(keys.min, keys.max, pictureSides(b, keys));
  b.beginObject("laptop lid", spot.pose() * turned({0, 0.12f, 0.012f}, -18.f, Vector3f::UnitX()));
  const PictureBox lid{{-0.17f, 0, 0}, {0.17f, 0.008f, 0.22f}, 2, drawScreen({900, 580}, spot.seed), p.chrome, 1.f};
  b.box(lid.min, lid.max, pictureSides(b, lid));
}

void monitor(SceneBuilder& b, const Palette& p, const Spot& spot, const Vector2f& size)
{
  b.beginObject("monitor", spot.pose());
  const float half = size.x() / 2;
  const PictureBox panel{
      {-half, -0.015f, 0.12f}, {half, 0.012f, 0.12f + size.y()}, 3, drawScreen({1200, 700}, spot.seed), p.black, 0.9f};
  b.boxes({solid({-half - 0.012f, -0.02f, 0.108f}, {half + 0.012f, 0.016f, 0.132f + size.y()}, p.black),
           {{-half, 0.012f, 0.12f}, {half, 0.016f, 0.12f + size.y()}, allSides(p.black), false},
           {panel.min, panel.max, pictureSides(b, panel), true},
           solid({-0.03f, -0.045f, 0.012f}, {0.03f, -0.02f, 0.3f}, p.black),
           solid({-0.13f, -0.1f, 0}, {0.13f, 0.08f, 0.012f}, p.black)});
}

void cup(SceneBuilder& b, const Spot& spot, int material)
{
  b.beginObject("cup", spot.pose());
  b.lathe({{0, 0}, {0.03f, 0}, {0.036f, 0.006f}, {0.041f, 0.09f}, {0.038f, 0.09f}, {0.034f, 0.01f}, {0, 0.008f}},
          material, 28);
  b.tube({{0.037f, 0, 0.075f}, {0.058f, 0, 0.07f}, {0.062f, 0, 0.045f}, {0.055f, 0, 0.025f}, {0.036f, 0, 0.02f}},
         0.005f, material);
}

void bottle(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("bottle", spot.pose());
  const int glass = addPaint(b, spot.seed % 2 ? Vector3f(0.2f, 0.42f, 0.3f) : Vector3f(0.35f, 0.5f, 0.62f));
  b.lathe({{0, 0},
           {0.034f, 0},
           {0.038f, 0.008f},
           {0.038f, 0.18f},
           {0.03f, 0.21f},
           {0.014f, 0.24f},
           {0.014f, 0.27f},
           {0, 0.27f}},
          glass, 28);
  b.lathe({{0, 0.268f}, {0.016f, 0.268f}, {0.016f, 0.288f}, {0, 0.288f}}, p.black, 28);
  b.lathe({{0, 0.07f}, {0.0388f, 0.07f}, {0.0388f, 0.15f}, {0, 0.15f}}, p.paper, 28);
}

void papers(SceneBuilder& b, const Palette& p, const Spot& spot, int count)
{
  CounterRandom random(spot.seed, 31, 0);
  for (int k = 0; k < count; ++k) {
    Spot own = spot;
    own.degrees += random.uniformFloat(-14, 14);
    own.position += Vector3f(random.uniformFloat(-0.05, 0.05), random.uniformFloat(-0.05, 0.05), 0.004f * k);
    b.beginObject("papers", own.pose());
    const PictureBox sheet{
        {-0.105f, -0.1485f, 0}, {0.105f, 0.1485f, 0.0035f}, 5, drawSheet({530, 750}, spot.seed + k), p.paper};
    b.box(sheet.min, sheet.max, pictureSides(b, sheet));
  }
  b.place(turned({0.04f, 0.02f, 0.004f * count + 0.0045f}, 35.f, Vector3f::UnitZ()));
  b.tube({{-0.07f, 0, 0}, {0.07f, 0, 0}}, 0.0045f, p.fabric_red);
}

void cartons(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  const auto carton = [&](const Vector3f& at, float degrees, const Vector3f& size) {
    b.beginObject("carton", spot.pose() * standing(at, degrees));
    const float x = size.x() / 2, y = size.y() / 2;
    const PictureBox label{{-0.09f, y, 0.4f * size.z()},
                           {0.07f, y + 0.0012f, 0.4f * size.z() + 0.1f},
                           3,
                           drawLabel({320, 200}, spot.seed + static_cast<std::uint64_t>(1000 * size.x())),
                           p.paper};
    b.boxes({solid({-x, -y, 0}, {x, y, size.z()}, p.cardboard),
             solid({-x, -0.03f, size.z()}, {x, 0.03f, size.z() + 0.0012f}, p.linen),
             {label.min, label.max, pictureSides(b, label), true}});
  };
  carton({0, 0, 0}, 0.f, {0.58f, 0.4f, 0.38f});
  carton({0.03f, 0.02f, 0.3815f}, 11.f, {0.42f, 0.32f, 0.27f});
  carton({-0.52f, 0.06f, 0}, -17.f, {0.34f, 0.34f, 0.3f});
}

void bin(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("bin", spot.pose());
  b.lathe({{0, 0},
           {0.12f, 0},
           {0.15f, 0.31f},
           {0.157f, 0.31f},
           {0.157f, 0.32f},
           {0.143f, 0.32f},
           {0.114f, 0.008f},
           {0, 0.008f}},
          p.grey_plastic, 40);
  b.place(turned({0.02f, 0.01f, 0.075f}, 24.f, Vector3f(1, 1, 0).normalized()));
  b.cushion({0.05f, 0.045f, 0.05f}, p.paper);
  b.place(turned({-0.045f, -0.02f, 0.065f}, -31.f, Vector3f(1, -1, 0.3f).normalized()));
  b.cushion({0.045f, 0.04f, 0.038f}, p.paper);
}

void plant(SceneBuilder& b, const Palette& p, const Spot& spot, float height)
{
  b.beginObject("plant", spot.pose());
  const float pot = 0.3f * height;
  b.lathe({{0, 0},
           {0.36f * pot, 0},
           {0.5f * pot, 0.85f * pot},
           {0.56f * pot, 0.85f * pot},
           {0.56f * pot, pot},
           {0.5f * pot, pot},
           {0.46f * pot, 0.9f * pot},
           {0, 0.9f * pot}},
          p.terracotta, 36);
  b.lathe({{0, 0.88f * pot}, {0.465f * pot, 0.88f * pot}, {0.43f * pot, 0.93f * pot}, {0, 0.95f * pot}}, p.soil, 36);
  CounterRandom random(spot.seed, 32, 0);
  const int leaves = 22;
  for (int k = 0; k < leaves; ++k) {
    const float a = 2.3999632f * k, reach = height * random.uniformFloat(0.25, 0.42);
    const float rise = height * (0.25f + 0.42f * k / leaves), wide = 0.045f * height * random.uniformFloat(0.8, 1.3);
    const Vector3f out(std::cos(a), std::sin(a), 0), across(-std::sin(a), std::cos(a), 0);
    std::vector<SweepKnot> knots;
    for (int i = 0; i <= 10; ++i) {
      const float t = i / 10.f;
      const float blade = t < 0.4f ? 0.f : std::sin(3.14159f * std::pow((t - 0.4f) / 0.6f, 0.8f));
      const Vector3f at = Vector3f(0, 0, 0.9f * pot) + out * (0.06f * pot + reach * t * t) +
                          Vector3f::UnitZ() * rise * (1.7f * t - t * t * 0.75f);
      knots.push_back({at, 0.004f + wide * blade, 0.003f});
    }
    b.sweep(knots, across, p.leaf);
  }
}

void flipChart(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  const Eigen::Isometry3f back = spot.pose() * turned({0, 0.f, 0.85f}, 10.f, Vector3f::UnitX());
  b.beginObject("flip chart", back);
  const PictureBox pad{
      {-0.33f, 0.011f, 0.05f}, {0.33f, 0.02f, 0.98f}, 3, drawFlipChart({792, 1116}, spot.seed), p.paper};
  b.box({-0.36f, -0.01f, 0}, {0.36f, 0.01f, 1.04f}, p.white_plastic);
  b.box(pad.min, pad.max, pictureSides(b, pad));
  b.box({-0.34f, 0.0105f, 0.985f}, {0.34f, 0.03f, 1.02f}, p.grey_plastic);
  b.beginObject("flip chart stand", spot.pose());
  for (const float x : {-0.3f, 0.3f})
    b.tube({{x, 0.165f, 0.f}, {x, -0.025f, 0.92f}}, 0.012f, p.steel);
  b.tube({{0, -0.55f, 0.f}, {0, -0.13f, 1.3f}}, 0.012f, p.steel);
}

void coatStand(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("coat stand", spot.pose());
  b.tube({{0, 0, 0.09f}, {0, 0, 1.78f}}, 0.018f, p.walnut);
  for (int k = 0; k < 4; ++k) {
    const float a = 1.5707963f * k + 0.3f, c = std::cos(a), s = std::sin(a);
    b.tube({{0.01f * c, 0.01f * s, 0.2f}, {0.12f * c, 0.12f * s, 0.1f}, {0.26f * c, 0.26f * s, 0.f}}, 0.013f, p.walnut);
    b.tube({{0.01f * c, 0.01f * s, 1.6f}, {0.1f * c, 0.1f * s, 1.62f}, {0.17f * c, 0.17f * s, 1.72f}}, 0.009f,
           p.walnut);
  }
  std::vector<SweepKnot> coat; // a jacket on a hook
  for (int i = 0; i <= 9; ++i) {
    const float t = i / 9.f;
    coat.push_back({{0.15f + 0.03f * std::sin(5.f * t), 0.05f, 1.66f - 0.85f * t},
                    0.05f + 0.13f * std::pow(std::sin(1.4f * t + 0.25f), 0.7f),
                    0.035f + 0.03f * t});
  }
  b.sweep(coat, Vector3f::UnitY(), p.fabric_blue);
}

void floorLamp(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("floor lamp", spot.pose());
  b.lathe({{0, 0}, {0.14f, 0}, {0.14f, 0.015f}, {0.02f, 0.03f}, {0, 0.03f}}, p.black, 36);
  b.tube({{0, 0, 0.025f}, {0, 0, 1.5f}}, 0.011f, p.black);
  b.lathe({{0.205f, 1.4f}, {0.21f, 1.4f}, {0.15f, 1.68f}, {0.145f, 1.68f}, {0.205f, 1.4f}}, p.linen, 40);
  b.place(Eigen::Isometry3f(Eigen::Translation3f(0, 0, 1.54f)));
  b.cushion({0.04f, 0.04f, 0.05f}, p.lamp);
}

void projector(SceneBuilder& b, const Palette& p, const Spot& spot, float ceiling)
{
  b.beginObject("projector", spot.pose());
  b.boxes({solid({-0.16f, -0.12f, 0}, {0.16f, 0.12f, 0.1f}, p.white_plastic),
           solid({-0.14f, -0.121f, 0.02f}, {-0.02f, -0.12f, 0.08f}, p.grey_plastic)});
  b.tube({{0, 0, 0.09f}, {0, 0, ceiling - spot.position.z()}}, 0.02f, p.chrome);
  b.place(turned({0.08f, 0.11f, 0.055f}, -90.f, Vector3f::UnitX()));
  b.cylinder(0.035f, 0.f, 0.045f, p.black);
  b.tube({{-0.088f, 0.f, 0.f}, {-0.088f, 0.f, 0.02f}}, 0.012f, p.rubber);
}
} // namespace fresco::simulation
