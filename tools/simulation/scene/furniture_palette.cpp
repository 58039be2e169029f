// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/furniture.h"
namespace fresco::simulation {
using Eigen::Vector3f;

namespace {
int addPattern(SceneBuilder& builder, Finish finish, const Vector3f& color, const Vector3f& accent)
{
  Material material;
  material.finish = finish;
  material.color = color;
  material.accent = accent;
  material.seed = static_cast<std::uint32_t>(100.f * color.sum()) + 17u * static_cast<std::uint32_t>(finish);
  return builder.add(material);
}

int addLamp(SceneBuilder& builder)
{
  Material material;
  material.color = {0.97f, 0.97f, 0.94f};
  material.contrast = 0.2f;
  material.emission = 1.05f;
  return builder.add(material);
}
} // namespace

int addPaint(SceneBuilder& builder, const Vector3f& color, Finish finish)
{
  return addPattern(builder, finish, color, 0.7f * color);
}

Palette::Palette(SceneBuilder& b)
{
  wall = addPaint(b, {0.87f, 0.86f, 0.82f}, Finish::plaster);
  wall_accent = addPaint(b, {0.55f, 0.66f, 0.68f}, Finish::plaster);
  ceiling = addPattern(b, Finish::ceiling_tile, {0.86f, 0.86f, 0.84f}, {0.78f, 0.78f, 0.78f});
  carpet = addPattern(b, Finish::carpet, {0.34f, 0.37f, 0.42f}, {0.55f, 0.55f, 0.54f});
  parquet = addPattern(b, Finish::planks, {0.46f, 0.32f, 0.2f}, {0.72f, 0.55f, 0.38f});
  skirting = addPaint(b, {0.78f, 0.77f, 0.74f});
  frame = addPaint(b, {0.88f, 0.88f, 0.87f});
  door = addPattern(b, Finish::wood, {0.6f, 0.44f, 0.3f}, {0.72f, 0.56f, 0.4f});
  oak = addPattern(b, Finish::wood, {0.6f, 0.46f, 0.3f}, {0.78f, 0.64f, 0.46f});
  walnut = addPattern(b, Finish::wood, {0.3f, 0.2f, 0.14f}, {0.5f, 0.36f, 0.25f});
  white_lacquer = addPaint(b, {0.85f, 0.85f, 0.84f});
  black = addPaint(b, {0.13f, 0.13f, 0.14f});
  chrome = addPaint(b, {0.62f, 0.63f, 0.65f}, Finish::metal);
  steel = addPaint(b, {0.45f, 0.46f, 0.48f}, Finish::metal);
  fabric_blue = addPattern(b, Finish::fabric, {0.16f, 0.25f, 0.42f}, {0.32f, 0.44f, 0.62f});
  fabric_grey = addPattern(b, Finish::fabric, {0.38f, 0.38f, 0.4f}, {0.58f, 0.58f, 0.58f});
  fabric_red = addPattern(b, Finish::fabric, {0.5f, 0.16f, 0.14f}, {0.68f, 0.34f, 0.28f});
  linen = addPattern(b, Finish::fabric, {0.74f, 0.72f, 0.66f}, {0.88f, 0.86f, 0.8f});
  white_plastic = addPaint(b, {0.84f, 0.84f, 0.82f});
  grey_plastic = addPaint(b, {0.42f, 0.43f, 0.45f});
  porcelain = addPaint(b, {0.87f, 0.86f, 0.83f});
  cardboard = addPaint(b, {0.66f, 0.52f, 0.36f}, Finish::cardboard);
  terracotta = addPaint(b, {0.7f, 0.4f, 0.28f}, Finish::plaster);
  soil = addPattern(b, Finish::carpet, {0.16f, 0.11f, 0.08f}, {0.36f, 0.27f, 0.2f});
  leaf = addPattern(b, Finish::leaf, {0.1f, 0.3f, 0.1f}, {0.36f, 0.55f, 0.22f});
  rubber = addPaint(b, {0.16f, 0.16f, 0.17f});
  lamp = addLamp(b);
  paper = addPaint(b, {0.9f, 0.9f, 0.87f});
  tiles = addPattern(b, Finish::tiles, {0.8f, 0.83f, 0.82f}, {0.6f, 0.6f, 0.58f});
}

BoxMaterials pictureSides(SceneBuilder& builder, const PictureBox& box)
{
  Material material;
  material.finish = Finish::picture;
  material.picture = box.picture;
  material.emission = box.emission;
  material.glass = box.glass;
  const int axis = box.direction / 2;
  const bool positive = box.direction % 2 == 1;
  const Vector3f size = box.max - box.min;
  // Seen from outside: right is up x outward, except on the top, where the picture's top points to +y.
  const Vector3f outward = (positive ? 1.f : -1.f) * Vector3f(Vector3f::Unit(axis));
  const Vector3f up = axis == 2 ? Vector3f(Vector3f::UnitY()) : Vector3f(Vector3f::UnitZ());
  const Vector3f right = up.cross(outward);
  const Vector3f middle = 0.5f * (box.min + box.max) + 0.5f * size.cwiseProduct(outward);
  const Vector3f wide = right * size.dot(right.cwiseAbs()), high = up * size.dot(up.cwiseAbs());
  material.corner = middle - 0.5f * wide + 0.5f * high;
  material.right = wide;
  material.down = -high;
  BoxMaterials sides = allSides(box.body);
  sides[box.direction] = builder.add(material);
  return sides;
}
} // namespace fresco::simulation
