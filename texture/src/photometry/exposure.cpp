// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/exposure.h"
#include "photometry/lens_calibration.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
namespace fresco::texture {
namespace {
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
      const double w = round == 0 ? e.weight : e.weight * cauchyWeight(error * error / (outlier * outlier));
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

Points solveGains(const ColorRatios& pairs, const std::vector<int>& owner)
{
  const Index views = owner.empty() ? 0 : 1 + *std::max_element(owner.begin(), owner.end());
  constexpr std::size_t least_samples = 12; // per pair of views, for a median to count
  Points gains = Points::Ones(3, views);
  for (int c = 0; c < 3 && views > 0; ++c) {
    std::vector<Equation> equations;
    Eigen::VectorXd known = Eigen::VectorXd::Zero(views);
    for (const auto& [key, ratios] : pairs)
      if (ratios.size() >= least_samples) {
        equations.push_back({key.first, key.second, channelMedian(ratios, c), std::sqrt(ratios.size())});
        known[key.first] = known[key.second] = 1;
      }
    if (equations.empty())
      break;
    const Eigen::VectorXd x = solve(equations, views);
    const double mean = known.dot(x) / known.sum();
    for (Index v = 0; v < views; ++v)
      if (known[v] > 0)
        gains(c, v) = std::exp(mean - x[v]);
  }
  return gains(Eigen::all, owner);
}
} // namespace

Points solveGains(const Candidates& candidates, const std::vector<int>& owner)
{
  return solveGains(collectColorRatios(candidates, owner), owner);
}

Photometry solvePhotometry(const Candidates& candidates, const std::vector<int>& lenses, const std::vector<int>& owner)
{
  Photometry out;
  out.gains.setOnes(3, lenses.size());
  if (lenses.empty())
    return out;
  ColorRatios pairs = collectColorRatios(candidates, owner);
  std::vector<int> lens_of_owner(1 + *std::max_element(owner.begin(), owner.end()), -1);
  for (std::size_t v = 0; v < owner.size(); ++v)
    lens_of_owner[owner[v]] = lenses[v];
  out.lens = lenses;
  calibrateLenses(pairs, lens_of_owner, out);
  correctRatios(out, lens_of_owner, pairs);
  out.gains = solveGains(pairs, owner);
  return out;
}

void describePhotometry(const Photometry& photometry, const std::vector<int>& owner, Index views, TextureResult& result)
{
  result.gains.resize(3, views);
  result.vignetting.resize(3, views);
  result.response.setZero(ResponseCurve::terms, views);
  for (std::size_t part = 0; part < owner.size(); ++part) {
    result.gains.col(owner[part]) = photometry.gains.col(part);
    result.vignetting.col(owner[part]) = photometry.falloffOf(part).a;
    if (const ResponseCurve* response = photometry.responseOf(part))
      result.response.col(owner[part]) = response->coefficients();
  }
}
} // namespace fresco::texture
