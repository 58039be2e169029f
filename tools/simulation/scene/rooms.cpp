// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/rooms.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
constexpr float skirting_height = 0.08f, skirting_depth = 0.015f;

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
} // namespace

void addSkirting(Shell& shell, const Plan& room, const std::vector<Plan>& gaps, int material)
{
  for (const bool upper : {false, true}) {
    std::vector<Vector2f> x_cuts, y_cuts;
    const float x = upper ? room.max.x() : room.min.x(), y = upper ? room.max.y() : room.min.y();
    for (const Plan& gap : gaps) {
      if (within(x, gap.min.x(), gap.max.x()))
        y_cuts.push_back({gap.min.y(), gap.max.y()});
      if (within(y, gap.min.y(), gap.max.y()))
        x_cuts.push_back({gap.min.x(), gap.max.x()});
    }
    const float inward = upper ? -skirting_depth : skirting_depth;
    for (const Vector2f& part : remaining(room.min.x(), room.max.x(), x_cuts))
      shell.solid({part.x(), std::min(y, y + inward), 0}, {part.y(), std::max(y, y + inward), skirting_height},
                  material);
    for (const Vector2f& part : remaining(room.min.y(), room.max.y(), y_cuts))
      shell.solid({std::min(x, x + inward), part.x(), 0}, {std::max(x, x + inward), part.y(), skirting_height},
                  material);
  }
}

void addWindow(SceneBuilder& b, const Palette& p, Shell& shell, const WindowSpec& spec)
{
  const auto y = [&](float depth) { return spec.wall + spec.sign * depth; };
  const auto box = [&](const Vector3f& from, const Vector3f& to, int material) { // y as depth into the wall
    shell.solid({from.x(), std::min(y(from.y()), y(to.y())), from.z()},
                {to.x(), std::max(y(from.y()), y(to.y())), to.z()}, material);
  };
  const float depth = 0.2f, bar = 0.06f, middle = 0.5f * (spec.left + spec.right);
  const PictureBox pane{{spec.left, std::min(y(0), y(depth)), spec.low},
                        {spec.right, std::max(y(0), y(depth)), spec.high},
                        spec.sign > 0 ? 2 : 3,
                        drawView({1000, 640}, spec.seed),
                        p.wall,
                        1.f,
                        true};
  BoxMaterials sides = pictureSides(b, pane); // drawn on the far side of the recess, seen from the room
  std::swap(sides[2], sides[3]);
  shell.free(pane.min, pane.max, sides);
  const float near = depth - 0.05f;
  box({spec.left, near, spec.low}, {spec.left + bar, depth, spec.high}, p.frame);
  box({spec.right - bar, near, spec.low}, {spec.right, depth, spec.high}, p.frame);
  box({middle - bar, near, spec.low}, {middle + bar, depth, spec.high}, p.frame);
  box({spec.left, near, spec.low}, {spec.right, depth, spec.low + bar}, p.frame);
  box({spec.left, near, spec.high - bar}, {spec.right, depth, spec.high}, p.frame);
  box({spec.left - 0.05f, -0.1f, spec.low - 0.03f}, {spec.right + 0.05f, 0.f, spec.low}, p.white_lacquer);
  const float half_x = 0.5f * (spec.right - spec.left) - bar, half_z = 0.5f * (spec.high - spec.low) - bar;
  const Vector3f center(middle, y(near - 0.01f), 0.5f * (spec.low + spec.high));
  b.lamp({center, {half_x, 0, 0}, {0, 0, spec.sign * half_z}, Vector3f(2.6f, 3.0f, 3.5f)});
}

void addDoor(SceneBuilder& b, const Palette& p, Shell& shell, const DoorSpec& spec)
{
  const auto x = [&](float depth) { return spec.wall + spec.sign * depth; };
  const float depth = 0.07f, high = 2.06f;
  PictureBox leaf{{std::min(x(0), x(depth)), spec.low, 0},
                  {std::max(x(0), x(depth)), spec.high, high},
                  spec.sign > 0 ? 0 : 1,
                  drawDoor({900, 1900}, spec.seed),
                  p.frame};
  BoxMaterials sides = pictureSides(b, leaf);
  std::swap(sides[0], sides[1]);
  sides[4] = p.parquet;
  shell.free(leaf.min, leaf.max, sides);
  const auto casing = [&](float y0, float y1, const Vector2f& z) {
    shell.solid({std::min(x(0), x(-0.02f)), y0, z.x()}, {std::max(x(0), x(-0.02f)), y1, z.y()}, p.frame);
  };
  casing(spec.low - 0.07f, spec.low, {0, high + 0.07f});
  casing(spec.high, spec.high + 0.07f, {0, high + 0.07f});
  casing(spec.low - 0.07f, spec.high + 0.07f, {high, high + 0.07f});
}

void addHandle(SceneBuilder& b, const Palette& p, const DoorSpec& spec)
{
  b.beginObject("door handle");
  const float leaf = spec.wall + spec.sign * 0.07f, out = -spec.sign, y = spec.high - 0.08f, z = 1.05f;
  b.box({std::min(leaf, leaf + out * 0.006f), y - 0.02f, z - 0.15f},
        {std::max(leaf, leaf + out * 0.006f), y + 0.02f, z + 0.06f}, p.chrome);
  b.tube({{leaf + out * 0.003f, y, z},
          {leaf + out * 0.05f, y, z},
          {leaf + out * 0.055f, y - 0.02f, z},
          {leaf + out * 0.055f, y - 0.13f, z}},
         0.009f, p.chrome);
}

void addCeilingPanel(SceneBuilder& b, const Palette& p, Shell& shell, const Plan& plan, float ceiling)
{
  BoxMaterials sides = allSides(p.frame);
  sides[5] = p.lamp;
  shell.free({plan.min.x(), plan.min.y(), ceiling}, {plan.max.x(), plan.max.y(), ceiling + 0.03f}, sides);
  const Vector2f middle = 0.5f * (plan.min + plan.max), half = 0.48f * (plan.max - plan.min);
  b.lamp({{middle.x(), middle.y(), ceiling + 0.004f}, {0, half.y(), 0}, {half.x(), 0, 0}, Vector3f(6.5f, 6.2f, 5.6f)});
}

Scene makeScene(const std::string& name, float max_edge)
{
  require(max_edge >= 0.02f && max_edge <= 10.f, "scene: edge ", max_edge, " m is not in 0.02..10");
  require(name == "conference_room" || name == "apartment", "scene: unknown name ", name);
  return name == "apartment" ? makeApartment(max_edge) : makeConferenceRoom(max_edge);
}
} // namespace fresco::simulation
