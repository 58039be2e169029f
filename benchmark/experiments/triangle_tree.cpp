// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <benchmark/benchmark.h>
#include <fresco/search/triangle_tree.h>
#include <random>
namespace fresco {
namespace {
// A bumpy sphere of about 1 + bumps radius, 2 * rings^2 * 2 triangles.
TriangleMesh bumpySphere(int rings)
{
  const int around = 2 * rings;
  TriangleMesh mesh;
  mesh.vertices.resize(3, (rings + 1) * around);
  for (int i = 0; i < mesh.vertices.cols(); ++i) {
    const double theta = M_PI * (i / around) / rings, phi = 2 * M_PI * (i % around) / around;
    const double radius = 1.0 + 0.1 * std::sin(9 * theta) * std::cos(7 * phi);
    mesh.vertices.col(i) =
        (radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)))
            .cast<float>();
  }
  mesh.faces.resize(3, 2 * rings * around);
  for (int i = 0; i < rings * around; ++i) {
    const int a = i, b = i / around * around + (i + 1) % around, c = a + around, d = b + around;
    mesh.faces.col(2 * i) << a, c, b;
    mesh.faces.col(2 * i + 1) << b, c, d;
  }
  return mesh;
}

// Points of another bumpy sphere, moved by Gaussian noise and shuffled.
Eigen::Matrix3Xd queries(int rings, double noise)
{
  std::mt19937 random(1);
  std::normal_distribution<double> offset(0.0, noise);
  const Eigen::Matrix3Xd points = bumpySphere(rings).vertices.cast<double>();
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(points.cols(), 0, static_cast<int>(points.cols()) - 1);
  std::shuffle(order.begin(), order.end(), random);
  return points(Eigen::all, order) + Eigen::Matrix3Xd::NullaryExpr(3, points.cols(), [&] { return offset(random); });
}

void build(benchmark::State& state)
{
  const TriangleMesh mesh = bumpySphere(static_cast<int>(state.range(0)));
  std::size_t bytes = 0;
  for (auto _ : state)
    bytes = TriangleTree(mesh, static_cast<int>(state.range(1))).memory();
  state.SetItemsProcessed(state.iterations() * mesh.faceCount());
  state.counters["bytes/triangle"] = static_cast<double>(bytes) / static_cast<double>(mesh.faceCount());
}
BENCHMARK(build)
    ->ArgNames({"rings", "threads"})
    ->Args({158, 1})
    ->Args({500, 1})
    ->Args({500, 0})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// Noise in thousandths of the radius.
void closestPointsTogether(benchmark::State& state)
{
  const TriangleTree tree(bumpySphere(500));
  const Eigen::Matrix3Xd points = queries(707, 1e-3 * static_cast<double>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(closestPoints(tree, points, static_cast<int>(state.range(1))));
  state.SetItemsProcessed(state.iterations() * points.cols());
}
BENCHMARK(closestPointsTogether)
    ->ArgNames({"noise", "threads"})
    ->Args({0, 1})
    ->Args({1, 1})
    ->Args({1, 0})
    ->Args({50, 1})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void closestOneByOne(benchmark::State& state)
{
  const TriangleTree tree(bumpySphere(500));
  const Eigen::Matrix3Xd points = queries(100, 1e-3 * static_cast<double>(state.range(0)));
  for (auto _ : state)
    for (Index i = 0; i < points.cols(); ++i)
      benchmark::DoNotOptimize(tree.closest(points.col(i)));
  state.SetItemsProcessed(state.iterations() * points.cols());
}
BENCHMARK(closestOneByOne)->ArgName("noise")->Arg(1)->Arg(50)->Unit(benchmark::kMillisecond);
} // namespace
} // namespace fresco

BENCHMARK_MAIN();
