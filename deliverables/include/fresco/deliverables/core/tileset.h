// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/progress.h>
#include <fresco/core/textured_mesh.h>
#include <string>
#include <vector>
namespace fresco {
/// A large model as 3D Tiles 1.1 (OGC 22-025r4): a quadtree seen from above, of which a browser loads what it shows.
struct TilesetOptions {
  Index faces = 20000;   ///< most of a tile, >= 1; borders between tiles, which stay as they are, may ask for more
  double texel = 0;      ///< side of a texel of the finest tiles, mesh units, >= 0; 0 = that of the full model
  int jpeg_quality = 85; ///< 1..100; 0 = PNG
  /// World from model, both z-up: kept in the tileset.
  Eigen::Matrix4d T_world_model = Eigen::Matrix4d::Identity();
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

struct Tile {
  std::string file;          ///< below the folder
  Eigen::AlignedBox3d box;   ///< of it and of all tiles below it, relative to the mesh's origin
  double error = 0;          ///< geometricError, mesh units: what it lacks of the finest tiles, 0 of these
  Index faces = 0;           ///< of the tile
  int depth = 0;             ///< 0 = root
  std::vector<int> children; ///< at most 4; none of the finest tiles, which hold all faces of the model, each once
};

/// Writes `folder`/tileset.json and `folder`/tile_N.glb. A tile above others is what simplifyMesh() leaves of these together, with
/// texels twice as large a level. Vertices that it shares with tiles beside it stay where they are, so that tiles of any levels
/// meet without gaps, and are free in the tile that holds both sides. Its error is the largest below it, the simplification's
/// and its texel together.
/// @param full with texture or colours, else grey
/// @return the tiles, the root first. @throws std::invalid_argument as bakeLightModel(), std::runtime_error "PATH: reason"
FRESCO_EXPORT std::vector<Tile> writeTileset(const std::string& folder, TexturedMesh full,
                                             const TilesetOptions& options = {}, const Progress& progress = {});
} // namespace fresco
