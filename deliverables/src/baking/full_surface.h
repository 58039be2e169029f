// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/textured_mesh.h>
#include <fresco/search/ray_scene.h>
#include <fresco/search/triangle_tree.h>
namespace fresco::deliverables {
/// A model that others take their detail from.
class FullSurface {
public:
  FullSurface(const TexturedMesh& model, int threads);

  struct Point {
    Index face;
    Eigen::Vector3f weights; ///< of its corners
  };

  /// What lies across a place of another surface; see bakeDetail().
  /// @param place in the mesh's coordinates
  /// @param normal unit
  Point across(const Eigen::Vector3f& place, const Eigen::Vector3f& normal, float cage) const;

  bool hasColors() const { return has_colors_; }
  /// RGB 0..255; grey where the model has no colour.
  Eigen::Vector3f color(const Point& point) const;
  /// Unit.
  Eigen::Vector3f normal(const Point& point) const;

private:
  Eigen::Vector3f faceNormal(Index face) const;

  const TexturedMesh& model_;
  RayScene rays_;
  TriangleTree tree_;
  Points normals_; ///< 3xV
  bool has_colors_;
};
} // namespace fresco::deliverables
