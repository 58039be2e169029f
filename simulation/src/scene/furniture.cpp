// SPDX-License-Identifier: BSD-3-Clause
#include "scene/furniture.h"
#include "scene/artwork.h"
#include "scene/descriptions.h"
namespace fresco::simulation {
using Eigen::Vector3f;

NLOHMANN_JSON_SERIALIZE_ENUM(Finish, {{Finish::plain, "plain"},
                                      {Finish::plaster, "plaster"},
                                      {Finish::carpet, "carpet"},
                                      {Finish::planks, "planks"},
                                      {Finish::wood, "wood"},
                                      {Finish::fabric, "fabric"},
                                      {Finish::ceiling_tile, "ceiling_tile"},
                                      {Finish::metal, "metal"},
                                      {Finish::cardboard, "cardboard"},
                                      {Finish::leaf, "leaf"}})

namespace {
Material materialOf(const Json& described)
{
  Material material;
  material.finish = described.value("finish", Finish::plain);
  material.color = vectorOf(described.at("color"));
  material.accent = described.contains("accent") ? vectorOf(described["accent"]) : 0.7f * material.color;
  material.contrast = described.value("contrast", material.contrast);
  material.emission = described.value("emission", material.emission);
  material.glass = described.value("glass", false);
  material.clear = described.value("clear", false);
  const auto own = static_cast<std::uint32_t>(100.f * material.color.sum());
  material.seed = described.value("seed", own + 17u * static_cast<std::uint32_t>(material.finish));
  return material;
}

/// "at" and the points of a part that may be mirrored: x times `side`.
Vector3f sided(const Json& point, float side) { return vectorOf(point).cwiseProduct(Vector3f(side, 1.f, 1.f)); }
} // namespace

Vector3f vectorOf(const Json& numbers)
{
  const auto [x, y, z] = numbers.get<std::array<float, 3>>();
  return {x, y, z};
}

Eigen::Isometry3f poseOf(const Json& described)
{
  const Vector3f at = described.contains("at") ? vectorOf(described["at"]) : Vector3f::Zero();
  if (!described.contains("lean"))
    return standing(at, described.value("turn", 0.f));
  const Vector3f axis = described.contains("about") ? vectorOf(described["about"]).normalized() : Vector3f::UnitX();
  return Eigen::Translation3f(at) *
         Eigen::Isometry3f(Eigen::AngleAxisf(described["lean"].get<float>() * 0.01745329f, axis));
}

Material printed(const Json& described, std::uint64_t seed)
{
  Material material;
  material.finish = Finish::picture;
  const PictureSize pixels{described.at("pixels").at(0), described["pixels"].at(1)};
  material.picture = drawPicture(described.at("picture"), pixels, seed + described.value("seed", 0u));
  material.emission = described.value("emission", 0.f);
  return material;
}

Box withPicture(SceneBuilder& builder, Box box, int direction, Material picture)
{
  const int axis = direction / 2;
  const Vector3f size = box.max - box.min;
  // Seen from outside: right is up x outward, except on the top, where the picture's top points to +y.
  const Vector3f outward = (direction % 2 == 1 ? 1.f : -1.f) * Vector3f(Vector3f::Unit(axis));
  const Vector3f up = axis == 2 ? Vector3f(Vector3f::UnitY()) : Vector3f(Vector3f::UnitZ());
  const Vector3f right = up.cross(outward);
  const Vector3f middle = 0.5f * (box.min + box.max) + 0.5f * size.cwiseProduct(outward);
  const Vector3f wide = right * size.dot(right.cwiseAbs()), high = up * size.dot(up.cwiseAbs());
  picture.corner = middle - 0.5f * wide + 0.5f * high;
  picture.right = wide;
  picture.down = -high;
  box.materials[direction] = builder.add(picture);
  return box;
}

Furniture::Furniture(SceneBuilder& builder) : builder_(builder), things_(Json::parse(things_json))
{
  const Json materials = Json::parse(materials_json);
  for (const auto& [name, described] : materials.items())
    materials_[name] = builder.add(materialOf(described));
}

int Furniture::material(const std::string& name, const Json& placed) const
{
  return materials_.at(placed.value(name, name));
}

Box Furniture::box(const Json& described, const Json& placed)
{
  Box box{vectorOf(described.at("from")), vectorOf(described.at("to")), {}, !described.value("free", false)};
  for (std::size_t k = 0; k < 6; ++k)
    box.materials[k] = material(described.contains("sides") ? described["sides"].at(k) : described.at("of"), placed);
  if (described.contains("picture"))
    return withPicture(builder_, box, described.at("side"), printed(described, placed.value("seed", 1u)));
  return box;
}

void Furniture::addPart(const Json& part, const Json& placed, float side)
{
  if (part.contains("object"))
    return builder_.beginObject(part["object"], poseOf(placed) * poseOf(part));
  if (part.contains("mirrored")) {
    for (const float own : {-1.f, 1.f})
      for (const Json& each : part["mirrored"])
        addPart(each, placed, own);
    return;
  }
  if (part.contains("lamp")) {
    const Eigen::Isometry3f pose = poseOf(placed);
    return builder_.lamp({pose * vectorOf(part["lamp"]), pose.linear() * vectorOf(part.at("half_u")),
                          pose.linear() * vectorOf(part.at("half_v")), vectorOf(part.at("color"))});
  }
  Eigen::Isometry3f pose = poseOf(part);
  pose.translation().x() *= side;
  builder_.place(pose);
  if (part.contains("boxes")) {
    std::vector<Box> boxes;
    for (const Json& each : part["boxes"])
      boxes.push_back(box(each, placed));
    return builder_.boxes(boxes);
  }
  const int material = this->material(part.at("of"), placed);
  if (part.contains("tube")) {
    std::vector<Vector3f> line;
    for (const Json& point : part["tube"])
      line.push_back(sided(point, side));
    builder_.tube(line, part.at("radius"), material);
  } else if (part.contains("lathe")) {
    std::vector<ProfilePoint> profile;
    for (const Json& point : part["lathe"])
      profile.push_back({point.at(0), point.at(1)});
    builder_.lathe(profile, material, part.value("segments", 24));
  } else {
    builder_.cushion(vectorOf(part.at("cushion")), material);
  }
}

void Furniture::add(const Json& placed)
{
  if (addComputed(*this, placed))
    return;
  for (const Json& part : things_.at(placed.at("thing").get<std::string>()))
    addPart(part, placed);
}
} // namespace fresco::simulation
