// SPDX-License-Identifier: BSD-3-Clause
#include "charts/texture_atlas.h"
#include "charts/atlas_packing.h"
#include "charts/chart_layout.h"
#include "charts/given_layout.h"
#include "photographs/photo_store.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <iomanip>
namespace fresco::texture {
namespace {
constexpr double most_texels = 200e6; // unless a size is asked for: a gigabyte with the masks and what packing wastes

/// Texture coordinates of every face; a vertex has one per chart.
void fillTexcoords(const std::vector<Chart>& charts, int side, TexturedMesh& model)
{
  const TriangleMesh& mesh = model.mesh;
  model.texcoord_faces = Eigen::Matrix3Xi::Constant(3, mesh.faceCount(), -1);
  model.face_atlas = Eigen::VectorXi::Constant(mesh.faceCount(), -1);
  std::vector<Eigen::Vector2f> coords;
  std::vector<int> number(mesh.vertexCount(), -1); // of the vertex's coordinate, if not below `begin`
  for (const Chart& chart : charts) {
    const int begin = coords.size();
    for (const int f : chart.faces) {
      model.face_atlas[f] = chart.atlas;
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.faces(k, f);
        if (number[v] < begin) {
          number[v] = coords.size();
          const Eigen::Vector2d at = (chart.texel(mesh.vertices.col(v)) + Eigen::Vector2d(chart.x, chart.y)) / side;
          coords.emplace_back(at.x(), 1 - at.y());
        }
        model.texcoord_faces(k, f) = number[v];
      }
    }
  }
  model.texcoords.resize(2, coords.size());
  for (std::size_t i = 0; i < coords.size(); ++i)
    model.texcoords.col(i) = coords[i];
}

double typicalTexel(const std::vector<Chart>& charts, const FaceGraph& graph)
{
  std::vector<std::pair<double, double>> sizes; // texel, area
  for (const Chart& chart : charts) {
    double area = 0;
    for (const int f : chart.faces)
      area += graph.areas[f];
    const double texels =
        chart.given ? (*chart.given)[chart.faces[0]].leftCols<3>().norm() / std::sqrt(2) : chart.T_texel.row(0).norm();
    sizes.emplace_back(1 / texels, area);
  }
  return sizes.empty() ? 0 : weightedQuantile(sizes, 0.5);
}

/// How much larger texels have to be than wanted.
double coarsening(const FaceGraph& graph, const Eigen::VectorXf& density)
{
  return std::sqrt(graph.areas.cast<double>().dot(density.cast<double>().cwiseAbs2()) / most_texels);
}

/// F, texels per mesh unit for each face.
/// @param texel mesh units; 0 = as the photographs show it, and coarsely where none does
Eigen::VectorXf wantedDensities(const PatchMesh& patches, Index faces, const Eigen::VectorXf& resolution, double texel)
{
  if (texel > 0)
    return Eigen::VectorXf::Constant(faces, 1 / texel);
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(faces), area = sum;
  for (Index i = 0; i < patches.size(); ++i)
    if (resolution[i] > 0) {
      sum[patches.parent[i]] += patches.areas[i] * resolution[i];
      area[patches.parent[i]] += patches.areas[i];
    }
  std::vector<float> seen;
  for (Index f = 0; f < faces; ++f)
    if (area[f] > 0)
      seen.push_back(sum[f] / area[f]);
  constexpr float oversampling = 1.4f;  // texels per pixel: interpolating a second time would blur otherwise
  constexpr float unseen_share = 0.25f; // of the typical density: there is no detail
  const float typical = seen.empty() ? least_atlas / std::sqrt(patches.areas.cast<double>().sum()) : median(seen);
  Eigen::VectorXf out(faces);
  for (Index f = 0; f < faces; ++f)
    out[f] = oversampling * std::max(unseen_share * typical, area[f] > 0 ? sum[f] / area[f] : 0.f);
  return out;
}

struct WantedTexels {
  const FaceGraph& graph;
  const Eigen::VectorXf& density; ///< F
};

std::vector<Chart> keepAtlas(const PatchMesh& patches, const WantedTexels& wanted, const TextureOptions& options,
                             TextureResult& result)
{
  std::vector<Chart> charts = keepLayout(patches, wanted.graph, wanted.density, options, result.model);
  double owned = 0, all = 0;
  for (const Chart& chart : charts)
    owned += chart.texels.count();
  result.masks.clear();
  for (const Image& atlas : result.model.atlases) {
    result.masks.emplace_back(atlas.width, atlas.height, 1);
    all += 1.0 * atlas.width * atlas.height;
  }
  result.used = owned / all;
  result.charts = charts.size();
  result.texel = typicalTexel(charts, wanted.graph);
  return charts;
}
} // namespace

Eigen::VectorXf patchResolutions(const PatchMesh& patches, const std::vector<Projector>& views,
                                 const Eigen::VectorXi& view)
{
  Eigen::VectorXf out = Eigen::VectorXf::Zero(patches.size());
  for (Index i = 0; i < patches.size(); ++i) {
    if (view[i] < 0)
      continue;
    const Projector& camera = views[view[i]];
    const Eigen::Vector3f ray = camera.center() - patches.middle(i);
    const float cosine = std::abs(patches.normals.col(i).dot(ray.normalized()));
    out[i] = camera.focal() / ray.norm() * std::sqrt(cosine); // geometric mean of 1 and the cosine
  }
  return out;
}

double pixelSize(const Eigen::VectorXf& resolution)
{
  std::vector<float> sizes;
  for (const float r : resolution)
    if (r > 0)
      sizes.push_back(1 / r);
  return sizes.empty() ? 0 : median(sizes);
}

std::vector<Chart> makeAtlas(const PatchMesh& patches, const Eigen::VectorXf& resolution, const TextureOptions& options,
                             TextureResult& result, Index own)
{
  FaceGraph graph = buildFaceGraph(result.model.mesh, options.threads);
  for (Index f = 0; f < graph.neighbors.cols(); ++f)
    for (int k = 0; k < 3; ++k)
      if ((graph.neighbors(k, f) < own) != (f < own))
        graph.neighbors(k, f) = -1;
  Eigen::VectorXf density = wantedDensities(patches, result.model.mesh.faceCount(), resolution, options.texel);
  if (result.model.texcoord_faces.cols() > 0)
    return keepAtlas(patches, {graph, density}, options, result);
  if (const double coarser = coarsening(graph, density); options.texel == 0 && coarser > 1) {
    const float factor = coarser;
    density /= factor;
    result.warnings.push_back(concat("texels are ", std::fixed, std::setprecision(2), coarser, std::defaultfloat,
                                     std::setprecision(6), " times as large as the input gives, so that there are ",
                                     most_texels / 1e6, " million: a smaller -texel makes more"));
  }
  const int side = options.atlas > 0 ? options.atlas : largest_atlas;
  LayoutOptions layout;
  layout.border = options.border;
  layout.largest = side - side / 16; // packing rounds up to its blocks
  layout.threads = options.threads;
  std::vector<Chart> charts = layOutCharts(patches, graph, density, layout);
  const auto around =
      std::stable_partition(charts.begin(), charts.end(), [&](const Chart& c) { return c.faces[0] < own; });
  std::vector<Chart> others(std::make_move_iterator(around), std::make_move_iterator(charts.end()));
  charts.erase(around, charts.end());
  result.charts = charts.size();
  result.texel = typicalTexel(charts, graph);
  result.model.atlases.clear();
  result.masks.clear();
  const auto pack = [&](std::vector<Chart>& group) {
    const int first = result.model.atlases.size();
    const Packing packing = packCharts(group, side);
    for (Chart& chart : group)
      chart.atlas += first;
    for (int a = 0; a < packing.atlases; ++a) {
      result.model.atlases.emplace_back(packing.side, packing.side, 3, mid_grey);
      result.masks.emplace_back(packing.side, packing.side, 1);
    }
    return packing;
  };
  const Packing packing = pack(charts);
  result.used = packing.used;
  fillTexcoords(charts, packing.side, result.model);
  if (!others.empty())
    pack(others);
  std::move(others.begin(), others.end(), std::back_inserter(charts));
  return charts;
}
} // namespace fresco::texture
