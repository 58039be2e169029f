// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/sensors/random.h>
namespace fresco::simulation {
using Eigen::Vector3f;

namespace {
constexpr int probe_rays = 256;

/// Evenly spread directions (Fibonacci lattice on the sphere).
Vector3f probeDirection(int i)
{
  const float z = 1.f - 2.f * (i + 0.5f) / probe_rays, r = std::sqrt(1.f - z * z);
  const float angle = 2.3999632f * i;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Whether the surfaces that can be seen from a place turn their front to it and keep their distance.
bool isFree(const PlanningInput& in, const Vector3f& place, float clearance)
{
  int hits = 0, fronts = 0;
  for (int i = 0; i < probe_rays; ++i) {
    const Vector3f direction = probeDirection(i);
    const RayHit hit = in.rays.intersect({place, direction});
    if (hit.face < 0)
      continue;
    if (hit.distance < clearance)
      return false;
    ++hits;
    if (faceNormal(in.scene.mesh, hit.face).dot(direction) < 0.f)
      ++fronts;
  }
  const int least = in.scene.furnished ? probe_rays : 1; // a room is closed
  if (hits < least || 10 * fronts < 9 * hits)
    return false;
  const float nearest = (in.samples.positions.colwise() - place).colwise().squaredNorm().minCoeff();
  return nearest >= clearance * clearance;
}

bool aboveFloor(const PlanningInput& in, const Vector3f& place)
{
  const RayHit hit = in.rays.intersect({place, -Vector3f::UnitZ()});
  const auto meets = [&](float floor) { return std::fabs(place.z() - hit.distance - floor) < 0.02f; };
  return hit.face >= 0 && std::any_of(in.scene.floors.begin(), in.scene.floors.end(), meets);
}

Eigen::AlignedBox3f bounds(const Scene& scene)
{
  return {scene.mesh.vertices.rowwise().minCoeff(), scene.mesh.vertices.rowwise().maxCoeff()};
}

std::vector<Vector3f> roomGrid(const PlanningInput& in, const PlaceRules& rules)
{
  const Eigen::AlignedBox3f box = bounds(in.scene);
  CounterRandom random(in.seed, 41, 0);
  const auto stray = [&](float range) { return range * random.uniformFloat(-1, 1); };
  std::vector<Vector3f> grid;
  for (float x = box.min().x() + rules.spacing; x < box.max().x(); x += rules.spacing)
    for (float y = box.min().y() + rules.spacing; y < box.max().y(); y += rules.spacing)
      for (const float floor : in.scene.floors)
        for (const float height : rules.heights)
          grid.push_back(
              {x + stray(0.3f * rules.spacing), y + stray(0.3f * rules.spacing), floor + height + stray(0.1f)});
  return grid;
}

/// All around and inside of a mesh.
std::vector<Vector3f> meshGrid(const PlanningInput& in)
{
  constexpr int steps = 13;
  const Eigen::AlignedBox3f box = bounds(in.scene);
  const float unit = sceneUnit(in.scene);
  const Vector3f low = box.min().array() - 1.5f * unit, high = box.max().array() + 1.5f * unit;
  CounterRandom random(in.seed, 42, 0);
  std::vector<Vector3f> grid;
  for (int i = 0; i < steps * steps * steps; ++i) {
    const Vector3f cell(i % steps, i / steps % steps, i / steps / steps);
    const Vector3f stray(random.uniformFloat(), random.uniformFloat(), random.uniformFloat());
    grid.push_back(low + (cell + stray).cwiseProduct(high - low) / steps);
  }
  return grid;
}

/// Place that adds most to what `seen` counts; each further view of a sample is worth half of the one before.
Index bestStation(const Eigen::MatrixXf& sees, const Eigen::VectorXi& seen, const std::vector<bool>& taken)
{
  Index best = -1;
  float most = -1.f;
  for (const bool linked : {true, false}) {
    for (Index p = 0; p < sees.rows(); ++p) {
      float gain = 0.f, overlap = 0.f, total = 0.f;
      for (Index s = 0; s < sees.cols(); ++s)
        if (sees(p, s) > 0.f) {
          gain += std::ldexp(1.f, -seen[s]);
          overlap += seen[s] > 0 ? 1.f : 0.f;
          total += 1.f;
        }
      const bool first = seen.maxCoeff() == 0;
      if (!taken[p] && gain > most && (!linked || first || overlap > 0.3f * total))
        most = gain, best = p;
    }
    if (best >= 0)
      return best;
  }
  return best;
}
} // namespace

float sceneUnit(const Scene& scene)
{
  const Eigen::AlignedBox3f box = bounds(scene);
  return scene.furnished ? 1.f : 0.2f * box.diagonal().norm();
}

ScenePlaces sampleSurface(const Scene& scene, int count, std::uint64_t seed)
{
  const TriangleMesh& mesh = scene.mesh;
  std::vector<double> until(mesh.faceCount());
  double area = 0.0;
  const auto corner = [&](Index f, int k) -> Vector3f { return mesh.vertices.col(mesh.faces(k, f)); };
  for (Index f = 0; f < mesh.faceCount(); ++f)
    until[f] = area += 0.5 * (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).norm();
  ScenePlaces samples{Points(3, count), Points(3, count)};
  for (int s = 0; s < count; ++s) {
    CounterRandom random(seed, 43, s);
    const double at = area * (s + random.uniform()) / count;
    const Index f =
        std::min<Index>(std::upper_bound(until.begin(), until.end(), at) - until.begin(), mesh.faceCount() - 1);
    float u = random.uniformFloat(), v = random.uniformFloat();
    if (u + v > 1.f)
      u = 1.f - u, v = 1.f - v;
    samples.positions.col(s) = (1 - u - v) * corner(f, 0) + u * corner(f, 1) + v * corner(f, 2);
    samples.normals.col(s) = faceNormal(mesh, f);
  }
  return samples;
}

Points freePlaces(const PlanningInput& in, const PlaceRules& rules)
{
  const std::vector<Vector3f> grid = in.scene.furnished ? roomGrid(in, rules) : meshGrid(in);
  const float clearance = rules.clearance * sceneUnit(in.scene);
  std::vector<char> good(grid.size(), 0);
  parallelFor(grid.size(), in.threads, [&](Index i) {
    const Vector3f& place = grid[i];
    const bool standing = !in.scene.furnished || !rules.on_floor || aboveFloor(in, place);
    good[i] = standing && isFree(in, place, clearance);
  });
  Points places(3, std::count(good.begin(), good.end(), 1));
  Index next = 0;
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (good[i])
      places.col(next++) = grid[i];
  if (next == 0)
    throw std::runtime_error("no place from which the front of the surface can be seen");
  return places;
}

Eigen::MatrixXf viewQuality(const PlanningInput& in, const Points& places, float good_distance)
{
  Eigen::MatrixXf quality = Eigen::MatrixXf::Zero(places.cols(), in.samples.positions.cols());
  const float lift = 1e-3f * sceneUnit(in.scene);
  parallelFor(places.cols(), in.threads, [&](Index p) {
    for (Index s = 0; s < quality.cols(); ++s) {
      const Vector3f target = in.samples.positions.col(s) + lift * in.samples.normals.col(s);
      const Vector3f way = target - places.col(p);
      const float distance = way.norm(), cosine = -way.dot(in.samples.normals.col(s)) / distance;
      if (cosine < 0.12f)
        continue;
      RayPacket<16> single;
      single[0] = {places.col(p), way, 1.f};
      if (in.rays.occluded(single, 1) == 0)
        quality(p, s) = cosine * std::min(1.f, good_distance / distance);
    }
  });
  return quality;
}

Points chooseStations(const PlanningInput& in, int count)
{
  require(count >= 1, "stations: ", count, " is not positive");
  PlaceRules rules;
  rules.heights = {1.2f, 1.6f};
  rules.spacing *= std::max(1.f, 0.4f / in.scene.detail);
  const Points free = freePlaces(in, rules);
  const int given = in.scene.stations.size();
  require(count >= given, "stations: ", count, " are fewer than the ", given, " of the stairwell");
  Points places(3, given + free.cols());
  for (int k = 0; k < given; ++k)
    places.col(k) = in.scene.stations[k];
  places.rightCols(free.cols()) = free;
  if (places.cols() < count)
    throw std::runtime_error(concat("only ", places.cols(), " free places for ", count, " stations"));
  const Eigen::MatrixXf sees = viewQuality(in, places, 4.f * sceneUnit(in.scene));
  Eigen::VectorXi seen = Eigen::VectorXi::Zero(sees.cols());
  std::vector<bool> taken(places.cols(), false);
  Points stations(3, count);
  for (int k = 0; k < count; ++k) {
    const Index best = k < given ? k : bestStation(sees, seen, taken);
    taken[best] = true;
    stations.col(k) = places.col(best);
    for (Index s = 0; s < sees.cols(); ++s)
      seen[s] += sees(best, s) > 0.f ? 1 : 0;
  }
  return stations;
}
} // namespace fresco::simulation
