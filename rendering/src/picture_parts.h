// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "actor.h"
#include <fresco/rendering/picture.h>
namespace fresco::rendering {
/// @throws std::invalid_argument naming the option that is out of range
void validatePictureOptions(const PictureOptions& options);

/// What a shading other than Texture, Error and PointCloud draws of a mesh.
DrawMesh drawnFaces(const TriangleMesh& mesh, const PictureOptions& options);
SurfaceLook surfaceLook(const DrawMesh& drawn, const PictureOptions& options);

/// The view asked for, else the whole model from the default direction.
/// @param model TriangleMesh or PointSet
template <typename Model>
Viewpoint chooseView(const Model& model, const PictureOptions& options)
{
  if (options.view)
    return *options.view;
  Framing framing;
  framing.aspect = static_cast<double>(options.width) / options.height;
  return frameView(model, framing);
}
} // namespace fresco::rendering
