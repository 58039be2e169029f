// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <fresco/simulation/sensors/picture.h>
#include <memory>
namespace fresco::simulation {
enum class Finish {
  plain,        ///< paint or plastic with faint speckles
  plaster,      ///< painted wall: rough, faintly uneven
  carpet,       ///< loops of yarn in tiles of 50 cm
  planks,       ///< parquet boards of wood along x
  wood,         ///< grain along the longest direction given by `along`
  fabric,       ///< weave
  ceiling_tile, ///< mineral fibre boards in a grid of 60 cm
  metal,        ///< brushed
  cardboard,    ///< corrugated
  leaf,         ///< plant
  picture       ///< a printed or written picture
};

/// How a surface looks. Colours are display values 0..1 (power law 1/2.2 of the reflectance).
struct Material {
  Finish finish = Finish::plain;
  Eigen::Vector3f color = {0.7f, 0.7f, 0.7f};
  Eigen::Vector3f accent = {0.5f, 0.5f, 0.5f}; ///< second colour of the pattern
  float contrast = 1.f;                        ///< of the pattern
  int along = 0;                               ///< axis of the object that grain runs along
  std::uint32_t seed = 1;
  float emission = 0.f; ///< 0 = lit by lamps; else shines with color * emission
  bool glass = false;   ///< most laser beams do not come back
  bool clear = false;   ///< laser beams pass, a few come back
  std::shared_ptr<const Picture> picture;
  /// Of a picture, in the object's frame: upper left corner, and the vectors that span it to the right and down.
  Eigen::Vector3f corner = {0, 0, 0}, right = {1, 0, 0}, down = {0, -1, 0};
};

/// Where a material is looked at.
struct SurfacePoint {
  Eigen::Vector3f position; ///< metres, in the object's frame
  Eigen::Vector3f normal;   ///< unit, in the object's frame
  float footprint = 0.002f; ///< metres, size of the asking pixel on the surface; finer detail is averaged
};

/// Display colour 0..1 of the material under white light of strength 1.
Eigen::Vector3f albedo(const Material& material, const SurfacePoint& at);
} // namespace fresco::simulation
