// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/image.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <string>
#include <vector>
namespace fresco {
/// Texture of a mesh from the points on it, where there are no photographs. A texel is the Gaussian mean of the points
/// around it on the surface, corrected by what the points differ from it: Barnes 1964, "A Technique for Maximizing
/// Details in Numerical Weather Map Analysis".
struct PointTextureOptions {
  double texel = 0;     ///< side of a texel in mesh units, >= 0; 0 = 1.4 texels from one point to the next
  int atlas = 0;        ///< largest side of an atlas, 128..16384 pixels, more atlases beyond; 0 = 8192
  int border = 2;       ///< texels around each chart that continue its surface against bleeding, 1..16
  double width = 0.45;  ///< deviation of the Gaussian in distances from one point to the next, 0.3..10
  int rounds = 2;       ///< corrections by what the points differ from the texture, 0..20: more are sharper and noisier
  bool exposure = true; ///< bring the brightness of scans together; intensities: also range and angle of incidence
  int threads = 0;      ///< 0 = all cores; the result does not depend on it
  int tile_faces = 0;   ///< most faces that are textured at a time, see TextureOptions
};

/// What points say of the look of a surface.
enum class PointLook { none, colors, intensities };

/// What a texture of these points would be made of: colours, unless all are the same; else intensities, likewise.
/// @param warnings gets a sentence on what is there and cannot be used; may be null
FRESCO_EXPORT PointLook lookOf(const PointSet& points, std::vector<std::string>* warnings = nullptr);

struct PointTextureResult {
  TexturedMesh model; ///< without atlases where the points have no look
  PointLook look = PointLook::none;
  /// One per atlas, grey: 255 where there is no point and the colour is inpainted.
  std::vector<Image> masks;
  double coverage = 0; ///< share of the mesh's area with points, 0..1
  double used = 0;     ///< share of the atlases' texels that lie in charts or their borders, 0..1
  double texel = 0;    ///< side of a texel in mesh units, median over the area
  Index charts = 0;
  Points gains;                  ///< 3xS, factors on RGB that bring the scans together; their mean logarithm is 0
  double range_exponent = 0;     ///< a, b: intensities were divided by range^a cos(incidence)^b; 0 where that did not
  double incidence_exponent = 0; ///< make scans agree better
  std::vector<std::string> warnings; ///< what was left out or ignored, a sentence each
};

/// Points belong to one scan where they have the same viewpoint. Points behind the surface, far from it or not finite are
/// left out.
/// @param mesh   as validateMesh() wants it, with at least one face of positive area
/// @param points with colors or intensities; else the model is untextured
/// @param take   takes the atlases of a mesh in tiles
/// @throws std::invalid_argument if mesh, points or an option are out of range
/// @throws std::runtime_error if no point lies on the mesh, or there would be more than a thousand megatexels
/// @throws std::runtime_error if the mesh takes more than machineMemory() even in tiles
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT PointTextureResult reconstructPointTexture(TriangleMesh mesh, const PointSet& points,
                                                         const PointTextureOptions& options = {},
                                                         const Progress& progress = {}, const AtlasSink& take = {});
} // namespace fresco
