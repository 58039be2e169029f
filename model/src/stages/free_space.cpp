// SPDX-License-Identifier: BSD-3-Clause
#include "stages/free_space.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/search/neighbors.h>
#include <fresco/surface/core/mesh_trimming.h>
namespace fresco::model {
namespace {
constexpr int beams_around = 8;
/// Of a border: enough to take its teeth, too few to close narrow gaps.
constexpr int smoothing_rounds = 2;
/// Share of a vertex's surroundings from which its surface stays: next to what goes nothing is certain.
constexpr float least_kept = 0.75f;
constexpr double depth_noise = 0.02; ///< of depth cameras and their poses, share of the depth

struct DepthRange {
  float least = 0, most = 0; ///< metres; 0 = not known
};

/// Depths in the 5x5 pixels around a place; not known where a third of them has no depth.
DepthRange depthAround(const Image16& image, float unit, const Eigen::Vector2d& pixel)
{
  constexpr int reach = 2;
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  DepthRange range{1e30f, 0.f};
  int known = 0;
  for (int v = y - reach; v <= y + reach; ++v)
    for (int u = x - reach; u <= x + reach; ++u) {
      if (u < 0 || v < 0 || u >= image.width || v >= image.height)
        continue;
      const std::uint16_t raw = image.data[Index(v) * image.width + u];
      if (raw == 0 || raw == 65535)
        continue;
      range.least = std::min(range.least, unit * raw);
      range.most = std::max(range.most, unit * raw);
      ++known;
    }
  return 3 * known < 2 * (2 * reach + 1) * (2 * reach + 1) ? DepthRange{} : range;
}

/// Angle, as length of a chord, within which most beams have `beams_around` neighbours; twice that is a gap.
float beamGap(const PointTree& directions, const Points& beams)
{
  std::vector<float> distances;
  std::vector<Neighbor> found;
  const Index step = std::max<Index>(1, beams.cols() / 1000);
  for (Index i = 0; i < beams.cols(); i += step) {
    directions.nearest(beams.col(i), beams_around, found);
    distances.push_back(found.back().squared_distance);
  }
  return 2.f * std::sqrt(rankedValue(distances, distances.size() * 3 / 4));
}
} // namespace

FreeSpace::FreeSpace(const Points& places, double tolerance, int threads)
    : places_(places), tolerance_(tolerance), threads_(threads), through_(places.cols()), there_(through_.size())
{
  require(tolerance > 0, "free space: a tolerance of ", tolerance, " is not positive");
}

template <typename Judge>
void FreeSpace::count(const Judge& judge)
{
  parallelFor(places_.cols(), threads_, [&](Index i) {
    const Answer answer = judge(places_.col(i));
    through_[i] += answer == Answer::Through;
    there_[i] += answer == Answer::There;
  });
}

void FreeSpace::ask(const Image16& depth, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
                    double unit)
{
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  count([&](const Eigen::Vector3f& place) {
    const Eigen::Vector3d p = T_camera_world * place.cast<double>();
    if (!(p.z() > 0.1))
      return Answer::Unknown;
    const Eigen::Vector2d pixel = project(camera, p);
    if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < depth.width && pixel.y() < depth.height))
      return Answer::Unknown;
    const DepthRange range = depthAround(depth, unit, pixel);
    const double slack = tolerance_ + depth_noise * p.z();
    if (range.most == 0.f || p.z() > range.most + slack)
      return Answer::Unknown;
    return range.least > p.z() + slack ? Answer::Through : Answer::There;
  });
}

void FreeSpace::ask(const Points& scan, const Eigen::Isometry3d& T_world_scan)
{
  Points beams(3, scan.cols());
  Eigen::VectorXf ranges(scan.cols());
  Index kept = 0;
  for (Index i = 0; i < scan.cols(); ++i)
    if (const float range = scan.col(i).norm(); std::isfinite(range) && range > 0.f) {
      ranges[kept] = range;
      beams.col(kept++) = scan.col(i) / range;
    }
  if (kept < beams_around)
    return;
  beams.conservativeResize(3, kept);
  const PointTree directions(beams, threads_);
  const float gap = beamGap(directions, beams);
  const Eigen::Isometry3d T_scan_world = T_world_scan.inverse();
  count([&](const Eigen::Vector3f& place) {
    const Eigen::Vector3f p = (T_scan_world * place.cast<double>()).cast<float>();
    const float range = p.norm();
    std::vector<Neighbor> around;
    if (range > 0.f)
      directions.nearest(p / range, beams_around, around);
    if (around.empty() || !(around.back().squared_distance < gap * gap))
      return Answer::Unknown;
    float least = ranges[around[0].index], most = least;
    for (const Neighbor& beam : around) {
      least = std::min(least, ranges[beam.index]);
      most = std::max(most, ranges[beam.index]);
    }
    const float slack = tolerance_;
    return range > most + slack ? Answer::Unknown : least > range + slack ? Answer::Through : Answer::There;
  });
}

std::vector<char> FreeSpace::empty(int least) const
{
  std::vector<char> result(through_.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = through_[i] >= least && through_[i] > 2 * there_[i];
  return result;
}

TriangleMesh withoutVertices(const TriangleMesh& mesh, std::vector<char> removed)
{
  require(Index(removed.size()) == mesh.vertexCount(), "mesh: ", mesh.vertexCount(), " vertices, ", removed.size(),
          " marks");
  for (int round = 0; round < 3; ++round) {
    std::vector<int> votes(removed.size(), 0); // for removal less against it, each edge counted once per face
    for (Index f = 0; f < mesh.faceCount(); ++f)
      for (int k = 0; k < 3; ++k)
        for (int other = 1; other < 3; ++other)
          votes[mesh.faces(k, f)] += removed[mesh.faces((k + other) % 3, f)] ? 1 : -1;
    for (std::size_t v = 0; v < removed.size(); ++v)
      removed[v] = votes[v] != 0 ? votes[v] > 0 : removed[v];
  }
  const auto marks = Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>>(removed.data(), mesh.vertexCount());
  return trimMesh(mesh, 1.f - marks.cast<float>().array(), {least_kept, 0.0, 0.0, smoothing_rounds});
}
} // namespace fresco::model
