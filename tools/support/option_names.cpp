// SPDX-License-Identifier: BSD-3-Clause
#include "support/option_names.h"
#include <algorithm>
#include <map>
namespace fresco {
namespace {
/// Options of PCL's tools, and the options of ours that do the same.
const std::map<std::string, std::vector<std::string>>& namesOfPcl()
{
  static const std::map<std::string, std::vector<std::string>> names = {
      {"leaf", {"voxel"}},           {"mean_k", {"outliers"}},
      {"std_dev_mul", {"outliers"}}, {"negative", {"removed"}},
      {"i", {"iterations"}},         {"d", {"max_distance"}},
      {"n_points", {"points"}},      {"search_radius", {"radius"}},
      {"target", {"faces"}},         {"n_faces", {"faces"}},
      {"cam", {"eye", "viewpoint"}}, {"max_iterations", {"iterations"}},
      {"neighbors", {"k"}},          {"resolution", {"cell", "voxel"}}};
  return names;
}

/// Letters that are put in, taken out, replaced or swapped with the next between two words: Damerau 1964.
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t k = 0; k <= b.size(); ++k) {
      cost[i][k] =
          i == 0 || k == 0
              ? i + k
              : std::min({cost[i - 1][k - 1] + (a[i - 1] == b[k - 1] ? 0 : 1), cost[i - 1][k] + 1, cost[i][k - 1] + 1});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        cost[i][k] = std::min(cost[i][k], cost[i - 2][k - 2] + 1);
    }
  return cost[a.size()][b.size()];
}
} // namespace

std::string meantOption(const std::string& given, const std::vector<std::string>& known)
{
  if (const auto pcl = namesOfPcl().find(given); pcl != namesOfPcl().end())
    for (const std::string& ours : pcl->second)
      if (std::find(known.begin(), known.end(), ours) != known.end())
        return "; here it is called -" + ours;
  std::string nearest;
  std::size_t least = 1 + given.size() / 3; // a word of three letters may have one wrong
  for (const std::string& name : known)
    if (const std::size_t distance = editDistance(given, name); distance < least) {
      least = distance;
      nearest = name;
    }
  return nearest.empty() ? "" : "; did you mean -" + nearest + "?";
}
} // namespace fresco
