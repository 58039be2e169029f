// SPDX-License-Identifier: BSD-3-Clause
// Sturm et al. 2012, "A benchmark for the evaluation of RGB-D SLAM systems": lists of times and files, poses by time.
#include "input/frame_files.h"
#include <cmath>
#include <fresco/core/require.h>
namespace fresco::model {
namespace {
constexpr double same_moment = 0.02; // seconds, as the benchmark's tool associates: less than half a frame

using Table = std::vector<std::vector<std::string>>;

/// The row whose time, its first number, is nearest; nullptr if that is not the same moment. @param rows by time
const std::vector<std::string>* rowAt(const std::map<double, const std::vector<std::string>*>& rows, double time)
{
  auto after = rows.lower_bound(time);
  auto best = after;
  if (after != rows.begin() && (after == rows.end() || time - std::prev(after)->first < after->first - time))
    best = std::prev(after);
  return best != rows.end() && std::abs(best->first - time) <= same_moment ? best->second : nullptr;
}

std::map<double, const std::vector<std::string>*> byTime(const std::string& path, const Table& table, std::size_t words)
{
  std::map<double, const std::vector<std::string>*> rows;
  for (const auto& row : table) {
    if (row.size() < words)
      throw std::runtime_error(concat(path, ": a line of ", row.size(), " words, ", words, " are wanted: time and ",
                                      words == 2 ? "file" : "tx ty tz qx qy qz qw"));
    rows[numberIn(path, row[0])] = &row;
  }
  return rows;
}

struct Pair {
  double time;
  std::string color, depth;
};

/// Images that belong together, in the order of the lists.
std::vector<Pair> associated(const Survey& found)
{
  std::vector<Pair> pairs;
  if (const auto list = found.match("associations.txt|association.txt"); !list.empty()) {
    const std::string path = found.at(list[0]);
    for (const auto& row : readTextRows(path)) {
      if (row.size() < 4)
        throw std::runtime_error(path + ": wants lines of time, colour image, time, depth image");
      const bool color_first = row[1].find("depth") == std::string::npos;
      pairs.push_back({numberIn(path, row[0]), row[color_first ? 1 : 3], row[color_first ? 3 : 1]});
    }
    return pairs;
  }
  const Table colors = readTextRows(found.at("rgb.txt")), depths = readTextRows(found.at("depth.txt"));
  const auto depth_at = byTime(found.at("depth.txt"), depths, 2);
  for (const auto& [time, row] : byTime(found.at("rgb.txt"), colors, 2))
    if (const auto* depth = rowAt(depth_at, time))
      pairs.push_back({time, (*row)[1], (*depth)[1]});
  return pairs;
}
} // namespace

RgbdParts readTum(const Survey& found, ModelInput& input)
{
  RgbdParts parts;
  parts.folder.depth_unit = 1.0 / 5000;
  parts.camera_file = found.at("camera-intrinsics.txt");
  const std::string truth = found.at("groundtruth.txt");
  const Table poses = found.has("groundtruth.txt") ? readTextRows(truth) : Table();
  const auto pose_at = byTime(truth, poses, 8);
  for (const auto& [time, color, depth] : associated(found)) {
    RgbdFrame frame;
    frame.name = depth;
    frame.color = found.at(color), frame.depth = found.at(depth);
    for (const std::string& name : {color, depth})
      if (!found.holds(name))
        throw std::runtime_error(found.at(name) + ": no such file, but the lists of this TUM folder name it");
    parts.folder.frames.push_back(frame);
    const auto* row = rowAt(pose_at, time);
    const auto number = [&](int k) { return numberIn(truth, (*row)[k]); };
    parts.poses.push_back(
        row ? poseOf(truth, {number(1), number(2), number(3)}, {number(4), number(5), number(6), number(7)})
            : std::nullopt);
  }
  if (parts.folder.frames.empty())
    throw std::runtime_error(found.path() +
                             ": no colour and depth image within 0.02 s of each other: do the times of rgb.txt and "
                             "depth.txt (or associations.txt) count from the same moment?");
  if (!poses.empty() &&
      std::none_of(parts.poses.begin(), parts.poses.end(), [](const Pose& pose) { return bool(pose); }))
    throw std::runtime_error(
        truth + ": no pose within 0.02 s of a frame: its times count from another moment; without the file "
                "the frames are tracked");
  if (found.has("camera-intrinsics.txt")) {
    parts.folder.camera = readCameraMatrix(parts.camera_file, 3);
  } else {
    parts.folder.camera = usualCamera(parts.folder.frames[0].depth, parts.camera_file);
    input.warnings.push_back(
        "no camera-intrinsics.txt (3x3): the camera is taken as the one that TUM recommends, fx = fy = 525");
  }
  return parts;
}
} // namespace fresco::model
