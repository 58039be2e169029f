// SPDX-License-Identifier: BSD-3-Clause
#include "scene/descriptions.h"
#include "scene/furniture.h"
#include "scene/office.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::simulation {
using Eigen::AlignedBox2f;
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
/// The shell of rooms: free boxes in solid ground, and the solids that belong to the walls. No face is hidden.
using Shell = std::vector<Box>;
using Pair = std::array<float, 2>;

constexpr float skirting_height = 0.08f, skirting_depth = 0.015f;

/// Rectangle of floor [x, y, x, y].
AlignedBox2f floorPlan(const Json& numbers)
{
  const auto corners = numbers.get<std::array<float, 4>>();
  return {Vector2f(corners[0], corners[1]), Vector2f(corners[2], corners[3])};
}

bool within(float at, float low, float high) { return at > low - 1e-4f && at < high + 1e-4f; }

/// Parts of [low, high] outside of all `cuts`.
std::vector<Vector2f> remaining(float low, float high, std::vector<Vector2f> cuts)
{
  std::sort(cuts.begin(), cuts.end(), [](const Vector2f& a, const Vector2f& b) { return a.x() < b.x(); });
  std::vector<Vector2f> parts;
  for (const Vector2f& cut : cuts) {
    if (cut.x() > low)
      parts.push_back({low, cut.x()});
    low = std::max(low, cut.y());
  }
  if (low < high)
    parts.push_back({low, high});
  return parts;
}

/// Skirting board along the four walls of the room "skirting"; "gaps" (openings) are cut out of it.
void addSkirting(Furniture& f, Shell& shell, const Json& described)
{
  const AlignedBox2f room = floorPlan(described.at("skirting"));
  for (const bool upper : {false, true}) {
    std::vector<Vector2f> x_cuts, y_cuts;
    const Vector2f wall = upper ? room.max() : room.min();
    for (const Json& numbers : described.at("gaps")) {
      const AlignedBox2f gap = floorPlan(numbers);
      if (within(wall.x(), gap.min().x(), gap.max().x()))
        y_cuts.push_back({gap.min().y(), gap.max().y()});
      if (within(wall.y(), gap.min().y(), gap.max().y()))
        x_cuts.push_back({gap.min().x(), gap.max().x()});
    }
    const Vector2f inner = wall.array() + (upper ? -skirting_depth : skirting_depth);
    const int material = f.material("skirting");
    for (const Vector2f& part : remaining(room.min().x(), room.max().x(), x_cuts))
      shell.push_back(solid({part.x(), wall.y(), 0}, {part.y(), inner.y(), skirting_height}, material));
    for (const Vector2f& part : remaining(room.min().y(), room.max().y(), y_cuts))
      shell.push_back(solid({wall.x(), part.x(), 0}, {inner.x(), part.y(), skirting_height}, material));
  }
}

/// A "window" [left, right] in the wall at "y" that looks to +y, "z" [low, high]: reveal, frame, panes, sill; and a lamp
/// for the daylight.
void addWindow(Furniture& f, Shell& shell, const Json& described)
{
  const auto [left, right] = described.at("window").get<Pair>();
  const auto [low, high] = described.at("z").get<Pair>();
  const float wall = described.at("y"), depth = 0.2f, bar = 0.06f, middle = 0.5f * (left + right), far = wall + depth,
              near = wall + (depth - 0.05f);
  Material view = printed({{"picture", "view"}, {"pixels", {1000, 640}}, {"emission", 1}}, described.at("seed"));
  view.glass = true;
  Box recess{{left, wall, low}, {right, far, high}, allSides(f.material("wall")), false};
  recess = withPicture(f.builder(), recess, 2, view); // drawn on the far side, seen from the room
  std::swap(recess.materials[2], recess.materials[3]);
  const int frame = f.material("frame");
  shell.insert(shell.end(), {recess, solid({left, near, low}, {left + bar, far, high}, frame),
                             solid({right - bar, near, low}, {right, far, high}, frame),
                             solid({middle - bar, near, low}, {middle + bar, far, high}, frame),
                             solid({left, near, low}, {right, far, low + bar}, frame),
                             solid({left, near, high - bar}, {right, far, high}, frame),
                             solid({left - 0.05f, wall - 0.1f, low - 0.03f}, {right + 0.05f, wall, low},
                                   f.material("white_lacquer"))});
  const float half_x = 0.5f * (right - left) - bar, half_z = 0.5f * (high - low) - bar;
  const Vector3f center(middle, wall + (depth - 0.05f - 0.01f), 0.5f * (low + high));
  f.builder().lamp({center, {half_x, 0, 0}, {0, 0, half_z}, Vector3f(2.6f, 3.0f, 3.5f)});
}

/// A closed "door" [low, high] in the wall at "x" that looks to -x: recess, casing. Its handle is a thing.
void addDoor(Furniture& f, Shell& shell, const Json& described)
{
  const auto [low, high] = described.at("door").get<Pair>();
  const float wall = described.at("x"), rim = 0.07f, top = 2.06f, out = wall + 0.02f;
  const int frame = f.material("frame");
  Box recess{{wall - 0.07f, low, 0}, {wall, high, top}, allSides(frame), false};
  recess = withPicture(f.builder(), recess, 1,
                       printed({{"picture", "door"}, {"pixels", {900, 1900}}}, described.at("seed")));
  std::swap(recess.materials[0], recess.materials[1]);
  recess.materials[4] = f.material("parquet");
  shell.insert(shell.end(), {recess, solid({wall, low - rim, 0}, {out, low, top + rim}, frame),
                             solid({wall, high, 0}, {out, high + rim, top + rim}, frame),
                             solid({wall, low - rim, top}, {out, high + rim, top + rim}, frame)});
}

/// A lit "panel" let into the ceiling at "z", and its lamp.
void addCeilingPanel(Furniture& f, Shell& shell, const Json& described)
{
  const AlignedBox2f plan = floorPlan(described.at("panel"));
  const Vector2f a = plan.min(), b = plan.max(), middle = 0.5f * (a + b), half = 0.48f * (b - a);
  const float z = described.at("z");
  Box recess{{a.x(), a.y(), z}, {b.x(), b.y(), z + 0.03f}, allSides(f.material("frame")), false};
  recess.materials[5] = f.material("lamp");
  shell.push_back(recess);
  f.builder().lamp(
      {{middle.x(), middle.y(), z + 0.004f}, {0, half.y(), 0}, {half.x(), 0, 0}, Vector3f(6.5f, 6.2f, 5.6f)});
}

void addShell(Furniture& f, const Json& room)
{
  Shell shell;
  for (const Json& part : room.at("shell"))
    if (part.contains("skirting"))
      addSkirting(f, shell, part);
    else if (part.contains("window"))
      addWindow(f, shell, part);
    else if (part.contains("door"))
      addDoor(f, shell, part);
    else if (part.contains("panel"))
      addCeilingPanel(f, shell, part);
    else
      shell.push_back(f.box(part));
  f.builder().beginObject(room.at("object"));
  f.builder().boxes(shell, true);
}

Scene sceneOf(const std::string& name, const Json& room, float max_edge)
{
  require(max_edge >= 0.02f && max_edge <= 10.f, "scene: edge ", max_edge, " m is not in 0.02..10");
  SceneBuilder builder(name, max_edge);
  Furniture furniture(builder);
  addShell(furniture, room);
  for (const Json& placed : room.at("things"))
    furniture.add(placed);
  return builder.finish();
}
} // namespace

Scene makeScene(const std::string& name, float max_edge)
{
  require(name == "conference_room" || name == "apartment", "scene: unknown name ", name);
  return sceneOf(name, Json::parse(name == "apartment" ? apartment_json : conference_room_json), max_edge);
}

Scene makeOffice(const OfficeOptions& options, float max_edge)
{
  const Json office = officeFloor(options);
  Scene scene = sceneOf("office", office, max_edge);
  scene.detail = 0.2f;
  scene.floors = office["floors"].get<std::vector<float>>();
  for (const Json& at : office.value("stations", Json::array()))
    scene.stations.push_back(vectorOf(at));
  return scene;
}
} // namespace fresco::simulation
