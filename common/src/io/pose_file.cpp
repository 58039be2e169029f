// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/pose_file.h>
#include <iomanip>
#include <sstream>
namespace fresco {
namespace {
Pose parsePose(const std::string& line, const std::string& where)
{
  std::istringstream words(line);
  std::string word;
  if (std::istringstream(line) >> word && word == "none")
    return {};
  Eigen::Matrix4d T;
  for (int i = 0; i < 16; ++i)
    if (!(words >> T(i / 4, i % 4)))
      throw std::runtime_error(concat(where, ": wants 16 numbers or the word none"));
  if (words >> word)
    throw std::runtime_error(concat(where, ": more than 16 numbers"));
  if (!isRigid(T, 1e-3))
    throw std::runtime_error(concat(where, ": not a rigid transform"));
  return T;
}
} // namespace

std::vector<Pose> readPoses(const std::string& path)
{
  std::istringstream lines(readFile(path));
  std::vector<Pose> poses;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      poses.push_back(parsePose(line, concat(path, ": line ", number)));
  }
  if (poses.empty())
    throw std::runtime_error(path + ": no pose in it");
  return poses;
}

void writePoses(const std::string& path, const std::vector<Pose>& poses)
{
  std::ostringstream text;
  text << std::setprecision(17);
  for (const Pose& pose : poses) {
    if (!pose)
      text << "none";
    for (int i = 0; pose && i < 16; ++i)
      text << (i > 0 ? " " : "") << (*pose)(i / 4, i % 4);
    text << "\n";
  }
  writeFile(path, text.str());
}
} // namespace fresco
