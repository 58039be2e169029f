// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/projector.h"
#include <fresco/search/ray_scene.h>
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
/// Faces that are turned inside out: of surfaces (faces that share edges and run alike) that photographs see, but all of them
/// from behind. Warns of these, and where much is seen from behind otherwise.
/// @param mesh that `scene` is of
/// @return F, whether the face is to be turned; empty if none is
std::vector<char> insideOutFaces(const TriangleMesh& mesh, const RayScene& scene, const std::vector<Projector>& views,
                                 TextureResult& result);

/// Lets the marked faces run the other way.
void turnFaces(const std::vector<char>& marked, TexturedMesh& model);
} // namespace fresco::texture
