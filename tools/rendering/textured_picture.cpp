// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/actor.h"
#include "rendering/canvas.h"
#include "rendering/picture.h"
#include "rendering/picture_parts.h"
#include <fresco/core/require.h>
namespace fresco::rendering {
namespace {
/// The faces of one atlas, ready to draw.
struct Part {
  DrawMesh drawn;
  Image atlas; ///< empty: faces without texture
};

std::vector<Part> makeParts(const TexturedMesh& model, int largest_texture)
{
  std::vector<Part> parts;
  for (int atlas = -1; atlas < static_cast<int>(model.atlases.size()); ++atlas) {
    Part part{texturedPart(model, atlas), {}};
    if (part.drawn.faces.cols() == 0)
      continue;
    if (atlas >= 0)
      part.atlas = shrinkTo(model.atlases[atlas], largest_texture);
    parts.push_back(std::move(part));
  }
  return parts;
}

SurfaceLook partLook(const Part& part, const PictureOptions& options)
{
  SurfaceLook look;
  look.cull_back_faces = options.cull_back_faces;
  if (part.atlas.empty())
    return look;
  look.texture = &part.atlas;
  look.color = {1, 1, 1};
  look.lit = false;
  return look;
}
} // namespace

Image renderPicture(const TexturedMesh& model, const PictureOptions& options)
{
  if (options.shading != Shading::Texture)
    return renderPicture(model.mesh, options);
  validatePictureOptions(options);
  validateTexturedMesh(model);
  require(!model.atlases.empty(), "picture: the model has no texture");
  require(model.mesh.faceCount() > 0, "picture: the textured model has no face");
  const Viewpoint view = chooseView(model.mesh, options);
  Canvas canvas(options);
  std::vector<Part> parts = makeParts(model, canvas.largestTexture());
  for (Part& part : parts)
    canvas.add(makeActor(part.drawn, partLook(part, options)));
  return canvas.draw(view, model.mesh.origin);
}
} // namespace fresco::rendering
