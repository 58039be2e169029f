// SPDX-License-Identifier: BSD-3-Clause
#include "views/patch_visibility.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <limits>
namespace fresco::texture {
namespace {
/// Where places lie of a triangle.
class Triangle {
public:
  explicit Triangle(const Footprint& patch) : corners_(patch.corners)
  {
    for (int k = 0; k < 3; ++k)
      edges_.col(k) = corners_.col((k + 1) % 3) - corners_.col(k);
    if (!(cross(edges_.col(0), -edges_.col(2)) > 0)) // clockwise
      edges_ = -edges_;
    lengths_ = edges_.colwise().norm().cwiseMax(1e-6f);
  }

  /// Whether the place lies in it or at most so many cells beyond each side.
  bool holds(const Eigen::Vector2f& p, float beyond) const
  {
    for (int k = 0; k < 3; ++k)
      if (!(cross(edges_.col(k), p - corners_.col(k)) >= -beyond * lengths_[k]))
        return false;
    return true;
  }

private:
  static float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

  Eigen::Matrix<float, 2, 3> corners_, edges_;
  Eigen::RowVector3f lengths_;
};

CellBox cellsOf(const Footprint& patch, const DepthMap& map)
{
  return {std::max<int>(0, patch.corners.row(0).minCoeff() - 0.5f),
          std::min<int>(map.width - 1, patch.corners.row(0).maxCoeff() + 0.5f),
          std::max<int>(0, patch.corners.row(1).minCoeff() - 0.5f),
          std::min<int>(map.height - 1, patch.corners.row(1).maxCoeff() + 0.5f)};
}

/// Whether any cell of the box is nearer than that.
bool isAnyNearer(const DepthMap& map, const CellBox& box, float depth)
{
  for (int y = box.y0; y <= box.y1; ++y) {
    int any = 0; // without jumps: most rows have none
    const float* row = map.depth.data() + cellAt(box.x0, y, map.width);
    for (int i = 0; i <= box.x1 - box.x0; ++i)
      any |= row[i] < depth;
    if (any)
      return true;
  }
  return false;
}

/// Whether the ray through the middle of a cell ends clearly before the patch's plane.
class PlaneTest {
public:
  PlaneTest(const Footprint& patch, float tolerance)
      : patch_(patch), tolerance_(tolerance),
        slope_(std::abs(patch.inverse_depth[0]) + std::abs(patch.inverse_depth[1]))
  {}

  /// What is not nearer ends nowhere before the plane.
  float bound() const { return patch_.farthest - tolerance_ - patch_.nearest * patch_.nearest * slope_; }

  bool endsBefore(float hit, const Eigen::Vector2f& cell) const
  {
    const float inverse = patch_.inverse_depth.dot(cell.homogeneous()), z = inverse > 0 ? 1 / inverse : patch_.farthest;
    const float depth = std::clamp(z, patch_.nearest, patch_.farthest);
    return hit < depth - tolerance_ - depth * depth * slope_;
  }

private:
  const Footprint& patch_;
  float tolerance_, slope_;
};
} // namespace

float typicalDepth(const Points& vertices, const std::vector<Projector>& views)
{
  const Index stride = std::max<Index>(1, vertices.cols() / median_samples);
  std::vector<float> depths;
  for (const Projector& view : views)
    for (Index v = 0; v < vertices.cols(); v += stride) {
      const Eigen::Vector3f p = view(vertices.col(v));
      if (p.z() > 0 && p.x() >= 0 && p.y() >= 0 && p.x() <= view.camera().width && p.y() <= view.camera().height)
        depths.push_back(p.z());
    }
  if (depths.empty())
    return 0;
  return median(depths);
}

VisibilityLimits limitsFor(const PatchMesh& patches, const VisibilityInput& input)
{
  const auto& [scene, views, options, whole] = input;
  const float typical = whole ? whole->typical_depth : typicalDepth(patches.vertices, views.projectors);
  const double tolerance = views.pose_uncertainty * options.depth_tolerance * typical;
  VisibilityLimits out;
  out.tolerance = tolerance;
  out.margin = views.pose_uncertainty * options.margin;
  out.pose_uncertainty = views.pose_uncertainty;
  return out;
}

Eigen::Vector3f pixelWithin(const Projector& view, const Eigen::Vector3f& vertex)
{
  const Eigen::Vector3f p = view(vertex);
  constexpr float low = 1; // pixels: interpolation needs a neighbour
  const float right = view.camera().width - low, bottom = view.camera().height - low;
  const bool inside = p.z() > 0 && p.x() >= low && p.y() >= low && p.x() <= right && p.y() <= bottom;
  return inside ? p : Eigen::Vector3f::Zero();
}

float cosineTowards(const PatchMesh& patches, Index patch, const Projector& view)
{
  return patches.normals.col(patch).dot((view.center() - patches.middle(patch)).normalized());
}

Footprint footprintOf(const Eigen::Matrix3f& pixels, float step)
{
  Footprint out;
  out.corners = pixels.topRows<2>() / step;
  const Eigen::Vector3f inverse = pixels.row(2).cwiseInverse();
  const Eigen::Vector2f u = out.corners.col(1) - out.corners.col(0), v = out.corners.col(2) - out.corners.col(0);
  const float det = u.x() * v.y() - u.y() * v.x(), du = inverse[1] - inverse[0], dv = inverse[2] - inverse[0];
  const bool flat = std::abs(det) < 1e-6f;
  const float a = flat ? 0 : (du * v.y() - dv * u.y()) / det, b = flat ? 0 : (dv * u.x() - du * v.x()) / det;
  out.inverse_depth = {a, b, inverse[0] - a * out.corners(0, 0) - b * out.corners(1, 0)};
  out.nearest = pixels.row(2).minCoeff();
  out.farthest = pixels.row(2).maxCoeff();
  return out;
}

Visibility visibilityOf(const Footprint& patch, const DepthMap& map, float tolerance)
{
  const CellBox box = cellsOf(patch, map);
  const PlaneTest plane(patch, tolerance);
  const float bound = plane.bound();
  if (!isAnyNearer(map, box, bound))
    return Visibility::clear;
  const Eigen::Vector2i middle = patch.corners.rowwise().mean().array().floor().cast<int>().matrix();
  const Triangle triangle(patch);
  Visibility visibility = Visibility::clear;
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const float hit = map.at(x, y);
      if (!(hit < bound))
        continue;
      const Eigen::Vector2f p(x + 0.5f, y + 0.5f);
      if (!triangle.holds(p, 1) || !plane.endsBefore(hit, p))
        continue;
      if (triangle.holds(p, 0) || Eigen::Vector2i(x, y) == middle)
        return Visibility::hidden;
      visibility = Visibility::beside;
    }
  return visibility;
}

bool isSeenInPart(const Footprint& patch, const DepthMap& map, float tolerance)
{
  const CellBox box = cellsOf(patch, map);
  const PlaneTest plane(patch, tolerance);
  const Triangle triangle(patch);
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const Eigen::Vector2f p(x + 0.5f, y + 0.5f);
      if (triangle.holds(p, 0) && !plane.endsBefore(map.at(x, y), p))
        return true;
    }
  return false;
}
} // namespace fresco::texture
