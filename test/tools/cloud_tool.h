// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "filters/virtual_scan.h"
#include <algorithm>
#include <cstdlib>
#include <fresco/io/cloud_file.h>
#include <fresco/io/file.h>
#include <fresco/io/point_io.h>
#include <fstream>
#include <sys/wait.h>
namespace fresco::test {
/// Clouds of few points.
constexpr const char* few_points[] = {"1 2 3\n", "1 2 3\n1 2 3\n", "0 0 0\n1 0 0\n0 1 0\n",
                                      "1e30 0 0\n-1e30 0 0\n0 1e30 0\n0 0 1\n"};

/// A tool that makes a cloud of a cloud: fresco_TOOL IN OUT [options].
class CloudTool : public ::testing::Test {
protected:
  explicit CloudTool(std::string tool) : tool_(std::move(tool)) {}

  /// Exit status; -1 after a signal.
  int run(const std::string& arguments) const
  {
    const std::string command =
        buildFolder() + "/bin/fresco_" + tool_ + " " + arguments + " >" + path("out") + " 2>" + path("err");
    const int code = std::system(command.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : -1;
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string errors() const { return std::filesystem::file_size(path("err")) > 0 ? readFile(path("err")) : ""; }
  std::string text(const std::string& name, const std::string& content) const
  {
    std::ofstream(path(name)) << content;
    return path(name);
  }
  /// A scan in colour, one point of it not finite.
  std::string scanFile(const std::string& name) const
  {
    PointSet set;
    set.points = scanWithMixedPixels(0.01f, 0.002f, 1).points;
    set.points.col(40).setConstant(nan);
    set.colors = Colors::Constant(3, set.size(), 9);
    for (Index i = 0; i < set.size(); ++i)
      set.colors(0, i) = static_cast<std::uint8_t>(i % 256);
    set.intensities = Eigen::VectorXf::LinSpaced(set.size(), 0, 1);
    set.viewpoints = Eigen::Vector3f::Zero();
    writePoints(path(name), set);
    return path(name);
  }
  void expectFailure(const std::string& arguments, int status) const
  {
    EXPECT_EQ(run(arguments + " -quiet"), status) << arguments << errors();
    const std::string lines = errors();
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;
    EXPECT_FALSE(std::filesystem::exists(path("result.pcd"))) << arguments;
  }
  /// What every such tool refuses with one line.
  void expectCommonFailures(const std::string& good) const
  {
    const std::string out = " " + path("result.pcd"), bytes = readFile(good);
    const std::string cut = text("cut.pcd", bytes.substr(0, bytes.size() / 2)), empty = text("empty.pcd", "");
    const std::string nothing = text("nothing.xyz", "nan nan nan\nnan nan nan\n");
    for (const std::string& in : {cut, empty, nothing, path("missing.pcd"), folder_, text("odd.jpg", "x")})
      expectFailure(in + out, 1);
    expectFailure(good + " " + folder_ + "/no/such/result.pcd", 1);
    expectFailure(good + out + " -nonsense", 2);
    expectFailure(good, 2);
  }
  void expectInHelp(const std::vector<std::string>& options) const
  {
    EXPECT_EQ(run("-h"), 0);
    const std::string help = readFile(path("out"));
    for (const std::string& option : options)
      EXPECT_NE(help.find(option), std::string::npos) << option;
  }
  const std::string tool_, folder_ = scratchFolder();
};

inline std::vector<std::string> fieldNames(const CloudFile& file)
{
  std::vector<std::string> names;
  for (const auto& field : file.cloud.fields)
    names.push_back(field.name);
  return names;
}

} // namespace fresco::test
