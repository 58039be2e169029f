// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/attributes.h"
#include "poisson/isosurface/isosurface.h"
#include "poisson/isosurface/small_components.h"
#include "poisson/octree/bytes.h"
#include "poisson/ranks/reconstruct_part.h"
#include "poisson/ranks/surface_part.h"
#include "poisson/ranks/whole_mesh.h"
#include "poisson/samples/density.h"
#include "poisson/samples/exact_sum.h"
#include "poisson/samples/noise.h"
#include "poisson/samples/occupied_cells.h"
#include "poisson/samples/sample_ghosts.h"
#include "poisson/samples/scatter.h"
#include "poisson/solver/constraints.h"
#include "poisson/solver/expected_values.h"
#include "poisson/solver/hat_function.h"
#include "poisson/solver/solve.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <iterator>
namespace fresco {
namespace {
using namespace poisson;

void validate(const PointSet& points, const VolumetricOptions& options)
{
  validatePointSet(points);
  require(points.hasNormals(), "volumetric reconstruction: the points have no normals");
  validateVolumetricOptions(options);
}

/// Mean of chi over the samples, weighted by their area (Kazhdan, Bolitho & Hoppe 2006, sections 4.4 and 4.5), kept
/// below the margin that closeBoundary() gives the cube's boundary, so that the level set stays in the cube.
float levelSetValue(const Octree& tree, const NodeField& chi, const SampleLevel& samples, int threads)
{
  const BrickLevel& level = tree.levels.back();
  const SampleRanges ranges = sampleRanges(level, samples.codes, tree.depth, threads);
  const BrickRun own = level.own();
  const Eigen::Array2d sums = exactSums(tree.exchange(), own.end - own.begin, threads, [&](Index k) {
    Eigen::Array2d sum(0, 0);
    const Index b = own.begin + k;
    if (ranges[b].empty())
      return sum;
    const Eigen::Vector3f origin = level.origin(b);
    float nodes[nodes_per_brick];
    chi.load(level, b, nodes);
    for (const std::uint32_t i : ranges[b]) {
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
  parallelRanges(surface.ranges.size(), threads, [&](Index begin, Index end) {
    Density::Reader reader(density);
    for (Index r = begin; r < end; ++r) {
      const VertexRange& range = surface.ranges[r];
      for (Index v = range.first; v < range.first + range.count; ++v)
        support[v] = std::max(0.f, reader.at(range.depth, range.brick, surface.vertices.col(v)).support - shift);
    }
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

bool isTrimmed(const VolumetricOptions& options) { return options.trim > 0 || options.trim_levels > 0; }

/// Depth below which the surface is cut away, 0 = nowhere; see VolumetricOptions::trim_levels.
float trimDepth(const Eigen::VectorXf& support, int depth, const VolumetricOptions& options)
{
  if (options.trim_levels <= 0 || support.size() == 0)
    return options.trim;
  Eigen::VectorXf values = support; // to be put in another order
  const float upper_quartile = rankedValue(values, values.size() * 3 / 4);
  return std::max(options.trim, std::min<float>(upper_quartile, depth) - options.trim_levels);
}

/// Cells of all depths, each counted by one rank.
Index countCells(const Octree& tree)
{
  Index cells = 0;
  for (const BrickLevel& level : tree.levels) {
    Index bricks = level.own().end - level.own().begin;
    if (level.ghosts.isDivided())
      bricks = sumOfAll(*level.ghosts.exchange, bricks);
    cells += bricks * brick_cells * brick_cells * brick_cells;
  }
  return cells;
}

/// The surface without small components; of several ranks this one's part.
SurfacePart extractSurface(const Octree& tree, std::vector<NodeField>&& chi, float level_set, int threads)
{
  if (tree.partition)
    return extractSurfacePart(tree, std::move(chi), level_set, threads);
  SurfacePart whole;
  whole.surface = extractIsoSurface(tree, std::move(chi), level_set, threads);
  removeSmallComponents(whole.surface, threads);
  return whole;
}

void trim(const Cube& cube, const VolumetricOptions& options, VolumetricResult& result)
{
  const Eigen::VectorXf& support = result.mesh.fields["support"];
  const float depth = trimDepth(support, result.depth, options);
  if (depth <= 0)
    return;
  result.trim_depth = depth;
  constexpr double trim_patch = 16; // faces of such cells: smaller gaps and islands are below what the depth resolves
  const double trim_cell = cube.side / std::exp2(result.trim_depth);
  const double patch_area = trim_patch * trim_cell * trim_cell;
  result.mesh =
      trimMesh(result.mesh, support, {depth, patch_area, patch_area, TrimmingOptions{}.rounds, options.threads});
}

/// @param partition nullptr: there is one rank
VolumetricPart reconstruct(Samples&& samples, const VolumetricOptions& options, const Progress& progress,
                           const Partition* partition = nullptr)
{
  VolumetricPart part;
  VolumetricResult& result = part.result;
  result.used_points = samples.used_points;
  result.left_out_points = samples.left_out_points;
  result.depth = samples.cube.depth;
  result.cell_size = samples.cube.cell();
  report(progress, "octree", 0.1);
  const Octree tree =
      buildOctree(samples.codes, result.depth, std::min(options.min_depth, result.depth), options.threads, partition);
  result.cells = countCells(tree);
  report(progress, "density", 0.15);
  const Density density(tree, samples, options.threads);
  estimateDensity(tree, density, options.samples_per_node, samples, options.threads);
  estimateNoise(samples, tree.exchange(), options.threads);
  weighScattered(tree, samples, options.threads);
  report(progress, "normal field", 0.25);
  const SampleGhosts ghosts(tree, samples.codes, options.threads);
  Array<Eigen::Vector3f> normals = normalsOf(samples, options.threads);
  ghosts.addTo(normals);
  SampleLevel finest = finestLevel(samples, options.threads);
  releaseMemory(samples.samples);
  releaseMemory(samples.codes);
  ghosts.addTo(finest);
  holdThin(tree, ghosts, normals, finest, options.threads);
  SampleLevels levels = sampleLevels(std::move(finest), normals, tree, options.threads);
  Constraints constraints = splatNormals(tree, levels.back(), std::move(normals), options.threads);
  const FreePlaces free_places{options.free_space.get(), samples.cube, samples.origin};
  Solution solution = solve({tree, free_places, constraints, levels}, options, progress);
  result.residual = solution.residual;
  report(progress, "surface", 0.7);
  const float level_set = levelSetValue(tree, solution.chi.back(), levels.back(), options.threads);
  if (!samples.has_colors && !samples.has_intensities)
    levels.clear(); // the vertices need them for their attributes only
  SurfacePart own = extractSurface(tree, std::move(solution.chi), level_set, options.threads);
  part.vertices = std::move(own.vertices);
  part.faces = std::move(own.faces);
  part.vertex_count = own.vertex_count;
  part.face_count = own.face_count;
  report(progress, "attributes", 0.9);
  Eigen::VectorXf support = vertexSupport(density, own.surface, options.samples_per_node, options.threads);
  Eigen::Matrix4Xf attributes;
  if (samples.has_colors || samples.has_intensities) {
    ghosts.addTo(samples.attributes);
    attributes = vertexAttributes(tree, {levels.back(), samples.attributes}, own.surface, options.threads);
  }
  result.mesh = toMesh(samples, own.surface, options.threads);
  addAttributes(samples, attributes, result.mesh);
  result.mesh.fields["support"].swap(support);
  own = SurfacePart(); // what backs the mesh ends before it is freed
  if (partition && isTrimmed(options))
    gatherMesh(tree.exchange(), part);
  if (tree.exchange().rank() == 0)
    trim(samples.cube, options, result);
  report(progress, "done", 1.0);
  return part;
}

/// Rank 0 has the whole mesh; what it tells the others of it.
void tellOthers(Exchange& exchange, VolumetricPart& part)
{
  VolumetricResult& result = part.result;
  if (exchange.rank() == 0) {
    part.vertex_count = result.mesh.vertexCount();
    part.face_count = result.mesh.faceCount();
    part.vertices = {{0, part.vertex_count}};
    part.faces = {{0, part.face_count}};
  }
  double numbers[] = {result.residual, result.trim_depth};
  std::int64_t counts[] = {result.cells, part.vertex_count, part.face_count};
  broadcast(exchange, numbers, std::size(numbers));
  broadcast(exchange, counts, std::size(counts));
  result.residual = numbers[0];
  result.trim_depth = numbers[1];
  result.cells = counts[0];
  part.vertex_count = counts[1];
  part.face_count = counts[2];
}

/// Rank 0 makes the whole, the others have no part in it.
VolumetricPart reconstructAlone(Samples&& samples, const VolumetricOptions& options, const Progress& progress,
                                Exchange& exchange)
{
  VolumetricPart part;
  part.result.used_points = samples.used_points;
  part.result.left_out_points = samples.left_out_points;
  part.result.depth = samples.cube.depth;
  part.result.cell_size = samples.cube.cell();
  TriangleMesh& mesh = part.result.mesh;
  mesh.origin = samples.origin;
  if (samples.has_intensities)
    mesh.fields["intensity"].resize(0);
  mesh.fields["support"].resize(0);
  if (exchange.rank() == 0)
    part = reconstruct(std::move(samples), options, progress);
  tellOthers(exchange, part);
  return part;
}
} // namespace

namespace poisson {
VolumetricPart reconstructPart(std::unique_ptr<PointStream> points, const VolumetricOptions& options,
                               const Progress& progress, const RankOptions& ranks, Exchange& exchange)
{
  validateVolumetricOptions(options);
  report(progress, "sort points", 0.0);
  if (exchange.size() == 1) {
    Samples samples = gatherSamples(*points, options);
    points.reset();
    return reconstructAlone(std::move(samples), options, progress, exchange);
  }
  SampleShare share = gatherShare(*points, options, ranks, exchange);
  points.reset();
  if (!isDivided(share.samples.cube.depth, ranks))
    return reconstructAlone(std::move(share.samples), options, progress, exchange);
  require(options.min_depth >= Partition::atomDepth(ranks.shared_depth) && options.min_depth <= ranks.shared_depth,
          "volumetric reconstruction: of several ranks the minimum depth ", options.min_depth, " is below ",
          Partition::atomDepth(ranks.shared_depth));
  VolumetricPart part = reconstruct(std::move(share.samples), options, progress, &share.partition);
  if (isTrimmed(options))
    tellOthers(exchange, part);
  return part;
}
} // namespace poisson

VolumetricResult reconstructVolumetric(const PointSet& points, const VolumetricOptions& options,
                                       const Progress& progress)
{
  validate(points, options);
  report(progress, "sort points", 0.0);
  return reconstruct(gatherSamples(points, options), options, progress).result;
}

VolumetricResult reconstructVolumetric(PointSet&& points, const VolumetricOptions& options, const Progress& progress)
{
  validate(points, options);
  report(progress, "sort points", 0.0);
  Samples samples = gatherSamples(points, options);
  points = PointSet();
  return reconstruct(std::move(samples), options, progress).result;
}

VolumetricResult reconstructVolumetric(std::unique_ptr<PointStream> points, const VolumetricOptions& options,
                                       const Progress& progress)
{
  validateVolumetricOptions(options);
  report(progress, "sort points", 0.0);
  Samples samples = gatherSamples(*points, options);
  points.reset();
  return reconstruct(std::move(samples), options, progress).result;
}

VolumetricPart reconstructVolumetricPart(std::unique_ptr<PointStream> points, const VolumetricOptions& options,
                                         const Progress& progress, Exchange& exchange)
{
  require(!options.free_space || exchange.size() == 1,
          "volumetric reconstruction: free space is asked for by one process only, not by several ranks");
  return reconstructPart(std::move(points), options, progress, RankOptions(), exchange);
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
