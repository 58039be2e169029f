// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_numbers.h"
#include <fresco/io/pose_file.h>
namespace fresco {
namespace {
Pose parsePose(std::string_view line, const std::string& where)
{
  io::TextScanner words(line);
  std::string_view word = words.word();
  if (word == "none")
    return {};
  Eigen::Matrix4d T;
  for (int i = 0; i < 16; ++i, word = words.word())
    T(i / 4, i % 4) = io::parseNumberOr<double>(word, where, ": wants 16 numbers or the word none");
  expect(word.empty(), where, ": more than 16 numbers");
  expect(isRigid(T, 1e-3), where, ": not a rigid transform");
  return T;
}
} // namespace

std::vector<Pose> readPoses(const std::string& path)
{
  const std::string content = readFile(path);
  std::vector<Pose> poses;
  for (io::TextScanner lines(content); !lines.done();) {
    const std::size_t number = lines.line();
    std::string_view line = lines.restOfLine();
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t") != std::string_view::npos)
      poses.push_back(parsePose(line, concat(path, ": line ", number)));
  }
  expect(!poses.empty(), path, ": no pose in it");
  return poses;
}

Eigen::Matrix4d readTransform(const std::string& path)
{
  const std::vector<Pose> poses = readPoses(path);
  expect(poses.size() == 1 && poses[0], path, ": is not one matrix of 16 numbers");
  return *poses[0];
}

void writePoses(const std::string& path, const std::vector<Pose>& poses)
{
  OutputFile file(path);
  for (const Pose& pose : poses) {
    if (!pose)
      file.write("none");
    for (int i = 0; pose && i < 16; ++i)
      file.write(io::textOf(i > 0 ? " " : "", (*pose)(i / 4, i % 4)));
    file.write("\n");
  }
  file.commit();
}
} // namespace fresco
