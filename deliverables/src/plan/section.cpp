// SPDX-License-Identifier: BSD-3-Clause
#include "plan/section.h"
#include <algorithm>
#include <cstdint>
#include <fresco/core/require.h>
#include <unordered_map>
namespace fresco {
namespace plan {
namespace {
/// A face meets the plane along a segment, from the edge that rises through it to the edge that falls.
struct Segment {
  std::uint64_t from = 0, to = 0; ///< names of these edges
  Eigen::Vector3d a, b;
};

std::uint64_t edgeName(int u, int v) { return std::uint64_t(std::min(u, v)) << 32 | std::uint32_t(std::max(u, v)); }

std::vector<Segment> cutFaces(const MeshToCut& mesh, const Eigen::Vector3d& axis, double offset)
{
  std::vector<Segment> segments;
  const Eigen::VectorXd heights = (axis.transpose() * mesh.vertices.cast<double>()).transpose().array() - offset;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    Segment segment;
    int crossings = 0;
    for (int k = 0; k < 3; ++k) {
      const int u = mesh.faces(k, f), v = mesh.faces((k + 1) % 3, f);
      if ((heights[u] >= 0) == (heights[v] >= 0))
        continue;
      // from the lower name on, so that both faces at an edge get the same bits
      const int p = std::min(u, v), q = std::max(u, v);
      const double t = heights[p] / (heights[p] - heights[q]);
      const Eigen::Vector3d a = mesh.vertices.col(p).cast<double>(), b = mesh.vertices.col(q).cast<double>();
      const bool rises = heights[v] >= 0;
      (rises ? segment.a : segment.b) = a + t * (b - a);
      (rises ? segment.from : segment.to) = edgeName(u, v);
      ++crossings;
    }
    if (crossings == 2)
      segments.push_back(segment);
  }
  return segments;
}
} // namespace

std::vector<Eigen::Matrix3Xd> cutLines(const MeshToCut& mesh, const Eigen::Vector3d& axis, double offset)
{
  const std::vector<Segment> segments = cutFaces(mesh, axis, offset);
  std::unordered_multimap<std::uint64_t, std::size_t> starting;
  std::unordered_map<std::uint64_t, int> ends;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    starting.emplace(segments[i].from, i);
    ++ends[segments[i].to];
  }
  std::vector<bool> used(segments.size(), false);
  std::vector<Eigen::Matrix3Xd> lines;
  const auto follow = [&](std::size_t first) {
    std::vector<Eigen::Vector3d> line{segments[first].a};
    for (std::size_t i = first; i < segments.size();) {
      used[i] = true;
      line.push_back(segments[i].b);
      const auto [begin, end] = starting.equal_range(segments[i].to);
      i = segments.size();
      for (auto next = begin; next != end; ++next)
        if (!used[next->second])
          i = std::min(i, next->second);
    }
    lines.emplace_back(3, line.size());
    for (std::size_t k = 0; k < line.size(); ++k)
      lines.back().col(k) = line[k];
  };
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!used[i] && ends.count(segments[i].from) == 0)
      follow(i);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!used[i])
      follow(i);
  return lines;
}
} // namespace plan

std::vector<Eigen::Matrix3Xd> cutMesh(const TriangleMesh& mesh, const Eigen::Vector3d& axis, double offset)
{
  validateMesh(mesh);
  require(std::abs(axis.norm() - 1) < 1e-6 && std::isfinite(offset), "section: the axis is not of unit length, or a "
                                                                     "value is not finite");
  std::vector<Eigen::Matrix3Xd> lines =
      plan::cutLines({mesh.vertices, weldedFaces(mesh)}, axis, offset - axis.dot(mesh.origin));
  for (Eigen::Matrix3Xd& line : lines)
    line.colwise() += mesh.origin;
  return lines;
}
} // namespace fresco
