// SPDX-License-Identifier: BSD-3-Clause
#include "views/patch_visibility.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <limits>
namespace fresco::texture {
namespace {
/// Median distance of the surface within the images, from what stands before it or not; mesh units.
float typicalDepth(const PatchMesh& patches, const std::vector<Projector>& views)
{
  constexpr Index samples = 2000; // enough for a median
  const Index stride = std::max<Index>(1, patches.vertices.cols() / samples);
  std::vector<float> depths;
  for (const Projector& view : views)
    for (Index v = 0; v < patches.vertices.cols(); v += stride) {
      const Eigen::Vector3f p = view(patches.vertices.col(v));
      if (p.z() > 0 && p.x() >= 0 && p.y() >= 0 && p.x() <= view.camera().width && p.y() <= view.camera().height)
        depths.push_back(p.z());
    }
  if (depths.empty())
    return 0;
  return median(depths);
}

/// Cells from a place to the triangle's nearest side, positive inside; some number below -1 where it lies further out.
float depthInside(const Footprint& patch, const Eigen::Vector2f& p)
{
  const auto& c = patch.corners;
  const Eigen::Vector2f u = c.col(1) - c.col(0), v = c.col(2) - c.col(0);
  const float turn = u.x() * v.y() - u.y() * v.x() > 0 ? 1.f : -1.f;
  float depth = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3 && depth >= -1; ++k) {
    const Eigen::Vector2f edge = c.col((k + 1) % 3) - c.col(k), to = p - c.col(k);
    depth = std::min(depth, turn * (edge.x() * to.y() - edge.y() * to.x()) / std::max(edge.norm(), 1e-6f));
  }
  return depth;
}

/// Cells around a patch's corners.
struct CellBox {
  int x0, x1, y0, y1; ///< both ends included
};

CellBox cellsOf(const Footprint& patch, const DepthMap& map)
{
  return {std::max<int>(0, patch.corners.row(0).minCoeff() - 0.5f),
          std::min<int>(map.width - 1, patch.corners.row(0).maxCoeff() + 0.5f),
          std::max<int>(0, patch.corners.row(1).minCoeff() - 0.5f),
          std::min<int>(map.height - 1, patch.corners.row(1).maxCoeff() + 0.5f)};
}

/// Whether the ray through the middle of a cell ends clearly before the patch's plane.
class PlaneTest {
public:
  PlaneTest(const Footprint& patch, float tolerance)
      : patch_(patch), tolerance_(tolerance),
        slope_(std::abs(patch.inverse_depth[0]) + std::abs(patch.inverse_depth[1]))
  {}

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

VisibilityLimits limitsFor(const PatchMesh& patches, const ViewList& views, const TextureOptions& options)
{
  const double tolerance = views.pose_uncertainty * options.depth_tolerance * typicalDepth(patches, views.projectors);
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
  const Eigen::Vector2i middle = patch.corners.rowwise().mean().array().floor().cast<int>().matrix();
  const PlaneTest plane(patch, tolerance);
  Visibility visibility = Visibility::clear;
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const float hit = map.at(x, y);
      if (!(hit < patch.farthest - tolerance))
        continue;
      const Eigen::Vector2f p(x + 0.5f, y + 0.5f);
      const float inside = depthInside(patch, p);
      if (inside < -1 || !plane.endsBefore(hit, p))
        continue;
      if (inside >= 0 || Eigen::Vector2i(x, y) == middle)
        return Visibility::hidden;
      visibility = Visibility::beside;
    }
  return visibility;
}

bool isSeenInPart(const Footprint& patch, const DepthMap& map, float tolerance)
{
  const CellBox box = cellsOf(patch, map);
  const PlaneTest plane(patch, tolerance);
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x) {
      const Eigen::Vector2f p(x + 0.5f, y + 0.5f);
      if (depthInside(patch, p) >= 0 && !plane.endsBefore(map.at(x, y), p))
        return true;
    }
  return false;
}
} // namespace fresco::texture
