// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/curved_data.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Vector3f;

struct Datum {
  float share;
  Vector3f point, normal, filtered; ///< its own normal, and the filtered one of its face; unit or zero
};

/// On the faces around v; of many every n-th, since all pairs of them are looked at.
void dataAround(const OptimizationProblem& problem, const FacePoints& lists, const Eigen::Matrix3Xf& normals, Index v,
                std::vector<Datum>& found)
{
  constexpr int most_data = 48; // a few times what three directions need
  found.clear();
  int count = 0;
  for (const int f : facesAround(problem.graph, v))
    count += lists.begin[f + 1] - lists.begin[f];
  const int step = (count + most_data - 1) / most_data;
  int next = 0;
  for (const int f : facesAround(problem.graph, v))
    for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
      if (next++ % step != 0)
        continue;
      const int i = lists.order[j];
      found.push_back({lists.share[j], problem.data.points.col(i), problem.data.normals.col(i), normals.col(f)});
    }
}

/// 0 where the differences between data around a vertex are at right angles to the filtered normals, as far as noise
/// lets them; to 1 where they are so to the data's own normals only. A chord of a circle is at right angles to the mean
/// of the normals at its ends; beside a crease normals that are blunt contradict the places.
double curvature(const std::vector<Datum>& data, double noise)
{
  constexpr float same_piece = 0.5f; // cosine: beyond 60 degrees a pair lies across a crease
  constexpr double blurred = 0.25;   // mean edge lengths: normals are estimated over so many then that they are blunt
  constexpr double least_data = 3.0, explained = 0.2; // data; standard deviations of the ratio, of which one tells
  double count = 0;
  for (const Datum& datum : data)
    count += datum.share;
  const double enough = ramp(count, 0.5 * least_data, least_data) * ramp(noise, blurred, 0.5 * blurred);
  if (!(enough > 0))
    return 0;
  double flat_squares = 0, own_squares = 0, noise_squares = 0;
  for (std::size_t a = 0; a < data.size(); ++a)
    for (std::size_t b = a + 1; b < data.size(); ++b) {
      const float filtered_cosine = data[a].filtered.dot(data[b].filtered), cosine = data[a].normal.dot(data[b].normal);
      if (filtered_cosine < same_piece || cosine < same_piece)
        continue;
      const Vector3f way = data[b].point - data[a].point;
      const double weight = data[a].share * data[b].share * way.squaredNorm(); // near ones show noise only
      const float flat = way.dot(data[a].filtered + data[b].filtered), own = way.dot(data[a].normal + data[b].normal);
      flat_squares += weight * (flat * flat / (2 + 2 * filtered_cosine)); // the sum of unit vectors, squared
      own_squares += weight * (own * own / (2 + 2 * cosine));
      noise_squares += weight * 2 * noise * noise;
    }
  if (!(noise_squares > 0))
    return 0;
  const double ratio = (flat_squares + noise_squares) / (own_squares + noise_squares), deviation = std::sqrt(2 / count);
  return ramp(ratio, 1 + explained * deviation, 1 + deviation) * enough;
}

/// Of the data on a face and on the faces around it that look the same way; zero where there are none.
Vector3f normalOfData(const OptimizationProblem& problem, const Eigen::Matrix3Xf& given, const Vector3f& own, Index f)
{
  Vector3f sum = Vector3f::Zero();
  for (int k = 0; k < 3; ++k)
    for (const int g : facesAround(problem.graph, problem.graph.faces(k, f)))
      sum += std::max(0.f, given.col(g).dot(own)) * given.col(g) * (g == f ? 1.f : 0.25f);
  return sum.squaredNorm() > 0.f ? sum.normalized().eval() : sum;
}
} // namespace

void followCurvedData(const OptimizationProblem& problem, const Eigen::Matrix3Xd& areas, const FacePoints& lists,
                      double noise, Eigen::Matrix3Xf& normals, int threads)
{
  if (!problem.data.hasNormals())
    return;
  const MeshGraph& graph = problem.graph;
  Eigen::VectorXf curved = Eigen::VectorXf::Zero(graph.vertexCount());
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    thread_local std::vector<Datum> data;
    dataAround(problem, lists, normals, v, data);
    curved[v] = curvature(data, std::max(noise, least_noise));
  });
  Eigen::Matrix3Xf given = Eigen::Matrix3Xf::Zero(3, graph.faceCount());
  parallelFor(graph.faceCount(), threads, [&](Index f) {
    for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j)
      given.col(f) += lists.share[j] * problem.data.normals.col(lists.order[j]);
  });
  parallelFor(graph.faceCount(), threads, [&](Index f) {
    if (graph.face_edges(0, f) < 0)
      return;
    const float by = std::max({curved[graph.faces(0, f)], curved[graph.faces(1, f)], curved[graph.faces(2, f)]});
    if (!(by > 0.f))
      return;
    const Vector3f own = areas.col(f).normalized().cast<float>();
    const Vector3f told = normalOfData(problem, given, own, f);
    if (!told.isZero())
      normals.col(f) = ((1.f - by) * normals.col(f) + by * told).normalized();
  });
}
} // namespace fresco::optimization
