// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/actor.h"
#include "rendering/canvas.h"
#include "rendering/picture.h"
#include "rendering/picture_parts.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::rendering {
namespace {
void validateTextures(const TexturedMesh& model)
{
  const Index faces = model.mesh.faceCount();
  const int atlases = model.atlases.size();
  require(atlases > 0, "picture: the model has no texture");
  require(model.texcoord_faces.cols() == faces && model.face_atlas.size() == faces, "picture: ", faces, " faces, ",
          model.texcoord_faces.cols(), " with texture coordinates, ", model.face_atlas.size(), " with an atlas");
  for (const Image& atlas : model.atlases)
    require(atlas.width > 0 && atlas.height > 0 &&
                (atlas.channels == 1 || atlas.channels == 3 || atlas.channels == 4) &&
                atlas.data.size() == std::size_t(atlas.width) * atlas.height * atlas.channels,
            "picture: an atlas is empty or malformed");
  for (Index f = 0; f < faces; ++f) {
    require(model.face_atlas[f] >= -1 && model.face_atlas[f] < atlases, "picture: face ", f, " names atlas ",
            model.face_atlas[f], " of ", atlases);
    for (int k = 0; k < 3 && model.face_atlas[f] >= 0; ++k) {
      const int t = model.texcoord_faces(k, f);
      require(t >= 0 && t < model.texcoords.cols(), "picture: face ", f, " names texture coordinate ", t, " of ",
              model.texcoords.cols());
      require(model.texcoords.col(t).allFinite(), "picture: texture coordinate ", t, " is not finite");
    }
  }
}

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
  validateMesh(model.mesh);
  validateTextures(model);
  require(model.mesh.faceCount() > 0, "picture: the textured model has no face");
  const Viewpoint view = chooseView(model.mesh, options);
  Canvas canvas(options);
  std::vector<Part> parts = makeParts(model, canvas.largestTexture());
  for (Part& part : parts)
    canvas.add(makeActor(part.drawn, partLook(part, options)));
  return canvas.draw(view, model.mesh.origin);
}
} // namespace fresco::rendering
