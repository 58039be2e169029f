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
/// Logarithms of the views, with mean 0, whose differences are the medians of their pairs.
/// @param outlier pairs off by more count less (Cauchy): of exposures by 3 %, of contrasts by 0.3 octaves
/// @param valueOf difference at a place that both views show; NaN: none
template <typename ValueOf>
Eigen::VectorXd solvePairs(const ColorRatios& pairs, Index views, double outlier, const ValueOf& valueOf)
{
  constexpr std::size_t least_samples = 12; // per pair of views, for a median to count
  constexpr int rounds = 10;                // of reweighting
  constexpr double regularization = 1e-3;   // holds views without partners at 0; nothing beside a pair's weight
  struct Equation {
    int first, second;
    double difference, weight;
  };
  std::vector<Equation> equations;
  for (const auto& [key, ratios] : pairs) {
    std::vector<float> values;
    for (const ColorRatio& ratio : ratios)
      if (const float value = valueOf(ratio); std::isfinite(value))
        values.push_back(value);
    if (values.size() >= least_samples)
      equations.push_back({key.first, key.second, median(values), std::sqrt(values.size())});
  }
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
  Points gains(3, owner.empty() ? 0 : 1 + *std::max_element(owner.begin(), owner.end()));
  for (int c = 0; c < 3; ++c) {
    const auto valueOf = [c](const ColorRatio& ratio) { return ratio.log_ratio[c]; };
    gains.row(c) = (-solvePairs(pairs, gains.cols(), 0.03, valueOf).array()).exp().cast<float>();
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
  const auto contrastOf = [](const ColorRatio& ratio) { return ratio.contrast; };
  out.sharpness = solvePairs(pairs, lens_of_owner.size(), 0.3, contrastOf)(owner).cast<float>();
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
