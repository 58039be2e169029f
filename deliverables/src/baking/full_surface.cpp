// SPDX-License-Identifier: BSD-3-Clause
#include "baking/full_surface.h"
#include <algorithm>
#include <cmath>
#include <fresco/deliverables/core/model_file.h>
namespace fresco::deliverables {
namespace {
/// Bilinear.
/// @param at texture coordinates, v pointing up
Eigen::Vector3f sample(const Image& image, const Eigen::Vector2f& at)
{
  const float x = at.x() * image.width - 0.5f, y = (1 - at.y()) * image.height - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const auto pixel = [&](float column, float row) {
    const std::uint8_t* from =
        image.pixel(std::clamp<float>(column, 0, image.width - 1), std::clamp<float>(row, 0, image.height - 1));
    return Eigen::Vector3f(from[0], from[1], from[2]);
  };
  const Eigen::Vector3f upper = pixel(left, top) + (x - left) * (pixel(left + 1, top) - pixel(left, top));
  const Eigen::Vector3f lower = pixel(left, top + 1) + (x - left) * (pixel(left + 1, top + 1) - pixel(left, top + 1));
  return upper + (y - top) * (lower - upper);
}

Eigen::Vector3f weightsOf(const TriangleMesh& mesh, const ClosestPoint& closest)
{
  const Eigen::Vector3d a = faceCorner(mesh, closest.face, 0);
  Eigen::Matrix<double, 3, 2> sides;
  sides << faceCorner(mesh, closest.face, 1) - a, faceCorner(mesh, closest.face, 2) - a;
  const Eigen::Vector2d at = (sides.transpose() * sides + 1e-30 * Eigen::Matrix2d::Identity())
                                 .ldlt()
                                 .solve(sides.transpose() * (closest.point - a));
  const Eigen::Vector3d weights = Eigen::Vector3d(1 - at.sum(), at[0], at[1]).cwiseMax(0);
  return (weights / weights.sum()).cast<float>();
}
} // namespace

FullSurface::FullSurface(const TexturedMesh& model, int threads)
    : model_(model), rays_(model.mesh), tree_(model.mesh, threads),
      normals_(model.mesh.normals.cols() > 0 ? model.mesh.normals : vertexNormals(model.mesh, threads)),
      has_colors_(isColored(model))
{}

FullSurface::Point FullSurface::across(const Eigen::Vector3f& place, const Eigen::Vector3f& normal, float cage) const
{
  const float start = 1e-3f * cage; // the surfaces may be the same
  RayHit nearest;
  for (const float side : {1.f, -1.f}) {
    const RayHit hit = rays_.intersect({place - side * start * normal, side * normal, cage + start});
    if (hit.face >= 0 && hit.normal.dot(normal) > 0 && std::abs(hit.distance - start) < nearest.distance) {
      nearest = hit;
      nearest.distance = std::abs(hit.distance - start);
    }
  }
  if (nearest.face >= 0)
    return {nearest.face, {1 - nearest.beta - nearest.gamma, nearest.beta, nearest.gamma}};
  const ClosestPoint closest = tree_.closest(place.cast<double>());
  return {closest.face, weightsOf(model_.mesh, closest)};
}

Eigen::Vector3f FullSurface::color(const Point& point) const
{
  if (model_.face_atlas.size() > 0 && model_.face_atlas[point.face] >= 0) {
    Eigen::Vector2f at = Eigen::Vector2f::Zero();
    for (int k = 0; k < 3; ++k)
      at += point.weights[k] * model_.texcoords.col(model_.texcoord_faces(k, point.face));
    return sample(model_.atlases[model_.face_atlas[point.face]], at);
  }
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  if (model_.mesh.colors.cols() == 0)
    return Eigen::Vector3f::Constant(128);
  for (int k = 0; k < 3; ++k)
    color += point.weights[k] * model_.mesh.colors.col(model_.mesh.faces(k, point.face)).cast<float>();
  return color;
}

Eigen::Vector3f FullSurface::normal(const Point& point) const
{
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int k = 0; k < 3; ++k)
    sum += point.weights[k] * normals_.col(model_.mesh.faces(k, point.face));
  const float length = sum.norm();
  return length > 1e-3f ? Eigen::Vector3f(sum / length)
                        : Eigen::Vector3f(areaVector(model_.mesh, point.face).normalized().cast<float>());
}
} // namespace fresco::deliverables
