// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/rooms.h"
#include <cmath>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
// Living room west of the wall at x = 1, bedroom east of it; the origin lies in the living room.
constexpr float west = -4.f, wall_low = 1.f, wall_high = 1.14f, east = 4.8f, half_y = 2.2f, height = 2.6f;
constexpr float door_low = -0.5f, door_high = 0.45f;
const DoorSpec entrance{west, -1.f, -1.8f, -0.85f, 7};

void addShell(SceneBuilder& b, const Palette& p)
{
  const int ceiling = addPaint(b, {0.88f, 0.88f, 0.86f}, Finish::plaster),
            soft = addPaint(b, {0.8f, 0.74f, 0.64f}, Finish::plaster);
  const int rose = addPaint(b, {0.62f, 0.66f, 0.58f}, Finish::plaster);
  Shell shell;
  shell.free({west, -half_y, 0}, {wall_low, half_y, height}, {p.wall, p.wall, soft, p.wall, p.parquet, ceiling});
  shell.free({wall_high, -half_y, 0}, {east, half_y, height}, {p.wall, rose, p.wall, p.wall, p.carpet, ceiling});
  shell.free({wall_low, door_low, 0}, {wall_high, door_high, 2.06f},
             {p.frame, p.frame, p.frame, p.frame, p.walnut, p.frame});
  for (const float x : {wall_low - 0.02f, wall_high}) {
    shell.solid({x, door_low - 0.07f, 0}, {x + 0.02f, door_low, 2.13f}, p.frame);
    shell.solid({x, door_high, 0}, {x + 0.02f, door_high + 0.07f, 2.13f}, p.frame);
    shell.solid({x, door_low - 0.07f, 2.06f}, {x + 0.02f, door_high + 0.07f, 2.13f}, p.frame);
  }
  addDoor(b, p, shell, entrance);
  addWindow(b, p, shell, {-2.4f, 0.f, 0.95f, 2.25f, half_y, 1.f, 43});
  addWindow(b, p, shell, {2.2f, 4.0f, 0.95f, 2.25f, half_y, 1.f, 44});
  const Plan between{{wall_low - 0.1f, door_low - 0.07f}, {wall_high + 0.1f, door_high + 0.07f}};
  addSkirting(shell, {{west, -half_y}, {wall_low, half_y}},
              {between, {{west - 0.1f, entrance.low - 0.07f}, {west + 0.1f, entrance.high + 0.07f}}}, p.skirting);
  addSkirting(shell, {{wall_high, -half_y}, {east, half_y}}, {between}, p.skirting);
  b.beginObject("rooms");
  b.boxes(shell.boxes, true);
  addHandle(b, p, entrance);
}

/// A round lamp on the ceiling.
void addCeilingLamp(SceneBuilder& b, const Palette& p, const Vector2f& at)
{
  b.beginObject("ceiling lamp", standing({at.x(), at.y(), 0}));
  b.lathe({{0, height - 0.1f}, {0.2f, height - 0.1f}, {0.22f, height - 0.085f}, {0.22f, height}, {0, height}}, p.chrome,
          48);
  b.lathe({{0, height - 0.105f}, {0.19f, height - 0.105f}, {0.19f, height - 0.09f}, {0, height - 0.09f}}, p.lamp, 48);
  b.lamp({{at.x(), at.y(), height - 0.108f}, {0, 0.17f, 0}, {0.17f, 0, 0}, Vector3f(48.f, 43.f, 35.f)});
}

/// A wavy curtain beside a window, hanging from `top` to the floor along the wall at y.
void addCurtain(SceneBuilder& b, const Vector2f& x, float y, int material)
{
  b.beginObject("curtain");
  constexpr int folds = 9;
  for (int strip = 0; strip < folds; ++strip) {
    std::vector<SweepKnot> knots;
    for (int i = 0; i <= 12; ++i) {
      const float t = i / 12.f;
      const float at = x.x() + (x.y() - x.x()) * (strip + 0.5f) / folds + 0.012f * std::sin(5.f * t + strip);
      knots.push_back(
          {{at, y + 0.02f * std::sin(strip * 2.1f), 0.02f + 2.38f * t}, 0.62f * (x.y() - x.x()) / folds, 0.035f});
    }
    b.sweep(knots, Vector3f::UnitX(), material);
  }
}

void furnishLivingRoom(SceneBuilder& b, const Palette& p)
{
  sofa(b, p, {{-2.f, -1.72f, 0}, 0.f, 31});
  b.beginObject("rug", standing({-1.9f, -0.2f, 0}, 3.f));
  const PictureBox rug{{-1.1f, -0.75f, 0}, {1.1f, 0.75f, 0.012f}, 5, drawRug({1600, 1090}, 5), p.linen};
  b.box(rug.min, rug.max, pictureSides(b, rug));
  coffeeTable(b, p, {{-1.9f, -0.35f, 0.012f}, 0.f, 1});
  cup(b, {{-1.75f, -0.2f, 0.432f}, 40.f, 1}, addPaint(b, {0.3f, 0.5f, 0.55f}));
  cup(b, {{-2.1f, -0.45f, 0.432f}, 190.f, 1}, p.porcelain);
  papers(b, p, {{-1.82f, -0.5f, 0.432f}, 25.f, 63}, 2);
  sideboard(b, p, {{-1.7f, half_y - 0.016f, 0}, 180.f, 1}, {1.8f, 0.4f, 0.5f});
  monitor(b, p, {{-1.7f, half_y - 0.2f, 0.5f}, 180.f, 71}, {1.1f, 0.62f});
  bookShelf(b, p, {{0.984f, 1.45f, 0}, 90.f, 82}, {1.2f, 2.0f});
  bookShelf(b, p, {{0.984f, -1.5f, 0}, 90.f, 83}, {1.0f, 1.25f});
  plant(b, p, {{0.75f, -1.4f, 1.25f}, 0.f, 93}, 0.4f);
  plant(b, p, {{-3.55f, 1.75f, 0}, 0.f, 97}, 1.2f);
  floorLamp(b, p, {{-3.5f, -0.4f, 0}, 0.f, 1});
  framedPicture(b, p, {{-2.7f, -half_y, 1.65f}, 0.f, 1}, drawLandscape({1200, 800}, 31));
  framedPicture(b, p, {{-1.4f, -half_y, 1.65f}, 0.f, 2}, drawAbstract({800, 1000}, 32));
  framedPicture(b, p, {{0.3f, -half_y, 1.6f}, 0.f, 4}, drawMap({900, 1000}, 33));
  framedPicture(b, p, {{west, 0.6f, 1.6f}, -90.f, 3}, drawAbstract({1200, 800}, 34));
  woodenChair(b, p, {{-3.5f, 0.75f, 0}, -70.f, 1});
  cartons(b, p, {{0.3f, -1.9f, 0}, 0.f, 92});
  socket(b, p, {{west, -0.6f, 1.1f}, -90.f, 1});
  addCurtain(b, {-2.78f, -2.48f}, half_y - 0.09f, p.linen);
  addCurtain(b, {0.08f, 0.36f}, half_y - 0.09f, p.linen);
}

void furnishBedroom(SceneBuilder& b, const Palette& p)
{
  bed(b, p, {{3.7f, -0.75f, 0}, 90.f, 1});
  wardrobe(b, p, {{2.1f, -half_y + 0.016f, 0}, 0.f, 1});
  desk(b, p, {{2.45f, half_y - 0.5f, 0}, 180.f, 1});
  monitor(b, p, {{2.45f, half_y - 0.34f, 0.74f}, 180.f, 72}, {0.55f, 0.33f});
  b.beginObject("keyboard", standing({2.42f, half_y - 0.66f, 0.74f}, 180.f));
  const PictureBox keys{{-0.2f, -0.07f, 0}, {0.2f, 0.07f, 0.02f}, 5, drawKeyboard({800, 280}, 3), p.black};
  b.box(keys.min, keys.max, pictureSides(b, keys));
  cup(b, {{1.95f, half_y - 0.45f, 0.74f}, 0.f, 1}, p.porcelain);
  papers(b, p, {{2.95f, half_y - 0.55f, 0.74f}, 190.f, 64}, 2);
  woodenChair(b, p, {{2.4f, 0.95f, 0}, 14.f, 1});
  bin(b, p, {{1.45f, 1.7f, 0}, 0.f, 1});
  framedPicture(b, p, {{east, -0.75f, 1.65f}, 90.f, 1}, drawLandscape({1300, 800}, 36));
  framedPicture(b, p, {{wall_high, 1.35f, 1.6f}, -90.f, 2}, drawPoster({800, 1100}, 37));
  radiator(b, p, {{3.9f, half_y, 0}, 180.f, 1}, 0.9f);
  plant(b, p, {{4.4f, 1.0f, 0}, 0.f, 98}, 0.8f);
  cartons(b, p, {{4.45f, 1.65f, 0}, -90.f, 95});
  wallClock(b, p, {{wall_high, -1.2f, 2.0f}, -90.f, 1});
  cable(b, p, {{3.3f, 2.15f}, {3.1f, 1.7f}, {3.3f, 1.2f}, {2.9f, 1.0f}, {2.5f, 1.5f}});
}
} // namespace

Scene makeApartment(float max_edge)
{
  SceneBuilder builder("apartment", max_edge);
  const Palette palette(builder);
  addShell(builder, palette);
  addCeilingLamp(builder, palette, {-1.6f, 0.1f});
  addCeilingLamp(builder, palette, {2.9f, 0.1f});
  furnishLivingRoom(builder, palette);
  furnishBedroom(builder, palette);
  return builder.finish();
}
} // namespace fresco::simulation
