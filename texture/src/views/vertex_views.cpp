// SPDX-License-Identifier: BSD-3-Clause
#include "views/vertex_views.h"
#include <algorithm>
namespace fresco::texture {
namespace {
void add(std::vector<VertexShare>& shares, int view, float weight)
{
  const auto at = std::find_if(shares.begin(), shares.end(), [&](const VertexShare& s) { return s.view == view; });
  if (at == shares.end())
    shares.push_back({view, weight});
  else
    at->weight += weight;
}

/// The largest shares only, by view number, with sum 1.
void tidy(std::vector<VertexShare>& shares)
{
  constexpr std::size_t most_shares = 4; // more views hardly meet at a vertex
  float sum = 0;
  for (const VertexShare& s : shares)
    sum += s.weight;
  std::sort(shares.begin(), shares.end(), [](const VertexShare& a, const VertexShare& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.view < b.view;
  });
  while (!shares.empty() && (shares.size() > most_shares || shares.back().weight < least_share * sum))
    shares.pop_back();
  sum = 0;
  for (const VertexShare& s : shares)
    sum += s.weight;
  for (VertexShare& s : shares)
    s.weight /= sum;
  std::sort(shares.begin(), shares.end(), [](const VertexShare& a, const VertexShare& b) { return a.view < b.view; });
}

VertexViews fromPatches(const PatchMesh& patches, const Groups& around, const Eigen::VectorXi& view)
{
  VertexViews out(around.begin.size() - 1);
  for (std::size_t v = 0; v < out.size(); ++v) {
    for (int k = around.begin[v]; k < around.begin[v + 1]; ++k)
      if (const int patch = around.list[k]; view[patch] >= 0)
        add(out[v], view[patch], std::max(patches.areas[patch], 1e-20f));
    tidy(out[v]);
  }
  return out;
}

/// Vertices with a neighbour that has another view than they, or more than one.
std::vector<int> atSeams(const PatchMesh& patches, const VertexViews& shares)
{
  std::vector<char> marked(shares.size(), 0);
  for (Index i = 0; i < patches.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int a = patches.faces(k, i), b = patches.faces((k + 1) % 3, i);
      const bool differ = shares[a].size() != 1 || shares[b].size() != 1 || shares[a][0].view != shares[b][0].view;
      if (differ && !shares[a].empty() && !shares[b].empty())
        marked[a] = marked[b] = 1;
    }
  std::vector<int> out;
  for (std::size_t v = 0; v < marked.size(); ++v)
    if (marked[v])
      out.push_back(v);
  return out;
}
} // namespace

Groups vertexPatches(const PatchMesh& patches)
{
  const int* vertices = patches.faces.data();
  Groups out = grouped(patches.faces.size(), patches.vertices.cols(), [&](Index i) { return vertices[i]; });
  for (int& i : out.list)
    i /= 3;
  return out;
}

VertexViews shareVertices(const PatchMesh& patches, const Groups& around, const Eigen::VectorXi& view, int rounds)
{
  VertexViews shares = fromPatches(patches, around, view);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<int> active = atSeams(patches, shares);
    std::vector<std::vector<VertexShare>> next(active.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
      const int v = active[i];
      for (int k = around.begin[v]; k < around.begin[v + 1]; ++k)
        for (int c = 0; c < 3; ++c)
          for (const VertexShare& s : shares[patches.faces(c, around.list[k])])
            add(next[i], s.view, s.weight);
      tidy(next[i]);
    }
    for (std::size_t i = 0; i < active.size(); ++i)
      shares[active[i]] = std::move(next[i]);
  }
  return shares;
}
} // namespace fresco::texture
