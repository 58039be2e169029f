// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/furniture.h"
#include <cmath>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
Eigen::Isometry3f leaning(const Vector3f& at, float degrees)
{
  return Eigen::Translation3f(at) * Eigen::Isometry3f(Eigen::AngleAxisf(degrees * 0.01745329f, Vector3f::UnitX()));
}

Box solid(const Vector3f& min, const Vector3f& max, int material) { return {min, max, allSides(material), true}; }

/// Four legs of square section below a board.
std::vector<Box> boardOnLegs(const Vector3f& half, float board, float leg, const std::array<int, 2>& materials)
{
  const float x = half.x() - 0.06f, y = half.y() - 0.06f, low = half.z() - board;
  std::vector<Box> boxes;
  for (const float sx : {-1.f, 1.f})
    for (const float sy : {-1.f, 1.f})
      boxes.push_back(
          solid({sx * x - leg / 2, sy * y - leg / 2, 0}, {sx * x + leg / 2, sy * y + leg / 2, low}, materials[1]));
  boxes.push_back(solid({-half.x(), -half.y(), low}, half, materials[0]));
  return boxes;
}
} // namespace

void conferenceChair(SceneBuilder& b, const Palette& p, const Spot& spot, int fabric)
{
  b.beginObject("chair", spot.pose());
  for (const float side : {-1.f, 1.f}) {
    b.tube({{side * 0.235f, 0.22f, 0.f},
            {side * 0.225f, 0.19f, 0.41f},
            {side * 0.225f, -0.2f, 0.41f},
            {side * 0.235f, -0.26f, 0.f}},
           0.011f, p.chrome);
    b.tube({{side * 0.205f, -0.19f, 0.4f}, {side * 0.205f, -0.232f, 0.6f}, {side * 0.2f, -0.285f, 0.82f}}, 0.01f,
           p.chrome);
    b.tube({{side * 0.255f, -0.2f, 0.64f}, {side * 0.26f, 0.12f, 0.65f}, {side * 0.24f, 0.17f, 0.43f}}, 0.009f,
           p.chrome);
    b.place(Eigen::Isometry3f(Eigen::Translation3f(side * 0.258f, -0.03f, 0.655f)));
    b.cushion({0.024f, 0.13f, 0.013f}, p.black);
    b.place(Eigen::Isometry3f::Identity());
  }
  b.place(Eigen::Isometry3f(Eigen::Translation3f(0, 0, 0.445f)));
  b.cushion({0.23f, 0.225f, 0.032f}, fabric);
  b.place(leaning({0, -0.265f, 0.74f}, 13.f));
  b.cushion({0.22f, 0.026f, 0.19f}, fabric);
}

void woodenChair(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("chair", spot.pose());
  std::vector<Box> boxes;
  for (const float x : {-0.2f, 0.17f}) {
    boxes.push_back(solid({x, 0.15f, 0}, {x + 0.03f, 0.18f, 0.43f}, p.oak));
    boxes.push_back(solid({x, -0.19f, 0}, {x + 0.03f, -0.16f, 0.9f}, p.oak));
    boxes.push_back(solid({x + 0.007f, -0.16f, 0.2f}, {x + 0.023f, 0.15f, 0.22f}, p.oak));
  }
  for (const float z : {0.58f, 0.7f, 0.82f})
    boxes.push_back(solid({-0.17f, -0.182f, z}, {0.17f, -0.168f, z + 0.06f}, p.oak));
  boxes.push_back(solid({-0.21f, -0.2f, 0.43f}, {0.21f, 0.2f, 0.455f}, p.oak));
  b.boxes(boxes);
}

void conferenceTable(SceneBuilder& b, const Palette& p, const Spot& spot, const Vector2f& size)
{
  b.beginObject("table", spot.pose());
  const float x = size.x() / 2, y = size.y() / 2;
  std::vector<Box> boxes;
  for (const float sx : {-x + 0.25f, 0.f, x - 0.25f})
    for (const float sy : {-1.f, 1.f}) {
      const float at = sy * (y - 0.12f);
      boxes.push_back(solid({sx - 0.02f, at - 0.02f, 0}, {sx + 0.02f, at + 0.02f, 0.71f}, p.steel));
    }
  boxes.push_back(solid({-x + 0.23f, -0.02f, 0.64f}, {x - 0.23f, 0.02f, 0.68f}, p.steel));
  for (const float sx : {-x + 0.25f, 0.f, x - 0.25f})
    boxes.push_back(solid({sx - 0.02f, -y + 0.1f, 0.68f}, {sx + 0.02f, y - 0.1f, 0.71f}, p.steel));
  boxes.push_back(solid({-x, -y, 0.71f}, {x, y, 0.74f}, p.oak));
  boxes.push_back(solid({-0.3f, -0.06f, 0.74f}, {0.3f, 0.06f, 0.755f}, p.black));
  b.boxes(boxes);
}

void coffeeTable(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("coffee table", spot.pose());
  b.lathe({{0, 0.39f}, {0.4f, 0.39f}, {0.42f, 0.4f}, {0.42f, 0.42f}, {0, 0.42f}}, p.walnut, 48);
  for (int leg = 0; leg < 3; ++leg) {
    const float a = 2.0943951f * leg + 0.4f;
    b.tube({{0.36f * std::cos(a), 0.36f * std::sin(a), 0}, {0.25f * std::cos(a), 0.25f * std::sin(a), 0.395f}}, 0.016f,
           p.walnut);
  }
}

void desk(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("desk", spot.pose());
  std::vector<Box> boxes = boardOnLegs({0.7f, 0.35f, 0.74f}, 0.025f, 0.045f, {p.white_lacquer, p.steel});
  boxes.push_back(solid({0.22f, -0.27f, 0.15f}, {0.62f, 0.27f, 0.715f}, p.white_lacquer));
  for (int drawer = 0; drawer < 3; ++drawer) {
    const float z = 0.165f + 0.182f * drawer;
    boxes.push_back(solid({0.23f, 0.27f, z}, {0.61f, 0.288f, z + 0.17f}, p.oak));
    boxes.push_back(solid({0.36f, 0.288f, z + 0.08f}, {0.48f, 0.303f, z + 0.09f}, p.chrome));
  }
  b.boxes(boxes);
}

void sofa(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("sofa", spot.pose());
  std::vector<Box> boxes;
  for (const float x : {-0.95f, 0.89f})
    for (const float y : {-0.38f, 0.32f})
      boxes.push_back(solid({x, y, 0}, {x + 0.06f, y + 0.06f, 0.1f}, p.walnut));
  boxes.push_back(solid({-1.f, -0.42f, 0.1f}, {1.f, 0.42f, 0.27f}, p.fabric_grey));
  boxes.push_back(solid({-1.f, -0.42f, 0.27f}, {1.f, -0.27f, 0.8f}, p.fabric_grey));
  boxes.push_back(solid({-1.f, -0.27f, 0.27f}, {-0.84f, 0.42f, 0.58f}, p.fabric_grey));
  boxes.push_back(solid({0.84f, -0.27f, 0.27f}, {1.f, 0.42f, 0.58f}, p.fabric_grey));
  b.boxes(boxes);
  for (int seat = 0; seat < 3; ++seat) {
    const float x = 0.56f * (seat - 1);
    b.place(Eigen::Isometry3f(Eigen::Translation3f(x, 0.09f, 0.345f)));
    b.cushion({0.276f, 0.345f, 0.085f}, p.fabric_grey);
    b.place(leaning({x, -0.19f, 0.6f}, 12.f));
    b.cushion({0.27f, 0.08f, 0.2f}, p.fabric_grey);
  }
  CounterRandom random(spot.seed, 21, 0);
  for (const float x : {-0.62f, 0.6f}) {
    b.place(leaning({x, -0.03f, 0.6f}, random.uniformFloat(18, 30)));
    b.cushion({0.2f, 0.075f, 0.19f}, x < 0 ? p.fabric_red : p.linen);
  }
}

void bed(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("bed", spot.pose());
  std::vector<Box> boxes;
  for (const float x : {-0.8f, 0.73f})
    for (const float y : {-0.98f, 0.95f})
      boxes.push_back(solid({x, y, 0}, {x + 0.07f, y + 0.05f, 0.2f}, p.oak));
  boxes.push_back(solid({-0.82f, -1.f, 0.2f}, {0.82f, 1.02f, 0.34f}, p.oak));
  boxes.push_back(solid({-0.82f, -1.06f, 0.1f}, {0.82f, -1.f, 0.95f}, p.oak));
  b.boxes(boxes);
  b.place(Eigen::Isometry3f(Eigen::Translation3f(0, 0.01f, 0.41f)));
  b.cushion({0.79f, 0.99f, 0.12f}, p.linen);
  b.place(Eigen::Isometry3f(Eigen::Translation3f(0, 0.33f, 0.49f)));
  b.cushion({0.83f, 0.7f, 0.085f}, p.fabric_blue);
  for (const float x : {-0.4f, 0.38f}) {
    b.place(leaning({x, -0.7f, 0.6f}, -16.f));
    b.cushion({0.32f, 0.22f, 0.075f}, p.linen);
  }
}

void bookShelf(SceneBuilder& b, const Palette& p, const Spot& spot, const Vector2f& size)
{
  b.beginObject("shelf", spot.pose());
  const float half = size.x() / 2, depth = 0.28f, board = 0.02f;
  const int floors = std::lround(size.y() / 0.36f);
  const float step = (size.y() - board) / floors;
  std::vector<Box> boxes = {solid({-half, 0, 0}, {half, 0.012f, size.y()}, p.oak),
                            solid({-half, 0, 0}, {-half + board, depth, size.y()}, p.oak),
                            solid({half - board, 0, 0}, {half, depth, size.y()}, p.oak)};
  for (int k = 0; k <= floors; ++k) {
    const float z = step * k;
    boxes.push_back(solid({-half, 0, z}, {half, depth, z + board}, p.oak));
  }
  b.boxes(boxes);
  CounterRandom random(spot.seed, 22, 0);
  for (int k = 0; k < floors; ++k) {
    const float z = step * k + board;
    float x = -half + board + 0.01f;
    while (x < half - board - 0.09f) {
      if (random.uniform() < 0.1) {
        x += random.uniformFloat(0.04, 0.16);
        continue;
      }
      const float thick = random.uniform(0.018, 0.055);
      const float high = random.uniformFloat(0.55, 0.88) * (step - board), deep = random.uniformFloat(0.15, 0.22);
      const PictureBox book{
          {x, 0.03f, z},
          {x + thick, 0.03f + deep, z + high},
          3,
          drawSpine({static_cast<int>(thick * 1400), static_cast<int>(high * 1400)}, random.integer(1 << 30)),
          p.paper};
      b.beginObject("book", spot.pose());
      b.box(book.min, book.max, pictureSides(b, book));
      x += thick + 0.0015f;
    }
  }
}

void sideboard(SceneBuilder& b, const Palette& p, const Spot& spot, const Vector3f& size)
{
  b.beginObject("sideboard", spot.pose());
  const float half = size.x() / 2;
  std::vector<Box> boxes = {solid({-half + 0.03f, 0.02f, 0}, {half - 0.03f, size.y() - 0.04f, 0.07f}, p.black),
                            solid({-half, 0, 0.07f}, {half, size.y() - 0.02f, size.z()}, p.walnut)};
  const int doors = std::lround(size.x() / 0.45f);
  const float wide = size.x() / doors;
  for (int k = 0; k < doors; ++k) {
    const float x = -half + wide * k;
    boxes.push_back(solid({x + 0.004f, size.y() - 0.02f, 0.09f}, {x + wide - 0.004f, size.y(), size.z() - 0.02f},
                          k % 2 ? p.walnut : p.white_lacquer));
    boxes.push_back(solid({x + wide - 0.05f, size.y(), size.z() - 0.22f},
                          {x + wide - 0.04f, size.y() + 0.022f, size.z() - 0.08f}, p.chrome));
  }
  b.boxes(boxes);
}

void wardrobe(SceneBuilder& b, const Palette& p, const Spot& spot) { sideboard(b, p, spot, {1.8f, 0.58f, 2.1f}); }
} // namespace fresco::simulation
