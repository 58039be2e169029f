// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
#include "points/surface_samples.h"
#include <fresco/texture/core/point_texture.h>
namespace fresco::texture {
/// P, samples per mesh unit on each patch; 0 where there are none.
Eigen::VectorXf patchDensities(const PatchMesh& patches, const SurfaceSamples& samples, const SurfaceGaussian& gaussian,
                               int threads);

/// Values whose Gaussian means come nearer to the given ones with each round: Barnes 1964.
/// @param values 3xM
Points sharpened(const SurfaceSamples& samples, const SurfaceGaussian& gaussian, const Points& values,
                 const PointTextureOptions& options);

/// What is painted, and with what.
struct PointPaint {
  const SurfaceGaussian& gaussian;
  const Points& values; ///< 3xM
};

/// Paints the seen patches. Texels without samples continue the colours around them and are marked in the masks.
/// @param view of the scene's patches: those without any sample become unseen
/// @param own patches that the result's figures count
void paintSamples(const PaintScene& scene, const PointPaint& paint, Eigen::VectorXi& view, Index own,
                  TextureResult& result);
} // namespace fresco::texture
