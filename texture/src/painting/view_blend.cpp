// SPDX-License-Identifier: BSD-3-Clause
#include "painting/view_blend.h"
#include "painting/seam_levelling.h"
#include "views/vertex_views.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
double meanEdge(const PatchMesh& patches)
{
  double sum = 0;
  for (Index i = 0; i < patches.size(); ++i)
    sum += (patches.vertices.col(patches.faces(0, i)) - patches.vertices.col(patches.faces(1, i))).norm();
  return sum / patches.size();
}

/// k rounds of averaging spread a step over about sqrt(k) edges to either side.
int blendRounds(double mean_edge, double width)
{
  const double edges = width / std::max(2 * mean_edge, 1e-30);
  return std::clamp(std::round(edges * edges), 0.0, 8.0);
}

namespace {
class Blending {
public:
  Blending(const BlendInput& input, const BlendOptions& options)
      : input_(input), patches_(input.patches), view_(input.view), around_(vertexPatches(patches_)),
        shares_(shareVertices(patches_, around_, view_, options.rounds))
  {
    if (options.level)
      offsets_ = levelSeams(input, around_, shares_, options);
  }

  Blend run() const
  {
    Blend out;
    out.begin.assign(1, 0);
    for (Index i = 0; i < patches_.size(); ++i) {
      if (view_[i] >= 0)
        addPatch(i, out.list);
      out.begin.push_back(out.list.size());
    }
    return out;
  }

private:
  void addPatch(Index patch, std::vector<BlendShare>& out) const
  {
    std::vector<int> views{view_[patch]};
    for (int k = 0; k < 3; ++k)
      for (const VertexShare& s : shares_[patches_.faces(k, patch)])
        if (std::find(views.begin(), views.end(), s.view) == views.end() && input_.usable(patch, s.view))
          views.push_back(s.view);
    const std::size_t first = out.size();
    for (const int view : views)
      out.push_back(shareOf(patch, view));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (std::size_t s = first; s < out.size(); ++s)
      sum += out[s].weights;
    for (int k = 0; k < 3; ++k)
      if (!(sum[k] > 0))
        out[first].weights[k] = sum[k] = 1;
    for (std::size_t s = first; s < out.size(); ++s)
      out[s].weights = out[s].weights.cwiseQuotient(sum);
  }

  BlendShare shareOf(Index patch, int view) const
  {
    BlendShare share{view, Eigen::Vector3f::Zero(), Eigen::Matrix3f::Zero()};
    Eigen::Array3f known = Eigen::Array3f::Zero();
    for (int k = 0; k < 3; ++k) {
      const int v = patches_.faces(k, patch);
      for (std::size_t s = 0; s < shares_[v].size(); ++s)
        if (shares_[v][s].view == view) {
          share.weights[k] = shares_[v][s].weight;
          if (offsets_.offsets.cols() > 0) {
            share.offsets.col(k) = offsets_.offsets.col(offsets_.begin[v] + s);
            known[k] = 1;
          }
        }
    }
    const Eigen::Vector3f mean = share.offsets.rowwise().sum() / std::max(1.f, known.sum());
    for (int k = 0; k < 3; ++k)
      if (known[k] == 0)
        share.offsets.col(k) = mean;
    return share;
  }

  const BlendInput input_;
  const PatchMesh& patches_;
  const Eigen::VectorXi& view_;
  Groups around_;
  VertexViews shares_;
  SeamOffsets offsets_;
};
} // namespace

Blend blendViews(const BlendInput& input, const BlendOptions& options) { return Blending(input, options).run(); }
} // namespace fresco::texture
