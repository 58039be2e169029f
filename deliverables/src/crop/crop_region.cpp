// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/deliverables/core/crop_region.h>
namespace fresco {
namespace {
using Eigen::Vector2d;

struct Edge {
  Vector2d from, to;
  std::size_t outline;
  Eigen::Index number, count; ///< of the outline
};

std::vector<Edge> edgesOf(const std::vector<Eigen::Matrix2Xd>& outlines)
{
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < outlines.size(); ++i)
    for (Eigen::Index k = 0, n = outlines[i].cols(); k < n; ++k)
      edges.push_back({outlines[i].col(k), outlines[i].col((k + 1) % n), i, k, n});
  return edges;
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// On the line through both ends: whether the projection on it lies between them, too.
bool isBetween(const Edge& edge, const Vector2d& point) { return (point - edge.from).dot(point - edge.to) <= 0; }

bool touch(const Edge& a, const Edge& b)
{
  const Vector2d along_a = a.to - a.from, along_b = b.to - b.from;
  const double from_b = cross(along_a, b.from - a.from), to_b = cross(along_a, b.to - a.from);
  const double from_a = cross(along_b, a.from - b.from), to_a = cross(along_b, a.to - b.from);
  if (from_b * to_b < 0 && from_a * to_a < 0)
    return true;
  return (from_b == 0 && isBetween(a, b.from)) || (to_b == 0 && isBetween(a, b.to)) ||
         (from_a == 0 && isBetween(b, a.from)) || (to_a == 0 && isBetween(b, a.to));
}

/// Whether the second edge begins where the first one ends.
bool follows(const Edge& first, const Edge& second)
{
  return first.outline == second.outline && (first.number + 1) % first.count == second.number;
}

/// Edges that follow each other share a point; they must not run back over each other.
bool foldsBack(const Edge& first, const Edge& second)
{
  const Vector2d along = first.to - first.from, next = second.to - second.from;
  return cross(along, next) == 0 && along.dot(next) < 0;
}
} // namespace

void validateCropRegion(const CropRegion& region)
{
  require(region.low < region.high, "crop: from ", region.low, " to ", region.high, " there is no height");
  for (const Eigen::Matrix2Xd& outline : region.outlines) {
    require(outline.cols() >= 3, "crop: an outline of ", outline.cols(), " points");
    require(outline.allFinite(), "crop: a point of an outline is not finite");
  }
  const std::vector<Edge> edges = edgesOf(region.outlines);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    require(edges[i].from != edges[i].to, "crop: an outline has the point ", edges[i].from.transpose(), " twice");
    for (std::size_t k = 0; k < i; ++k) {
      const bool next = follows(edges[k], edges[i]), previous = follows(edges[i], edges[k]);
      const bool bad = next       ? foldsBack(edges[k], edges[i])
                       : previous ? foldsBack(edges[i], edges[k])
                                  : touch(edges[i], edges[k]);
      require(!bad, "crop: the outlines cross or touch each other near ", edges[i].from.transpose());
    }
  }
}

bool isInside(const CropRegion& region, const Eigen::Vector3d& world)
{
  const Eigen::Vector3d point = region.T_region_world * world;
  if (!(point.z() >= region.low && point.z() <= region.high))
    return false;
  bool inside = region.outlines.empty();
  for (const Eigen::Matrix2Xd& outline : region.outlines)
    for (Eigen::Index k = 0, last = outline.cols() - 1; k < outline.cols(); last = k++) {
      const Vector2d a = outline.col(last), b = outline.col(k);
      if ((a.y() > point.y()) != (b.y() > point.y()) &&
          point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        inside = !inside;
    }
  return inside;
}
} // namespace fresco
