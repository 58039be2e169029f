// SPDX-License-Identifier: BSD-3-Clause
#include "filling/color_diffusion.h"
#include <fresco/core/grouped.h>
#include <fresco/core/parallel.h>
#include <vector>
namespace fresco::texture {
namespace {
/// Of each vertex those joined with it by an edge, as often as patches share the edge.
Groups ringsOf(const PatchMesh& patches)
{
  const auto vertex = [&](Index i) { return patches.faces.data()[i / 2]; }; // two entries per corner of a patch
  Groups rings = grouped(2 * patches.faces.size(), patches.vertices.cols(), vertex);
  for (int& i : rings.list)
    i = patches.faces((i / 2 + 1 + i % 2) % 3, i / 6);
  return rings;
}

struct Known {
  Points value;            ///< 3xV
  std::vector<char> fixed; ///< V: value is given, not continued
};

Known seenVertices(const PatchMesh& patches, const Points& patch_colors)
{
  Known known{Points::Zero(3, patches.vertices.cols()), std::vector<char>(patches.vertices.cols(), 0)};
  Eigen::VectorXf weight = Eigen::VectorXf::Zero(patches.vertices.cols());
  for (Index i = 0; i < patches.size(); ++i)
    for (int k = 0; k < 3 && patch_colors(0, i) >= 0; ++k) {
      const int v = patches.faces(k, i);
      known.value.col(v) += patches.areas[i] * patch_colors.col(i);
      weight[v] += patches.areas[i];
    }
  for (Index v = 0; v < weight.size(); ++v)
    if (weight[v] > 0) {
      known.value.col(v) /= weight[v];
      known.fixed[v] = 1;
    }
  return known;
}

/// Breadth first from the known vertices: each takes the mean of its neighbours reached before it.
/// @return the vertices reached, none of them fixed
std::vector<int> spread(const Groups& rings, Known& known)
{
  std::vector<int> order;
  std::vector<char> reached = known.fixed;
  for (std::size_t v = 0; v < reached.size(); ++v)
    if (reached[v])
      order.push_back(v);
  const std::size_t given = order.size();
  std::vector<char> valued = known.fixed;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int v = order[i];
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float count = 0;
    for (Index r = rings.begin[v]; r < rings.begin[v + 1]; ++r) {
      const int other = rings.list[r];
      if (valued[other] && !known.fixed[v]) {
        sum += known.value.col(other);
        ++count;
      }
      if (!reached[other]) {
        reached[other] = 1;
        order.push_back(other);
      }
    }
    if (count > 0)
      known.value.col(v) = sum / count;
    valued[v] = 1;
  }
  return {order.begin() + given, order.end()};
}

void smooth(const Groups& rings, const std::vector<int>& free, int threads, Points& value)
{
  constexpr int rounds =
      100; // takes the streaks of the breadth-first start away; a solution to the last digit is not needed
  Points next = value;
  for (int round = 0; round < rounds; ++round) {
    parallelFor(free.size(), threads, [&](Index i) {
      const int v = free[i];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (Index r = rings.begin[v]; r < rings.begin[v + 1]; ++r)
        sum += value.col(rings.list[r]);
      next.col(v) = sum / (rings.begin[v + 1] - rings.begin[v]);
    });
    value.swap(next);
  }
}
} // namespace

Points diffuseColors(const PatchMesh& patches, const Points& patch_colors, int threads)
{
  constexpr float mid_grey = 128.f;
  Known known = seenVertices(patches, patch_colors);
  const bool colored = patches.colors.cols() > 0;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  float count = 0;
  for (Index v = 0; v < known.value.cols(); ++v)
    if (known.fixed[v]) {
      if (colored)
        known.value.col(v) -= patches.colors.col(v);
      mean += known.value.col(v);
      ++count;
    }
  mean = count > 0 ? Eigen::Vector3f(mean / count) : Eigen::Vector3f::Constant(colored ? 0 : mid_grey);
  for (Index v = 0; v < known.value.cols(); ++v)
    if (!known.fixed[v])
      known.value.col(v) = mean;
  const Groups rings = ringsOf(patches);
  const std::vector<int> free = spread(rings, known);
  smooth(rings, free, threads, known.value);
  if (colored)
    known.value += patches.colors;
  return known.value.cwiseMax(0.f).cwiseMin(255.f);
}
} // namespace fresco::texture
