// SPDX-License-Identifier: BSD-3-Clause
#include "simplification/corner_table.h"
#include <algorithm>
namespace fresco::deliverables {
CornerTable::CornerTable(TexturedMesh& model)
    : model_(model), textured_(model.texcoord_faces.cols() > 0), first_(model.mesh.vertexCount(), -1),
      next_(model.mesh.faces.size(), -1), freedom_(first_.size(), Freedom::surface)
{
  Faces& faces = model.mesh.faces;
  for (int f = 0; f < faces.cols(); ++f) {
    const Eigen::Vector3i face = faces.col(f);
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
      faces.col(f).setConstant(-1);
      continue;
    }
    ++faces_;
    for (int k = 0; k < 3; ++k) {
      next_[3 * f + k] = first_[face[k]];
      first_[face[k]] = 3 * f + k;
    }
  }
  for (std::size_t v = 0; v < first_.size(); ++v)
    classify(v);
}

std::vector<int> CornerTable::neighbors(int vertex) const
{
  std::vector<int> found;
  found.reserve(24); // twice the usual number
  forFaces(vertex, [&](int face, int k) {
    found.push_back(model_.mesh.faces((k + 1) % 3, face));
    found.push_back(model_.mesh.faces((k + 2) % 3, face));
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

CornerTable::EdgeFaces CornerTable::edge(int from, int to) const
{
  EdgeFaces found;
  forFaces(from, [&](int face, int k) {
    for (const int step : {1, 2}) {
      const int other = (k + step) % 3;
      if (model_.mesh.faces(other, face) != to)
        continue;
      if (found.count < 2) {
        found.face[found.count] = face;
        found.tip[found.count] = model_.mesh.faces((k + 3 - step) % 3, face);
        found.from[found.count] = 3 * face + k;
        found.to[found.count] = 3 * face + other;
      }
      ++found.count;
    }
  });
  return found;
}

bool CornerTable::isCurve(const EdgeFaces& edge) const
{
  if (edge.count != 2)
    return true;
  return textured_ &&
         (model_.face_atlas[edge.face[0]] != model_.face_atlas[edge.face[1]] ||
          texcoord(edge.from[0]) != texcoord(edge.from[1]) || texcoord(edge.to[0]) != texcoord(edge.to[1]));
}

/// A vertex is manifold where a walk from face to face over its edges meets all of its faces.
void CornerTable::classify(int vertex)
{
  int faces = 0, curves = 0, open = 0;
  bool manifold = true;
  forFaces(vertex, [&](int, int) { ++faces; });
  int start = -1;
  for (const int other : neighbors(vertex)) {
    const EdgeFaces at = edge(vertex, other);
    manifold = manifold && at.count <= 2;
    if (at.count == 2) // which run through it in opposite directions
      manifold = manifold && ((at.from[0] % 3 + 1) % 3 == at.to[0] % 3) != ((at.from[1] % 3 + 1) % 3 == at.to[1] % 3);
    curves += isCurve(at) ? 1 : 0;
    open += at.count == 1 ? 1 : 0;
    if (start < 0 || at.count == 1)
      start = other;
  }
  int walked = 0;
  for (int at = start, face = -1; manifold && at >= 0 && walked <= faces;) {
    const EdgeFaces here = edge(vertex, at);
    const int side = here.face[0] != face ? 0 : 1;
    if (side >= here.count || (walked > 0 && at == start))
      break;
    face = here.face[side];
    at = here.tip[side];
    ++walked;
  }
  const bool single = manifold && walked == faces && (open == 0 || open == 2);
  freedom_[vertex] = single && curves == 0 ? Freedom::surface : single && curves == 2 ? Freedom::curve : Freedom::none;
}

bool CornerTable::mayCollapse(int from, int to, const EdgeFaces& at) const
{
  if (at.count < 1 || at.count > 2)
    return false;
  const std::vector<int> around = neighbors(from), others = neighbors(to);
  std::vector<int> common;
  std::set_intersection(around.begin(), around.end(), others.begin(), others.end(), std::back_inserter(common));
  // The link condition of Dey, Edelsbrunner, Guha & Nekhayev 1999, "Topology Preserving Edge Contraction".
  if (Index(common.size()) != at.count || (at.count == 2 && at.tip[0] == at.tip[1]))
    return false;
  if (at.count == 2) { // the surface must not be a tetrahedron
    const EdgeFaces across = edge(at.tip[0], at.tip[1]);
    if (across.count == 2 && std::minmax(across.tip[0], across.tip[1]) == std::minmax(from, to))
      return false;
  }
  for (int i = 0; i < at.count; ++i) // two curves, or two sides of a chart, must not become one
    if (isCurve(edge(from, at.tip[i])) && isCurve(edge(to, at.tip[i])))
      return false;
  return true;
}

void CornerTable::collapse(int from, int to, double share)
{
  const EdgeFaces at = edge(from, to);
  const int count = std::min(at.count, 2);
  int gone[2] = {-1, -1}, kept[2] = {-1, -1};
  for (int i = 0; i < count; ++i) {
    gone[i] = texcoord(at.from[i]);
    kept[i] = texcoord(at.to[i]);
    if (kept[i] >= 0 && (i == 0 || kept[1] != kept[0])) {
      const Eigen::Vector2f a = model_.texcoords.col(gone[i]), b = model_.texcoords.col(kept[i]);
      model_.texcoords.col(kept[i]) = a + float(share) * (b - a);
    }
    model_.mesh.faces.col(at.face[i]).setConstant(-1);
    --faces_;
  }
  int last = -1; // of the corners of `from` that stay
  for (int corner = first_[from], after = -1; corner >= 0; corner = after) {
    after = next_[corner];
    const int face = corner / 3, k = corner % 3;
    if (!isAlive(face))
      continue;
    model_.mesh.faces(k, face) = to;
    for (int i = 0; i < count && textured_; ++i)
      if (model_.texcoord_faces(k, face) == gone[i]) {
        model_.texcoord_faces(k, face) = kept[i];
        break;
      }
    next_[corner] = last;
    last = corner;
  }
  for (int corner = first_[to], after = -1; corner >= 0; corner = after) {
    after = next_[corner];
    if (!isAlive(corner / 3))
      continue;
    next_[corner] = last;
    last = corner;
  }
  first_[to] = last;
  first_[from] = -1;
}
} // namespace fresco::deliverables
