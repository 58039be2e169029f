// SPDX-License-Identifier: BSD-3-Clause
// One file of points or a folder of them: scans, each from one place, or parts of one cloud. The files tell, else the points.
#include "input/parts.h"
#include "input/standpoint.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::model {
namespace {
/// Whether files share hardly any ground. Scans lie over one another, each around the place that it was seen from.
bool areTiles(const std::vector<Eigen::AlignedBox3f>& boxes)
{
  constexpr float shared = 0.25f; // of the smaller one: tiles are cut with a rim
  const auto area = [](const Eigen::AlignedBox3f& box) { return box.isEmpty() ? 0 : box.sizes().head<2>().prod(); };
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (!(area(boxes[a].intersection(boxes[b])) < shared * std::min(area(boxes[a]), area(boxes[b]))))
        return false;
  return boxes.size() > 1;
}

/// Whether the files are parts of a cloud rather than scans. What is empty or damaged does not tell: those that read the points
/// say so.
bool isCloud(const Survey& found, const ModelInput& input)
{
  std::string scan, cloud, problem;
  const std::size_t count = input.scans.size(), step = std::max<std::size_t>(1, count / 3);
  std::vector<Eigen::AlignedBox3f> boxes;
  for (std::size_t s = 0; s < count; s += step) {
    Standing standing;
    try {
      standing = standpointOf(input.scans[s]);
    } catch (const std::runtime_error& error) {
      problem = error.what();
      continue;
    }
    boxes.push_back(standing.box);
    const bool scanned_so = standing.from == Standpoint::unknown && count > 1; // as what is in many files
    const bool from_origin = standing.from == Standpoint::origin || scanned_so;
    (from_origin ? scan : cloud) = input.scans[s].name();
  }
  if (scan.empty() && cloud.empty())
    throw std::runtime_error(problem);
  if (areTiles(boxes))
    return true;
  if (!scan.empty() && !cloud.empty())
    throw std::runtime_error(concat(found.path(), ": ", scan, " was seen from its origin, ", cloud,
                                    " was not: say -as scans or -as cloud, or move one sort elsewhere"));
  return !cloud.empty();
}
} // namespace

void readFlatPoints(const Survey& found, std::optional<Reading> asked, ModelInput& input)
{
  if (const auto packed = found.match("*.laz"); !packed.empty())
    throw std::runtime_error(
        concat(found.at(packed[0]), packed.size() > 1 ? concat(" and ", packed.size() - 1, " more") : "",
               ": compressed LAS is not read: unpack all at once (laszip -i \"", found.path(),
               found.isFile() ? "" : "/*.laz", "\", or pdal translate) and move the .laz elsewhere"));
  takeScans(input, found, found.match("<points>"));
  takePoses(input, found);
  const bool by_files = input.scans.size() > 1 && !input.poses.empty();
  if (asked == Reading::cloud || (!asked && !by_files && isCloud(found, input)))
    takeAsCloud(input, found);
  else if (input.poses.empty())
    input.found.push_back(
        "each was seen from the origin of its frame (-as cloud: they are parts of one cloud in one frame)");
  if (found.isFile())
    return;
  takePhotographs(input, found);
  takePanoramas(input, found, "panoramas/<pictures>");
  if (input.cameras.views.empty() && input.unplaced.empty() && input.panoramas.empty())
    takePicturesBeside(input, found);
}
} // namespace fresco::model
