// SPDX-License-Identifier: BSD-3-Clause
// scans/, poses.txt, cameras/, images/, panoramas/: what fresco_scan writes and fresco's tools read.
#include "input/parts.h"
#include <fresco/core/require.h>
namespace fresco::model {
void readScansFolder(const Survey& found, std::optional<Reading> asked, ModelInput& input)
{
  const std::vector<std::string> scans = found.match("scans/<points>");
  if (scans.empty())
    throw std::runtime_error(found.at("scans") + ": no scan (" + readablePoints() + ") in it");
  takeScans(input, found, scans);
  takePoses(input, found);
  if (asked == Reading::cloud)
    takeAsCloud(input, found);
  takePhotographs(input, found);
  takePanoramas(input, found, "panoramas/<pictures>");
}
} // namespace fresco::model
