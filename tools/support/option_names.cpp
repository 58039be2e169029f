// SPDX-License-Identifier: BSD-3-Clause
#include "support/option_names.h"
#include <algorithm>
#include <map>
#include <numeric>
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

/// Letters that are put in, taken out or replaced between two words: Levenshtein 1966.
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, row[k] + 1, row[k + 1] + 1});
    }
  }
  return row.back();
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
