// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
namespace fresco {
void ScanOption::declare(Args& args)
{
  args.option("scan", number,
              "read one scan of a file of several (.e57, .ptx, .pts), in its own frame, from 1; 0 = all of them as one "
              "cloud, in the frame of the file");
}

ScanPath ScanOption::of(const std::string& file) const
{
  if (number < 0)
    throw UsageError("-scan: " + std::to_string(number) + " is negative");
  return {file, number - 1};
}
} // namespace fresco
