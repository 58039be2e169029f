// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/io/range.h>
#include <limits>
namespace fresco {
namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string digits(double number) // 100000000, not 1e+08
{
  const auto whole = static_cast<long long>(number);
  return whole == number ? concat(whole) : concat(number);
}
} // namespace

Range Range::any() { return {-infinity, infinity, "any number"}; }

Range Range::within(double least, double most) { return {least, most, digits(least) + ".." + digits(most)}; }

Range Range::atLeast(double least) { return {least, infinity, "at least " + digits(least)}; }

Range Range::above(double bound) { return {std::nextafter(bound, infinity), infinity, "above " + digits(bound)}; }

Range Range::atMost(double most) const { return {least_, most, text_ + " and at most " + digits(most)}; }

Range Range::below(double bound) const
{
  return {least_, std::nextafter(bound, -infinity), text_ + " and below " + digits(bound)};
}

Range Range::zero(const std::string& meaning) const
{
  Range range(least_, most_, text_ + "; 0 = " + meaning);
  range.or_zero_ = true;
  return range;
}
} // namespace fresco
