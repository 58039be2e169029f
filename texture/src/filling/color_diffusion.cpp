// SPDX-License-Identifier: BSD-3-Clause
#include "filling/color_diffusion.h"
#include "filling/creases.h"
#include "photographs/photo_store.h"
#include <fresco/core/grouped.h>
#include <fresco/core/parallel.h>
#include <limits>
#include <queue>
#include <vector>
namespace fresco::texture {
namespace {
constexpr float least_weight = 1e-3f; // over creases: a hundred smooth links in a row still join better

/// What colours are continued along.
struct Links {
  Groups rings;                   ///< nodes next to each node, as often as patches share the edge
  std::vector<float> weight;      ///< of each entry, 0..1
  std::vector<float> over_crease; ///< by node, with which it takes the colours of its vertex's other nodes
};

/// N. Nodes hardly take colours from beyond a crease, unless nothing is seen on their side: these are the best guess.
std::vector<float> weightsOverCreases(const PatchMesh& patches, const SmoothCorners& corners,
                                      const std::vector<char>& seen)
{
  const std::vector<int> pieces = smoothPieces(patches);
  std::vector<char> has_seen(patches.size(), 0); // by piece
  for (Index i = 0; i < patches.size(); ++i)
    has_seen[pieces[i]] |= seen[i];
  std::vector<float> weights(corners.size(), 1.f);
  for (Index i = 0; i < patches.size(); ++i)
    for (int k = 0; k < 3 && has_seen[pieces[i]]; ++k)
      weights[corners.node(k, i)] = least_weight;
  return weights;
}

/// Nodes joined by an edge of a patch, and those of one vertex.
Links linksOf(const SmoothCorners& corners, std::vector<float> over_crease)
{
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(corners.node.size() + corners.size() / 8);
  for (Index i = 0; i < corners.node.cols(); ++i)
    for (int k = 0; k < 3; ++k)
      pairs.emplace_back(corners.node(k, i), corners.node((k + 1) % 3, i));
  for (Index a = 0; a < corners.size(); ++a)
    for (Index b = a + 1; b < corners.size() && corners.vertex[b] == corners.vertex[a]; ++b)
      pairs.emplace_back(a, b);
  const auto ends = [&](Index i) { return i % 2 ? std::pair(pairs[i / 2].second, pairs[i / 2].first) : pairs[i / 2]; };
  Links links{
      grouped(2 * pairs.size(), corners.size(), [&](Index i) { return ends(i).first; }), {}, std::move(over_crease)};
  links.weight.reserve(links.rings.list.size());
  for (int& i : links.rings.list) {
    const auto [a, b] = ends(i);
    const float cosine = corners.normals.col(a).dot(corners.normals.col(b));
    const bool same_vertex = corners.vertex[a] == corners.vertex[b];
    links.weight.push_back(same_vertex ? links.over_crease[a]
                                       : std::max(least_weight, (cosine - crease_cosine) / (1 - crease_cosine)));
    i = b;
  }
  return links;
}

struct Known {
  Points value;            ///< 3xN, above `base`
  std::vector<char> fixed; ///< N: value is given, not continued
  Points least;            ///< 3xN, colours that what is continued is not darker than
  Points base;             ///< 3xN, colours of the mesh's own, or 0

  /// A value that is continued, as bright as it has to be in its own hue: what is overexposed tells of none.
  Eigen::Vector3f raised(Index node, const Eigen::Vector3f& continued) const
  {
    const Eigen::Vector3f color = (continued + base.col(node)).cwiseMax(1.f);
    return (continued + (lightAbove(color, least.col(node)) - 1) * color).cwiseMax(least.col(node) - base.col(node));
  }
};

Known seenNodes(const PatchMesh& patches, const SmoothCorners& corners, const Points& patch_colors,
                const std::vector<char>& seen)
{
  const Points none = Points::Zero(3, corners.size());
  Known known{none, std::vector<char>(corners.size(), 0), none, none};
  Eigen::VectorXf weight = Eigen::VectorXf::Zero(corners.size());
  for (Index i = 0; i < patches.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int v = corners.node(k, i);
      const float area = seen[i] ? patches.areas[i] : 0;
      known.value.col(v) += area * patch_colors.col(i);
      weight[v] += area;
      if (!seen[i])
        known.least.col(v) = known.least.col(v).cwiseMax(patch_colors.col(i));
    }
  for (Index v = 0; v < weight.size(); ++v)
    if (weight[v] > 0) {
      known.value.col(v) /= weight[v];
      known.fixed[v] = 1;
    }
  return known;
}

/// Outwards from the known nodes, the shortest way first: each takes the mean of those reached before it.
/// A link is as long as it hardly joins, so what is behind a crease is reached last.
/// @return the nodes reached, none of them fixed
std::vector<int> spread(const Links& links, const std::vector<int>& vertex, Known& known)
{
  using Reached = std::pair<float, int>; // way, node
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  std::vector<float> way(known.fixed.size(), std::numeric_limits<float>::infinity());
  for (std::size_t v = 0; v < way.size(); ++v)
    if (known.fixed[v])
      queue.emplace(way[v] = 0.f, v);
  std::vector<char> done(way.size(), 0);
  std::vector<int> order;
  while (!queue.empty()) {
    const auto [length, v] = queue.top();
    queue.pop();
    if (done[v])
      continue;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float total = 0;
    for (Index r = links.rings.begin[v]; r < links.rings.begin[v + 1]; ++r) {
      const int other = links.rings.list[r];
      if (done[other]) {
        sum += links.weight[r] * known.value.col(other);
        total += links.weight[r];
      } else {
        const float weight = vertex[other] == vertex[v] ? links.over_crease[other] : links.weight[r];
        if (const float next = length + 1.f / weight; next < way[other])
          queue.emplace(way[other] = next, other);
      }
    }
    done[v] = 1;
    if (known.fixed[v])
      continue;
    known.value.col(v) = known.raised(v, sum / total);
    order.push_back(v);
  }
  return order;
}

/// Rounds of means over the nodes beside, with the factors of Golub & Varga 1961 (Chebyshev's semi-iteration).
void smooth(const Links& links, const std::vector<int>& free, int threads, Known& known)
{
  constexpr int rounds = 20; // takes the streaks of the outward start away; a solution to the last digit is not needed
  constexpr float radius = 0.99f;             // spectral, of what is to go
  Points &value = known.value, other = value; // of the round before, then of the next
  float factor = 1;
  for (int round = 0; round < rounds; ++round) {
    parallelFor(free.size(), threads, [&](Index i) {
      const int v = free[i];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      float total = 0;
      for (Index r = links.rings.begin[v]; r < links.rings.begin[v + 1]; ++r) {
        sum += links.weight[r] * value.col(links.rings.list[r]);
        total += links.weight[r];
      }
      other.col(v) = known.raised(v, other.col(v) + factor * (sum / total - other.col(v)));
    });
    value.swap(other);
    factor = 1 / (1 - radius * radius * (round == 0 ? 0.5f : 0.25f * factor));
  }
}
} // namespace

Points diffuseColors(const PatchMesh& patches, const Points& colors, const std::vector<char>& clipped, int threads)
{
  const SmoothCorners corners = joinSmoothCorners(patches);
  std::vector<char> seen(patches.size());
  for (Index i = 0; i < patches.size(); ++i)
    seen[i] = colors(0, i) >= 0 && !clipped[i];
  Known known = seenNodes(patches, corners, colors, seen);
  const bool colored = patches.colors.cols() > 0;
  if (colored)
    known.base = patches.colors(Eigen::all, corners.vertex);
  known.value -= known.base;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  float count = 0;
  for (Index v = 0; v < known.value.cols(); ++v) {
    mean += known.fixed[v] * known.value.col(v);
    count += known.fixed[v];
  }
  mean = count > 0 ? Eigen::Vector3f(mean / count) : Eigen::Vector3f::Constant(colored ? 0 : mid_grey);
  for (Index v = 0; v < known.value.cols(); ++v)
    if (!known.fixed[v])
      known.value.col(v) = known.raised(v, mean);
  const Links links = linksOf(corners, weightsOverCreases(patches, corners, seen));
  smooth(links, spread(links, corners.vertex, known), threads, known);
  known.value += known.base;
  const Eigen::Map<const Eigen::VectorXi> nodes(corners.node.data(), corners.node.size());
  return known.value(Eigen::all, nodes).cwiseMax(0.f).cwiseMin(255.f);
}
} // namespace fresco::texture
