// SPDX-License-Identifier: BSD-3-Clause
#include "views/exposure.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <map>
#include <numeric>
namespace fresco::texture {
namespace {
/// Logarithms of the first view's colours over the second's.
using Pairs = std::map<std::pair<int, int>, std::vector<Eigen::Vector3f>>;

bool isClear(const Candidate& c)
{
  constexpr int darkest = 12, brightest = 240; // grey levels: beyond, a value says little of the light
  return std::all_of(c.color.begin(), c.color.end(), [](int v) { return v >= darkest && v <= brightest; });
}

Eigen::Vector3f logColor(const Candidate& c)
{
  return Eigen::Vector3f(c.color[0], c.color[1], c.color[2]).array().log();
}

void addPatch(const Candidates& candidates, const std::vector<int>& owner, Index patch, Pairs& pairs)
{
  constexpr float trusted = 0.2f;            // of the best quality: views that show much less blur the colour
  constexpr std::size_t most_samples = 1000; // per pair of views: more hardly change a median
  const Candidate* list = candidates.of(patch);
  const float best = candidates.bestQuality(patch);
  for (Index i = 0; i < candidates.count(patch); ++i) {
    if (list[i].quality() < trusted * best || !isClear(list[i]))
      continue;
    for (Index j = i + 1; j < candidates.count(patch); ++j)
      if (const int a = owner[list[i].view], b = owner[list[j].view];
          a != b && list[j].quality() >= trusted * best && isClear(list[j])) {
        auto& ratios = pairs[{a, b}];
        if (ratios.size() < most_samples)
          ratios.push_back(logColor(list[i]) - logColor(list[j]));
      }
  }
}

/// From patches spread over the whole mesh.
Pairs collectPairs(const Candidates& candidates, const std::vector<int>& owner)
{
  constexpr Index most_patches = 40000; // far more than the unknowns ask for
  const Index patches = candidates.begin.size() - 1;
  const Index taken = std::min(patches, most_patches);
  Pairs pairs;
  const Index golden = 0.618 * taken;
  Index step = golden | 1;
  while (taken > 1 && std::gcd(step, taken) != 1)
    step += 2;
  for (Index k = 0, at = 0; k < taken; ++k, at = (at + step) % taken)
    addPatch(candidates, owner, at * patches / taken, pairs);
  return pairs;
}

float channelMedian(const std::vector<Eigen::Vector3f>& values, int channel)
{
  std::vector<float> numbers;
  for (const Eigen::Vector3f& v : values)
    numbers.push_back(v[channel]);
  return median(numbers);
}

struct Equation {
  int first, second;
  double difference, weight;
};

Eigen::VectorXd solve(const std::vector<Equation>& equations, Index views)
{
  constexpr int rounds = 10;              // of reweighting
  constexpr double outlier = 0.03;        // of a logarithm (Cauchy): pairs off by more than 3 % count less
  constexpr double regularization = 1e-3; // holds views without partners at 1; nothing beside a pair's weight
  Eigen::VectorXd x = Eigen::VectorXd::Zero(views);
  for (int round = 0; round < rounds; ++round) {
    Eigen::MatrixXd A = regularization * Eigen::MatrixXd::Identity(views, views);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(views);
    for (const Equation& e : equations) {
      const double error = x[e.first] - x[e.second] - e.difference;
      const double w = round == 0 ? e.weight : e.weight / (1 + error * error / (outlier * outlier));
      A(e.first, e.first) += w;
      A(e.second, e.second) += w;
      A(e.first, e.second) -= w;
      A(e.second, e.first) -= w;
      b[e.first] += w * e.difference;
      b[e.second] -= w * e.difference;
    }
    x = A.ldlt().solve(b);
  }
  return x;
}
} // namespace

Points solveGains(const Candidates& candidates, const std::vector<int>& owner)
{
  const Index views = owner.empty() ? 0 : 1 + *std::max_element(owner.begin(), owner.end());
  constexpr std::size_t least_samples = 12; // per pair of views, for a median to count
  const Pairs pairs = collectPairs(candidates, owner);
  Points gains = Points::Ones(3, views);
  for (int c = 0; c < 3 && views > 0; ++c) {
    std::vector<Equation> equations;
    std::vector<char> known(views, 0);
    for (const auto& [key, ratios] : pairs)
      if (ratios.size() >= least_samples) {
        equations.push_back({key.first, key.second, channelMedian(ratios, c), std::sqrt(ratios.size())});
        known[key.first] = known[key.second] = 1;
      }
    const double count = std::count(known.begin(), known.end(), 1);
    if (!(count > 0))
      break;
    const Eigen::VectorXd x = solve(equations, views);
    double mean = 0;
    for (Index v = 0; v < views; ++v)
      mean += known[v] ? x[v] / count : 0;
    for (Index v = 0; v < views; ++v)
      if (known[v])
        gains(c, v) = std::exp(mean - x[v]);
  }
  return gains(Eigen::all, owner);
}
} // namespace fresco::texture
