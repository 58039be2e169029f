// SPDX-License-Identifier: BSD-3-Clause
#include "canvas.h"
#include "picture_parts.h"
#include <fresco/core/require.h>
#include <vtkProperty.h>
namespace fresco::rendering {
/// What stands before the eye.
struct PictureSeries::Stage {
  Stage(const TriangleMesh& mesh, const PictureOptions& options)
      : surface{mesh.vertices, mesh.faces, {}, {}, {}, mesh.origin}, canvas(options), hidden(mesh.faceCount(), 0)
  {}

  void add(DrawMesh&& mesh, const SurfaceLook& look)
  {
    drawn.push_back(std::make_unique<DrawMesh>(std::move(mesh)));
    actors.push_back(makeActor(*drawn.back(), look));
    canvas.add(actors.back());
    whole.push_back(drawn.back()->faces);
  }

  void show(bool cull_back_faces, const Eigen::Vector3d& eye)
  {
    std::vector<char> out = cull_back_faces ? hangingFaces(surface, eye) : std::vector<char>(hidden.size(), 0);
    const bool changed = out != hidden;
    hidden = std::move(out);
    for (std::size_t i = 0; i < actors.size(); ++i) {
      actors[i]->GetProperty()->SetBackfaceCulling(cull_back_faces);
      if (!changed)
        continue;
      drawn[i]->faces = whole[i];
      leaveOut(*drawn[i], hidden);
      update(*actors[i], *drawn[i]);
    }
  }

  TriangleMesh surface;                         ///< without attributes
  std::vector<std::unique_ptr<DrawMesh>> drawn; ///< actors use them in place
  std::vector<Faces> whole;                     ///< of each of them
  Canvas canvas;
  std::vector<vtkSmartPointer<vtkActor>> actors;
  std::vector<char> hidden; ///< F, not shown now
};

namespace {
/// Of the faces without texture where there is none.
SurfaceLook texturedLook(const Image* texture)
{
  SurfaceLook look;
  if (!texture)
    return look;
  look.texture = texture;
  look.color = {1, 1, 1};
  look.lit = false;
  return look;
}
} // namespace

PictureSeries::PictureSeries(const TexturedMesh& model, const PictureOptions& options)
{
  validatePictureOptions(options);
  validateTexturedMesh(model);
  const bool textured = options.shading == Shading::Texture;
  require(!textured || !model.atlases.empty(), "picture: the model has no texture");
  require(options.shading <= Shading::Flat || textured, "picture: no series of this shading");
  require(model.mesh.faceCount() > 0, "picture: the model has no face");
  stage_ = std::make_unique<Stage>(model.mesh, options);
  if (!textured) {
    DrawMesh drawn = drawnFaces(model.mesh, options);
    const SurfaceLook look = surfaceLook(drawn, options);
    stage_->add(std::move(drawn), look);
  }
  for (int atlas = -1; textured && atlas < static_cast<int>(model.atlases.size()); ++atlas) {
    DrawMesh drawn = texturedPart(model, atlas);
    if (drawn.faces.cols() == 0)
      continue;
    const Image texture = atlas >= 0 ? shrinkTo(model.atlases[atlas], stage_->canvas.largestTexture()) : Image();
    stage_->add(std::move(drawn), texturedLook(atlas >= 0 ? &texture : nullptr));
  }
}

PictureSeries::~PictureSeries() = default;

Image PictureSeries::draw(const Viewpoint& view, bool cull_back_faces)
{
  stage_->show(cull_back_faces, view.eye);
  return stage_->canvas.draw(view, stage_->surface.origin);
}

Image renderPicture(const TexturedMesh& model, const PictureOptions& options)
{
  if (options.shading != Shading::Texture)
    return renderPicture(model.mesh, options);
  return PictureSeries(model, options).draw(chooseView(model.mesh, options), options.cull_back_faces);
}
} // namespace fresco::rendering
