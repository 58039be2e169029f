// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/photo_store.h"
#include <array>
#include <functional>
#include <string>
namespace fresco::texture {
/// @throws std::invalid_argument as reconstructTexture() says
void validate(const TriangleMesh& mesh, const std::vector<TextureView>& views, const TextureOptions& options);

/// Bytes that texturing takes.
struct MemoryNeed {
  std::size_t fixed;               ///< points
  std::size_t fixed_of_tiles;      ///< beside them of a mesh in tiles: photographs and their depth maps
  std::size_t face_at_once;        ///< of each face that is textured at a time
  std::size_t face_of_tiles = 105; ///< of each face of a mesh in tiles; measured, as the others: docs/texture.md
};

/// Most faces of a tile: those asked for, or as many as leave machineMemory() room.
/// @param asked 0 = all faces, if these fit
/// @throws std::runtime_error if the mesh is larger than memory allows even in tiles
Index tileFaces(Index faces, int asked, const MemoryNeed& need);

/// Joins corners at equal places for the length of the work, and says so where neighbours shared hardly a vertex.
void weld(TextureResult& result);

/// The first ones of faces with the same corners in the same order, ascending.
std::vector<Index> firstFaces(const Faces& faces);

std::string duplicatesWarning(Index count);

/// The model without faces of the same corners in the same order, of which it warns; corners at equal places are the same.
TexturedMesh withoutDuplicates(const TexturedMesh& model, TextureResult& result);

/// Whether mesh and cameras may have one unit: the mesh is neither far larger nor far smaller than where the cameras stand.
bool sameUnits(const TriangleMesh& mesh, const std::vector<TextureView>& views);

/// Warns where little of the surface is seen, with the likely cause.
/// @param seen share of the area, 0..1
void warnOfLittleSeen(double seen, const std::vector<TextureView>& views, TextureResult& result);

/// Warns of photographs that have something, the first ones by name and how much it is.
/// @param shown shown(view), behind the name; "" = it has not
/// @param what before the names, and behind one or several
void warnOf(const std::vector<ViewPart>& parts, const std::function<std::string(int)>& shown,
            const std::array<std::string, 3>& what, TextureResult& result);

/// Orientation that a JPEG file carries in its EXIF block: 1 = as stored (also where there is none, or no JPEG), 2..8
/// turned or mirrored. CIPA DC-008-2012, "Exchangeable image file format", tag 274.
int exifOrientation(const std::string& path);

/// Reads every photograph and mask once, so that one that is missing or of another size is found before the long work. Warns of
/// EXIF rotations.
/// @param parts of the views
void checkPhotos(PhotoStore& photos, const std::vector<ViewPart>& parts, const TextureOptions& options,
                 TextureResult& result);
} // namespace fresco::texture
