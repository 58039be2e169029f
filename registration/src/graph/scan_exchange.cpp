// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_exchange.h"
namespace fresco::registration {
void addPairs(const std::vector<PairAlignment>& more, std::vector<PairAlignment>& pairs)
{
  pairs.insert(pairs.end(), more.begin(), more.end());
  std::sort(pairs.begin(), pairs.end(),
            [](const PairAlignment& x, const PairAlignment& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
}

void shareScans(Exchange& ranks, std::vector<PreparedScan>& scans, int threads)
{
  shareItems(ranks, scans);
  for (PreparedScan& scan : scans)
    for (ScanLevel& level : scan.levels)
      if (!level.tree && !level.search)
        level.tree = std::make_shared<PointTree>(level.points, threads);
}
} // namespace fresco::registration
