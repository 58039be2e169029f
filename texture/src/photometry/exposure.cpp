// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/exposure.h"
#include "photometry/lens_calibration.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
namespace fresco::texture {
namespace {
/// A row for the logarithm of the light of each channel and one for the octaves of contrast of the views, each with mean 0,
/// whose differences are the medians of their pairs. Contrasts, of variances within patches, err by ten times as much as light.
Eigen::Array4Xd solvePairs(const ColorRatios& pairs, Index views)
{
  struct Equation {
    int first, second;
    double difference, weight;
  };
  std::array<std::vector<Equation>, 4> equations;
  for (const auto& [key, ratios] : pairs) {
    std::array<std::vector<float>, 4> values;
    for (const ColorRatio& ratio : ratios)
      for (int row = 0; row < 4; ++row)
        if (const float value = row < 3 ? ratio.log_ratio[row] : ratio.contrast; std::isfinite(value))
          values[row].push_back(value);
    for (int row = 0; row < 4; ++row)
      if (const Index count = values[row].size(); count >= fewest_samples)
        equations[row].push_back({key.first, key.second, median(values[row]), std::sqrt(count)});
  }
  Eigen::Array4Xd out(4, views);
  for (int row = 0; row < 4; ++row) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(views);
    for (int round = 0; round < reweightings; ++round) {
      Eigen::MatrixXd A = 1e-3 * Eigen::MatrixXd::Identity(views, views); // holds views without partners at 0
      Eigen::VectorXd b = Eigen::VectorXd::Zero(views);
      for (const Equation& e : equations[row]) {
        const double error = (x[e.first] - x[e.second] - e.difference) / (row < 3 ? usual_error : 10 * usual_error);
        const double w = round == 0 ? e.weight : e.weight * cauchyWeight(error * error);
        A(e.first, e.first) += w;
        A(e.second, e.second) += w;
        A(e.first, e.second) -= w;
        A(e.second, e.first) -= w;
        b[e.first] += w * e.difference;
        b[e.second] -= w * e.difference;
      }
      x = A.ldlt().solve(b);
    }
    out.row(row) = x.transpose();
  }
  return out;
}

Points gainsOf(const Eigen::Array4Xd& levels) { return (-levels.topRows<3>()).exp().cast<float>(); }
} // namespace

Points solveGains(const Candidates& candidates, const std::vector<int>& owner)
{
  const Index owners = owner.empty() ? 0 : 1 + *std::max_element(owner.begin(), owner.end());
  return gainsOf(solvePairs(collectColorRatios(candidates, owner), owners))(Eigen::all, owner);
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
  const Eigen::Array4Xd levels = solvePairs(pairs, lens_of_owner.size());
  out.gains = gainsOf(levels)(Eigen::all, owner);
  out.sharpness = levels.row(3).transpose()(owner).matrix().cast<float>();
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
