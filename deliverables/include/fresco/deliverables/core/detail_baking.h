// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/progress.h>
#include <fresco/io/gltf.h>
namespace fresco {
/// What a light model shows of the full one that it was made of: Cignoni, Montani, Rocchini & Scopigno 1998, "A General Method
/// for Preserving Attribute Values on Simplified Meshes"; along rays across the light surface: Krishnamurthy & Levoy 1996,
/// "Fitting Smooth Surfaces to Dense Polygon Meshes".
struct BakingOptions {
  double cage =
      0; ///< how far the full surface is looked for on either side, mesh units, >= 0; 0 = a hundredth of the diagonal
  int border = 4;  ///< texels around each chart that continue its surface, 0..64
  int coarser = 2; ///< texels of the atlas along a side of a texel of the normal map, 1..16
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// Paints the atlases of `light` with the colours of `full`, where that has any, and makes its normal maps: normals of `full`
/// in the frames that texcoordTangents() gives, green pointing up. A texel gets what the nearer hit of the rays along the light
/// surface's normal, outwards and inwards, finds of the front of `full`; where neither finds any, the closest point.
/// @param light with texture coordinates in 0..1 and atlases that have their sizes; its frame is that of `full`, whatever their
///        origins
/// @throws std::invalid_argument as validateTexturedMesh(), if `full` has no face or an option is out of range
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT GltfModel bakeDetail(TexturedMesh light, const TexturedMesh& full, const BakingOptions& options = {},
                                   const Progress& progress = {});

/// A model as it is handed over.
struct LightModelOptions {
  Index faces = 100000; ///< at most, >= 0; 0 = those of the full model
  double error = 0;     ///< see SimplificationOptions::error
  double texel = 0;     ///< side of a texel, mesh units, >= 0; 0 = what `full` holds, or as `atlases` allows
  int atlas = 4096;     ///< side of an atlas, 128..16384 pixels
  int atlases = 4;      ///< at most, >= 1: texels are made larger until they suffice
  int threads = 0;      ///< 0 = all cores; the result does not depend on it
};

/// A new atlas for a mesh, and the colours and normals of `full` in it: layOutTexture(), bakeDetail(). Where `full` has no
/// colours, the atlases are small and grey.
/// @throws as these
FRESCO_EXPORT GltfModel bakeLightModel(TriangleMesh light, const TexturedMesh& full,
                                       const LightModelOptions& options = {}, const Progress& progress = {});

/// The same for what simplifyMesh() leaves of the full model.
/// @throws as these
FRESCO_EXPORT GltfModel makeLightModel(const TexturedMesh& full, const LightModelOptions& options = {},
                                       const Progress& progress = {});

/// An RGB image of half as many pixels a side, rounded up, each the mean of four.
FRESCO_EXPORT Image halfSize(const Image& image);

/// Side of a texel on the surface, mesh units, of the typical face, by area; without a texture that of a square as large as a face.
FRESCO_EXPORT double typicalTexel(const TexturedMesh& model);
} // namespace fresco
