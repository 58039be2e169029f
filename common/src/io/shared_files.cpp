// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/expect.h"
#include <algorithm>
#include <filesystem>
#include <fresco/io/packing.h>
#include <fresco/io/shared_files.h>
namespace fresco {
void requireSameFiles(const std::vector<std::string>& files, const std::string& name, Exchange& ranks)
{
  std::vector<std::pair<std::string, std::uintmax_t>> own;
  for (const std::string& file : files) {
    std::error_code error; // whoever reads it will say why
    own.emplace_back(file, std::filesystem::file_size(file, error));
  }
  const auto all = gatherValues(ranks, own);
  const auto other = std::find_if(all.begin(), all.end(), [&](const auto& found) { return found != all[0]; });
  expect(other == all.end(), name, ": rank ", other - all.begin(), " finds other files or sizes there than rank 0");
}
} // namespace fresco
