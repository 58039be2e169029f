// SPDX-License-Identifier: BSD-3-Clause
#include "actor.h"
#include "canvas.h"
#include "picture_parts.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/rendering/picture.h>
#include <fresco/rendering/scale_bar.h>
#include <fresco/surface/core/error_colors.h>
namespace fresco::rendering {
namespace {
constexpr int ramp_size = 1024;

/// The next tick of the scale bar.
double roundUp(double distance)
{
  const std::vector<double> ticks = roundTicks(distance);
  return ticks.back() >= distance * (1 - 1e-6) ? ticks.back() : ticks.back() + ticks[1];
}

/// Distance that is blue: the one asked for, else a round one such that at most one vertex in a hundred lies above.
double blueDistance(const Eigen::VectorXf& distances, const PictureOptions& options)
{
  if (options.error_limit > 0)
    return options.error_limit;
  std::vector<float> sorted(distances.data(), distances.data() + distances.size());
  const Index rank = 0.99 * (sorted.size() - 1);
  const float at = rankedValue(sorted, rank);
  const double usual = at > 0 ? at : distances.maxCoeff();
  return usual > 0 ? roundUp(usual) : 1.0;
}

/// The colours from 0 to the largest distance as one row of texels.
Image errorRamp()
{
  const Colors colors = errorColors(Eigen::VectorXf::LinSpaced(ramp_size, 0.f, 1.f), 1.f);
  Image ramp(ramp_size, 1, 3);
  std::copy_n(colors.data(), colors.size(), ramp.data.data());
  return ramp;
}

Eigen::VectorXf drawnDistances(const DrawMesh& drawn, const Eigen::VectorXf& distances)
{
  const Eigen::VectorXf shown = distances(drawn.source);
  require(shown.allFinite() && shown.minCoeff() >= 0, "picture: a distance is negative or not finite");
  return shown;
}

/// Distances as coordinates into errorRamp(): the colour is looked up per pixel, not mixed between vertices.
Eigen::Matrix2Xf rampCoordinates(const Eigen::VectorXf& distances, double largest)
{
  Eigen::Matrix2Xf texcoords = Eigen::Matrix2Xf::Constant(2, distances.size(), 0.5f);
  for (Index v = 0; v < texcoords.cols(); ++v)
    texcoords(0, v) = (0.5 + (ramp_size - 1) * (distances[v] / largest)) / ramp_size;
  return texcoords;
}

ScaleBar makeBar(const Eigen::VectorXf& distances, double largest, const PictureOptions& options)
{
  ScaleBar bar;
  bar.largest = largest;
  bar.open_ended = distances.maxCoeff() > largest * (1 + 1e-6);
  bar.title = {"distance", "(" + (options.unit.empty() ? "model unit" : options.unit) + ")"};
  const auto& [red, green, blue] = options.background;
  const bool dark = !options.transparent && 0.3 * red + 0.59 * green + 0.11 * blue < 110;
  bar.text_color = dark ? std::array<std::uint8_t, 3>{255, 255, 255} : std::array<std::uint8_t, 3>{0, 0, 0};
  return bar;
}

Image drawColored(DrawMesh& drawn, const Viewpoint& view, const Eigen::Vector3d& origin, const PictureOptions& options)
{
  const Image ramp = errorRamp();
  SurfaceLook look;
  look.color = {1, 1, 1};
  look.ambient = 0.5;
  look.texture = &ramp;
  look.mipmap = false;
  look.cull_back_faces = options.cull_back_faces;
  Canvas canvas(options, Lighting::Headlight);
  canvas.add(makeActor(drawn, look));
  return canvas.draw(view, origin);
}

/// The view of a picture that is narrower than the one asked for by the bar: all of what that would show is in it.
Viewpoint narrowView(const TriangleMesh& mesh, const PictureOptions& part, int whole_width)
{
  Viewpoint view = chooseView(mesh, part);
  constexpr double degree = radians_per_degree;
  if (part.view)
    view.angle = std::min(170.0, 2 / degree * std::atan(std::tan(view.angle * degree / 2) * whole_width / part.width));
  return view;
}

/// `picture` with a strip of `width` columns in the background's colour at its right side.
Image widen(const Image& picture, int width, const PictureOptions& options)
{
  Image wide(picture.width + width, picture.height, picture.channels);
  for (int y = 0; y < wide.height; ++y) {
    std::copy_n(picture.pixel(0, y), picture.width * picture.channels, wide.pixel(0, y));
    for (int x = picture.width; x < wide.width; ++x) // alpha stays 0
      std::copy_n(options.background.begin(), 3, wide.pixel(x, y));
  }
  return wide;
}
} // namespace

Image renderErrorPicture(const TriangleMesh& mesh, const Eigen::VectorXf& distances, const PictureOptions& options)
{
  validatePictureOptions(options);
  validateMesh(mesh);
  require(options.width >= 160 && options.height >= 120, "picture: an error picture needs at least 160x120 pixels");
  require(mesh.faceCount() > 0, "picture: the mesh has no face");
  require(distances.size() == mesh.vertexCount(), "picture: ", mesh.vertexCount(), " vertices, ", distances.size(),
          " distances");
  DrawMesh drawn = creasedMesh(mesh, options.crease_angle, options.threads);
  const Eigen::VectorXf shown = drawnDistances(drawn, distances);
  const double largest = blueDistance(shown, options);
  const ScaleBar bar = makeBar(shown, largest, options);
  PictureOptions part = options;
  part.width -= scaleBarWidth(bar, options.height);
  require(part.width >= 16, "picture: ", options.width, " pixels are too few for an error picture of that height");
  drawn.texcoords = rampCoordinates(shown, largest);
  Image picture = widen(drawColored(drawn, narrowView(mesh, part, options.width), mesh.origin, part),
                        options.width - part.width, options);
  drawScaleBar(picture, bar);
  return picture;
}
} // namespace fresco::rendering
