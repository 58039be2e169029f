// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <unordered_map>
#include <vector>
namespace fresco {
namespace {
/// Mean of each vertex's value and those of its neighbours.
Eigen::VectorXf smoothed(const TriangleMesh& mesh, const Eigen::VectorXf& values)
{
  Eigen::VectorXf sum = values, count = Eigen::VectorXf::Ones(values.size());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      sum[mesh.faces(k, f)] += values[mesh.faces((k + 1) % 3, f)];
      count[mesh.faces(k, f)] += 1.f;
    }
  return sum.cwiseQuotient(count);
}

/// Moves the values of connected patches on one side of `least` to the other side where the patch is small.
void flipPatches(const TriangleMesh& mesh, float least, double patch_area, Eigen::VectorXf& values)
{
  constexpr float flipped_margin = 0.1f; // from `least`: only where a cut meets the patch does it matter
  const auto above = [&](int v) { return values[v] >= least; };
  UnionFind patches(mesh.vertexCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      if (const int a = mesh.faces(k, f), b = mesh.faces((k + 1) % 3, f); above(a) == above(b))
        patches.join(a, b);
  std::vector<double> area(mesh.vertexCount(), 0.0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k)
      area[patches.root(mesh.faces(k, f))] += 0.5 * areaVector(mesh, f).norm() / 3;
  for (int v = 0; v < mesh.vertexCount(); ++v)
    if (area[patches.root(v)] < patch_area)
      values[v] = above(v) ? least - flipped_margin : least + flipped_margin;
}

struct Cut {
  int a, b; ///< a < b
  float t;  ///< position from a to b
};

class Trimmer {
public:
  Trimmer(const Eigen::VectorXf& values, float least) : values_(values), least_(least) {}

  void add(const Eigen::Vector3i& face)
  {
    int polygon[4], n = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      if (keeps(a))
        polygon[n++] = a;
      if (keeps(a) != keeps(b))
        polygon[n++] = cutVertex(a, b);
    }
    for (int k = 2; k < n; ++k)
      faces_.insert(faces_.end(), {polygon[0], polygon[k - 1], polygon[k]});
  }

  std::vector<int> faces_;
  std::vector<Cut> cuts_;

private:
  bool keeps(int v) const { return values_[v] >= least_; }

  int cutVertex(int a, int b)
  {
    constexpr float end_margin = 1e-3f; // of an edge of length 1: cuts stay off its ends, so no triangle degenerates
    if (a > b)
      std::swap(a, b);
    const auto [at, added] = cut_of_edge_.try_emplace(std::uint64_t(a) << 32 | b, values_.size() + cuts_.size());
    if (added)
      cuts_.push_back(
          {a, b, std::clamp((least_ - values_[a]) / (values_[b] - values_[a]), end_margin, 1.f - end_margin)});
    return at->second;
  }

  const Eigen::VectorXf& values_;
  float least_;
  std::unordered_map<std::uint64_t, int> cut_of_edge_;
};

template <typename Matrix>
Matrix extended(const Matrix& values, const std::vector<Cut>& cuts)
{
  if (values.cols() == 0)
    return values;
  Matrix result(values.rows(), values.cols() + cuts.size());
  result.leftCols(values.cols()) = values;
  Index at = values.cols();
  for (const Cut& cut : cuts)
    result.col(at++) =
        ((1.f - cut.t) * values.col(cut.a).template cast<float>() + cut.t * values.col(cut.b).template cast<float>())
            .template cast<typename Matrix::Scalar>();
  return result;
}
} // namespace

TriangleMesh trimMesh(const TriangleMesh& mesh, Eigen::VectorXf values, float least, double patch_area, int rounds)
{
  require(values.size() == mesh.vertexCount(), "trimming: ", values.size(), " values for ", mesh.vertexCount(),
          " vertices");
  for (int i = 0; i < rounds; ++i)
    values = smoothed(mesh, values);
  flipPatches(mesh, least, patch_area, values);
  Trimmer trimmer(values, least);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    trimmer.add(mesh.faces.col(f));
  TriangleMesh cut;
  cut.origin = mesh.origin;
  cut.vertices = extended(mesh.vertices, trimmer.cuts_);
  cut.normals = extended(mesh.normals, trimmer.cuts_);
  cut.colors = extended(mesh.colors, trimmer.cuts_);
  for (const auto& [name, field_values] : mesh.fields)
    cut.fields[name] = extended(Eigen::RowVectorXf(field_values.transpose()), trimmer.cuts_).transpose();
  cut.faces = Eigen::Map<const Faces>(trimmer.faces_.data(), 3, trimmer.faces_.size() / 3);
  return removeUnreferencedVertices(cut);
}
} // namespace fresco
