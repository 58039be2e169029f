// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "simulation/scene/artwork.h"
#include "simulation/scene/scene_builder.h"
#include "simulation/sensors/random.h"
namespace fresco::simulation {
/// Materials that many things share; numbers as SceneBuilder::add() gives them.
struct Palette {
  explicit Palette(SceneBuilder& builder);
  int wall, wall_accent, ceiling, carpet, parquet, skirting, frame, door;
  int oak, walnut, white_lacquer, black, chrome, steel, fabric_blue, fabric_grey, fabric_red, linen;
  int white_plastic, grey_plastic, porcelain, cardboard, terracotta, soil, leaf, rubber, lamp, paper, tiles;
};

/// A colour without pattern worth a name.
int addPaint(SceneBuilder& builder, const Eigen::Vector3f& color, Finish finish = Finish::plain);

/// Box with a picture on its side `direction` (-x +x -y +y -z +z), upright, right way round seen from outside.
struct PictureBox {
  Eigen::Vector3f min, max;
  int direction = 3;
  PicturePtr picture;
  int body = 0; ///< material of the other sides
  float emission = 0.f;
  bool glass = false;
};
BoxMaterials pictureSides(SceneBuilder& builder, const PictureBox& box);

/// Where a thing stands, and its own random numbers.
struct Spot {
  Eigen::Vector3f position;
  float degrees = 0.f; ///< turn about z; things face +y
  std::uint64_t seed = 1;
  Eigen::Isometry3f pose() const { return standing(position, degrees); }
};

// Seating and tables
void conferenceChair(SceneBuilder& builder, const Palette& palette, const Spot& spot, int fabric);
void woodenChair(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void conferenceTable(SceneBuilder& builder, const Palette& palette, const Spot& spot, const Eigen::Vector2f& size);
void coffeeTable(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void desk(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void sofa(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void bed(SceneBuilder& builder, const Palette& palette, const Spot& spot);

// Storage
void bookShelf(SceneBuilder& builder, const Palette& palette, const Spot& spot, const Eigen::Vector2f& size);
void sideboard(SceneBuilder& builder, const Palette& palette, const Spot& spot, const Eigen::Vector3f& size);
void wardrobe(SceneBuilder& builder, const Palette& palette, const Spot& spot);

// On walls (position: middle of the back, things face +y)
void framedPicture(SceneBuilder& builder, const Palette& palette, const Spot& spot, const PicturePtr& picture);
void whiteboard(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void wallClock(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void socket(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void radiator(SceneBuilder& builder, const Palette& palette, const Spot& spot, float width);

// Small things
void laptop(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void monitor(SceneBuilder& builder, const Palette& palette, const Spot& spot, const Eigen::Vector2f& size);
void cup(SceneBuilder& builder, const Spot& spot, int material);
void bottle(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void papers(SceneBuilder& builder, const Palette& palette, const Spot& spot, int count);
void cartons(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void bin(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void plant(SceneBuilder& builder, const Palette& palette, const Spot& spot, float height);
void flipChart(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void coatStand(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void floorLamp(SceneBuilder& builder, const Palette& palette, const Spot& spot);
void projector(SceneBuilder& builder, const Palette& palette, const Spot& spot, float ceiling);
void cable(SceneBuilder& builder, const Palette& palette, const std::vector<Eigen::Vector2f>& line);
} // namespace fresco::simulation
