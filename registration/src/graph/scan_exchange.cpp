// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_exchange.h"
namespace fresco::registration {
void shareScans(Exchange& ranks, std::vector<PreparedScan>& scans, int threads)
{
  shareItems(ranks, scans);
  for (PreparedScan& scan : scans)
    for (ScanLevel& level : scan.levels)
      if (!level.tree && !level.search)
        level.tree = std::make_shared<PointTree>(level.points, threads);
}
} // namespace fresco::registration
