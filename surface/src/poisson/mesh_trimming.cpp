// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/corners_by_vertex.h"
#include "poisson/isosurface/edges.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <fresco/core/array.h>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <unordered_map>
#include <vector>
namespace fresco {
namespace {
using poisson::chunk_size, poisson::CornersByVertex;

/// Mean of each vertex's value and those of its neighbours.
Eigen::VectorXf smoothed(const TriangleMesh& mesh, const CornersByVertex& corners, const Eigen::VectorXf& values)
{
  Eigen::VectorXf sum = values, count = Eigen::VectorXf::Ones(values.size());
  corners.forEach([&](Index v, Index f, int k) {
    sum[v] += values[mesh.faces((k + 1) % 3, f)];
    count[v] += 1.f;
  });
  return sum.cwiseQuotient(count);
}

/// Moves the values of connected patches on one side of `least` to the other side where the patch is small.
void flipPatches(const TriangleMesh& mesh, const CornersByVertex& corners, const TrimmingOptions& options,
                 Eigen::VectorXf& values)
{
  constexpr float flipped_margin = 0.1f; // from `least`: only where a cut meets the patch does it matter
  const auto above = [&](int v) { return values[v] >= options.least; };
  const Index n = mesh.vertexCount();
  ConcurrentUnionFind patches(n, options.threads);
  parallelFor(mesh.faceCount(), options.threads, [&](Index f) {
    for (int k = 0; k < 3; ++k)
      if (const int a = mesh.faces(k, f), b = mesh.faces((k + 1) % 3, f); above(a) == above(b))
        patches.join(a, b);
  });
  std::vector<double> area(n, 0.0);
  corners.forEach([&](Index v, Index f, int) { area[v] += 0.5 * areaVector(mesh, f).norm() / 3; });
  for (Index v = 0; v < n; ++v)
    if (const Index root = patches.root(v); root != v)
      area[root] += area[v];
  parallelFor(n, options.threads, [&](Index v) {
    if (area[patches.root(v)] < (above(v) ? options.island_area : options.gap_area))
      values[v] = above(v) ? options.least - flipped_margin : options.least + flipped_margin;
  });
}

struct Cut {
  int a, b; ///< a < b
  float t;  ///< position from a to b
};

/// Where the level line crosses the edges of the faces.
class Cuts {
public:
  Cuts(const Faces& faces, const Eigen::VectorXf& values, const TrimmingOptions& options)
      : values_(values), least_(options.least), parts_((faces.cols() + chunk_size - 1) / chunk_size)
  {
    parallelRanges(
        faces.cols(), options.threads, [&](Index begin, Index end) { collect(faces, begin, end); }, chunk_size);
    for (const Part& part : parts_)
      for (const std::uint64_t edge : part.edges)
        add(edge);
  }

  const std::vector<Cut>& cuts() const { return cuts_; }
  /// Corners of what is left of the faces of a chunk.
  Index cornersOf(Index begin) const { return parts_[begin / chunk_size].corners; }
  bool keeps(int v) const { return values_[v] >= least_; }

  /// put(vertex) for the corners of the triangles that are left of a face. Cuts follow the mesh's vertices.
  template <typename Put>
  void trim(const Eigen::Vector3i& face, const Put& put) const
  {
    int polygon[4], n = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      if (keeps(a))
        polygon[n++] = a;
      if (keeps(a) != keeps(b))
        polygon[n++] = number_.at(edgeOf(a, b));
    }
    for (int k = 2; k < n; ++k)
      for (const int corner : {0, k - 1, k})
        put(polygon[corner]);
  }

private:
  struct Part {
    std::vector<std::uint64_t> edges;
    Index corners = 0;
  };

  static std::uint64_t edgeOf(int a, int b)
  {
    return std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
  }

  void collect(const Faces& faces, Index begin, Index end)
  {
    Part& part = parts_[begin / chunk_size];
    for (Index f = begin; f < end; ++f) {
      int n = 0;
      for (int k = 0; k < 3; ++k) {
        const int a = faces(k, f), b = faces((k + 1) % 3, f);
        n += keeps(a);
        if (keeps(a) == keeps(b))
          continue;
        ++n;
        part.edges.push_back(edgeOf(a, b));
      }
      part.corners += 3 * std::max(0, n - 2);
    }
  }

  /// Numbers the cut edges in the order of the faces.
  void add(std::uint64_t edge)
  {
    if (!number_.try_emplace(edge, values_.size() + cuts_.size()).second)
      return;
    const int a = edge >> 32, b = edge & 0xffffffff;
    cuts_.push_back({a, b, poisson::crossing(values_[a], values_[b], least_)});
  }

  const Eigen::VectorXf& values_;
  float least_;
  std::vector<Part> parts_;
  std::unordered_map<std::uint64_t, int> number_;
  std::vector<Cut> cuts_;
};

/// The vertices that remain: some of the mesh's, in their order, and the cuts.
class KeptVertices {
public:
  /// @param in_faces by vertex: whether a face has it
  KeptVertices(const Cuts& cuts, const std::vector<char>& in_faces, int threads)
      : cuts_(cuts.cuts()), first_cut_(in_faces.size()), threads_(threads), new_index_(in_faces.size()),
        kept_(poisson::selectIndices(in_faces.size(), threads, [&](Index v) { return in_faces[v] && cuts.keeps(v); }))
  {
    parallelFor(kept_.size(), threads, [&](Index i) { new_index_[kept_[i]] = i; });
  }

  /// @param v of the mesh, or a cut behind them
  int newIndex(int v) const { return v < first_cut_ ? new_index_[v] : int(kept_.size()) + v - first_cut_; }

  /// @param values a column per vertex, or none
  template <typename Matrix>
  Matrix of(const Matrix& values) const
  {
    if (values.cols() == 0)
      return values;
    const Index n = kept_.size();
    Matrix result(values.rows(), n + Index(cuts_.size()));
    parallelFor(n, threads_, [&](Index i) { result.col(i) = values.col(kept_[i]); });
    parallelFor(cuts_.size(), threads_, [&](Index i) {
      const Cut& cut = cuts_[i];
      result.col(n + i) =
          ((1.f - cut.t) * values.col(cut.a).template cast<float>() + cut.t * values.col(cut.b).template cast<float>())
              .template cast<typename Matrix::Scalar>();
    });
    return result;
  }

private:
  const std::vector<Cut>& cuts_;
  int first_cut_, threads_;
  Array<int> new_index_;
  Array<std::uint32_t> kept_;
};

Faces trimmedFaces(const Faces& faces, const Cuts& cuts, const KeptVertices& kept, int threads)
{
  std::vector<Index> first(1, 0);
  for (Index begin = 0; begin < faces.cols(); begin += chunk_size)
    first.push_back(first.back() + cuts.cornersOf(begin));
  Faces result(3, first.back() / 3);
  parallelRanges(
      faces.cols(), threads,
      [&](Index begin, Index end) {
        int* to = result.data() + first[begin / chunk_size];
        for (Index f = begin; f < end; ++f)
          cuts.trim(faces.col(f), [&](int v) { *to++ = kept.newIndex(v); });
      },
      chunk_size);
  return result;
}
} // namespace

TriangleMesh trimMesh(const TriangleMesh& mesh, Eigen::VectorXf values, const TrimmingOptions& options)
{
  require(values.size() == mesh.vertexCount(), "trimming: ", values.size(), " values for ", mesh.vertexCount(),
          " vertices");
  const CornersByVertex corners(mesh.faces, mesh.vertexCount(), options.threads);
  for (int i = 0; i < options.rounds; ++i)
    values = smoothed(mesh, corners, values);
  if (options.gap_area > 0 || options.island_area > 0)
    flipPatches(mesh, corners, options, values);
  std::vector<char> in_faces(mesh.vertexCount(), 0);
  corners.forEach([&](Index v, Index, int) { in_faces[v] = 1; });
  const Cuts cuts(mesh.faces, values, options);
  const KeptVertices kept(cuts, in_faces, options.threads);
  TriangleMesh result;
  result.origin = mesh.origin;
  result.vertices = kept.of(mesh.vertices);
  result.normals = kept.of(mesh.normals);
  result.colors = kept.of(mesh.colors);
  for (const auto& [name, field_values] : mesh.fields)
    result.fields[name] = kept.of(Eigen::RowVectorXf(field_values.transpose())).transpose();
  result.faces = trimmedFaces(mesh.faces, cuts, kept, options.threads);
  return result;
}
} // namespace fresco
