// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/isosurface/polygon.h"
#include <Eigen/Geometry>
#include <cmath>
namespace fresco::poisson {
namespace {
/// Polygons with more corners, which are rare, get a centre vertex: the search for the best triangles takes their cube.
constexpr std::size_t most_corners = 12;
} // namespace

const int face_corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

FaceCrossings crossFace(const float chi[4])
{
  FaceCrossings crossings;
  const auto inside = [&](int k) { return chi[k & 3] < 0.f; };
  const bool alternating = inside(0) == inside(2) && inside(1) == inside(3) && inside(0) != inside(1);
  const double c[4] = {chi[0], chi[1], chi[2], chi[3]};
  const double even = c[0] * c[2], odd = c[1] * c[3];
  const bool inside_connected = inside(0) ? even > odd : odd > even;
  for (int k = 0; k < 4; ++k) {
    if (!inside(k) || inside(k + 1))
      continue; // the side does not leave the inside
    int to = (k + 1) & 3;
    if (alternating && !inside_connected)
      to = (k + 3) & 3;
    else
      while (inside(to) || !inside(to + 1))
        to = (to + 1) & 3;
    crossings.from[crossings.count] = to;
    crossings.to[crossings.count++] = k;
  }
  return crossings;
}

void CellPolygons::triangulate(const Eigen::Matrix3Xf& positions, Array<int>& faces, Array<Eigen::Vector3f>& extra)
{
  used_.assign(segments_.size(), 0);
  for (std::size_t s = 0; s < segments_.size(); ++s)
    if (!used_[s]) {
      nextPolygon(s);
      triangulatePolygon(positions, faces, extra);
    }
}

void CellPolygons::nextPolygon(std::size_t first)
{
  polygon_.clear();
  unsigned face_before = 0;
  for (std::size_t s = first; s < segments_.size();) {
    used_[s] = 1;
    const unsigned face = 1u << segments_[s].face;
    polygon_.push_back({segments_[s].from, face | face_before});
    face_before = face;
    std::size_t next = segments_.size();
    for (std::size_t t = 0; t < segments_.size(); ++t)
      if (!used_[t] && segments_[t].from == segments_[s].to)
        next = t;
    s = next;
  }
  polygon_.front().faces |= face_before;
}

void CellPolygons::triangulatePolygon(const Eigen::Matrix3Xf& positions, Array<int>& faces,
                                      Array<Eigen::Vector3f>& extra) const
{
  const std::size_t n = polygon_.size();
  if (n < 3)
    return;
  if (n == 3) {
    faces.insert(faces.end(), {polygon_[0].vertex, polygon_[1].vertex, polygon_[2].vertex});
    return;
  }
  if (n <= most_corners && cheapestTriangles(positions, faces))
    return;
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  for (const Corner& corner : polygon_)
    center += positions.col(corner.vertex) / n;
  const int index = extra.size();
  extra.push_back(center);
  for (std::size_t i = 0; i < n; ++i)
    faces.insert(faces.end(), {polygon_[i].vertex, polygon_[(i + 1) % n].vertex, -1 - index});
}

/// Least total area, by dynamic programming over the corner intervals.
bool CellPolygons::cheapestTriangles(const Eigen::Matrix3Xf& positions, Array<int>& faces) const
{
  const int n = polygon_.size();
  float cost[most_corners][most_corners];
  int middle[most_corners][most_corners];
  Eigen::Vector3f p[most_corners];
  for (int i = 0; i < n; ++i)
    p[i] = positions.col(polygon_[i].vertex);
  const auto shareFace = [&](int i, int j) { return (polygon_[i].faces & polygon_[j].faces) != 0; };
  for (int length = 1; length < n; ++length)
    for (int i = 0; i + length < n; ++i) {
      const int j = i + length;
      cost[i][j] = length == 1 ? 0.f : HUGE_VALF;
      const bool side = length == 1 || length == n - 1;
      if (length == 1 || (!side && shareFace(i, j)))
        continue;
      for (int k = i + 1; k < j; ++k) {
        const float c = cost[i][k] + cost[k][j] + (p[k] - p[i]).cross(p[j] - p[i]).norm();
        if (c < cost[i][j]) {
          cost[i][j] = c;
          middle[i][j] = k;
        }
      }
    }
  if (!(cost[0][n - 1] < HUGE_VALF))
    return false;
  int stack[most_corners][2] = {{0, n - 1}}, depth = 1;
  while (depth > 0) {
    const int i = stack[--depth][0], j = stack[depth][1];
    if (j - i < 2)
      continue;
    const int k = middle[i][j];
    const auto vertex = [&](int c) { return polygon_[c].vertex; };
    faces.insert(faces.end(), {vertex(i), vertex(k), vertex(j)});
    stack[depth][0] = i;
    stack[depth++][1] = k;
    stack[depth][0] = k;
    stack[depth++][1] = j;
  }
  return true;
}
} // namespace fresco::poisson
