// SPDX-License-Identifier: BSD-3-Clause
#include "scene/office.h"
#include "scene/furniture.h"
#include <algorithm>
#include <array>
#include <fresco/core/require.h>
#include <fresco/simulation/sensors/random.h>
#include <vector>
namespace fresco::simulation {
namespace {
constexpr float wall = 0.12f, height = 2.6f, storey_height = 2.9f; // the slab between storeys: 30 cm
constexpr float door_width = 0.95f, door_height = 2.06f;

enum class Front { open, closed, glass }; ///< of a room to its corridor

/// A room in its own frame: x along the corridor's wall, y into the room, the origin in the corner.
struct OfficeRoom {
  float width = 0.f, depth = 0.f, door = 0.f; ///< metres; door: where it begins
  Front front = Front::open;
  std::uint64_t seed = 1; ///< of the furniture
};

/// Rooms side by side along a corridor.
struct Row {
  float x = 0.f, y = 0.f; ///< of the end of the corridor's wall where the first room begins
  bool turned = false;    ///< by half a turn: it grows towards -x and its rooms lie towards -y
};

class Floor {
public:
  explicit Floor(const OfficeOptions& options) : options_(options), random_(options.seed, 91, 0) {}
  Json describe();

private:
  void addStorey();
  Json addStairwell();
  std::vector<OfficeRoom> drawRow(int rooms);
  void build(const Row& row, const std::vector<OfficeRoom>& rooms);
  void addRoom(const OfficeRoom& room);
  void addFront(const OfficeRoom& room);
  void furnish(const OfficeRoom& room);
  void addDesks(const OfficeRoom& room, CounterRandom& random);
  void addMeeting(const OfficeRoom& room, CounterRandom& random);
  void addLounge(const OfficeRoom& room, CounterRandom& random);
  void addStorage(const OfficeRoom& room, CounterRandom& random);
  void addSides(const OfficeRoom& room, CounterRandom& random);
  void addBesideDoor(const OfficeRoom& room);
  void addCorridor(float x0, float y0, float x1, float y1);
  void box(const std::array<float, 3>& from, const std::array<float, 3>& to, const Json& how);
  void thing(const char* name, const std::array<float, 3>& at, float turn, Json how = Json::object());
  float worldX(float x) const { return row_.x + (row_.turned ? -x : x); }
  float worldY(float y) const { return row_.y + (row_.turned ? -y : y); }

  const OfficeOptions& options_;
  CounterRandom random_;
  float base_ = 0.f;                 ///< height of the floor of the storey that is being built
  float across_ = 0.f, begin_ = 0.f; ///< width of the corridors, x where the first one begins
  Json shell_ = Json::array(), things_ = Json::array();
  Row row_; ///< of the room that is being built, its origin
};

void Floor::box(const std::array<float, 3>& a, const std::array<float, 3>& b, const Json& how)
{
  const auto [x0, x1] = std::minmax({worldX(a[0]), worldX(b[0])});
  const auto [y0, y1] = std::minmax({worldY(a[1]), worldY(b[1])});
  Json described = how;
  described["from"] = {x0, y0, base_ + a[2]};
  described["to"] = {x1, y1, base_ + b[2]};
  shell_.push_back(described);
}

void Floor::thing(const char* name, const std::array<float, 3>& at, float turn, Json how)
{
  how["thing"] = name;
  how["at"] = {worldX(at[0]), worldY(at[1]), base_ + at[2]};
  how["turn"] = turn + (row_.turned ? 180.f : 0.f);
  things_.push_back(how);
}

/// The next room is often equal to the one before it.
std::vector<OfficeRoom> Floor::drawRow(int rooms)
{
  constexpr double equal_share = 0.25, open_share = 0.65, closed_share = 0.15;
  std::vector<OfficeRoom> row;
  for (int k = 0; k < rooms; ++k) {
    if (k > 0 && random_.uniform() < equal_share) {
      row.push_back(row.back());
      continue;
    }
    OfficeRoom room;
    room.width = random_.uniformFloat(2.9, 6.2);
    room.depth = random_.uniformFloat(3.6, 5.6);
    room.door = random_.uniformFloat(0.25, room.width - door_width - 0.25);
    const double front = random_.uniform();
    room.front = front < open_share ? Front::open : front < open_share + closed_share ? Front::closed : Front::glass;
    room.seed = random_.integer(1 << 30);
    row.push_back(room);
  }
  return row;
}

void Floor::addFront(const OfficeRoom& room)
{
  const float left = room.door, right = room.door + door_width;
  const Json free = {{"free", true}, {"of", "frame"}}, leaf = {{"of", "oak"}};
  if (room.front == Front::closed) { // a recess on both sides of the leaf
    box({left, -0.03f, 0}, {right, 0, door_height}, free);
    box({left, -wall, 0}, {right, -wall + 0.03f, door_height}, free);
    return;
  }
  box({left, -wall, 0}, {right, 0, door_height}, free);
  if (room.seed % 3 > 0 && right + 0.05f < room.width) // the leaf, opened by a right angle
    box({right, 0, 0.01f}, {right + 0.04f, door_width - 0.05f, door_height - 0.02f}, leaf);
  if (room.front != Front::glass)
    return;
  for (const auto& [a, b] : {std::pair(0.15f, left - 0.15f), std::pair(right + 0.15f, room.width - 0.15f)})
    if (b - a > 0.3f) {
      box({a, -wall, 0.1f}, {b, 0, 2.4f}, free);
      box({a, -0.07f, 0.1f}, {b, -0.05f, 2.4f}, {{"of", "clear_glass"}});
    }
}

void Floor::addDesks(const OfficeRoom& room, CounterRandom& random)
{
  constexpr float pitch = 1.75f;
  const int count = std::max(1, static_cast<int>((room.width - 0.5f) / pitch));
  const float wide = room.width / count;
  for (int k = 0; k < count; ++k) {
    if (count > 1 && random.uniform() < 0.2)
      continue;
    const float x = wide * (k + 0.5f) + random.uniformFloat(-0.1, 0.1), y = room.depth - random.uniformFloat(0.45, 0.7);
    const std::uint64_t seed = room.seed + k;
    thing("desk", {x, y, 0}, 180);
    thing("monitor", {x + random.uniformFloat(-0.3, 0.3), y + 0.16f, 0.74f}, random.uniformFloat(165, 195),
          {{"seed", seed % 1000}});
    thing("keyboard", {x, y - 0.16f, 0.74f}, 180, {{"seed", 3}});
    thing("chair", {x + random.uniformFloat(-0.3, 0.3), y - random.uniformFloat(0.65, 1.0), 0},
          random.uniformFloat(-60, 60), {{"fabric", k % 2 ? "fabric_blue" : "fabric_grey"}});
    if (random.uniform() < 0.5)
      thing("bin", {x + 0.8f, y - 0.1f, 0}, 0);
  }
}

void Floor::addMeeting(const OfficeRoom& room, CounterRandom& random)
{
  const float x = 0.5f * room.width, y = 0.55f * room.depth;
  thing("conference_table", {x, y, 0}, 0);
  for (int k = 0; k < 6; ++k)
    if (random.uniform() < 0.8)
      thing("chair", {x - 1.5f + 1.5f * (k / 2) + random.uniformFloat(-0.15, 0.15), y + (k % 2 ? 1.f : -1.f), 0},
            (k % 2 ? 180.f : 0.f) + random.uniformFloat(-15, 15), {{"fabric", "fabric_red"}});
  thing("whiteboard", {0, y, 1.5f}, -90, {{"seed", 11}});
  thing("flip_chart", {room.width - 0.6f, room.depth - 0.6f, 0}, random.uniformFloat(110, 160), {{"seed", 12}});
}

void Floor::addLounge(const OfficeRoom& room, CounterRandom& random)
{
  const float y = random.uniformFloat(0.5, 0.7) * room.depth;
  thing("sofa", {0.5f, y, 0}, -90);
  thing("coffee_table", {1.5f, y, 0}, random.uniformFloat(0, 90));
  thing("wooden_chair", {2.2f, y + random.uniformFloat(-0.6, 0.6), 0}, random.uniformFloat(60, 120));
  thing("floor_lamp", {0.4f, room.depth - 0.4f, 0}, 0);
  thing("sideboard", {0.55f * room.width, room.depth - 0.016f, 0}, 180, {{"size", {1.35f, 0.42f, 0.78f}}});
}

void Floor::addStorage(const OfficeRoom& room, CounterRandom& random)
{
  for (float x = 0.7f; x + 0.6f < room.width; x += 1.25f)
    thing("sideboard", {x, room.depth - 0.016f, 0}, 180,
          {{"size", {1.2f, 0.45f, random.uniform() < 0.5 ? 1.9f : 1.2f}}});
  for (int k = 0; k < 5; ++k)
    thing("cartons", {random.uniformFloat(0.5, room.width - 0.5), random.uniformFloat(1.6, room.depth - 0.9), 0},
          random.uniformFloat(0, 180), {{"seed", 90 + k}});
}

/// What stands at the two side walls.
void Floor::addSides(const OfficeRoom& room, CounterRandom& random)
{
  const auto along = [&] { return random.uniformFloat(1.7, room.depth - 1.0); };
  const int seed = random.integer(1000);
  if (random.uniform() < 0.6)
    thing("book_shelf", {room.width - 0.016f, along(), 0}, 90,
          {{"seed", seed}, {"size", {random.uniformFloat(0.8, 1.4), random.uniform() < 0.5 ? 2.f : 1.25f}}});
  if (random.uniform() < 0.5)
    thing("framed_picture", {0, along(), 1.6f}, -90,
          {{"frame", "black"}, {"picture", "poster"}, {"pixels", {240, 330}}, {"seed", seed}});
  if (random.uniform() < 0.5)
    thing("plant", {room.width - 0.45f, room.depth - 0.45f, 0}, 0,
          {{"seed", seed}, {"height", random.uniformFloat(0.6, 1.3)}});
  if (random.uniform() < 0.4)
    thing("coat_stand", {0.35f, room.depth - 0.35f, 0}, 0);
  if (random.uniform() < 0.6)
    thing("radiator", {0.5f * room.width, room.depth, 0}, 180, {{"width", 1.2f}});
}

void Floor::furnish(const OfficeRoom& room)
{
  CounterRandom random(room.seed, 92, 0);
  const double kind = random.uniform();
  if (kind < 0.25 && room.width > 4.8f && room.depth > 3.9f)
    addMeeting(room, random);
  else if (kind < 0.35)
    addLounge(room, random);
  else if (kind < 0.45)
    addStorage(room, random);
  else
    addDesks(room, random);
  addSides(room, random);
  thing("ceiling_lamp", {0.5f * room.width, 0.5f * room.depth, 0}, 0);
}

void Floor::addRoom(const OfficeRoom& room)
{
  static const char* const paints[] = {"wall", "wall_accent", "wall_soft", "wall_rose"};
  const char* paint = paints[room.seed % 4];
  const Json free = {{"free", true}, {"sides", {paint, paint, paint, paint, "carpet", "ceiling_plain"}}};
  box({0, 0, 0}, {room.width, room.depth, height}, free);
  const float left = 0.2f * room.width, right = 0.8f * room.width;
  if (room.seed % 5 > 0) // a window: a recess with a pane that sends little back
    box({left, room.depth, 0.95f}, {right, room.depth + 0.15f, 2.25f}, {{"free", true}, {"of", "window_pane"}});
  addFront(room);
  furnish(room);
}

void Floor::build(const Row& row, const std::vector<OfficeRoom>& rooms)
{
  row_ = row;
  for (const OfficeRoom& room : rooms) {
    addRoom(room);
    addBesideDoor(room);
    row_.x = worldX(room.width + wall);
  }
}

void Floor::addCorridor(float x0, float y0, float x1, float y1)
{
  row_ = {};
  box({x0, y0, 0}, {x1, y1, height},
      {{"free", true}, {"sides", {"wall", "wall", "wall", "wall", "parquet", "ceiling_plain"}}});
  const bool along = x1 - x0 > y1 - y0;
  for (float at = 1.5f; at < (along ? x1 - x0 : y1 - y0); at += random_.uniformFloat(3, 5)) {
    const float x = along ? x0 + at : 0.5f * (x0 + x1), y = along ? 0.5f * (y0 + y1) : y0 + at;
    thing("ceiling_lamp", {x, y, 0}, 0);
  }
}

/// What stands in the corridor beside the door.
void Floor::addBesideDoor(const OfficeRoom& room)
{
  const float right = room.door + door_width, free = room.width - right;
  const float x = room.door > free ? 0.5f * room.door : right + 0.5f * free, y = -wall;
  const double what = random_.uniform();
  const int seed = random_.integer(1000);
  if (what < 0.12)
    thing("sideboard", {x, y, 0}, 180, {{"size", {0.8f, 0.35f, random_.uniformFloat(0.7, 1.9)}}});
  else if (what < 0.24)
    thing("plant", {x, y - 0.3f, 0}, 0, {{"seed", seed}, {"height", random_.uniformFloat(0.7, 1.3)}});
  else if (what < 0.36)
    thing("cartons", {x, y - 0.3f, 0}, random_.uniformFloat(170, 190), {{"seed", seed}});
  else if (what < 0.48)
    thing("wooden_chair", {x, y - 0.4f, 0}, random_.uniformFloat(160, 200));
}

float greatestDepth(const std::vector<OfficeRoom>& row)
{
  float depth = 0.f;
  for (const OfficeRoom& room : row)
    depth = std::max(depth, room.depth);
  return depth;
}

float lengthOf(const std::vector<OfficeRoom>& row)
{
  float length = 0.f;
  for (const OfficeRoom& room : row)
    length += room.width + wall;
  return length;
}

void Floor::addStorey()
{
  constexpr int most_around_one = 10; // rooms around one corridor
  const int rooms = options_.rooms;
  const int corridors = rooms <= most_around_one ? 1 : 2, rows = 2 * corridors;
  const float drawn_across = random_.uniformFloat(1.6, 2.3), across = across_ > 0.f ? across_ : drawn_across;
  across_ = across;
  std::vector<std::vector<OfficeRoom>> drawn; // above and below the first corridor, above and below the second
  float length = 0.f;
  for (int r = 0; r < rows; ++r) {
    drawn.push_back(drawRow(rooms / rows + (r < rooms % rows ? 1 : 0)));
    length = std::max(length, lengthOf(drawn.back()));
  }
  const float between = corridors == 2 ? greatestDepth(drawn[0]) + greatestDepth(drawn[3]) + 3 * wall : 0.f;
  for (int c = 0; c < corridors; ++c) {
    const float y = c * (across + between), beyond = corridors == 2 ? across : 0.f;
    const float stairs = options_.storeys > 1 && c == 0 ? wall : 0.f; // no room beside the stairwell
    const float begin = (beyond > 0.f ? -across - wall : 0.f) - stairs;
    addCorridor(begin, y, length + beyond, y + across);
    begin_ = c == 0 ? begin : begin_;
    build({0.f, y + across + wall, false}, drawn[2 * c]);
    build({length - wall, y - wall, true}, drawn[2 * c + 1]);
  }
  if (corridors == 2)
    for (const float x : {-across - wall, length})
      addCorridor(x, across, x + across, across + between);
}

/// A shaft through both storeys, open to their corridors; the slab ends where the stairs arrive. @return stations
Json Floor::addStairwell()
{
  constexpr float arrival = 1.3f; // metres of floor before the stairs, on both storeys
  const Stairs stairs;
  const float middle = 0.5f * across_, foot = begin_ - arrival, x0 = foot - stairs.length();
  const float y0 = middle - stairs.half_width, y1 = middle + stairs.half_width;
  const Json free = {{"free", true},
                     {"sides", {"wall_soft", "wall_soft", "wall_soft", "wall_soft", "parquet", "ceiling_plain"}}};
  row_ = {};
  base_ = 0.f;
  box({x0, y0, 0}, {begin_, y1, height}, free);
  box({x0, y0, storey_height}, {begin_, y1, storey_height + height}, free);
  box({x0, y0, height}, {foot, y1, storey_height}, free);
  thing("stairs", {foot, middle, 0}, 0, {{"height", storey_height}});
  thing("ceiling_lamp", {foot + 0.5f * arrival, middle, 0}, 0);
  thing("ceiling_lamp", {0.5f * (x0 + foot), middle, storey_height}, 0);
  const auto station = [&](float x, float floor) -> Json {
    const float aside = random_.uniformFloat(-0.3, 0.3);
    return {x + random_.uniformFloat(-0.1, 0.1), middle + aside, floor + random_.uniformFloat(1.2, 1.6)};
  };
  const Json at_foot = station(foot + 0.5f * arrival, 0.f),
             on_landing = station(x0 + 0.5f * stairs.landing, 0.5f * storey_height);
  return {at_foot, on_landing};
}

Json Floor::describe()
{
  Json office = {{"object", "rooms"}};
  for (int storey = 0; storey < options_.storeys; ++storey) {
    random_ = CounterRandom(options_.seed, 91, storey);
    base_ = storey * storey_height;
    office["floors"].push_back(base_);
    addStorey();
  }
  if (options_.storeys > 1)
    office["stations"] = addStairwell();
  office["shell"] = shell_;
  office["things"] = things_;
  return office;
}
} // namespace

Json officeFloor(const OfficeOptions& options)
{
  require(options.rooms >= 4 && options.rooms <= 32, "office: ", options.rooms, " rooms are not in 4..32");
  require(options.storeys >= 1 && options.storeys <= 2, "office: ", options.storeys, " storeys are not in 1..2");
  return Floor(options).describe();
}
} // namespace fresco::simulation
