// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/attributes.h"
#include "poisson/density.h"
#include "poisson/isosurface/isosurface.h"
#include "poisson/noise.h"
#include "poisson/occupied_cells.h"
#include "poisson/small_components.h"
#include "poisson/solver/base_solver.h"
#include "poisson/solver/constraints.h"
#include "poisson/solver/level_system.h"
#include "poisson/solver/low_pass_filter.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/release.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco {
namespace {
using namespace poisson;

void validate(const PointSet& points, const VolumetricOptions& options)
{
  validatePointSet(points);
  require(points.hasNormals(), "volumetric reconstruction: the points have no normals");
  validateVolumetricOptions(options);
}

/// Samples joined in the cells of each depth, by depth.
using SampleLevels = std::vector<SampleLevel>;

SampleLevels sampleLevels(SampleLevel&& finest, int threads)
{
  SampleLevels levels(finest.depth + 1);
  levels.back() = std::move(finest);
  for (int d = levels.back().depth; d > 2; --d)
    levels[d - 1] = coarsen(levels[d], threads);
  return levels;
}

struct Solution {
  std::vector<NodeField> chi; ///< by depth, from the complete depth on
  double residual = 0;
};

/// Frees what it does not need any more: of `levels` all but the finest remain empty.
Solution solve(const Octree& tree, Constraints& constraints, SampleLevels& levels, const VolumetricOptions& options,
               const Progress& progress)
{
  Solution solution;
  solution.chi.resize(tree.levels.size());
  for (int d = 2; d <= tree.full_depth; ++d)
    addCoarser(tree, d, options.threads, constraints);
  solution.chi[tree.full_depth] = solveBase(tree, constraints.fine, levels, options.point_weight, options.threads);
  for (int d = 2; d <= std::min(tree.full_depth + 1, tree.depth - 1); ++d)
    levels[d] = SampleLevel();
  for (int d = tree.full_depth + 1; d <= tree.depth; ++d) {
    report(progress, "solve", 0.35 + 0.35 * (d - tree.full_depth) / (tree.depth - tree.full_depth + 1));
    addCoarser(tree, d, options.threads, constraints);
    const BrickLevel& level = tree.levels[d];
    NodeField& chi = solution.chi[d] = NodeField(level);
    interpolateLevel(tree, d, solution.chi[d - 1], options.threads,
                     [&](Index b, const float* nodes) { chi.store(level, b, nodes); });
    const SampleLevel& joined = levels[std::min(d + 1, tree.depth)];
    const LevelSystem system(level, joined, tree.depth, options.point_weight, options.threads);
    system.smooth(constraints.fine[d], options.iterations, solution.chi[d]);
    if (d == tree.depth) {
      const LevelSystem::Norms norms = system.residual(constraints.fine[d], solution.chi[d]);
      solution.residual = norms.right > 0 ? std::sqrt(norms.residual / norms.right) : 0;
    } else {
      system.addMultiplierUpdate(solution.chi[d], constraints.own[d]);
    }
    LowPassFilter(level, joined, tree.depth, options.threads).apply(solution.chi[d], constraints.fine[d]);
    constraints.fine[d] = NodeField();
    if (d + 1 < tree.depth)
      levels[d + 1] = SampleLevel();
  }
  return solution;
}

/// Mean of chi over the samples, weighted by their area (Kazhdan, Bolitho & Hoppe 2006, sections 4.4 and 4.5), kept
/// below the margin that closeBoundary() gives the cube's boundary, so that the level set stays in the cube.
float levelSetValue(const Octree& tree, const NodeField& chi, const SampleLevel& samples, int threads)
{
  const BrickLevel& level = tree.levels.back();
  const Array<std::uint32_t> begin = sampleRanges(level, samples.codes, tree.depth, threads);
  const Eigen::Array2d sums = parallelSum(level.size(), threads, Eigen::Array2d(0, 0), [&](Index b) {
    Eigen::Array2d sum(0, 0);
    if (begin[b] == begin[b + 1])
      return sum;
    const Eigen::Vector3f origin = level.origin(b);
    float nodes[nodes_per_brick];
    chi.load(level, b, nodes);
    for (std::uint32_t i = begin[b]; i < begin[b + 1]; ++i) {
      const CoarseSample& s = samples.samples[i];
      const double value = HatWeights::inBrick(s.position - origin).interpolate(nodes);
      sum += Eigen::Array2d(s.area * value, s.area);
    }
    return sum;
  });
  return std::clamp(sums[0] / sums[1], -0.05, 0.05);
}

Eigen::VectorXf vertexSupport(const Density& density, const IsoSurface& surface, float samples_per_node, int threads)
{
  Eigen::VectorXf support(surface.vertices.cols());
  const float shift = 0.5f * std::log2(samples_per_node);
  parallelFor(surface.ranges.size(), threads, [&](Index r) {
    const VertexRange& range = surface.ranges[r];
    for (Index v = range.first; v < range.first + range.count; ++v)
      support[v] = std::max(0.f, density.at(range.depth, range.brick, surface.vertices.col(v)).support - shift);
  });
  return support;
}

/// Takes the vertices and faces; what backs them is still the surface's.
TriangleMesh toMesh(const Samples& samples, IsoSurface& surface, int threads)
{
  TriangleMesh mesh;
  const Cube& cube = samples.cube;
  mesh.origin = samples.origin;
  mesh.faces = std::move(surface.faces);
  mesh.vertices = std::move(surface.vertices);
  parallelFor(mesh.vertices.cols(), threads, [&](Index v) {
    mesh.vertices.col(v) = (cube.corner + cube.cell() * mesh.vertices.col(v).cast<double>()).cast<float>();
  });
  return mesh;
}

void addAttributes(const Samples& samples, const Eigen::Matrix4Xf& attributes, TriangleMesh& mesh)
{
  if (samples.has_colors)
    mesh.colors = (attributes.topRows<3>().array() + 0.5f).max(0.f).min(255.f).cast<std::uint8_t>();
  if (samples.has_intensities)
    mesh.fields["intensity"] = attributes.row(3).transpose();
}

/// Depth below which the surface is cut away, 0 = nowhere; see VolumetricOptions::trim_levels.
float trimDepth(const Eigen::VectorXf& support, int depth, const VolumetricOptions& options)
{
  if (options.trim_levels <= 0 || support.size() == 0)
    return options.trim;
  Eigen::VectorXf values = support; // to be put in another order
  const float upper_quartile = rankedValue(values, values.size() * 3 / 4);
  return std::max(options.trim, std::min<float>(upper_quartile, depth) - options.trim_levels);
}

VolumetricResult reconstruct(Samples&& samples, const VolumetricOptions& options, const Progress& progress)
{
  VolumetricResult result;
  result.used_points = samples.used_points;
  result.left_out_points = samples.left_out_points;
  result.depth = samples.cube.depth;
  result.cell_size = samples.cube.cell();
  report(progress, "octree", 0.1);
  const Octree tree =
      buildOctree(samples.codes, result.depth, std::min(options.min_depth, result.depth), options.threads);
  for (const BrickLevel& level : tree.levels)
    result.cells += level.size() * brick_cells * brick_cells * brick_cells;
  report(progress, "density", 0.15);
  const Density density(tree, samples, options.threads);
  estimateDensity(tree, density, options.samples_per_node, samples, options.threads);
  estimateNoise(samples, options.threads);
  report(progress, "normal field", 0.25);
  Array<Eigen::Vector3f> normals = normalsOf(samples, options.threads);
  SampleLevel finest = finestLevel(samples, options.threads);
  releaseMemory(samples.samples);
  releaseMemory(samples.codes);
  Constraints constraints = splatNormals(tree, finest, std::move(normals), options.threads);
  SampleLevels levels = sampleLevels(std::move(finest), options.threads);
  Solution solution = solve(tree, constraints, levels, options, progress);
  result.residual = solution.residual;
  report(progress, "surface", 0.7);
  const float level_set = levelSetValue(tree, solution.chi.back(), levels.back(), options.threads);
  if (samples.attributes.empty())
    levels.clear(); // the vertices need them for their attributes only
  IsoSurface surface = extractIsoSurface(tree, std::move(solution.chi), level_set, options.threads);
  removeSmallComponents(surface, options.threads);
  report(progress, "attributes", 0.9);
  Eigen::VectorXf support = vertexSupport(density, surface, options.samples_per_node, options.threads);
  Eigen::Matrix4Xf attributes;
  if (!samples.attributes.empty())
    attributes = vertexAttributes(tree, {levels.back(), samples.attributes}, surface, options.threads);
  result.mesh = toMesh(samples, surface, options.threads);
  if (attributes.cols() > 0)
    addAttributes(samples, attributes, result.mesh);
  const float trim = trimDepth(support, result.depth, options);
  result.mesh.fields["support"].swap(support);
  if (trim > 0) {
    surface = IsoSurface(); // what backs the mesh ends before it is freed
    result.trim_depth = trim;
    constexpr double trim_patch = 16; // faces of such cells: smaller gaps and islands are below what the depth resolves
    const double trim_cell = samples.cube.side / std::exp2(result.trim_depth);
    result.mesh = trimMesh(result.mesh, result.mesh.fields["support"],
                           {trim, trim_patch * trim_cell * trim_cell, TrimmingOptions{}.rounds, options.threads});
  }
  report(progress, "done", 1.0);
  return result;
}
} // namespace

void validateVolumetricOptions(const VolumetricOptions& options)
{
  require(options.depth >= 2 && options.depth <= 16, "volumetric reconstruction: depth ", options.depth,
          " is not in 2..16");
  require(options.cell_size >= 0 && std::isfinite(options.cell_size), "volumetric reconstruction: cell size ",
          options.cell_size, " is negative or not finite");
  require(options.min_depth >= 2 && options.min_depth <= 8, "volumetric reconstruction: minimum depth ",
          options.min_depth, " is not in 2..8");
  require(options.point_weight >= 0 && std::isfinite(options.point_weight), "volumetric reconstruction: point weight ",
          options.point_weight, " is negative or not finite");
  require(options.scale >= 1 && options.scale <= 100, "volumetric reconstruction: scale ", options.scale,
          " is not in 1..100");
  require(options.samples_per_node > 0 && std::isfinite(options.samples_per_node),
          "volumetric reconstruction: samples per node ", options.samples_per_node, " is not positive");
  require(options.trim >= 0 && std::isfinite(options.trim), "volumetric reconstruction: trimming depth ", options.trim,
          " is negative or not finite");
  require(options.trim_levels >= 0 && std::isfinite(options.trim_levels),
          "volumetric reconstruction: ", options.trim_levels, " levels of trimming are negative or not finite");
  require(options.iterations >= 1 && options.iterations <= 1000, "volumetric reconstruction: ", options.iterations,
          " iterations are not in 1..1000");
  threadCount(options.threads);
}

VolumetricResult reconstructVolumetric(const PointSet& points, const VolumetricOptions& options,
                                       const Progress& progress)
{
  validate(points, options);
  report(progress, "sort points", 0.0);
  return reconstruct(gatherSamples(points, options), options, progress);
}

VolumetricResult reconstructVolumetric(PointSet&& points, const VolumetricOptions& options, const Progress& progress)
{
  validate(points, options);
  report(progress, "sort points", 0.0);
  Samples samples = gatherSamples(points, options);
  points = PointSet();
  return reconstruct(std::move(samples), options, progress);
}

VolumetricResult reconstructVolumetric(std::unique_ptr<PointStream> points, const VolumetricOptions& options,
                                       const Progress& progress)
{
  validateVolumetricOptions(options);
  report(progress, "sort points", 0.0);
  Samples samples = gatherSamples(*points, options);
  points.reset();
  return reconstruct(std::move(samples), options, progress);
}

VolumetricEstimate estimateVolumetric(const PointStream& points, const VolumetricOptions& options)
{
  // What the solver holds at its peak, or the surface while its faces are joined; measured in docs/scale.md.
  constexpr std::size_t bytes_per_brick = 800, bytes_per_sample = 36, bytes_per_attribute = 32;
  constexpr std::size_t bytes_per_point = 60, most_points_at_once = 2'000'000; // while they are read and sorted
  constexpr std::size_t bytes_per_sum = 58;                                    // of points that come in several pieces
  // Passes over one point that a brick costs, and passes over all points, in all and here. docs/scale.md has both times.
  constexpr double passes_per_brick = 350, passes = 3, passes_here = 2;
  validateVolumetricOptions(options);
  const auto start = std::chrono::steady_clock::now();
  const Extent extent = findExtent(points, options);
  const Array<std::uint64_t> codes = findCells(points, extent, options.threads).codes(options.threads);
  const std::chrono::duration<double> here = std::chrono::steady_clock::now() - start;
  const int depth = extent.cube.depth;
  Index bricks = 0;
  for (const Index n : countBricks(codes, depth, std::min(options.min_depth, depth), options.threads))
    bricks += n;
  const double seconds_per_pass = here.count() / passes_here;
  const std::size_t more = extent.colors || extent.intensities ? bytes_per_attribute : 0;
  const std::size_t reading = bytes_per_point * std::min<std::size_t>(extent.all, most_points_at_once) +
                              (isOnePiece(extent) ? 0 : codes.size() * (bytes_per_sum + more));
  return {std::max(reading, bricks * bytes_per_brick + codes.size() * (bytes_per_sample + more)),
          seconds_per_pass * (passes + passes_per_brick * bricks / std::max<Index>(1, extent.all))};
}

std::size_t estimateMemory(const PointStream& points, const VolumetricOptions& options)
{
  return estimateVolumetric(points, options).memory;
}

std::size_t estimateMemory(const PointSet& points, const VolumetricOptions& options)
{
  validate(points, options);
  return estimateMemory(WholeSet(points), options);
}
} // namespace fresco
