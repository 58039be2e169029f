// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/rooms.h"
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
constexpr float half_x = 4.f, half_y = 3.f, height = 2.8f;
const DoorSpec entrance{-half_x, -1.f, 1.35f, 2.3f, 3};

void addShell(SceneBuilder& b, const Palette& p)
{
  Shell shell;
  shell.free({-half_x, -half_y, 0}, {half_x, half_y, height},
             {p.wall, p.wall_accent, p.wall, p.wall, p.carpet, p.ceiling});
  shell.solid({3.6f, 2.6f, 0}, {half_x, half_y, height}, p.wall); // pillar
  for (const float x : {-2.4f, 0.f, 2.4f})
    for (const float y : {-1.5f, 1.5f})
      addCeilingPanel(b, p, shell, {{x - 0.6f, y - 0.3f}, {x + 0.6f, y + 0.3f}}, height);
  addDoor(b, p, shell, entrance);
  addWindow(b, p, shell, {-2.9f, -0.5f, 0.95f, 2.35f, half_y, 1.f, 41});
  addWindow(b, p, shell, {0.6f, 3.0f, 0.95f, 2.35f, half_y, 1.f, 42});
  addSkirting(shell, {{-half_x, -half_y}, {half_x, half_y}},
              {{{-half_x - 0.1f, entrance.low - 0.07f}, {-half_x + 0.1f, entrance.high + 0.07f}},
               {{3.5f, 2.5f}, {half_x, half_y}}},
              p.skirting);
  b.beginObject("room");
  b.boxes(shell.boxes, true);
  addHandle(b, p, entrance);
}

void addTableAndChairs(SceneBuilder& b, const Palette& p, CounterRandom& random)
{
  const auto jitter = [&](double range) { return random.uniformFloat(-range, range); };
  conferenceTable(b, p, {{0.1f, -0.1f, 0}, 0.f, 1}, {4.2f, 1.3f});
  for (int k = 0; k < 4; ++k) {
    const float x = -1.4f + 1.f * k;
    const int fabric = k % 4 == 2 ? p.fabric_red : p.fabric_blue;
    conferenceChair(b, p, {{x + jitter(0.1), -1.05f + jitter(0.12), 0}, jitter(14), 1}, fabric);
    conferenceChair(b, p, {{x + 0.1f + jitter(0.1), 0.85f + jitter(0.12), 0}, 180.f + jitter(14), 1}, p.fabric_blue);
  }
  conferenceChair(b, p, {{-2.35f, -0.05f, 0}, -82.f, 1}, p.fabric_grey);
  conferenceChair(b, p, {{2.65f, -0.25f, 0}, 105.f, 1}, p.fabric_grey);
}

void addTableTop(SceneBuilder& b, const Palette& p)
{
  const float top = 0.74f;
  laptop(b, p, {{-0.9f, -0.35f, top}, 8.f, 51});
  laptop(b, p, {{1.2f, 0.2f, top}, 172.f, 52});
  const Vector3f glazes[] = {{0.85f, 0.84f, 0.8f}, {0.2f, 0.35f, 0.55f}, {0.75f, 0.35f, 0.2f}, {0.3f, 0.45f, 0.32f}};
  const Vector2f places[] = {{-0.45f, -0.5f}, {0.75f, 0.25f}, {1.6f, -0.45f}, {-1.3f, 0.25f}};
  for (int k = 0; k < 4; ++k)
    cup(b, {{places[k].x(), places[k].y(), top}, 70.f * k, 1}, addPaint(b, glazes[k]));
  bottle(b, p, {{0.55f, -0.05f, top}, 0.f, 1});
  bottle(b, p, {{-0.35f, 0.2f, top}, 0.f, 2});
  papers(b, p, {{0.35f, -0.5f, top}, 12.f, 61}, 3);
  papers(b, p, {{-1.2f, -0.05f, top}, 195.f, 66}, 2);
  papers(b, p, {{1.75f, 0.1f, top}, 80.f, 71}, 1);
}

void addWallThings(SceneBuilder& b, const Palette& p)
{
  whiteboard(b, p, {{half_x, -0.2f, 1.5f}, 90.f, 11});
  framedPicture(b, p, {{-2.7f, -half_y, 1.6f}, 0.f, 1}, drawLandscape({1200, 800}, 21));
  framedPicture(b, p, {{-1.35f, -half_y, 1.6f}, 0.f, 2}, drawAbstract({900, 900}, 22));
  framedPicture(b, p, {{3.2f, -half_y, 1.55f}, 0.f, 4}, drawPoster({800, 1100}, 26));
  framedPicture(b, p, {{-half_x, -0.6f, 1.55f}, -90.f, 3}, drawMap({1300, 900}, 24));
  framedPicture(b, p, {{0.05f, half_y, 1.7f}, 180.f, 4}, drawCalendar({600, 900}, 25));
  framedPicture(b, p, {{-half_x, -2.2f, 1.6f}, -90.f, 6}, drawAbstract({800, 1000}, 27));
  wallClock(b, p, {{half_x, 1.9f, 2.2f}, 90.f, 1});
  socket(b, p, {{-half_x, 1.1f, 1.1f}, -90.f, 1});
  for (const float x : {-3.2f, -0.4f, 2.4f})
    socket(b, p, {{x, -half_y, 0.3f}, 0.f, 1});
  radiator(b, p, {{-1.7f, half_y, 0}, 180.f, 1}, 1.5f);
  radiator(b, p, {{1.8f, half_y, 0}, 180.f, 1}, 1.5f);
}

void addClutter(SceneBuilder& b, const Palette& p)
{
  bookShelf(b, p, {{1.2f, -half_y + 0.016f, 0}, 0.f, 81}, {1.8f, 1.9f});
  sideboard(b, p, {{-2.1f, -half_y + 0.016f, 0}, 0.f, 1}, {1.8f, 0.42f, 0.78f});
  plant(b, p, {{-1.5f, -2.78f, 0.78f}, 0.f, 95}, 0.45f);
  cartons(b, p, {{3.35f, -2.55f, 0}, 4.f, 91});
  bin(b, p, {{-3.65f, 0.85f, 0}, 0.f, 1});
  plant(b, p, {{-3.5f, 2.55f, 0}, 0.f, 94}, 1.35f);
  flipChart(b, p, {{3.2f, 1.75f, 0}, 128.f, 96});
  coatStand(b, p, {{-3.55f, -1.45f, 0}, 20.f, 1});
  projector(b, p, {{0.f, -0.1f, 2.25f}, -90.f, 1}, height);
  cable(
      b, p,
      {{-0.4f, -2.97f}, {-0.3f, -2.4f}, {0.2f, -2.1f}, {0.0f, -1.6f}, {0.25f, -1.2f}, {0.1f, -0.4f}, {0.12f, -0.12f}});
  cable(b, p, {{2.4f, -2.97f}, {2.45f, -2.3f}, {2.1f, -1.8f}, {2.5f, -1.3f}, {2.0f, -0.6f}, {1.7f, -0.2f}});
  b.beginObject("smoke detector");
  b.lathe({{0, height - 0.05f}, {0.03f, height - 0.05f}, {0.05f, height - 0.03f}, {0.055f, height}, {0, height}},
          p.white_plastic, 32);
}
} // namespace

Scene makeConferenceRoom(float max_edge)
{
  SceneBuilder builder("conference_room", max_edge);
  const Palette palette(builder);
  CounterRandom random(2024, 1, 0); // the room is always the same
  addShell(builder, palette);
  addTableAndChairs(builder, palette, random);
  addTableTop(builder, palette);
  addWallThings(builder, palette);
  addClutter(builder, palette);
  return builder.finish();
}
} // namespace fresco::simulation
