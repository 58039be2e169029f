// SPDX-License-Identifier: BSD-3-Clause
#include "views/view_selection.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <limits>
namespace fresco::texture {
namespace {
constexpr int rounds = 24;              // messages reach as many patches far; sweeps end by themselves long before
constexpr std::size_t most_labels = 16; // per patch, the best ones: the others lose by their cost anyway

struct Label {
  int view;
  float cost;
};

/// Labels of every patch, by view number.
struct Labels {
  std::vector<Index> begin;
  std::vector<Label> list;
  Index count(Index i) const { return begin[i + 1] - begin[i]; }
};

Labels labelsOf(const PatchMesh& patches, const ViewCosts& costs)
{
  Labels out;
  out.begin.assign(1, 0);
  out.begin.reserve(patches.size() + 1);
  out.list.reserve(costs.candidates.list.size());
  std::vector<Label> kept;
  for (Index i = 0; i < patches.size(); ++i) {
    kept.clear();
    for (Index c = costs.candidates.begin[i]; c < costs.candidates.begin[i + 1]; ++c)
      kept.push_back({costs.candidates.list[c].view, costs.extra[c] - std::log2(costs.candidates.list[c].quality)});
    std::sort(kept.begin(), kept.end(),
              [](const Label& a, const Label& b) { return a.cost != b.cost ? a.cost < b.cost : a.view < b.view; });
    kept.resize(std::min(kept.size(), most_labels));
    const float least = kept.empty() ? 0.f : kept.front().cost;
    std::sort(kept.begin(), kept.end(), [](const Label& a, const Label& b) { return a.view < b.view; });
    for (const Label& label : kept)
      out.list.push_back({label.view, patches.areas[i] * (label.cost - least)});
    out.begin.push_back(out.list.size());
  }
  return out;
}

/// Length of a patch's side as far as a seam along it would show.
float visibleLength(const PatchMesh& patches, Index patch, int side)
{
  constexpr float crease_share = 0.1f; // of a seam's cost at a crease: shading changes there anyway
  const float cosine = patches.normals.col(patch).dot(patches.normals.col(patches.neighbors(side, patch)));
  return edgeLength(patches, patch, side) * (cosine > crease_cosine ? 1 : crease_share);
}

/// Min-sum messages of the Potts model over the patches' edges; all are renewed at once from those of the last round,
/// so that the order does not matter. Felzenszwalb & Huttenlocher 2006, "Efficient Belief Propagation for Early
/// Vision".
class BeliefPropagation {
public:
  BeliefPropagation(const PatchMesh& patches, const Labels& labels, const Eigen::Matrix3Xf& seams)
      : patches_(patches), labels_(labels), seams_(seams), now_(3 * labels.list.size(), 0.f), next_(now_)
  {}

  void round(int threads)
  {
    parallelFor(patches_.size(), threads, [&](Index i) {
      for (int side = 0; side < 3; ++side)
        if (const int from = patches_.neighbors(side, i); from >= 0 && labels_.count(i) > 0)
          receive(i, side, from);
    });
    now_.swap(next_);
  }

  int best(Index i) const
  {
    int view = -1;
    float least = std::numeric_limits<float>::infinity();
    for (Index l = labels_.begin[i]; l < labels_.begin[i + 1]; ++l)
      if (const float belief = labels_.list[l].cost + incoming(l, -1); belief < least) {
        least = belief;
        view = labels_.list[l].view;
      }
    return view;
  }

private:
  float incoming(Index label, int without) const
  {
    float sum = 0;
    for (int side = 0; side < 3; ++side)
      if (side != without)
        sum += now_[3 * label + side];
    return sum;
  }

  void receive(Index i, int side, int from)
  {
    constexpr float damping = 0.5f; // messages renewed at once would swing between two states
    if (labels_.count(from) == 0)
      return;
    const float edge = seams_(side, i);
    int back = 0; // the side of `from` that it shares with i
    while (back < 2 && patches_.neighbors(back, from) != i)
      ++back;
    float least = std::numeric_limits<float>::infinity(), others[most_labels]; // costs without what i says
    const Index first = labels_.begin[from];
    for (Index l = first; l < labels_.begin[from + 1]; ++l)
      least = std::min(least, others[l - first] = labels_.list[l].cost + incoming(l, back));
    Index k = first;
    for (Index l = labels_.begin[i]; l < labels_.begin[i + 1]; ++l) {
      while (k < labels_.begin[from + 1] && labels_.list[k].view < labels_.list[l].view)
        ++k;
      float message = edge;
      if (k < labels_.begin[from + 1] && labels_.list[k].view == labels_.list[l].view)
        message = std::min(edge, others[k - first] - least);
      next_[3 * l + side] = damping * now_[3 * l + side] + (1 - damping) * message;
    }
  }

  const PatchMesh& patches_;
  const Labels& labels_;
  const Eigen::Matrix3Xf& seams_;
  std::vector<float> now_, next_; ///< 3 per label: from the patch across each side
};

/// Each patch in turn takes the label that costs least given its neighbours, until none changes. Besag 1986, "On the
/// Statistical Analysis of Dirty Pictures".
void iteratedConditionalModes(const PatchMesh& patches, const Labels& labels, const Eigen::Matrix3Xf& seams,
                              Eigen::VectorXi& view)
{
  bool changed = true;
  for (int sweep = 0; sweep < rounds && changed; ++sweep) {
    changed = false;
    for (Index i = 0; i < patches.size(); ++i) {
      float least = std::numeric_limits<float>::infinity();
      int best = view[i];
      for (Index l = labels.begin[i]; l < labels.begin[i + 1]; ++l) {
        float cost = labels.list[l].cost;
        for (int side = 0; side < 3; ++side)
          if (const int other = patches.neighbors(side, i); other >= 0 && view[other] != labels.list[l].view)
            cost += seams(side, i);
        if (cost < least || (cost == least && labels.list[l].view == view[i])) {
          least = cost;
          best = labels.list[l].view;
        }
      }
      changed = changed || best != view[i];
      view[i] = best;
    }
  }
}
} // namespace

float edgeLength(const PatchMesh& patches, Index patch, int side)
{
  return (patches.vertices.col(patches.faces(side, patch)) - patches.vertices.col(patches.faces((side + 1) % 3, patch)))
      .norm();
}

Eigen::VectorXi selectViews(const PatchMesh& patches, const ViewCosts& costs, double seam, int threads)
{
  const Labels labels = labelsOf(patches, costs);
  const float seam_cost = seam;
  Eigen::Matrix3Xf seams = Eigen::Matrix3Xf::Zero(3, patches.size()); // cost of each side
  parallelFor(patches.size(), threads, [&](Index i) {
    for (int side = 0; side < 3; ++side)
      if (patches.neighbors(side, i) >= 0)
        seams(side, i) = seam_cost * visibleLength(patches, i, side);
  });
  BeliefPropagation propagation(patches, labels, seams);
  if (seam > 0)
    for (int r = 0; r < rounds; ++r)
      propagation.round(threads);
  Eigen::VectorXi view(patches.size());
  parallelFor(patches.size(), threads, [&](Index i) { view[i] = propagation.best(i); });
  iteratedConditionalModes(patches, labels, seams, view);
  return view;
}

double seamLength(const PatchMesh& patches, const Eigen::VectorXi& view)
{
  double length = 0;
  for (Index i = 0; i < view.size(); ++i)
    for (int side = 0; side < 3; ++side)
      if (const int other = patches.neighbors(side, i); other > i && other < view.size() && view[i] != view[other])
        length += edgeLength(patches, i, side);
  return length;
}
} // namespace fresco::texture
