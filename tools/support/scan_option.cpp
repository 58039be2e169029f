// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include <fresco/io/reading.h>
namespace fresco {
void declareColumns(Args& args)
{
  args.values("columns", "NAMES",
              "columns of text clouds (.xyz .txt .asc .csv), whatever their headers say, as in "
              "x,y,z,intensity,r,g,b,nx,ny,nz; - = leave this one out (default: by the header, else by the values)",
              [](const std::vector<std::string>& words) {
                std::vector<std::string> names;
                for (std::size_t at = 0; at <= words[0].size();) {
                  const std::size_t end = std::min(words[0].find(',', at), words[0].size());
                  names.push_back(words[0].substr(at, end - at));
                  at = end + 1;
                }
                try {
                  setTextColumns(names);
                } catch (const std::invalid_argument& error) {
                  throw UsageError(std::string("-") + error.what());
                }
              });
}

void ScanOption::declare(Args& args)
{
  declareColumns(args);
  args.option("scan", number, Range::atLeast(1).zero("all of them as one cloud, in the frame of the file"),
              "read one scan of a file of several (.e57, .ptx, .pts), in its own frame, by its number");
}

ScanPath ScanOption::of(const std::string& file) const { return {file, number - 1}; }
} // namespace fresco
