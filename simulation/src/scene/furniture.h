// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/simulation/scene/scene_builder.h>
#include <nlohmann/json.hpp>
namespace fresco::simulation {
using Json = nlohmann::json;

Eigen::Vector3f vectorOf(const Json& numbers);

/// Where something stands: "at" [x, y, z], turned by "turn" degrees about z, or by "lean" degrees about the axis "about"
/// (default x). Things face +y; those on walls have their origin in the middle of their back.
Eigen::Isometry3f poseOf(const Json& described);

/// A closed box between two opposite corners.
inline Box solid(const Eigen::Vector3f& a, const Eigen::Vector3f& b, int material)
{
  return {a.cwiseMin(b), a.cwiseMax(b), allSides(material), true};
}

/// A picture as material, named by "picture" (see artwork.h) with "pixels" [width, height] and "emission".
/// @param seed of what is drawn; "seed" is added
Material printed(const Json& described, std::uint64_t seed);

/// Gives side `direction` (-x +x -y +y -z +z) of a box a picture, upright and right way round seen from outside.
Box withPicture(SceneBuilder& builder, Box box, int direction, Material picture);

/// Puts things into a room: those that descriptions/things.json lists and some that are computed.
///
/// A thing is a list of parts. {"object": name} with a pose begins a closed solid; what follows belongs to it:
/// {"boxes": [box ...]}, {"tube": points, "radius"}, {"lathe": profile, "segments"}, {"cushion": half axes} each with a
/// pose and with a material "of"; {"lamp": center, "half_u", "half_v", "color"}, see Lamp; {"mirrored": parts}, once with
/// x negated. A box has "from", "to", its material "of" or six "sides", "free" if it carves, and a picture on "side".
class Furniture {
public:
  explicit Furniture(SceneBuilder& builder);

  /// @param placed "thing" and a pose; "seed" of its pictures; other names replace materials of the thing or are
  ///               parameters of a computed one
  void add(const Json& placed);

  /// @param placed may replace the name by another one
  /// @throws nlohmann::json::exception if there is no such material
  int material(const std::string& name, const Json& placed = Json::object()) const;
  Box box(const Json& described, const Json& placed = Json::object());
  SceneBuilder& builder() { return builder_; }

private:
  void addPart(const Json& part, const Json& placed, float side = 1.f);

  SceneBuilder& builder_;
  Json things_, materials_; ///< materials: numbers by name
};

/// Measures of stairs with two equal flights, metres.
struct Stairs {
  int risers = 9; ///< of a flight
  float tread = 0.28f, landing = 1.3f, half_width = 1.25f;
  float length() const { return tread * (risers - 1) + landing; }
};

/// Adds a thing that is computed. @return whether there is one of that name
bool addComputed(Furniture& furniture, const Json& placed);
} // namespace fresco::simulation
