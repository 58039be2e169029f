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
/// One patch in two views.
struct ColorRatio {
  Eigen::Vector3f log_ratio; ///< of the first view's colour over the second's
  float radius[2];           ///< squared, in either photograph
};
using Pairs = std::map<std::pair<int, int>, std::vector<ColorRatio>>;

bool isClear(const Candidate& c)
{
  constexpr int darkest = 12, brightest = 240; // grey levels: beyond, a value says little of the light
  return !c.clipped &&
         std::all_of(c.color.begin(), c.color.end(), [](int v) { return v >= darkest && v <= brightest; });
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
          ratios.push_back({logColor(list[i]) - logColor(list[j]), {list[i].squaredRadius(), list[j].squaredRadius()}});
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

/// The lenses' transmission, with the exposure of each view as a by-product: Cauchy-weighted least squares on grey.
class FalloffSystem {
public:
  FalloffSystem(const Pairs& pairs, const std::vector<int>& lens)
      : pairs_(pairs), lens_(lens), lenses_(std::max(*std::max_element(lens.begin(), lens.end()) + 1, 1))
  {}

  std::vector<LensFalloff> solve() const
  {
    constexpr int rounds = 8; // of reweighting
    Eigen::VectorXd x = Eigen::VectorXd::Zero(terms * lenses_ + lens_.size());
    for (int round = 0; round < rounds; ++round)
      x = step(x, round > 0);
    std::vector<LensFalloff> out(lenses_);
    for (int l = 0; l < lenses_; ++l)
      out[l].a = x.segment<terms>(terms * l).cast<float>();
    return out;
  }

private:
  static constexpr int terms = 3;

  /// Of one ratio: log(first / second) = sum of factor * x over six coefficients of lenses and two views.
  struct Row {
    std::array<int, 2 * terms + 2> at;
    Eigen::Matrix<double, 2 * terms + 2, 1> factor;
  };

  Row rowOf(const std::pair<int, int>& views, const ColorRatio& ratio) const
  {
    Row row;
    const int view[2] = {views.first, views.second};
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1 : -1, r2 = ratio.radius[side];
      for (int t = 0; t < terms; ++t) {
        const int lens = lens_[view[side]];
        row.at[terms * side + t] = terms * std::max(lens, 0) + t;
        row.factor[terms * side + t] = lens < 0 ? 0 : sign * std::pow(r2, t + 1);
      }
      row.at[2 * terms + side] = terms * lenses_ + view[side];
      row.factor[2 * terms + side] = sign;
    }
    return row;
  }

  Eigen::VectorXd step(const Eigen::VectorXd& x, bool reweight) const
  {
    constexpr double outlier = 0.03;        // of a logarithm (Cauchy): patches off by more than 3 % count less
    constexpr double usual = 0.5;           // coefficients of a strong lens: corners at 60 %
    constexpr std::size_t most_ratios = 64; // per pair of views
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(x.size(), x.size());
    A.diagonal().setConstant(outlier * outlier / (usual * usual));
    Eigen::VectorXd b = Eigen::VectorXd::Zero(x.size());
    for (const auto& [views, ratios] : pairs_)
      for (std::size_t k = 0; k < std::min(ratios.size(), most_ratios); ++k) {
        const Row row = rowOf(views, ratios[k]);
        const double value = ratios[k].log_ratio.mean();
        double error = -value;
        for (std::size_t i = 0; i < row.at.size(); ++i)
          error += row.factor[i] * x[row.at[i]];
        const double w = reweight ? 1 / (1 + error * error / (outlier * outlier)) : 1;
        for (std::size_t i = 0; i < row.at.size(); ++i) {
          b[row.at[i]] += w * row.factor[i] * value;
          for (std::size_t j = 0; j < row.at.size(); ++j)
            A(row.at[i], row.at[j]) += w * row.factor[i] * row.factor[j];
        }
      }
    return A.ldlt().solve(b);
  }

  const Pairs& pairs_;
  const std::vector<int>& lens_;
  int lenses_;
};

/// Lenses that let through the same everywhere, to the precision of the measurement, are taken as such.
std::vector<LensFalloff> solveFalloff(const Pairs& pairs, const std::vector<int>& lens)
{
  constexpr float least = 0.01f; // of a logarithm: 1 % of the light, 2.5 grey levels, do not show
  std::vector<LensFalloff> out = FalloffSystem(pairs, lens).solve();
  for (LensFalloff& falloff : out) {
    float most = 0;
    for (const float r2 : {0.25f, 0.5f, 0.75f, 1.f})
      most = std::max(most, std::fabs(falloff.logTransmission(r2)));
    if (most < least)
      falloff = {};
  }
  return out;
}

/// Takes the lenses' part out of the ratios.
void correctRatios(const std::vector<LensFalloff>& falloff, const std::vector<int>& lens, Pairs& pairs)
{
  const auto of = [&](int view) { return lens[view] < 0 ? LensFalloff{} : falloff[lens[view]]; };
  for (auto& [views, ratios] : pairs) {
    const LensFalloff first = of(views.first), second = of(views.second);
    for (ColorRatio& ratio : ratios)
      ratio.log_ratio.array() -= first.logTransmission(ratio.radius[0]) - second.logTransmission(ratio.radius[1]);
  }
}

float channelMedian(const std::vector<ColorRatio>& values, int channel)
{
  std::vector<float> numbers;
  for (const ColorRatio& v : values)
    numbers.push_back(v.log_ratio[channel]);
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

Points solveGains(const Pairs& pairs, const std::vector<int>& owner)
{
  const Index views = owner.empty() ? 0 : 1 + *std::max_element(owner.begin(), owner.end());
  constexpr std::size_t least_samples = 12; // per pair of views, for a median to count
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
} // namespace

Points solveGains(const Candidates& candidates, const std::vector<int>& owner)
{
  return solveGains(collectPairs(candidates, owner), owner);
}

Photometry solvePhotometry(const Candidates& candidates, const std::vector<int>& lenses, const std::vector<int>& owner)
{
  Photometry out;
  out.gains.setOnes(3, lenses.size());
  if (lenses.empty())
    return out;
  Pairs pairs = collectPairs(candidates, owner);
  std::vector<int> lens_of_owner(1 + *std::max_element(owner.begin(), owner.end()), -1);
  for (std::size_t v = 0; v < owner.size(); ++v)
    lens_of_owner[owner[v]] = lenses[v];
  out.lens = lenses;
  out.falloff = solveFalloff(pairs, lens_of_owner);
  correctRatios(out.falloff, lens_of_owner, pairs);
  out.gains = solveGains(pairs, owner);
  return out;
}

void describePhotometry(const Photometry& photometry, const std::vector<int>& owner, Index views, TextureResult& result)
{
  result.gains.resize(3, views);
  result.vignetting.resize(3, views);
  for (std::size_t part = 0; part < owner.size(); ++part) {
    result.gains.col(owner[part]) = photometry.gains.col(part);
    result.vignetting.col(owner[part]) = photometry.falloffOf(part).a;
  }
}
} // namespace fresco::texture
