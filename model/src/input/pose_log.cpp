// SPDX-License-Identifier: BSD-3-Clause
#include "input/pose_log.h"
#include "input/text_table.h"
#include <fresco/core/require.h>
namespace fresco::model {
std::vector<Pose> readPoseLog(const Survey& found, const std::string& pattern, std::size_t frames)
{
  const std::vector<std::string> names = found.match(pattern);
  if (names.empty())
    return {};
  const std::string path = found.at(names[0]);
  const auto rows = readTable(path);
  if (rows.size() % 5 != 0)
    throw std::runtime_error(
        concat(path, ": ", rows.size(), " lines, but each pose has five: three numbers and a 4x4 matrix"));
  if (rows.size() / 5 != frames)
    throw std::runtime_error(concat(path, ": ", rows.size() / 5, " poses for ", frames,
                                    " frames: complete it, or take it away and the frames are tracked"));
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < rows.size(); k += 5) {
    Eigen::Matrix4d T;
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) {
        if (rows[k + 1 + r].size() != 4)
          throw std::runtime_error(concat(path, ": pose ", k / 5 + 1, " is not 4 lines of 4 numbers"));
        T(r, c) = numberIn(path, rows[k + 1 + r][c]);
      }
    poses.push_back(rigidPose(path, T));
  }
  return poses;
}
} // namespace fresco::model
