// SPDX-License-Identifier: BSD-3-Clause
#include "networks/weights.h"
#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>
#include <tuple>
using namespace fresco::filters;
namespace fresco {
namespace {
TEST(Weights, OfTheLibraryAreThereAndFinite)
{
  const Weights score(candidateScoreData()), first(mixedPixelData()), second(secondStageData());
  for (const auto& [weights, name, rows, columns] : {std::tuple{&score, "of_candidate", 44, 16},
                                                     {&first, "first_weights", 154, 64},
                                                     {&second, "first_weights", 455, 96}}) {
    const float* values = weights->values(name, {std::uint32_t(rows), std::uint32_t(columns)});
    for (int i = 0; i < rows * columns; ++i)
      ASSERT_TRUE(std::isfinite(values[i])) << name << " " << i;
  }
}

TEST(Weights, OfAnotherNameOrShapeAreRefused)
{
  const Weights weights(mixedPixelData());
  EXPECT_NO_THROW(weights.values("first_bias", {1, 64}));
  EXPECT_THROW(weights.values("first", {1, 64}), std::runtime_error);
  EXPECT_THROW(weights.values("first_bias", {64, 1}), std::runtime_error);
}

TEST(Weights, DamagedDataAreRefused)
{
  const std::string whole(mixedPixelData());
  for (const std::size_t size : {std::size_t{0}, std::size_t{11}, std::size_t{40}, whole.size() - 4})
    EXPECT_THROW(Weights(whole.substr(0, size)), std::runtime_error) << size;
  for (const std::size_t place : {0, 8, 11, 36, 40}) { // magic, number of matrices, rows, columns
    std::string damaged = whole;
    damaged[place] = '\x7f';
    EXPECT_THROW(Weights{damaged}, std::runtime_error) << place;
  }
}
} // namespace
} // namespace fresco
