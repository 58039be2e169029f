// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/rgbd_walk.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/simulation/sensors/random.h>
#include <iomanip>
#include <limits>
#include <queue>
namespace fresco::simulation {
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
constexpr double longest_step = 0.015; // metres a frame: 0.45 m a second

/// Free places, and which of them see each other.
struct PathGraph {
  Points places;
  std::vector<std::vector<Index>> neighbors;

  explicit PathGraph(const PlanningInput& in)
  {
    PlaceRules rules;
    rules.heights = {1.4f};
    rules.spacing = 0.35f;
    rules.clearance = 0.4f;
    rules.on_floor = false;
    places = freePlaces(in, rules);
    neighbors.resize(places.cols());
    const float reach = 0.9f * sceneUnit(in.scene);
    for (Index i = 0; i < places.cols(); ++i)
      for (Index j = 0; j < places.cols(); ++j) {
        const Vector3f way = places.col(j) - places.col(i);
        if (i != j && way.norm() < reach && !(in.rays.intersect(Ray{places.col(i), way}).distance < 1.f))
          neighbors[i].push_back(j);
      }
  }

  /// Lengths of the shortest ways from a place and the place before each on them.
  std::pair<std::vector<double>, std::vector<Index>> ways(Index from) const
  {
    std::vector<double> length(places.cols(), std::numeric_limits<double>::infinity());
    std::vector<Index> before(places.cols(), -1);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    queue.push({length[from] = 0, from});
    while (!queue.empty()) {
      const auto [far, at] = queue.top();
      queue.pop();
      if (far > length[at])
        continue;
      for (const Index next : neighbors[at]) {
        const double sum = far + (places.col(next) - places.col(at)).norm();
        if (sum < length[next]) {
          length[next] = sum;
          before[next] = at;
          queue.push({sum, next});
        }
      }
    }
    return {length, before};
  }
};

/// From one end of the free space to places far from all before, and back to the first.
std::vector<Vector3d> tour(const PathGraph& graph)
{
  constexpr int stops = 5;
  std::vector<Index> visited = {0};
  const std::size_t most = std::max_element(graph.neighbors.begin(), graph.neighbors.end(),
                                            [](const auto& a, const auto& b) { return a.size() < b.size(); }) -
                           graph.neighbors.begin();
  visited[0] = static_cast<Index>(most); // in the open
  std::vector<double> nearest = graph.ways(visited[0]).first;
  for (int k = 1; k < stops; ++k) {
    Index far = visited[0];
    for (std::size_t i = 0; i < nearest.size(); ++i)
      if (std::isfinite(nearest[i]) && nearest[i] > nearest[far])
        far = i;
    visited.push_back(far);
    const std::vector<double> other = graph.ways(far).first;
    for (std::size_t i = 0; i < nearest.size(); ++i)
      nearest[i] = std::min(nearest[i], other[i]);
  }
  visited.push_back(visited[0]);
  std::vector<Vector3d> path = {graph.places.col(visited[0]).cast<double>()};
  for (std::size_t k = 1; k < visited.size(); ++k) {
    const std::vector<Index> before = graph.ways(visited[k - 1]).second;
    std::vector<Vector3d> way;
    for (Index at = visited[k]; at >= 0 && at != visited[k - 1]; at = before[at])
      way.push_back(graph.places.col(at).cast<double>());
    path.insert(path.end(), way.rbegin(), way.rend());
  }
  return path;
}

/// Points at equal steps along a path, as many as there are frames.
std::vector<Vector3d> walked(const std::vector<Vector3d>& path, int frames, double step)
{
  std::vector<Vector3d> points;
  std::size_t leg = 0;
  double along = 0;
  for (int f = 0; f < frames; ++f) {
    for (; leg + 1 < path.size() && along > (path[leg + 1] - path[leg]).norm(); ++leg)
      along -= (path[leg + 1] - path[leg]).norm();
    const Vector3d way = leg + 1 < path.size() ? Vector3d(path[leg + 1] - path[leg]) : Vector3d(Vector3d::Zero());
    points.push_back(path[std::min(leg, path.size() - 1)] +
                     (way.norm() > 0 ? Vector3d(along * way.normalized()) : Vector3d(Vector3d::Zero())));
    along += step;
  }
  return points;
}

/// Means over a window that slides; the ends are repeated.
template <typename Value>
std::vector<Value> smoothed(const std::vector<Value>& values, int radius)
{
  std::vector<Value> result;
  const int count = static_cast<int>(values.size());
  for (int i = 0; i < count; ++i) {
    Value sum = values[i];
    for (int k = 1; k <= radius; ++k)
      sum += values[std::max(0, i - k)] + values[std::min(count - 1, i + k)];
    result.push_back(sum / (2.0 * radius + 1.0));
  }
  return result;
}

std::string frameName(std::size_t frame) { return concat("frame-", std::setfill('0'), std::setw(6), frame); }
} // namespace

std::vector<Eigen::Isometry3d> planWalk(const PlanningInput& in, int frames)
{
  const std::vector<Vector3d> path = tour(PathGraph(in));
  double length = 0;
  for (std::size_t k = 1; k < path.size(); ++k)
    length += (path[k] - path[k - 1]).norm();
  const double step = std::min(longest_step, length / frames);
  std::vector<Vector3d> places = walked(path, frames, step);
  places = smoothed(smoothed(places, 15), 15);
  std::vector<double> headings;
  for (int f = 0; f < frames; ++f) {
    const Vector3d way = places[std::min(f + 5, frames - 1)] - places[std::max(f - 5, 0)];
    double heading = way.norm() > 1e-6 ? std::atan2(way.y(), way.x()) : headings.empty() ? 0 : headings.back();
    if (!headings.empty())
      heading += 2 * pi * std::round((headings.back() - heading) / (2 * pi));
    headings.push_back(heading);
  }
  headings = smoothed(smoothed(headings, 30), 30);
  std::vector<Eigen::Isometry3d> poses;
  for (int f = 0; f < frames; ++f) {
    const double t = f / 30.0; // seconds
    const double yaw = headings[f] + 0.5 * std::sin(1.1 * t), pitch = -0.25 + 0.15 * std::sin(0.7 * t + 1);
    const double roll = 0.05 * std::sin(1.7 * t) + 0.01 * std::sin(9 * t);
    const Vector3d forward(std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch));
    const Vector3d right(std::sin(yaw), -std::cos(yaw), 0);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << right, forward.cross(right), forward;
    T.rotate(Eigen::AngleAxisd(roll, Vector3d::UnitZ()));
    const Vector3d sway(0.01 * std::sin(5 * t), 0.01 * std::sin(4.3 * t + 2), 0.02 * std::sin(11 * t));
    T.translation() = places[f] + sway + in.scene.mesh.origin;
    poses.push_back(T);
  }
  return poses;
}

Image16 takeDepthImage(const LitScene& lit, const Shot& shot, int threads)
{
  constexpr double farthest = 8, jump = 0.05; // metres; of the depth
  constexpr double disparity = 351.3;         // units times metres: a unit is 1.1 cm at 2 m
  const CameraModel& camera = shot.camera;
  const Eigen::Isometry3d T_world_camera = shot.view.T_camera_world.inverse();
  const Vector3f center = (T_world_camera.translation() - lit.scene.mesh.origin).cast<float>();
  const auto depthAt = [&](double u, double v) -> double { // pixels
    const Vector3f beam = (T_world_camera.linear() * unproject(camera, {u, v})).cast<float>();
    const RayHit hit = lit.rays.intersect(Ray{center, beam});
    constexpr float grazing = 0.1f; // cosine of the incidence: hardly any light comes back
    if (hit.face < 0 || std::fabs(faceNormal(lit.scene.mesh, hit.face).dot(beam.normalized())) < grazing)
      return 0;
    return hit.distance;
  };
  Image16 image{camera.width, camera.height, {}};
  image.data.resize(std::size_t(camera.width) * camera.height);
  parallelFor(camera.height, threads, [&](Index y) {
    for (int x = 0; x < camera.width; ++x) {
      CounterRandom random(shot.exposure.seed, 71 + shot.exposure.number, y * camera.width + x);
      const double du = 0.5 * random.gaussian(), dv = 0.5 * random.gaussian();
      const double z = depthAt(x + 0.5 + du, y + 0.5 + dv);
      if (!(z > 0) || z > farthest)
        continue;
      const double beside = depthAt(x + 2.5, y + 0.5), other = depthAt(x - 1.5, y + 0.5);
      const bool edge = std::fabs(beside - z) > jump * z || std::fabs(other - z) > jump * z;
      if (edge && random.uniform() < 0.5)
        continue;
      const double seen = disparity / std::max(1.0, std::round(disparity / z + random.gaussian() / 6));
      image.data[y * camera.width + x] = static_cast<std::uint16_t>(std::clamp(1000 * seen + 0.5, 0.0, 65000.0));
    }
  });
  return image;
}

void writeRgbdWalk(const LitScene& lit, const std::string& folder, const std::vector<Eigen::Isometry3d>& T_world_camera,
                   const RgbdWalkOptions& options, const Progress& progress)
{
  makeFolder(folder);
  CameraModel camera;
  camera.width = options.width, camera.height = options.height;
  camera.fx = camera.fy = 0.82 * options.width; // of usual devices
  camera.cx = 0.5 * options.width, camera.cy = 0.5 * options.height;
  writeFile(folder + "/camera-intrinsics.txt",
            concat(camera.fx, " 0 ", camera.cx - 0.5, "\n0 ", camera.fy, " ", camera.cy - 0.5, "\n0 0 1\n"));
  std::vector<Pose> poses;
  for (std::size_t f = 0; f < T_world_camera.size(); ++f) {
    report(progress, concat("frame ", f + 1, " of ", T_world_camera.size()), double(f) / T_world_camera.size());
    View view;
    view.T_camera_world = T_world_camera[f].inverse();
    Exposure exposure;
    exposure.gain *= static_cast<float>(1 + 0.08 * std::sin(0.02 * f)); // the device adapts to the light
    exposure.noise = 2.f;
    exposure.blur = 0.6f;
    exposure.seed = options.seed;
    exposure.number = f;
    const Shot shot{camera, view, exposure};
    const std::string stem = folder + "/" + frameName(f);
    writeImage(stem + ".color.jpg", takePhotograph(lit, shot, options.threads), options.jpeg_quality);
    writeImage(stem + ".depth.png", takeDepthImage(lit, shot, options.threads));
    poses.emplace_back(T_world_camera[f].matrix());
  }
  writePoses(folder + "/poses.txt", poses);
}
} // namespace fresco::simulation
