// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// Numbers that an option may hold: what is checked, and how the help and a refusal put it.
class FRESCO_EXPORT Range {
public:
  static Range any();
  static Range within(double least, double most);
  static Range atLeast(double least);
  static Range above(double bound);
  Range atMost(double most) const;              ///< of above()
  Range below(double bound) const;              ///< of above()
  Range zero(const std::string& meaning) const; ///< 0 is allowed besides and stands for something

  bool holds(double value) const { return (or_zero_ && value == 0) || (value >= least_ && value <= most_); }
  const std::string& text() const { return text_; } ///< "2..16", "above 0 and below 90", "at least 1; 0 = all"

private:
  Range(double least, double most, std::string text) : least_(least), most_(most), text_(std::move(text)) {}
  double least_, most_;
  std::string text_;
  bool or_zero_ = false;
};
} // namespace fresco
