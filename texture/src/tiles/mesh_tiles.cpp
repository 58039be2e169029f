// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/mesh_tiles.h"
#include <algorithm>
#include <numeric>
namespace fresco::texture {
namespace {
Eigen::Vector3f middleOf(const TriangleMesh& mesh, Index face)
{
  return (mesh.vertices.col(mesh.faces(0, face)) + mesh.vertices.col(mesh.faces(1, face)) +
          mesh.vertices.col(mesh.faces(2, face))) /
         3;
}

Eigen::AlignedBox3f boxOf(const TriangleMesh& mesh, Index face)
{
  Eigen::AlignedBox3f box;
  for (int k = 0; k < 3; ++k)
    box.extend(mesh.vertices.col(mesh.faces(k, face)));
  return box;
}

using Faces1 = Array<int>::iterator;

/// Halves by the middle of the longest side of the box of the middles of the faces, so that faces at one place stay
/// together.
void bisect(const TriangleMesh& mesh, Faces1 first, Faces1 last, Index most, std::vector<Faces1>& ends)
{
  Eigen::AlignedBox3f box;
  for (Faces1 f = first; f != last; ++f)
    box.extend(middleOf(mesh, *f));
  int axis = 0;
  const float length = box.sizes().maxCoeff(&axis);
  Faces1 cut = last;
  if (last - first > most && length > 0) {
    const auto at = [&](int face) { return middleOf(mesh, face)[axis]; };
    const Faces1 half = first + (last - first) / 2;
    std::nth_element(first, half, last, [&](int a, int b) { return at(a) < at(b); });
    float limit = at(*half);
    if (limit == box.min()[axis])
      limit = std::nextafter(limit, box.max()[axis]);
    cut = std::partition(first, last, [&](int face) { return at(face) < limit; });
  }
  if (cut == first || cut == last) {
    std::sort(first, last);
    ends.push_back(last);
    return;
  }
  bisect(mesh, first, cut, most, ends);
  bisect(mesh, cut, last, most, ends);
}
} // namespace

MeshTiles cutIntoTiles(const TriangleMesh& mesh, Index most_faces)
{
  MeshTiles out;
  out.order.resize(mesh.faceCount());
  std::iota(out.order.begin(), out.order.end(), 0);
  std::vector<Faces1> ends;
  bisect(mesh, out.order.begin(), out.order.end(), most_faces, ends);
  out.begin.push_back(0);
  for (const Faces1 end : ends) {
    out.boxes.emplace_back();
    for (Faces1 f = out.order.begin() + out.begin.back(); f != end; ++f)
      out.boxes.back().extend(boxOf(mesh, *f));
    out.begin.push_back(end - out.order.begin());
  }
  return out;
}

TriangleMesh meshOf(const TriangleMesh& mesh, const std::vector<int>& faces)
{
  std::vector<int> vertices;
  vertices.reserve(3 * faces.size());
  for (const int f : faces)
    for (int k = 0; k < 3; ++k)
      vertices.push_back(mesh.faces(k, f));
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  TriangleMesh out;
  out.origin = mesh.origin;
  out.vertices = mesh.vertices(Eigen::all, vertices);
  if (mesh.colors.cols() > 0)
    out.colors = mesh.colors(Eigen::all, vertices);
  out.faces.resize(3, faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int k = 0; k < 3; ++k)
      out.faces(k, i) = std::lower_bound(vertices.begin(), vertices.end(), mesh.faces(k, faces[i])) - vertices.begin();
  return out;
}

TileMesh tileMesh(const TriangleMesh& mesh, const MeshTiles& tiles, Index tile, float halo)
{
  TileMesh out;
  std::vector<int> faces(tiles.order.begin() + tiles.begin[tile], tiles.order.begin() + tiles.begin[tile + 1]);
  out.own = faces.size();
  const Eigen::AlignedBox3f box(tiles.boxes[tile].min().array() - halo, tiles.boxes[tile].max().array() + halo);
  for (Index t = 0; t < tiles.count() && halo >= 0; ++t)
    for (Index i = tiles.begin[t]; t != tile && tiles.boxes[t].intersects(box) && i < tiles.begin[t + 1]; ++i)
      if (boxOf(mesh, tiles.order[i]).intersects(box)) {
        faces.push_back(tiles.order[i]);
        out.around.push_back({static_cast<int>(t), static_cast<int>(i - tiles.begin[t])});
      }
  out.mesh = meshOf(mesh, faces);
  out.mesh.faces = weldedFaces(out.mesh);
  return out;
}

double meanEdge(const TriangleMesh& mesh, float longest)
{
  double sum = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      sum += std::min<double>(
          longest, (mesh.vertices.col(mesh.faces(k, f)) - mesh.vertices.col(mesh.faces((k + 1) % 3, f))).norm());
  return sum / (3 * mesh.faceCount());
}
} // namespace fresco::texture
