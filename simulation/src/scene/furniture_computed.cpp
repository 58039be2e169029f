// SPDX-License-Identifier: BSD-3-Clause
#include "scene/furniture.h"
#include <cmath>
#include <fresco/simulation/sensors/random.h>
#include <map>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
using Pair = std::array<float, 2>;

constexpr float gap = 0.003f; // metres between a wall and what hangs on it

Box hole(const Vector3f& min, const Vector3f& max, int material) { return {min, max, allSides(material), false}; }

std::uint64_t seedOf(const Json& placed) { return placed.value("seed", 1u); }

Material picture(const char* name, const std::array<int, 2>& pixels, std::uint64_t seed)
{
  return printed({{"picture", name}, {"pixels", pixels}}, seed);
}

/// "count" sheets and a pen.
void papers(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  CounterRandom random(seedOf(placed), 31, 0);
  const int count = placed.at("count");
  for (int k = 0; k < count; ++k) {
    const float degrees = placed.at("turn").get<float>() + random.uniformFloat(-14, 14);
    const float y = random.uniformFloat(-0.05, 0.05), x = random.uniformFloat(-0.05, 0.05);
    b.beginObject("papers", standing(vectorOf(placed.at("at")) + Vector3f(x, y, 0.004f * k), degrees));
    const Box sheet = solid({-0.105f, -0.1485f, 0}, {0.105f, 0.1485f, 0.0035f}, f.material("paper"));
    b.boxes({withPicture(b, sheet, 5, picture("sheet", {530, 750}, seedOf(placed) + k))});
  }
  b.place(poseOf({{"at", {0.04f, 0.02f, 0.004f * count + 0.0045f}}, {"lean", 35.f}, {"about", {0, 0, 1}}}));
  b.tube({{-0.07f, 0, 0}, {0.07f, 0, 0}}, 0.0045f, f.material("fabric_red"));
}

/// "height" of pot and leaves.
void plant(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  b.beginObject("plant", poseOf(placed));
  const float height = placed.at("height"), pot = 0.3f * height;
  const float rim = 0.85f * pot, earth = 0.9f * pot;
  b.lathe({{0, 0},
           {0.36f * pot, 0},
           {0.5f * pot, rim},
           {0.56f * pot, rim},
           {0.56f * pot, pot},
           {0.5f * pot, pot},
           {0.46f * pot, earth},
           {0, earth}},
          f.material("terracotta"), 36);
  b.lathe({{0, 0.88f * pot}, {0.465f * pot, 0.88f * pot}, {0.43f * pot, 0.93f * pot}, {0, 0.95f * pot}},
          f.material("soil"), 36);
  CounterRandom random(seedOf(placed), 32, 0);
  const int leaves = 22;
  for (int k = 0; k < leaves; ++k) {
    const float a = 2.3999632f * k, reach = height * random.uniformFloat(0.25, 0.42);
    const float rise = height * (0.25f + 0.42f * k / leaves), wide = 0.045f * height * random.uniformFloat(0.8, 1.3);
    const Vector3f out(std::cos(a), std::sin(a), 0), across(-std::sin(a), std::cos(a), 0);
    std::vector<SweepKnot> knots;
    for (int i = 0; i <= 10; ++i) {
      const float t = i / 10.f;
      const float blade = t < 0.4f ? 0.f : std::sin(3.14159f * std::pow((t - 0.4f) / 0.6f, 0.8f));
      const Vector3f at = Vector3f(0, 0, earth) + out * (0.06f * pot + reach * t * t) +
                          Vector3f::UnitZ() * rise * (1.7f * t - t * t * 0.75f);
      knots.push_back({at, 0.004f + wide * blade, 0.003f});
    }
    b.sweep(knots, across, f.material("leaf"));
  }
}

void coatStand(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  b.beginObject("coat stand", poseOf(placed));
  const int wood = f.material("walnut");
  b.tube({{0, 0, 0.09f}, {0, 0, 1.78f}}, 0.018f, wood);
  for (int k = 0; k < 4; ++k) {
    const float a = 1.5707963f * k + 0.3f, c = std::cos(a), s = std::sin(a);
    b.tube({{0.01f * c, 0.01f * s, 0.2f}, {0.12f * c, 0.12f * s, 0.1f}, {0.26f * c, 0.26f * s, 0.f}}, 0.013f, wood);
    b.tube({{0.01f * c, 0.01f * s, 1.6f}, {0.1f * c, 0.1f * s, 1.62f}, {0.17f * c, 0.17f * s, 1.72f}}, 0.009f, wood);
  }
  std::vector<SweepKnot> coat; // a jacket on a hook
  for (int i = 0; i <= 9; ++i) {
    const float t = i / 9.f;
    coat.push_back({{0.15f + 0.03f * std::sin(5.f * t), 0.05f, 1.66f - 0.85f * t},
                    0.05f + 0.13f * std::pow(std::sin(1.4f * t + 0.25f), 0.7f),
                    0.035f + 0.03f * t});
  }
  b.sweep(coat, Vector3f::UnitY(), f.material("fabric_blue"));
}

/// "picture" with "pixels", 60 cm high, in a "frame".
void framedPicture(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  const Material shown = printed(placed, 0);
  const float half_z = 0.3f, half_x = half_z * shown.picture->width() / shown.picture->height(), bar = 0.025f;
  b.beginObject("picture", poseOf(placed));
  const Box sheet = solid({-half_x, gap, -half_z}, {half_x, 0.012f, half_z}, f.material("black"));
  const int frame = f.material("frame", placed);
  b.boxes({solid({-half_x - bar, gap, -half_z - bar}, {half_x + bar, 0.028f, half_z + bar}, frame),
           hole({-half_x, 0.012f, -half_z}, {half_x, 0.028f, half_z}, frame), withPicture(b, sheet, 3, shown)});
}

void wallClock(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  b.beginObject("clock", poseOf(placed));
  b.place(Eigen::Isometry3f(Eigen::AngleAxisf(-1.5707963f, Vector3f::UnitX())));
  b.lathe({{0, gap}, {0.15f, gap}, {0.165f, 0.01f}, {0.165f, 0.04f}, {0.15f, 0.045f}, {0.148f, 0.03f}, {0, 0.03f}},
          f.material("black"), 48);
  Material face = picture("clock", {512, 512}, seedOf(placed));
  face.corner = {0.15f, 0.03f, 0.15f};
  face.right = {-0.3f, 0, 0};
  face.down = {0, 0, -0.3f};
  b.lathe({{0, 0.029f}, {0.148f, 0.029f}, {0.148f, 0.032f}, {0, 0.032f}}, b.add(face), 48);
}

/// "width" over all ribs.
void radiator(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  b.beginObject("radiator", poseOf(placed));
  const float width = placed.at("width"), half = width / 2;
  const int ribs = std::lround(width / 0.06f), paint = f.material("frame");
  std::vector<Box> boxes = {solid({-half, 0.045f, 0.14f}, {half, 0.075f, 0.18f}, paint),
                            solid({-half, 0.045f, 0.66f}, {half, 0.075f, 0.7f}, paint)};
  for (int k = 0; k < ribs; ++k) {
    const float x = -half + (k + 0.1f) * width / ribs;
    boxes.push_back(solid({x, 0.03f, 0.12f}, {x + 0.046f, 0.09f, 0.72f}, paint));
  }
  b.boxes(boxes);
  for (const float z : {0.16f, 0.68f})
    b.tube({{half, 0.06f, z}, {half + 0.05f, 0.06f, z}, {half + 0.05f, 0.06f, 0.f}}, 0.009f, f.material("chrome"));
}

/// Two flights with a landing between them, up to "height": the first climbs along -x at +y, the second comes back. The
/// origin lies before the middle of the foot; a board keeps people from falling at the head. See Stairs.
void stairs(Furniture& f, const Json& placed)
{
  const Stairs s;
  constexpr float apart = 0.05f, thick = 0.2f, board = 1.f; // half of the way between the flights; of slabs; metres
  const float rise = float(placed.at("height")) / (2 * s.risers), end = -s.tread * (s.risers - 1),
              top = 2 * s.risers * rise;
  BoxMaterials paint = allSides(f.material("wall"));
  paint[5] = f.material("oak");
  std::vector<Box> boxes = {
      {{end - s.landing, -s.half_width, s.risers * rise - thick}, {end, s.half_width, s.risers * rise}, paint}};
  for (int k = 0; k + 1 < s.risers; ++k) {
    const float below = -k * s.tread, above = end + k * s.tread, up = (s.risers + k + 1) * rise;
    boxes.push_back({{below - s.tread, apart, 0}, {below, s.half_width, (k + 1) * rise}, paint});
    boxes.push_back({{above, -s.half_width, up - rise - thick}, {above + s.tread, -apart, up}, paint});
  }
  f.builder().beginObject("stairs", poseOf(placed));
  f.builder().boxes(boxes);
  f.builder().beginObject("stair board", poseOf(placed));
  f.builder().boxes({solid({0, apart, top}, {0.04f, s.half_width, top + board}, f.material("oak"))});
}

/// Along the Catmull-Rom spline through "line" [[x, y] ...] on the floor.
void cable(Furniture& f, const Json& placed)
{
  f.builder().beginObject("cable");
  std::vector<Vector2f> line;
  for (const auto& [x, y] : placed.at("line").get<std::vector<Pair>>())
    line.emplace_back(x, y);
  std::vector<SweepKnot> knots;
  const auto knot = [&](const Vector2f& q) { knots.push_back({{q.x(), q.y(), 0.0055f}, 0.005f, 0.005f}); };
  const auto at = [&](std::size_t k) { return line[std::min(k, line.size() - 1)]; };
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
    for (int i = 0; i < 6; ++i) {
      const float t = i / 6.f;
      const Vector2f a = at(k == 0 ? 0 : k - 1), c = at(k), d = at(k + 1), e = at(k + 2);
      knot(0.5f * (2 * c + t * (d - a) + t * t * (2 * a - 5 * c + 4 * d - e) + t * t * t * (3 * c - a - 3 * d + e)));
    }
  knot(line.back());
  f.builder().sweep(knots, Vector3f::UnitZ(), f.material("rubber"));
}

/// "size" [width, height]; full of books.
void bookShelf(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  b.beginObject("shelf", poseOf(placed));
  const auto [wide, top] = placed.at("size").get<Pair>();
  const float half = wide / 2, depth = 0.28f, board = 0.02f;
  const int floors = std::lround(top / 0.36f), oak = f.material("oak");
  const float step = (top - board) / floors;
  std::vector<Box> boxes = {solid({-half, 0, 0}, {half, 0.012f, top}, oak),
                            solid({-half, 0, 0}, {-half + board, depth, top}, oak),
                            solid({half - board, 0, 0}, {half, depth, top}, oak)};
  for (int k = 0; k <= floors; ++k)
    boxes.push_back(solid({-half, 0, step * k}, {half, depth, step * k + board}, oak));
  b.boxes(boxes);
  CounterRandom random(seedOf(placed), 22, 0);
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
      const Box book = solid({x, 0.03f, z}, {x + thick, 0.03f + deep, z + high}, f.material("paper"));
      const std::array<int, 2> pixels = {static_cast<int>(thick * 1400), static_cast<int>(high * 1400)};
      b.beginObject("book", poseOf(placed));
      b.boxes({withPicture(b, book, 3, picture("spine", pixels, random.integer(1 << 30)))});
      x += thick + 0.0015f;
    }
  }
}

/// "size" [width, depth, height].
void sideboard(Furniture& f, const Json& placed)
{
  SceneBuilder& b = f.builder();
  b.beginObject("sideboard", poseOf(placed));
  const Vector3f size = vectorOf(placed.at("size"));
  const float half = size.x() / 2;
  std::vector<Box> boxes = {
      solid({-half + 0.03f, 0.02f, 0}, {half - 0.03f, size.y() - 0.04f, 0.07f}, f.material("black")),
      solid({-half, 0, 0.07f}, {half, size.y() - 0.02f, size.z()}, f.material("walnut"))};
  const int doors = std::lround(size.x() / 0.45f);
  const float wide = size.x() / doors;
  for (int k = 0; k < doors; ++k) {
    const float x = -half + wide * k;
    boxes.push_back(solid({x + 0.004f, size.y() - 0.02f, 0.09f}, {x + wide - 0.004f, size.y(), size.z() - 0.02f},
                          f.material(k % 2 ? "walnut" : "white_lacquer")));
    boxes.push_back(solid({x + wide - 0.05f, size.y(), size.z() - 0.22f},
                          {x + wide - 0.04f, size.y() + 0.022f, size.z() - 0.08f}, f.material("chrome")));
  }
  b.boxes(boxes);
}

/// Wavy, down to the floor, from "x" [left, right] at "y".
void curtain(Furniture& f, const Json& placed)
{
  f.builder().beginObject("curtain");
  constexpr int folds = 9;
  const auto [left, right] = placed.at("x").get<Pair>();
  const float y = placed.at("y");
  for (int strip = 0; strip < folds; ++strip) {
    std::vector<SweepKnot> knots;
    for (int i = 0; i <= 12; ++i) {
      const float t = i / 12.f;
      const float at = left + (right - left) * (strip + 0.5f) / folds + 0.012f * std::sin(5.f * t + strip);
      knots.push_back(
          {{at, y + 0.02f * std::sin(strip * 2.1f), 0.02f + 2.38f * t}, 0.62f * (right - left) / folds, 0.035f});
    }
    f.builder().sweep(knots, Vector3f::UnitX(), f.material("linen"));
  }
}

/// Of a door, see addDoor().
void handle(Furniture& f, const Json& placed)
{
  f.builder().beginObject("door handle");
  const float leaf = placed.at("x").get<float>() - 0.07f, y = placed.at("door").at(1).get<float>() - 0.08f, z = 1.05f;
  f.builder().boxes({solid({leaf, y - 0.02f, z - 0.15f}, {leaf + 0.006f, y + 0.02f, z + 0.06f}, f.material("chrome"))});
  f.builder().tube(
      {{leaf + 0.003f, y, z}, {leaf + 0.05f, y, z}, {leaf + 0.055f, y - 0.02f, z}, {leaf + 0.055f, y - 0.13f, z}},
      0.009f, f.material("chrome"));
}
} // namespace

bool addComputed(Furniture& furniture, const Json& placed)
{
  using Make = void (*)(Furniture&, const Json&);
  static const std::map<std::string, Make> known = {
      {"book_shelf", bookShelf}, {"cable", cable},         {"clock", wallClock},
      {"coat_stand", coatStand}, {"curtain", curtain},     {"framed_picture", framedPicture},
      {"handle", handle},        {"papers", papers},       {"plant", plant},
      {"radiator", radiator},    {"sideboard", sideboard}, {"stairs", stairs}};
  const auto found = known.find(placed.at("thing"));
  if (found == known.end())
    return false;
  found->second(furniture, placed);
  return true;
}
} // namespace fresco::simulation
