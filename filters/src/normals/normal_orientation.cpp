// SPDX-License-Identifier: BSD-3-Clause
#include "normals/occupancy.h"
#include "normals/orientation_forest.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/filters/core/normal_orientation.h>
namespace fresco {
using namespace filters;
namespace {
/// Which way normals of a patch or part point, by its points: positive = to the free side, as they are signed now.
struct Evidence {
  double sum = 0, asked = 0;
  double mean() const { return asked > 0 ? sum / asked : 0; }
};

struct Sensors {
  const Points& places;
  PointTree tree;
};

/// How certain it is, -1..1, that the normal of a point is on the free side: the side where a sensor that sees the point stands;
/// else that of the longer ways to the next surface, along the normal and 60 degrees off it: a floor meets what stands on it. A
/// way without an end counts as none where the cloud was seen from within: nobody stood there.
float freeSide(const Occupancy& occupied, const Sensors& sensors, const Eigen::Vector3f& point,
               const Eigen::Vector3f& normal)
{
  constexpr int nearest_sensors = 8;
  if (sensors.places.cols() > 0) {
    std::vector<Neighbor> near;
    sensors.tree.nearest(point, nearest_sensors, near);
    for (const Neighbor& sensor : near) {
      const Eigen::Vector3f to = sensors.places.col(sensor.index) - point;
      const float cosine = normal.dot(to) / std::max(to.norm(), 1e-30f);
      if (std::abs(cosine) > 0.1f && occupied.freeWay(point, to, 1) >= to.norm())
        return cosine > 0 ? 1.f : -1.f;
    }
  }
  const Eigen::Vector3f u = std::sqrt(3.f) * normal.unitOrthogonal(), v = normal.cross(u);
  float ahead = 0, behind = 0;
  for (const Eigen::Vector3f& off : {Eigen::Vector3f(0, 0, 0), u, v, Eigen::Vector3f(-u), Eigen::Vector3f(-v)}) {
    ahead += occupied.freeWay(point, off + normal);
    behind += occupied.freeWay(point, off - normal);
  }
  return ahead + behind > 0 ? (ahead - behind) / (ahead + behind) : 0;
}

/// Of the field's points, about `most` of each group, spread over it.
std::vector<Index> sampleOf(const std::vector<int>& groups, Index most)
{
  std::vector<Index> sizes(groups.size(), 0), seen(groups.size(), 0), chosen;
  for (const int group : groups)
    ++sizes[group];
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (seen[groups[i]]++ % (1 + sizes[groups[i]] / most) == 0)
      chosen.push_back(i);
  return chosen;
}
} // namespace

void orientToViewpoints(const Points& points, const Points& viewpoints, Points& normals, int threads)
{
  require(points.cols() == normals.cols(), "normals: ", points.cols(), " points, ", normals.cols(), " normals");
  require(viewpoints.cols() == 1 || viewpoints.cols() == points.cols(), "normals: ", viewpoints.cols(),
          " viewpoints for ", points.cols(), " points");
  parallelFor(points.cols(), threads, [&](Index i) {
    if (normals.col(i).dot(viewpoints.col(viewpoints.cols() == 1 ? 0 : i) - points.col(i)) < 0)
      normals.col(i) *= -1;
  });
}

void orientByNeighbors(const Points& points, Points& normals, int threads)
{
  require(points.cols() == normals.cols(), "normals: ", points.cols(), " points, ", normals.cols(), " normals");
  const NormalGraph field = makeNormalGraph(points, normals, threads);
  const ParityUnionFind parts = spanningForest(field, threads).parts;
  const std::vector<char> turns = partTurns(field, parts);
  for (Index i = 0; i < field.points.cols(); ++i)
    if ((parts.sign(i) < 0) != (turns[parts.root(i)] != 0))
      normals.col(field.columns[i]) *= -1;
}

void orientToFreeSide(const Points& points, const FreeSideHints& hints, Points& normals, int threads)
{
  require(points.cols() == normals.cols(), "normals: ", points.cols(), " points, ", normals.cols(), " normals");
  require(hints.sensors.allFinite(), "normals: a place of the sensor is not finite");
  constexpr Index asked_of_patch = 64, enough = 8;
  constexpr double decisive = 0.3; // of -1..1: clutter on both sides makes it smaller
  const NormalGraph field = makeNormalGraph(points, normals, threads);
  if (field.points.cols() == 0)
    return;
  const OrientationForest forest = spanningForest(field, threads);
  const Occupancy occupied(field.points, std::sqrt(median(std::vector<float>(field.areas.begin(), field.areas.end()))),
                           hints.outside);
  const Sensors sensors{hints.sensors, PointTree(hints.sensors, threads)};
  const std::vector<Index> asked = sampleOf(forest.patches, asked_of_patch);
  std::vector<float> votes(asked.size());
  parallelFor(asked.size(), threads, [&](Index k) {
    const Index i = asked[k];
    votes[k] = freeSide(occupied, sensors, field.points.col(i), field.normals.col(i));
  });
  const Index count = field.points.cols();
  std::vector<Evidence> patches(count), parts(count);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    Evidence& patch = patches[forest.patches[asked[k]]];
    patch.sum += forest.parts.sign(asked[k]) * votes[k];
    ++patch.asked;
  }
  for (Index i = 0; i < count; ++i) {
    Evidence& part = parts[forest.parts.root(i)];
    part.sum += field.areas[i] * patches[forest.patches[i]].mean();
    part.asked += field.areas[i];
  }
  const std::vector<char> turns = partTurns(field, forest.parts); // where nothing else tells
  for (Index i = 0; i < count; ++i) {
    const Evidence &patch = patches[forest.patches[i]], &part = parts[forest.parts.root(i)];
    const double told = patch.asked >= enough && std::abs(patch.mean()) >= decisive ? patch.mean() : part.mean();
    const bool turned = told != 0 ? told < 0 : turns[forest.parts.root(i)] != 0;
    if ((forest.parts.sign(i) < 0) != turned)
      normals.col(field.columns[i]) *= -1;
  }
}
} // namespace fresco
