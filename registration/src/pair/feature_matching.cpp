// SPDX-License-Identifier: BSD-3-Clause
#include "pair/feature_matching.h"
#include <algorithm>
namespace fresco::registration {
namespace {
struct RankedMatch {
  bool single; // chosen in one direction only
  float likeness;
  Correspondence match;
};

std::vector<Correspondence> bestMatches(std::vector<RankedMatch> ranked, std::size_t most)
{
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedMatch& x, const RankedMatch& y) {
    return x.single != y.single ? y.single : x.likeness > y.likeness;
  });
  std::vector<Correspondence> matches;
  for (std::size_t k = 0; k < std::min(most, ranked.size()); ++k)
    matches.push_back(ranked[k].match);
  return matches;
}

// For each column the row of the most similar descriptor, and the likeness, 0..1.
std::vector<std::pair<Index, float>> mostSimilar(const Eigen::MatrixXf& likeness)
{
  std::vector<std::pair<Index, float>> best(likeness.cols());
  for (Index i = 0; i < likeness.cols(); ++i) {
    Index row = 0;
    const float value = likeness.col(i).maxCoeff(&row);
    best[i] = {row, value};
  }
  return best;
}
} // namespace

std::vector<Correspondence> matchFeatures(const ScanFeatures& a, const ScanFeatures& b, std::size_t most)
{
  if (a.points.cols() == 0 || b.points.cols() == 0)
    return {};
  const Eigen::MatrixXf likeness = b.descriptors.transpose() * a.descriptors;
  const auto forward = mostSimilar(likeness), backward = mostSimilar(likeness.transpose());
  std::vector<RankedMatch> ranked;
  for (Index i = 0; i < a.points.cols(); ++i) {
    const auto [j, value] = forward[i];
    ranked.push_back({backward[j].first != i, value, {i, j}});
  }
  for (Index j = 0; j < b.points.cols(); ++j) {
    const auto [i, value] = backward[j];
    if (forward[i].first != j)
      ranked.push_back({true, value, {i, j}});
  }
  return bestMatches(std::move(ranked), most);
}

std::vector<Correspondence> matchToSelf(const ScanFeatures& features, const SelfMatching& matching)
{
  constexpr std::size_t most_matches = 2000; // bounds the square matrix of compatibilities
  std::vector<RankedMatch> ranked;
  for (const Index i : matching.from) {
    Eigen::VectorXf likeness = features.descriptors.transpose() * features.descriptors.col(i);
    Index j = i;
    for (int k = 0; k < matching.count; ++k) {
      const float apart = k == 0 ? matching.apart : matching.between;
      for (Index other = 0; other < features.points.cols(); ++other)
        if ((features.points.col(other) - features.points.col(j)).squaredNorm() < apart * apart)
          likeness[other] = -1.f;
      if (!(likeness.maxCoeff(&j) > 0.f))
        break;
      ranked.push_back({false, likeness[j], {i, j}});
    }
  }
  return bestMatches(std::move(ranked), most_matches);
}
} // namespace fresco::registration
