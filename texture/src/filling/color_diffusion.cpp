// SPDX-License-Identifier: BSD-3-Clause
#include "filling/color_diffusion.h"
#include <fresco/core/parallel.h>
#include <vector>
namespace fresco::texture {
namespace {
/// Vertices joined by an edge, each as often as patches share the edge.
struct Rings {
  std::vector<int> begin, list;
};

Rings ringsOf(const PatchMesh& patches)
{
  Rings rings;
  rings.begin.assign(patches.vertices.cols() + 1, 0);
  for (Index i = 0; i < patches.faces.size(); ++i)
    rings.begin[patches.faces.data()[i] + 1] += 2;
  for (std::size_t v = 1; v < rings.begin.size(); ++v)
    rings.begin[v] += rings.begin[v - 1];
  rings.list.resize(rings.begin.back());
  std::vector<int> next(rings.begin.begin(), rings.begin.end() - 1);
  for (Index i = 0; i < patches.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      rings.list[next[patches.faces(k, i)]++] = patches.faces((k + 1) % 3, i);
      rings.list[next[patches.faces(k, i)]++] = patches.faces((k + 2) % 3, i);
    }
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
std::vector<int> spread(const Rings& rings, Known& known)
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
    for (int r = rings.begin[v]; r < rings.begin[v + 1]; ++r) {
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

void smooth(const Rings& rings, const std::vector<int>& free, int threads, Points& value)
{
  constexpr int rounds =
      100; // takes the streaks of the breadth-first start away; a solution to the last digit is not needed
  Points next = value;
  for (int round = 0; round < rounds; ++round) {
    parallelFor(free.size(), threads, [&](Index i) {
      const int v = free[i];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int r = rings.begin[v]; r < rings.begin[v + 1]; ++r)
        sum += value.col(rings.list[r]);
      next.col(v) = sum / static_cast<float>(rings.begin[v + 1] - rings.begin[v]);
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
  const Rings rings = ringsOf(patches);
  const std::vector<int> free = spread(rings, known);
  smooth(rings, free, threads, known.value);
  if (colored)
    known.value += patches.colors;
  return known.value.cwiseMax(0.f).cwiseMin(255.f);
}
} // namespace fresco::texture
