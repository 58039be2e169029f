// SPDX-License-Identifier: BSD-3-Clause
#include "input/text_table.h"
#include <charconv>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <string_view>
namespace fresco::model {
std::vector<std::vector<std::string>> readTable(const std::string& path)
{
  constexpr const char* separators = " \t\r,;";
  const std::string text = readFile(path);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    std::vector<std::string> words;
    for (std::size_t at = line.find_first_not_of(separators); at != std::string::npos;) {
      const std::size_t stop = std::min(line.find_first_of(separators, at), line.size());
      words.push_back(line.substr(at, stop - at));
      at = line.find_first_not_of(separators, stop);
    }
    if (!words.empty() && words[0][0] != '#')
      rows.push_back(std::move(words));
  }
  return rows;
}

double numberIn(const std::string& path, const std::string& word)
{
  double value = 0;
  const char *begin = word.data() + (word[0] == '+'), *end = word.data() + word.size();
  if (const auto read = std::from_chars(begin, end, value); read.ec != std::errc() || read.ptr != end)
    throw std::runtime_error(path + ": '" + word + "' is no number");
  return value;
}

std::vector<double> readNumbers(const std::string& path, std::size_t count)
{
  std::vector<double> numbers;
  for (const auto& row : readTable(path))
    for (const std::string& word : row)
      numbers.push_back(numberIn(path, word));
  if (numbers.size() != count)
    throw std::runtime_error(concat(path, ": wants ", count, " numbers, has ", numbers.size()));
  return numbers;
}

Pose rigidPose(const std::string& path, const Eigen::Matrix4d& T)
{
  constexpr double rounded = 0.02; // trackers add up rotations without making them rotations again
  if (!T.allFinite())
    return {};
  if (!isRigid(T, rounded))
    throw std::runtime_error(path + ": not a rigid transform");
  Eigen::Matrix4d pose = T;
  pose.topLeftCorner<3, 3>() =
      Eigen::Quaterniond(Eigen::Matrix3d(T.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  return pose;
}

Pose poseOf(const std::string& path, const Eigen::Vector3d& t, const Eigen::Vector4d& q)
{
  if (!t.allFinite() || !q.allFinite())
    return {};
  if (!(q.norm() > 0))
    throw std::runtime_error(path + ": a quaternion of zeros is no rotation");
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::Quaterniond(q).normalized().toRotationMatrix();
  T.topRightCorner<3, 1>() = t;
  return rigidPose(path, T);
}

CameraModel readCameraMatrix(const std::string& path, int side)
{
  const std::vector<double> K = readNumbers(path, side * side);
  return {0, 0, K[0], K[side + 1], K[2] + 0.5, K[side + 2] + 0.5};
}

Eigen::Matrix4d lookingAhead(const Eigen::Matrix4d& T_world_camera)
{
  return T_world_camera * Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
}
} // namespace fresco::model
