// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <vector>
namespace fresco::texture {
/// Tone curve of a camera, as light over value: a value v, as a share of white, stands for the light
///   v exp(b_1 v + b_2 v^3),
/// up to a factor and a power, which exposures do not tell. Two terms follow the curves of usual cameras within 3 grey levels.
class ResponseCurve {
public:
  static constexpr int terms = 2;
  static constexpr float flattest = 0.1f; ///< of a logarithm: less light cannot be told from noise
  using Coefficients = Eigen::Matrix<float, terms, 1>;

  ResponseCurve() = default; ///< a value is its light
  /// @param b any; those of a curve that does not rise everywhere are made smaller
  explicit ResponseCurve(Coefficients b);

  /// Whether more light is a higher value everywhere. Otherwise it is no camera's curve: values differ for another reason.
  static bool rises(const Coefficients& b);

  bool isLinear() const { return light_.empty(); }
  const Coefficients& coefficients() const { return b_; }

  /// What each coefficient is multiplied by at a value.
  template <typename T>
  static Eigen::Matrix<T, terms, 1> logTerms(T value)
  {
    return {value, value * value * value};
  }

  /// Values, 0..255, of `factors` times the light.
  Eigen::Vector3f relight(const Eigen::Vector3f& values, const Eigen::Vector3f& factors) const
  {
    Eigen::Vector3f out;
    for (int c = 0; c < 3; ++c)
      out[c] = at(values_, factors[c] * at(light_, values[c] * (1 / 255.f)) / white_);
    return out;
  }

private:
  /// Linear interpolation of a table over 0..1, continued beyond 1.
  static float at(const std::vector<float>& table, float share)
  {
    const auto last = static_cast<int>(table.size()) - 1;
    const float x = std::max(share, 0.f) * static_cast<float>(last);
    const int i = std::min(static_cast<int>(x), last - 1);
    return table[i] + (x - static_cast<float>(i)) * (table[i + 1] - table[i]);
  }

  Coefficients b_ = Coefficients::Zero();
  float white_ = 1;           ///< light of white
  std::vector<float> light_;  ///< by value over white
  std::vector<float> values_; ///< 0..255, by light over that of white
};
} // namespace fresco::texture
