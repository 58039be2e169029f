// SPDX-License-Identifier: BSD-3-Clause
#include "pair/plane_matching.h"
#include "scan/lists.h"
#include <algorithm>
#include <array>
#include <cmath>
namespace fresco::registration {
namespace {
struct Shift {
  float bins = 0.f, score = 0.f; ///< of the second scan's planes; correlation, 0..1
};

// An axis of the second scan that becomes one of the first.
struct AxisMatch {
  int a = 0, b = 0;
  bool flipped = false;
};

double weightOf(const std::array<PlaneHistogram, 2>& axis)
{
  double sum = 0.0;
  for (const PlaneHistogram& histogram : axis)
    for (const float weight : histogram.weights)
      sum += weight * weight;
  return sum;
}

PlaneHistogram flipped(PlaneHistogram histogram)
{
  const Index count = histogram.weights.size();
  histogram.first = -(histogram.first + count - 1);
  std::reverse(histogram.weights.begin(), histogram.weights.end());
  return histogram;
}

// The highest peaks of the correlation.
std::vector<Shift> findShifts(const ScanPlanes& a, const ScanPlanes& b, const AxisMatch& match)
{
  constexpr std::size_t peaks = 8; // pairs of walls that can be meant
  constexpr Index apart = 2;       // bins: nearer peaks are one
  std::array<PlaneHistogram, 2> second = b.histograms[match.b];
  if (match.flipped)
    second = {flipped(second[1]), flipped(second[0])};
  Index low = 0, high = 0;
  for (const int side : {0, 1}) {
    const PlaneHistogram &x = a.histograms[match.a][side], &y = second[side];
    low = std::min(low, x.first - y.first - static_cast<Index>(y.weights.size()));
    high = std::max(high, x.first + static_cast<Index>(x.weights.size()) - y.first);
  }
  std::vector<float> correlation(high - low + 1, 0.f);
  for (const int side : {0, 1}) {
    const PlaneHistogram &x = a.histograms[match.a][side], &y = second[side];
    for (std::size_t i = 0; i < x.weights.size(); ++i)
      for (std::size_t k = 0; x.weights[i] > 0.f && k < y.weights.size(); ++k)
        correlation[x.first + i - y.first - k - low] += x.weights[i] * y.weights[k];
  }
  const float norm = std::sqrt(weightOf(a.histograms[match.a]) * weightOf(second)) + 1e-9f;
  std::vector<Shift> shifts;
  const Index n = correlation.size();
  for (Index k = 0; k < n; ++k) {
    const auto from = correlation.begin() + std::max<Index>(0, k - apart),
               to = correlation.begin() + std::min(n, k + apart + 1);
    if (correlation[k] > 0.f && correlation[k] >= *std::max_element(from, to))
      shifts.push_back({static_cast<float>(k + low), correlation[k] / norm});
  }
  keepLargest(shifts, peaks, &Shift::score);
  return shifts;
}

// The 24 rotations that bring axes onto axes.
std::vector<std::array<AxisMatch, 3>> axisMatches()
{
  std::vector<std::array<AxisMatch, 3>> all;
  std::array<int, 3> order = {0, 1, 2};
  do {
    const bool even = (order[1] - order[0] + 3) % 3 == 1;
    for (int flips = 0; flips < 8; ++flips) {
      const std::array<bool, 3> flip = {(flips & 1) != 0, (flips & 2) != 0, (flips & 4) != 0};
      const bool odd = (flip[0] != flip[1]) != flip[2];
      if (odd == even)
        continue; // a reflection
      all.push_back({AxisMatch{0, order[0], flip[0]}, {1, order[1], flip[1]}, {2, order[2], flip[2]}});
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

Eigen::Matrix3f turn(const ScanPlanes& a, const ScanPlanes& b, const std::array<AxisMatch, 3>& matches)
{
  Eigen::Matrix3f R = Eigen::Matrix3f::Zero();
  for (const AxisMatch& match : matches)
    R += (match.flipped ? -1.f : 1.f) * a.axes.col(match.a) * b.axes.col(match.b).transpose();
  return R;
}
} // namespace

PoseHypotheses matchPlanes(const ScanPlanes& a, const ScanPlanes& b, std::size_t most)
{
  PoseHypotheses found;
  if (a.axes.isZero() || b.axes.isZero())
    return found;
  std::array<std::vector<Shift>, 18> shifts;
  const auto number = [](const AxisMatch& match) { return match.a * 6 + match.b * 2 + (match.flipped ? 1 : 0); };
  for (int k = 0; k < 18; ++k)
    shifts[k] = findShifts(a, b, {k / 6, k / 2 % 3, k % 2 == 1});
  for (const auto& matches : axisMatches()) {
    PoseHypothesis next;
    next.T_a_b.linear() = turn(a, b, matches).cast<double>();
    for (const Shift& x : shifts[number(matches[0])])
      for (const Shift& y : shifts[number(matches[1])])
        for (const Shift& z : shifts[number(matches[2])]) {
          next.T_a_b.translation() = (a.axes * Eigen::Vector3f(x.bins, y.bins, z.bins) * a.bin).cast<double>();
          next.score = x.score * y.score * z.score;
          found.push_back(next);
        }
  }
  keepLargest(found, most, &PoseHypothesis::score);
  return found;
}
} // namespace fresco::registration
