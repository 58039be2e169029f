// SPDX-License-Identifier: BSD-3-Clause
#include "views/face_orientation.h"
#include "views/patch_mesh.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
namespace fresco::texture {
namespace {
/// Number of the surface of each face: its lowest face.
std::vector<int> surfacesOf(const TriangleMesh& mesh)
{
  const Eigen::Matrix3Xi neighbors = faceNeighbors(mesh.faces, 0);
  const auto runs = [&](Index face, int from, int to) {
    for (int k = 0; k < 3; ++k)
      if (mesh.faces(k, face) == from && mesh.faces((k + 1) % 3, face) == to)
        return true;
    return false;
  };
  UnionFind joined(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      if (const int other = neighbors(k, f); other > f && runs(other, mesh.faces((k + 1) % 3, f), mesh.faces(k, f)))
        joined.join(f, other);
  std::vector<int> out(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    out[f] = joined.root(f);
  return out;
}

/// Faces hit by a grid of rays, and whether from behind.
std::vector<std::pair<int, bool>> hitsOf(const RayScene& scene, const Projector& view)
{
  constexpr double rays = 50000; // 250 along a side: depth maps take many times as many
  const CameraModel& camera = view.camera();
  const double step = std::max(1.0, std::sqrt(1.0 * camera.width * camera.height / rays));
  std::vector<std::pair<int, bool>> hits;
  for (double y = 0.5 * step; y < camera.height; y += step)
    for (double x = 0.5 * step; x < camera.width; x += step) {
      const Eigen::Vector3f ray = view.ray({x, y});
      if (const RayHit hit = scene.intersect({view.center(), ray}); hit.face >= 0)
        hits.emplace_back(hit.face, hit.normal.dot(ray) >= 0);
    }
  return hits;
}

/// 2xF, rays that end on the front and on the back of a surface, in the column of its number.
Eigen::Array2Xd countSides(const std::vector<int>& surfaces, const RayScene& scene, const std::vector<Projector>& views)
{
  std::vector<std::vector<std::pair<int, bool>>> hits(views.size());
  parallelFor(
      views.size(), 0, [&](Index v) { hits[v] = hitsOf(scene, views[v]); }, 1);
  Eigen::Array2Xd counts = Eigen::Array2Xd::Zero(2, surfaces.size());
  for (const auto& list : hits)
    for (const auto& [face, from_behind] : list)
      ++counts(from_behind, surfaces[face]);
  return counts;
}
} // namespace

std::vector<char> insideOutFaces(const TriangleMesh& mesh, const RayScene& scene, const std::vector<Projector>& views,
                                 TextureResult& result)
{
  constexpr double all = 0.98; // of a surface: rays along its rim may pass by what stands before it
  constexpr double much = 0.2; // of what photographs see: a closed mesh shows nothing from behind
  const std::vector<int> surfaces = surfacesOf(mesh);
  const Eigen::Array2Xd counts = countSides(surfaces, scene, views);
  std::vector<char> marked(surfaces.size(), 0);
  double back = 0, seen = 0;
  for (std::size_t f = 0; f < surfaces.size(); ++f) {
    const double behind = counts(1, surfaces[f]), rays = counts(0, surfaces[f]) + behind;
    marked[f] = rays > 0 && behind >= all * rays;
    if (surfaces[f] == static_cast<int>(f)) {
      seen += rays;
      back += marked[f] ? 0 : behind;
    }
  }
  const auto turned = std::count(marked.begin(), marked.end(), 1);
  if (turned > 0)
    result.warnings.push_back(
        concat(turned, " of ", surfaces.size(),
               " faces are turned inside out: photographs see them from behind alone; they are turned"));
  if (back > much * seen)
    result.warnings.push_back(
        concat(std::lround(100 * back / seen),
               " % of what the photographs see is seen from behind, which has no texture: are faces "
               "turned inside out, or is the mesh not in the cameras' frame?"));
  return turned > 0 ? marked : std::vector<char>();
}

void turnFaces(const std::vector<char>& marked, TexturedMesh& model)
{
  for (std::size_t f = 0; f < marked.size(); ++f)
    if (marked[f]) {
      std::swap(model.mesh.faces(1, f), model.mesh.faces(2, f));
      if (model.texcoord_faces.cols() > 0)
        std::swap(model.texcoord_faces(1, f), model.texcoord_faces(2, f));
    }
}
} // namespace fresco::texture
