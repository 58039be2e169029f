// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/normals_sample.h"
#include <array>
#include <map>
namespace fresco {
using Eigen::Vector3f;

namespace {
Vector3f faceNormal(const TriangleMesh& mesh, Index face)
{
  const Eigen::Vector3i v = mesh.faces.col(face);
  const Vector3f a = mesh.vertices.col(v[0]);
  return (Vector3f(mesh.vertices.col(v[1])) - a).cross(Vector3f(mesh.vertices.col(v[2])) - a).normalized();
}

/// Places along the edges where faces meet at more than `degrees`, or that do not belong to two faces.
Points creasePlaces(const TriangleMesh& mesh, float degrees, float spread)
{
  std::map<std::array<float, 3>, int> first;
  std::map<std::pair<int, int>, std::vector<Index>> edges;
  const auto welded = [&](int v) {
    return first.emplace(std::array{mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v)}, v).first->second;
  };
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = welded(mesh.faces(k, f)), b = welded(mesh.faces((k + 1) % 3, f));
      if (a != b)
        edges[{std::min(a, b), std::max(a, b)}].push_back(f);
    }
  const float flat = std::cos(degrees * 0.017453293f);
  std::vector<Vector3f> places;
  for (const auto& [ends, faces] : edges) {
    if (faces.size() == 2 && faceNormal(mesh, faces[0]).dot(faceNormal(mesh, faces[1])) > flat)
      continue;
    const Vector3f a = mesh.vertices.col(ends.first), way = Vector3f(mesh.vertices.col(ends.second)) - a;
    const int steps = std::max(1, static_cast<int>(way.norm() / spread));
    for (int s = 0; s <= steps; ++s)
      places.emplace_back(a + way * (static_cast<float>(s) / static_cast<float>(steps)));
  }
  Points all(3, static_cast<Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    all.col(static_cast<Index>(i)) = places[i];
  return all;
}
NormalSample takeSample(const ScannedRoom& room, const Creases& creases, const Vector3f& station,
                        const LaserOptions& laser)
{
  const LitScene lit = room.lit();
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topRightCorner<3, 1>() = station.cast<double>() + lit.scene.mesh.origin;
  const LaserScan scan = scanScene(lit, pose, laser, 0);
  const Index n = scan.points.size();
  NormalSample sample;
  sample.points = scan.points.points;
  sample.deviations = Eigen::VectorXf::Map(scan.deviations.data(), n);
  sample.truth.resize(3, n);
  sample.exact.resize(3, n);
  sample.place.resize(n);
  for (Index i = 0; i < n; ++i) {
    const Vector3f normal = faceNormal(lit.scene.mesh, scan.faces[i]);
    sample.truth.col(i) = scan.mixed[i] ? Vector3f::Constant(NAN) : normal;
    const Index corner = lit.scene.mesh.faces(0, scan.faces[i]);
    const Vector3f beam = sample.points.col(i), on_face = Vector3f(lit.scene.mesh.vertices.col(corner)) - station;
    sample.exact.col(i) = beam * (normal.dot(on_face) / normal.dot(beam));
    const Vector3f at = beam + station;
    sample.place[i] = creases.sharp.nearest(at, creases.edge).index >= 0   ? 0
                      : creases.bends.nearest(at, creases.plane).index < 0 ? 1
                                                                           : 2;
  }
  return sample;
}

NormalSample merge(const std::vector<NormalSample>& scans, const Points& stations)
{
  Index n = 0, at = 0;
  for (const NormalSample& scan : scans)
    n += scan.points.cols();
  NormalSample all;
  for (Points* values : {&all.points, &all.truth, &all.exact, &all.viewpoints})
    values->resize(3, n);
  all.deviations.resize(n);
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const Index count = scans[s].points.cols();
    const Vector3f station = stations.col(static_cast<Index>(s));
    all.points.middleCols(at, count) = scans[s].points.colwise() + station;
    all.exact.middleCols(at, count) = scans[s].exact.colwise() + station;
    all.truth.middleCols(at, count) = scans[s].truth;
    all.deviations.segment(at, count) = scans[s].deviations;
    all.viewpoints.middleCols(at, count).colwise() = station;
    all.place.insert(all.place.end(), scans[s].place.begin(), scans[s].place.end());
    at += count;
  }
  return all;
}
} // namespace

Creases::Creases(const TriangleMesh& mesh, const NormalMeasure& measure, int threads)
    : sharp(creasePlaces(mesh, measure.crease, measure.spread), threads),
      bends(creasePlaces(mesh, measure.bend, measure.plane / 5), threads), edge(measure.edge), plane(measure.plane)
{}

std::vector<NormalSample> takeSamples(const ScannedRoom& room, const Creases& creases, const LaserOptions& laser,
                                      bool merged)
{
  std::vector<NormalSample> samples;
  for (Index s = 0; s < room.stations.cols(); ++s)
    samples.push_back(takeSample(room, creases, room.stations.col(s), laser));
  if (merged)
    return {merge(samples, room.stations)};
  return samples;
}
} // namespace fresco
