// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/response_curve.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
namespace {
constexpr int light_steps = 256, value_steps = 1024; // finer where the curve may be steep

/// Logarithm of light over that of value: its least slope.
float leastSlope(const ResponseCurve::Coefficients& b)
{
  float least = 1;
  for (int i = 0; i <= light_steps; ++i) {
    const float v = static_cast<float>(i) / light_steps;
    least = std::min(least, 1 + b[0] * v + 3 * b[1] * v * v * v);
  }
  return least;
}
} // namespace

bool ResponseCurve::rises(const Coefficients& b) { return leastSlope(b) >= flattest; }

ResponseCurve::ResponseCurve(Coefficients b)
{
  if (b.isZero(0))
    return;
  if (const float slope = leastSlope(b); slope < flattest)
    b *= (1 - flattest) / (1 - slope);
  b_ = b;
  for (int i = 0; i <= light_steps; ++i) {
    const float v = static_cast<float>(i) / light_steps;
    light_.push_back(v * std::exp(b.dot(logTerms(v))));
  }
  white_ = light_.back();
  for (int i = 0, k = 1; i <= value_steps; ++i) {
    const float light = white_ * static_cast<float>(i) / value_steps;
    while (k < light_steps && light_[k] < light)
      ++k;
    const float share = (light - light_[k - 1]) / (light_[k] - light_[k - 1]);
    values_.push_back(255 * (static_cast<float>(k - 1) + share) / light_steps);
  }
}
} // namespace fresco::texture
