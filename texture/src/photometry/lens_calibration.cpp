// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/lens_calibration.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/robust_weights.h>
#include <limits>
namespace fresco::texture {
namespace {
using Response = Eigen::Vector2d; ///< coefficients, or what they are multiplied by

/// Logarithm of the light's share that a value has beside the value itself.
Response responseTerms(double log_value) { return ResponseCurve::logTerms(std::exp(log_value) / 255); }

/// Differences of the terms between two views, mean over the channels, where the lights' logarithms differ by `log_light`.
/// The measured difference of values has no part in it: its noise would look like a curve.
Response termDifference(const ColorRatio& ratio, double log_light, const Response& b)
{
  constexpr int iterations = 3; // Newton
  Response sum = Response::Zero();
  for (int c = 0; c < 3; ++c) {
    const double mean = ratio.log_mean[c];
    double d = log_light; // of the values' logarithms
    for (int i = 0;; ++i) {
      const Response high = responseTerms(mean + d / 2), low = responseTerms(mean - d / 2);
      if (i == iterations) {
        sum += (high - low) / 3;
        break;
      }
      const double slope = 1 + 0.5 * b.dot((high + low).cwiseProduct(Response(1, 3)));
      d = std::clamp(d - (d + b.dot(high - low) - log_light) / std::max<double>(slope, ResponseCurve::flattest), -2.0,
                     2.0);
    }
  }
  return sum;
}

/// Half the range of what a change of light by one factor does to logarithms of values.
double unevenness(const ResponseCurve& curve, double log_factor)
{
  float least = std::numeric_limits<float>::infinity(), most = -least;
  for (float value = 16; value <= 240; value += 16) {
    const Eigen::Vector3f all = Eigen::Vector3f::Constant(value);
    const float change =
        std::log(curve.relight(all, Eigen::Vector3f::Constant(std::exp(static_cast<float>(log_factor))))[0] / value);
    least = std::min(least, change);
    most = std::max(most, change);
  }
  return 0.5 * (most - least);
}

/// The lenses' transmission and response, with the exposure of each view as a by-product: Cauchy-weighted least squares
/// on grey.
class LensSystem {
public:
  /// @param curved lenses whose response is an unknown too
  LensSystem(const ColorRatios& pairs, const std::vector<int>& lens, const std::vector<char>& curved)
      : pairs_(pairs), lens_(lens), curved_(curved), lenses_(curved.size()), views_(static_cast<int>(lens.size())),
        x_(Eigen::VectorXd::Zero(falloff_terms * lenses_ + views_ +
                                 (std::count(curved.begin(), curved.end(), 1) > 0 ? 2 * lenses_ : 0)))
  {
    for (int round = 0; round < reweightings; ++round) {
      const Eigen::VectorXd b = assemble(round > 0);
      x_ = A_.ldlt().solve(b);
    }
  }

  LensFalloff falloff(int lens) const { return {x_.segment<falloff_terms>(falloff_terms * lens).cast<float>()}; }

  Response response(int lens) const
  {
    return curved_[lens] ? Response(x_.segment<2>(responseAt(lens))) : Response(Response::Zero());
  }

  /// Most that the response changes photographs of the lens by beside a factor, as a logarithm.
  double strength(int lens) const
  {
    const ResponseCurve curve(response(lens).cast<float>());
    const Eigen::VectorXd exposure = x_.segment(falloff_terms * lenses_, views_);
    double most = 0;
    for (int v = 0; v < views_; ++v)
      if (lens_[v] == lens && !curve.isLinear())
        most = std::max(most, unevenness(curve, exposure.mean() - exposure[v]));
    return most;
  }

  /// Whether the response is not straight by chance. Its covariance is that of the pairs' pulls: errors of one pair have
  /// common causes.
  bool isCertain(int lens) const
  {
    constexpr double deviations = 5;
    Eigen::MatrixXd select = Eigen::MatrixXd::Zero(x_.size(), 2);
    select.middleRows<2>(responseAt(lens)).setIdentity();
    const Eigen::MatrixXd influence = A_.ldlt().solve(select);
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (const auto& [views, ratios] : pairs_) {
      Response pull = Response::Zero();
      for (std::size_t k = 0; k < used(ratios); ++k) {
        const Row row = rowOf(views, ratios[k]);
        for (int i = 0; i < row.size; ++i)
          pull += weight(row.error) * row.error * row.factor[i] * influence.row(row.at[i]).transpose();
      }
      covariance += pull * pull.transpose();
    }
    const double freedom = static_cast<double>(pairs_.size()) - views_; // pairs beyond those that tell exposures
    const Response b = response(lens);
    const double distance = b.dot(covariance.ldlt().solve(b)) * freedom / static_cast<double>(pairs_.size());
    return freedom > 0 && distance > deviations * deviations;
  }

private:
  static constexpr int falloff_terms = 3;

  /// Of one ratio: log(first / second) = sum of factor * x over coefficients of lenses and two views.
  struct Row {
    static constexpr int most = 2 * falloff_terms + 2 + 4;
    std::array<int, most> at;
    Eigen::Matrix<double, most, 1> factor;
    int size = 0;
    double error = 0; ///< of what the present solution says

    void add(int place, double f)
    {
      at[size] = place;
      factor[size++] = f;
    }
  };

  int responseAt(int lens) const { return falloff_terms * lenses_ + views_ + 2 * lens; }
  static double weight(double error) { return cauchyWeight(error * error / (usual_error * usual_error)); }

  static std::size_t used(const std::vector<ColorRatio>& ratios)
  {
    constexpr std::size_t most_ratios = 64; // per pair of views
    return std::min(ratios.size(), most_ratios);
  }

  Row rowOf(const std::pair<int, int>& views, const ColorRatio& ratio) const
  {
    Row row;
    const int view[2] = {views.first, views.second};
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1 : -1, r2 = ratio.radius[side];
      const int lens = lens_[view[side]];
      for (int t = 0; t < falloff_terms && lens >= 0; ++t)
        row.add(falloff_terms * lens + t, sign * std::pow(r2, t + 1));
      row.add(falloff_terms * lenses_ + view[side], sign);
    }
    double light = 0;
    for (int i = 0; i < row.size; ++i)
      light += row.factor[i] * x_[row.at[i]];
    row.error = light - ratio.log_ratio.mean();
    const int first = lens_[view[0]], second = lens_[view[1]];
    if (first >= 0 && first == second && curved_[first]) {
      const Response b = response(first), terms = termDifference(ratio, light, b);
      for (int t = 0; t < 2; ++t)
        row.add(responseAt(first) + t, -terms[t]);
      row.error -= b.dot(terms);
    }
    return row;
  }

  /// Fills A.
  /// @return right side
  Eigen::VectorXd assemble(bool reweight)
  {
    constexpr double usual = 0.5;        // coefficients of a strong lens: corners at 60 %
    constexpr double usual_response = 2; // of a strong tone curve
    A_ = Eigen::MatrixXd::Zero(x_.size(), x_.size());
    A_.diagonal().setConstant(usual_error * usual_error / (usual * usual));
    A_.diagonal()
        .tail(x_.size() - falloff_terms * lenses_ - views_)
        .setConstant(usual_error * usual_error / (usual_response * usual_response));
    Eigen::VectorXd b = Eigen::VectorXd::Zero(x_.size());
    for (const auto& [views, ratios] : pairs_)
      for (std::size_t k = 0; k < used(ratios); ++k) {
        const Row row = rowOf(views, ratios[k]);
        const double value = ratios[k].log_ratio.mean(), w = reweight ? weight(row.error) : 1;
        for (int i = 0; i < row.size; ++i) {
          b[row.at[i]] += w * row.factor[i] * value;
          for (int j = 0; j < row.size; ++j)
            A_(row.at[i], row.at[j]) += w * row.factor[i] * row.factor[j];
        }
      }
    return b;
  }

  const ColorRatios& pairs_;
  const std::vector<int>& lens_;
  const std::vector<char> curved_;
  int lenses_, views_;
  Eigen::VectorXd x_; ///< of each lens its falloff, of each view its exposure, of each lens its response
  Eigen::MatrixXd A_;
};

float strengthOf(const LensFalloff& falloff)
{
  float most = 0;
  for (const float r2 : {0.25f, 0.5f, 0.75f, 1.f})
    most = std::max(most, std::fabs(falloff.logTransmission(r2)));
  return most;
}
} // namespace

void calibrateLenses(const ColorRatios& pairs, const std::vector<int>& lens, Photometry& out)
{
  constexpr float least = 0.01f;       // of a logarithm: 1 % of the light, 2.5 grey levels, do not show
  constexpr double least_curve = 0.02; // likewise: detail within patches, rounding and JPEG leave 1 %
  const int lenses = std::max(*std::max_element(lens.begin(), lens.end()) + 1, 1);
  std::vector<char> curved(lenses, 1);
  const LensSystem first(pairs, lens, curved);
  for (int l = 0; l < lenses; ++l)
    curved[l] =
        ResponseCurve::rises(first.response(l).cast<float>()) && first.isCertain(l) && first.strength(l) >= least_curve;
  const LensSystem last(pairs, lens, curved);
  for (int l = 0; l < lenses; ++l) {
    out.falloff.push_back(last.falloff(l));
    if (strengthOf(out.falloff.back()) < least)
      out.falloff.back() = {};
    out.response.emplace_back(last.response(l).cast<float>());
  }
}

void correctRatios(const Photometry& photometry, const std::vector<int>& lens, ColorRatios& pairs)
{
  const auto falloffOf = [&](int view) { return lens[view] < 0 ? LensFalloff{} : photometry.falloff[lens[view]]; };
  const auto termsOf = [&](int view, float log_value) -> double {
    return lens[view] < 0 ? 0
                          : responseTerms(log_value).dot(photometry.response[lens[view]].coefficients().cast<double>());
  };
  for (auto& [views, ratios] : pairs) {
    const LensFalloff first = falloffOf(views.first), second = falloffOf(views.second);
    for (ColorRatio& ratio : ratios) {
      for (int c = 0; c < 3; ++c)
        ratio.log_ratio[c] += termsOf(views.first, ratio.log_mean[c] + 0.5f * ratio.log_ratio[c]) -
                              termsOf(views.second, ratio.log_mean[c] - 0.5f * ratio.log_ratio[c]);
      ratio.log_ratio.array() -= first.logTransmission(ratio.radius[0]) - second.logTransmission(ratio.radius[1]);
    }
  }
}
} // namespace fresco::texture
