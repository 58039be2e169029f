// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/surface/core/surface_samples.h>
#include <vector>
namespace fresco {
namespace {
// Uniform in [0, 1), a function of its arguments only (SplitMix64: Steele, Lea, Flood 2014).
double uniform(std::uint64_t seed, std::uint64_t counter)
{
  std::uint64_t x = seed * 0xd1342543de82ef95u + (counter + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return ((x ^ (x >> 31)) >> 11) * 0x1.0p-53;
}

// Sums of the areas of the faces up to and including each.
std::vector<double> areaSums(const TriangleMesh& mesh, int threads)
{
  std::vector<double> sums(mesh.faceCount());
  parallelFor(mesh.faceCount(), threads, [&](Index f) { sums[f] = 0.5 * areaVector(mesh, f).norm(); });
  double sum = 0.0;
  for (double& entry : sums)
    entry = sum += entry;
  return sums;
}
} // namespace

SurfaceSamples sampleSurface(const TriangleMesh& mesh, Index count, std::uint64_t seed, int threads)
{
  require(count > 0, "sampleSurface: ", count, " samples");
  validateMesh(mesh);
  const std::vector<double> sums = areaSums(mesh, threads);
  const double area = sums.empty() ? 0.0 : sums.back();
  require(area > 0.0, "sampleSurface: the surface has no area");
  const auto last = std::lower_bound(sums.begin(), sums.end(), area) - sums.begin(); // last face with an area
  SurfaceSamples samples{Eigen::Matrix3Xd(3, count), Eigen::VectorXi(count)};
  parallelFor(count, threads, [&](Index i) {
    const std::uint64_t counter = 3 * i;
    const double at = (i + uniform(seed, counter)) / count * area;
    const Index f = std::min<Index>(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin(), last);
    const double r = std::sqrt(uniform(seed, counter + 1)), s = uniform(seed, counter + 2);
    samples.points.col(i) =
        (1.0 - r) * faceCorner(mesh, f, 0) + r * (1.0 - s) * faceCorner(mesh, f, 1) + r * s * faceCorner(mesh, f, 2);
    samples.faces[i] = f;
  });
  return samples;
}
} // namespace fresco
