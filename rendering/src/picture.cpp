// SPDX-License-Identifier: BSD-3-Clause
#include "actor.h"
#include "canvas.h"
#include "picture_parts.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/rendering/picture.h>
namespace fresco::rendering {
namespace {
/// Points that lie side by side at a few hundred thousand and stay visible when they are few.
double pointSize(Index count, const PictureOptions& options)
{
  if (options.point_size > 0)
    return options.point_size;
  const double pixels = 0.5 * options.width * options.height;
  return std::clamp(std::sqrt(pixels / std::max<Index>(count, 1)), 1.5, 6.0);
}

/// Edges become finer and paler where faces are small, so that they do not cover the surface.
void setEdges(SurfaceLook& look, const TriangleMesh& mesh, const Viewpoint& view, int height)
{
  double sum = 0;
  const Index step = std::max<Index>(1, mesh.faceCount() / 10000);
  Index count = 0;
  for (Index f = 0; f < mesh.faceCount(); f += step, ++count)
    sum += (mesh.vertices.col(mesh.faces(0, f)) - mesh.vertices.col(mesh.faces(1, f))).norm();
  const double visible = 2 * (view.eye - view.look).norm() * std::tan(view.angle * pi / 360);
  const double pixels = sum / count / visible * height; // mean length of an edge
  look.edge_strength = std::clamp((pixels - 1) / 6, 0.0, 0.85);
  look.size = std::clamp(pixels / 10, 0.05, 1.0);
}

SurfaceLook pointLook(const DrawMesh& drawn, const PictureOptions& options)
{
  SurfaceLook look;
  look.lit = drawn.normals.cols() > 0 && drawn.colors.cols() == 0;
  look.size = pointSize(drawn.vertices.cols(), options);
  return look;
}

/// @param origin of the frame that the actor's coordinates are in; the view is in world coordinates
Image drawOne(DrawMesh& drawn, SurfaceLook look, const Viewpoint& view, const Eigen::Vector3d& origin,
              const PictureOptions& options)
{
  Canvas canvas(options);
  look.size *= canvas.oversampling();
  canvas.add(makeActor(drawn, look));
  return canvas.draw(view, origin);
}

PointSet verticesOf(const TriangleMesh& mesh)
{
  PointSet set;
  set.points = mesh.vertices;
  set.normals = mesh.normals;
  set.colors = mesh.colors;
  set.origin = mesh.origin;
  return set;
}

/// The points to be drawn: with `cull_back_faces` those whose normals point to the side of the eye.
PointSet drawnPoints(PointSet set, const PictureOptions& options, const Eigen::Vector3d& eye)
{
  if (options.no_colors) {
    set.colors.resize(3, 0);
    set.intensities.resize(0);
  }
  if (!options.cull_back_faces || !set.hasNormals())
    return set;
  const Eigen::Vector3f place = (eye - set.origin).cast<float>();
  std::vector<Index> seen;
  for (Index i = 0; i < set.size(); ++i)
    if (set.normals.col(i).dot(place - set.points.col(i)) > 0.f)
      seen.push_back(i);
  return selectPoints(set, seen);
}
} // namespace

DrawMesh drawnFaces(const TriangleMesh& mesh, const PictureOptions& options)
{
  if (options.shading == Shading::Normals)
    return normalColoredMesh(mesh, options.threads);
  DrawMesh drawn =
      options.shading == Shading::Gouraud ? creasedMesh(mesh, options.crease_angle, options.threads) : plainMesh(mesh);
  if (options.no_colors || options.shading == Shading::Wireframe)
    drawn.colors.resize(3, 0);
  return drawn;
}

SurfaceLook surfaceLook(const DrawMesh& drawn, const PictureOptions& options)
{
  SurfaceLook look;
  look.lit = options.shading != Shading::Normals;
  look.ambient = drawn.colors.cols() > 0 ? 0.5 : 0.08; // colours that were seen hold the light of the place
  look.specular = options.shading == Shading::Gouraud ? 0.12 : 0.0;
  look.cull_back_faces = options.cull_back_faces;
  return look;
}

void validatePictureOptions(const PictureOptions& options)
{
  require(options.width >= 1 && options.height >= 1, "picture: size ", options.width, "x", options.height,
          " is not positive");
  require(options.crease_angle >= 0 && options.crease_angle <= 180, "picture: crease angle ", options.crease_angle,
          " is not in 0..180 degrees");
  require(options.point_size >= 0 && options.point_size <= 1000, "picture: point size ", options.point_size,
          " is not in 0..1000 pixels");
  require(options.error_limit >= 0 && std::isfinite(options.error_limit), "picture: error limit ", options.error_limit,
          " is negative or not finite");
  require(options.oversampling >= 1 && options.oversampling <= 4, "picture: oversampling ", options.oversampling,
          " is not in 1..4");
  if (options.view)
    validateViewpoint(*options.view);
}

const std::vector<std::string>& shadingNames()
{
  static const std::vector<std::string> names{"normals", "gouraud", "flat", "wireframe", "texture", "error", "points"};
  return names;
}

Shading shadingByName(const std::string& name)
{
  const auto& names = shadingNames();
  const auto at = std::find(names.begin(), names.end(), name);
  require(at != names.end(), "picture: shading '", name, "' is not known");
  return static_cast<Shading>(at - names.begin());
}

Image renderPicture(const TriangleMesh& mesh, const PictureOptions& options)
{
  validatePictureOptions(options);
  validateMesh(mesh);
  if (mesh.faceCount() == 0 || options.shading == Shading::PointCloud)
    return renderPicture(verticesOf(mesh), options);
  require(options.shading != Shading::Texture, "picture: the model has no texture");
  require(options.shading != Shading::Error, "picture: error shading needs distances to a reference");
  const Viewpoint view = chooseView(mesh, options);
  DrawMesh drawn = drawnFaces(mesh, options);
  if (options.cull_back_faces)
    leaveOut(drawn, hangingFaces(mesh, view.eye));
  SurfaceLook look = surfaceLook(drawn, options);
  if (options.shading == Shading::Wireframe)
    setEdges(look, mesh, view, options.height);
  return drawOne(drawn, look, view, mesh.origin, options);
}

Image renderPicture(const PointSet& set, const PictureOptions& options)
{
  validatePictureOptions(options);
  validatePointSet(set);
  const Viewpoint view = chooseView(set, options);
  require(options.shading != Shading::Normals || set.hasNormals(), "picture: the points have no normals");
  DrawMesh drawn = drawPoints(drawnPoints(set, options, view.eye));
  if (options.shading == Shading::Normals)
    drawn.colors = normalColors(drawn.normals);
  return drawOne(drawn, pointLook(drawn, options), view, set.origin, options);
}
} // namespace fresco::rendering
