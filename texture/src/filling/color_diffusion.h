// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/patch_mesh.h"
#include <algorithm>
namespace fresco::texture {
/// Factor >= 1 that makes a colour as bright as `least` in its own hue; where hues differ by more than a tenth, as its
/// brightest channel: what is overexposed tells of no hue, but is hardly of a strong one.
inline float lightAbove(const Eigen::Vector3f& color, const Eigen::Vector3f& least)
{
  const float brightest = least.maxCoeff() / color.maxCoeff();
  return std::max(1.f, std::min(least.cwiseQuotient(color).maxCoeff(), 1.1f * brightest));
}

/// Colour of every corner of the patches: of vertices of seen patches the mean over these, of the others a smooth
/// continuation over the mesh, which hardly crosses creases: a vertex there has one colour for each side. Where the mesh
/// has colours of its own, what is continued is the difference from them.
/// @param colors 3xP 0..255; -1 where unseen
/// @param clipped P: the patch's colour is the least that it may be, and is continued
/// @return 3x3P, three columns per patch, 0..255; mid grey where nothing is known
Points diffuseColors(const PatchMesh& patches, const Points& colors, const std::vector<char>& clipped, int threads);
} // namespace fresco::texture
