// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
constexpr float least_cosine = 0.1f; // 84 degrees: beyond, a pixel smears over ten times its size

constexpr Index most_cells = 1 << 20; // of a depth map: enough for outlines, and a 12 megapixel view takes a second

struct VisibilityLimits {
  float tolerance;        ///< of depth, mesh units
  float margin;           ///< pixels
  float pose_uncertainty; ///< factor on the octaves
};

/// The tolerance is the same length in all views, so that near views are not penalized more than far ones.
VisibilityLimits limitsFor(const PatchMesh& patches, const VisibilityInput& input);

/// Median distance of the surface within the images, from what stands before it or not; mesh units.
float typicalDepth(const Points& vertices, const std::vector<Projector>& views);

/// Pixel and depth of a vertex; depth 0 where it is too near to the image's border, outside, or behind the camera.
Eigen::Vector3f pixelWithin(const Projector& view, const Eigen::Vector3f& vertex);

/// Cosine between the patch's normal and the direction from its middle to the camera.
float cosineTowards(const PatchMesh& patches, Index patch, const Projector& view);

/// A patch in the cells of a depth map.
struct Footprint {
  Eigen::Matrix<float, 2, 3> corners; ///< cells
  Eigen::Vector3f inverse_depth;      ///< a x + b y + c over the cells
  float nearest, farthest;            ///< depth of the corners
};

/// @param pixels x, y, depth of the corners (columns); depths > 0
/// @param step pixels per cell
Footprint footprintOf(const Eigen::Matrix3f& pixels, float step);

enum class Visibility { clear, beside, hidden };

/// hidden: some ray through a cell whose centre the patch covers ends before it; beside: one through a cell next to it.
/// @param tolerance mesh units
Visibility visibilityOf(const Footprint& patch, const DepthMap& map, float tolerance);

/// Whether a ray through some cell whose centre the patch covers ends at it.
bool isSeenInPart(const Footprint& patch, const DepthMap& map, float tolerance);
} // namespace fresco::texture
