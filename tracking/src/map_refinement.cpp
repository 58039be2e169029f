// SPDX-License-Identifier: BSD-3-Clause
#include "map_refinement.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel_batches.h>
#include <fresco/core/union_find.h>
#include <map>
#include <queue>
namespace fresco::tracking {
namespace {
/// Points of a key frame, few, for estimates of overlap.
struct Sketch {
  Points points;
};

Sketch sketchOf(const KeyFrame& key, const RgbdCameras& cameras)
{
  const RgbdLevel& level = key.pyramid.levels.back();
  const Pinhole K = halved(cameras.depth, level.depth_halvings);
  constexpr int stride = 3; // pixels of the coarsest level: some hundred points
  std::vector<Eigen::Vector3f> points;
  for (int y = 0; y < level.depth.height; y += stride)
    for (int x = 0; x < level.depth.width; x += stride)
      if (const float z = level.depth.row(y)[x]; z > 0.f)
        points.emplace_back(z * (x - K.cx) / K.fx, z * (y - K.cy) / K.fy, z);
  Sketch sketch{Points(3, points.size())};
  for (std::size_t i = 0; i < points.size(); ++i)
    sketch.points.col(i) = points[i];
  return sketch;
}

/// Share of the points of b that a sees at about the same place.
double sharedView(const Sketch& b, const KeyFrame& a, const RgbdCameras& cameras, const Eigen::Isometry3d& T_a_b)
{
  constexpr float same = 0.1f; // of the depth: poses are not yet exact
  const RgbdLevel& level = a.pyramid.levels.back();
  const Pinhole K = halved(cameras.depth, level.depth_halvings);
  const Eigen::Isometry3f T = T_a_b.cast<float>();
  Index seen = 0;
  for (Index i = 0; i < b.points.cols(); ++i) {
    const Eigen::Vector3f p = T * b.points.col(i);
    const float u = p.x() / p.z() * K.fx + K.cx + 0.5f, v = p.y() / p.z() * K.fy + K.cy + 0.5f;
    if (p.z() > 0.f && u >= 0.f && v >= 0.f && u < level.depth.width && v < level.depth.height)
      seen += std::fabs(level.depth.row(static_cast<int>(v))[static_cast<int>(u)] - p.z()) < same * p.z();
  }
  return double(seen) / std::max<Index>(1, b.points.cols());
}

/// For each key frame the pairs (a, b), a < b, to be aligned, those of most overlap first.
std::vector<std::vector<Index>> overlappingPairs(const TrackingMap& map, const IsometryVector& poses, int threads)
{
  constexpr double least_overlap = 0.4;
  constexpr std::size_t most = 10; // partners of each: more cost time and hardly tell anything new
  const Index count = map.key_frames.size();
  const Submaps submaps = findSubmaps(map);
  std::vector<Sketch> sketches(count);
  parallelFor(count, threads, [&](Index k) { sketches[k] = sketchOf(map.key_frames[k], map.cameras); });
  std::vector<std::vector<Index>> partners(count);
  parallelFor(count, threads, [&](Index a) {
    std::vector<std::pair<double, Index>> order;
    for (Index b = a + 1; b < count; ++b) {
      const Eigen::Isometry3d T = poses[a].inverse() * poses[b];
      if (submaps.of[a] != submaps.of[b] || T.linear()(2, 2) < 0.3) // looks another way
        continue;
      const double overlap = std::min(sharedView(sketches[b], map.key_frames[a], map.cameras, T),
                                      sharedView(sketches[a], map.key_frames[b], map.cameras, T.inverse()));
      if (overlap >= least_overlap)
        order.emplace_back(-overlap, b);
    }
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), most));
    for (const auto& [overlap, b] : order)
      partners[a].push_back(b);
  });
  return partners;
}
} // namespace

Submaps findSubmaps(const TrackingMap& map)
{
  const Index count = map.key_frames.size();
  UnionFind joined(count);
  for (const KeyFrameEdge& edge : map.edges)
    joined.join(edge.a, edge.b);
  Submaps submaps;
  std::map<Index, Index> numbers;
  for (Index k = 0; k < count; ++k)
    submaps.of.push_back(numbers.try_emplace(joined.root(k), numbers.size()).first->second);
  submaps.frames.assign(numbers.size(), 0);
  for (const FramePlace& place : map.frames)
    if (place.key_frame >= 0)
      ++submaps.frames[submaps.of[place.key_frame]];
  return submaps;
}

IsometryVector chainPoses(const TrackingMap& map)
{
  const Index count = map.key_frames.size();
  IsometryVector poses(count, Eigen::Isometry3d::Identity());
  std::vector<std::vector<std::pair<Index, Eigen::Isometry3d>>> neighbors(count);
  for (const KeyFrameEdge& edge : map.edges) {
    neighbors[edge.a].emplace_back(edge.b, edge.T_a_b);
    neighbors[edge.b].emplace_back(edge.a, edge.T_a_b.inverse());
  }
  std::vector<char> known(count, 0);
  for (Index root = 0; root < count; ++root) {
    if (known[root])
      continue;
    using Step = std::pair<std::pair<Index, Index>, Eigen::Isometry3d>; // (distance in time, key frame), pose
    const auto later = [](const Step& x, const Step& y) { return x.first > y.first; };
    std::priority_queue<Step, std::vector<Step>, decltype(later)> queue(later);
    queue.push({{0, root}, Eigen::Isometry3d::Identity()});
    while (!queue.empty()) {
      const auto [key, pose] = queue.top();
      queue.pop();
      if (known[key.second])
        continue;
      known[key.second] = 1;
      poses[key.second] = pose;
      for (const auto& [next, T] : neighbors[key.second])
        if (!known[next])
          queue.push({{std::abs(next - key.second), next}, pose * T});
    }
  }
  return poses;
}

IsometryVector solvePoses(const TrackingMap& map, const IsometryVector& start)
{
  registration::PoseGraphOptions options;
  options.tolerance = 0.03; // metres by which two key frames are off: beyond, one of the two is of another place
  const Submaps submaps = findSubmaps(map);
  options.fixed.assign(start.size(), 0);
  std::vector<char> begun(submaps.frames.size(), 0);
  for (std::size_t k = 0; k < start.size(); ++k)
    if (!begun[submaps.of[k]]) {
      begun[submaps.of[k]] = 1;
      options.fixed[k] = 1;
    }
  return registration::optimizePoseGraph(start, map.edges, options);
}

void refineMap(TrackingMap& map, IsometryVector& poses, int threads, const Progress& progress)
{
  const Index count = map.key_frames.size();
  const std::vector<std::vector<Index>> partners = overlappingPairs(map, poses, threads);
  std::vector<KeyFrameEdges> found(count);
  const auto align = [&](Index a) {
    const ReferenceFrame reference = makeReference(map.key_frames[a].pyramid, map.cameras);
    for (const Index b : partners[a])
      for (const KeyFrameEdge& edge : alignBothWays(map, {a, b, poses[a].inverse() * poses[b]}, 1, reference))
        found[a].push_back(edge);
  };
  parallelBatches(count, threads, progress, "refine", align);
  std::map<std::pair<Index, Index>, bool> measured;
  KeyFrameEdges edges;
  for (const KeyFrameEdges& of_one : found)
    for (const KeyFrameEdge& edge : of_one) {
      edges.push_back(edge);
      measured[std::minmax(edge.a, edge.b)] = true;
    }
  for (const KeyFrameEdge& edge : map.edges) // that hold what these do not
    if (!measured.count(std::minmax(edge.a, edge.b)))
      edges.push_back(edge);
  map.edges = std::move(edges);
  poses = solvePoses(map, poses);
}
} // namespace fresco::tracking
