// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/core/robust_weights.h>
#include <gtest/gtest.h>
namespace fresco {
namespace {
// The weight of a residual r under the loss rho is rho'(r) / r, up to the factor that makes it 1 at 0.
TEST(RobustWeights, AreTheSlopesOfTheirLosses)
{
  const auto slope = [](auto loss, double r) { return (loss(r + 1e-6) - loss(r - 1e-6)) / 2e-6 / r; };
  for (const double r : {0.1, 0.5, 0.9, 1.5, 4.0}) {
    EXPECT_NEAR(cauchyWeight(r * r), slope([](double x) { return std::log1p(x * x) / 2; }, r), 1e-8);
    EXPECT_NEAR(gemanMcClureWeight(r * r), slope([](double x) { return x * x / (1 + x * x) / 2; }, r), 1e-8);
    EXPECT_NEAR(tukeyWeight(r * r), slope([](double x) { return (1 - std::pow(1 - std::min(x * x, 1.0), 3)) / 6; }, r),
                1e-8);
  }
}

TEST(RobustWeights, AreOneAtZeroAndFall)
{
  double before[3] = {1, 1, 1};
  for (double s = 0; s < 5; s += 0.25) {
    const double now[3] = {cauchyWeight(s), gemanMcClureWeight(s), tukeyWeight(s)};
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(s == 0 ? now[k] == 1 : now[k] < before[k] || now[k] == 0) << s << " " << k;
      before[k] = now[k];
    }
  }
}
} // namespace
} // namespace fresco
