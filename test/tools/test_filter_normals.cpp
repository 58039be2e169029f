// SPDX-License-Identifier: BSD-3-Clause
#include "filters/virtual_scan.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/file.h>
#include <fresco/io/point_io.h>
#include <fstream>
#include <sys/wait.h>
namespace fresco {
namespace {
using test::nan;

class FilterTools : public testing::Test {
protected:
  /// Exit status; -1 after a signal.
  int run(const std::string& tool, const std::string& arguments) const
  {
    const std::string command = std::string(FRESCO_BINARY_DIR) + "/bin/fresco_" + tool + " " + arguments + " >" +
                                path("out") + " 2>" + path("err");
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
    set.points = test::scanWithVeil(0.01f, 0.002f, 1).points;
    set.points.col(40).setConstant(nan);
    set.colors = Colors::Constant(3, set.size(), 9);
    for (Index i = 0; i < set.size(); ++i)
      set.colors(0, i) = static_cast<std::uint8_t>(i % 256);
    set.intensities = Eigen::VectorXf::LinSpaced(set.size(), 0, 1);
    set.viewpoints = Eigen::Vector3f::Zero();
    writePoints(path(name), set);
    return path(name);
  }
  void expectFailure(const std::string& tool, const std::string& arguments, int status) const
  {
    EXPECT_EQ(run(tool, arguments + " -quiet"), status) << tool << " " << arguments << errors();
    const std::string lines = errors();
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;
    EXPECT_FALSE(std::filesystem::exists(path("result.pcd"))) << arguments;
  }
  const std::string folder_ = test::scratchFolder();
};

std::vector<std::string> fieldNames(const CloudFile& file)
{
  std::vector<std::string> names;
  for (const auto& field : file.cloud.fields)
    names.push_back(field.name);
  return names;
}

TEST_F(FilterTools, FilterKeepsEveryFieldOfThePointsThatStay)
{
  const std::string in = scanFile("scan.pcd");
  ASSERT_EQ(run("filter", in + " " + path("result.pcd") + " -veil 15"), 0) << errors();
  const PointSet before = readPoints(in), after = readPoints(path("result.pcd"));
  MixedPixelOptions options;
  options.angle = 15;
  const PointSet truth = selectPoints(before, withoutMixedPixels(before.points, before.viewpoints, options));
  EXPECT_TRUE(test::same(after.points, truth.points));
  EXPECT_TRUE((after.colors.array() == truth.colors.array()).all());
  EXPECT_TRUE(test::same(after.intensities, truth.intensities));
  EXPECT_EQ(fieldNames(readCloud(path("result.pcd"))), fieldNames(readCloud(in)));
  ASSERT_EQ(run("filter", in + " " + path("removed.pcd") + " -removed -veil 15"), 0);
  EXPECT_EQ(readPoints(path("removed.pcd")).size() + after.size() + 1, before.size());
}

TEST_F(FilterTools, FilterStepsAndThreads)
{
  const std::string in = scanFile("scan.pcd"),
                    options = " -veil 15 -outliers 12 3 -relative -voxel 0.05 -centroid -quiet ";
  ASSERT_EQ(run("filter", in + " " + path("one.pcd") + options + "-threads 1"), 0) << errors();
  ASSERT_EQ(run("filter", in + " " + path("four.pcd") + options + "-threads 4"), 0) << errors();
  EXPECT_EQ(readFile(path("one.pcd")), readFile(path("four.pcd")));
  EXPECT_EQ(errors(), "");
  ASSERT_EQ(run("filter", in + " " + path("plain.ply")), 0) << errors();
  EXPECT_EQ(readPoints(path("plain.ply")).size() + 1, readPoints(in).size());
}

TEST_F(FilterTools, FilterKeepsOrganizedClouds)
{
  CloudFile file = readCloud(scanFile("scan.pcd"));
  file.cloud.height = 2;
  file.cloud.width /= 2;
  file.cloud.data.resize(std::size_t{2} * file.cloud.width * file.cloud.point_step);
  file.cloud.row_step = file.cloud.width * file.cloud.point_step;
  writeCloud(path("grid.pcd"), file);
  ASSERT_EQ(run("filter", path("grid.pcd") + " " + path("kept.pcd") + " -veil 15 -keep_organized"), 0) << errors();
  const CloudFile kept = readCloud(path("kept.pcd"));
  EXPECT_EQ(kept.cloud.height, 2u);
  EXPECT_EQ(kept.cloud.width, file.cloud.width);
  EXPECT_FALSE(kept.cloud.is_dense);
}

/// Named field of point `i`, as bytes.
std::string bytesOf(const CloudFile& file, const std::string& name, std::size_t i)
{
  for (const auto& field : file.cloud.fields)
    if (field.name == name)
      return {reinterpret_cast<const char*>(file.cloud.data.data()) + i * file.cloud.point_step + field.offset,
              name == "label"    ? 2u
              : name == "spread" ? 24u
                                 : 4u};
  return "none";
}

TEST_F(FilterTools, NormalsKeepFieldsInAnyOrder)
{
  const auto* types = "4 2 4 8 4 4 4 4";
  for (const char* const fields : {"vp_x label y spread x z vp_z vp_y", "x label y spread vp_y z vp_z vp_x"})
    for (const char* const type : {"F U F F F F F F", "F I F F F F F F"}) {
      std::string file = "VERSION .7\nFIELDS " + std::string(fields) + "\nSIZE " + types + "\nTYPE " + type +
                         "\nCOUNT 1 1 1 3 1 1 1 1\nWIDTH 12\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 12\n"
                         "DATA ascii\n";
      for (int i = 0; i < 12; ++i)
        file +=
            concat(0.1 * i, " ", 7 * i, " ", i % 3, " ", i, " ", -i, " 0.3 ", i / 3, " ", i * i, " 5 ", 7 - i, "\n");
      const std::string in = text("odd.pcd", file);
      ASSERT_EQ(run("normals", in + " " + path("kept.pcd") + " -bilateral 1"), 0) << errors();
      const CloudFile before = readCloud(in), after = readCloud(path("kept.pcd"));
      auto names = fieldNames(before);
      for (std::size_t i = 0; i < 12; ++i)
        for (const std::string& name : names)
          EXPECT_EQ(bytesOf(after, name, i), bytesOf(before, name, i)) << name << " of " << i;
      for (const char* const added : {"normal_x", "normal_y", "normal_z", "curvature"})
        names.emplace_back(added);
      EXPECT_EQ(fieldNames(after), names);
    }
}

TEST_F(FilterTools, NormalsAreThoseOfTheCoreAndOtherFieldsStay)
{
  const std::string in = scanFile("scan.pcd");
  ASSERT_EQ(run("normals", in + " " + path("result.pcd") + " -k 12 -confidence"), 0) << errors();
  const PointSet before = readPoints(in), after = readPoints(path("result.pcd"));
  NormalOptions options;
  options.k = 12;
  EXPECT_TRUE(test::same(after.normals, estimateNormals(before, options).normals));
  EXPECT_TRUE(test::same(after.points, before.points));
  EXPECT_TRUE(test::same(after.intensities, before.intensities));
  EXPECT_EQ(after.confidences.size(), before.size());
  // A second run overwrites; the fields stay the same.
  ASSERT_EQ(run("normals", path("result.pcd") + " " + path("again.pcd") + " -k 12 -flip -threads 3"), 0) << errors();
  EXPECT_TRUE(test::same(readPoints(path("again.pcd")).normals, Points(-after.normals)));
  EXPECT_EQ(fieldNames(readCloud(path("again.pcd"))), fieldNames(readCloud(path("result.pcd"))));
}

TEST_F(FilterTools, NormalsTakeTheViewpointFromOptionFieldsHeaderOrNeighbors)
{
  PointSet set;
  set.points = test::flatSquare(500, 1).points;
  const auto signOf = [&](const std::string& file, const std::string& options) {
    EXPECT_EQ(run("normals", path(file) + " " + path("result.ply") + options), 0) << errors();
    const PointSet result = readPoints(path("result.ply"));
    return result.normals.row(2).minCoeff() > 0.9f ? 1 : result.normals.row(2).maxCoeff() < -0.9f ? -1 : 0;
  };
  writePoints(path("none.ply"), set);
  EXPECT_NE(signOf("none.ply", ""), 0);
  EXPECT_EQ(signOf("none.ply", " -viewpoint 0 0 -1"), -1);
  set.viewpoints = Eigen::Vector3f(0, 0, -3);
  writePoints(path("header.pcd"), set);
  EXPECT_EQ(signOf("header.pcd", ""), -1);
  EXPECT_EQ(signOf("header.pcd", " -viewpoint 0 0 1"), 1);
  set.viewpoints = Points::Random(3, 500);
  set.viewpoints.row(2).setConstant(-3);
  writePoints(path("fields.pcd"), set);
  EXPECT_EQ(signOf("fields.pcd", ""), -1);
  EXPECT_EQ(signOf("fields.pcd", " -propagate"), 1);
}

TEST_F(FilterTools, NormalsSmoothAndMove)
{
  PointSet set;
  set.points = test::withNoise(test::flatSquare(3000, 1).points, 0.02f, 3);
  set.viewpoints = Eigen::Vector3f(0, 0, 3);
  writePoints(path("noisy.pcd"), set);
  const auto spread = [&](const std::string& options, bool heights) {
    EXPECT_EQ(run("normals", path("noisy.pcd") + " " + path("result.pcd") + options), 0) << errors();
    const PointSet result = readPoints(path("result.pcd"));
    return heights ? result.points.row(2).norm() : result.normals.topRows(2).norm();
  };
  EXPECT_LT(spread(" -bilateral 3 -sigma_n 30", false), 0.6f * spread("", false));
  EXPECT_LT(spread(" -bilateral 3 -sigma_d 0.2 -move 3", true), 0.6f * spread("", true));
}

TEST_F(FilterTools, HelpNamesEveryOption)
{
  for (const std::string tool : {"filter", "normals"}) {
    EXPECT_EQ(run(tool, "-h"), 0);
    const std::string help = readFile(path("out"));
    for (const std::string& option : tool == "filter" ? std::vector<std::string>{"-outliers K SIGMA", "-veil", "-voxel"}
                                                      : std::vector<std::string>{"-k", "-radius", "-viewpoint X Y Z",
                                                                                 "-bilateral", "-sigma_d", "-sigma_n"})
      EXPECT_NE(help.find(option), std::string::npos) << option;
  }
}

TEST_F(FilterTools, BadInputEndsWithOneLineAndNoFile)
{
  const std::string good = scanFile("scan.pcd"), out = " " + path("result.pcd");
  const std::string bytes = readFile(good);
  const std::string cut = text("cut.pcd", bytes.substr(0, bytes.size() / 2)), empty = text("empty.pcd", "");
  const std::string nothing = text("nothing.xyz", "nan nan nan\nnan nan nan\n");
  for (const std::string tool : {"filter", "normals"}) {
    for (const std::string& in : {cut, empty, nothing, path("missing.pcd"), folder_, text("odd.jpg", "x")})
      expectFailure(tool, in + out, 1);
    expectFailure(tool, good + " " + folder_ + "/no/such/result.pcd", 1);
    expectFailure(tool, good + out + " -nonsense", 2);
    expectFailure(tool, good, 2);
  }
  for (const std::string options :
       {"-outliers 0 1", "-outliers 5", "-veil 90", "-veil x", "-voxel 0", "-voxel -1", "-noise -1"})
    expectFailure("filter", good + out + " " + options, 2);
  expectFailure("filter", good + out + " -voxel 1e-9", 1);
  expectFailure("filter", text("points.xyz", "0 0 0\n1 1 1\n") + out + " -veil 10", 1);
  for (const std::string options : {"-k 2", "-k 5 -radius 1", "-radius 0", "-bilateral -1", "-sigma_n 0", "-sigma_d -1",
                                    "-viewpoint 0 0", "-propagate -viewpoint 0 0 1"})
    expectFailure("normals", good + out + " " + options, 2);
}

TEST_F(FilterTools, SmallCloudsPass)
{
  for (const std::string points :
       {"1 2 3\n", "1 2 3\n1 2 3\n", "0 0 0\n1 0 0\n0 1 0\n", "1e30 0 0\n-1e30 0 0\n0 1e30 0\n0 0 1\n"}) {
    const std::string in = text("few.xyz", points);
    EXPECT_EQ(run("filter", in + " " + path("few.pcd") + " -viewpoint 0 0 9 -veil 10 -outliers 8 2"), 0) << errors();
    EXPECT_EQ(run("normals", in + " " + path("few.pcd") + " -bilateral 2"), 0) << errors();
    EXPECT_EQ(run("normals", in + " " + path("few.pcd") + " -viewpoint 0 0 9 -radius 0.5 -bilateral 2 -move 1"), 0)
        << errors();
  }
}

TEST_F(FilterTools, RealScans)
{
  FRESCO_NEED_DATA("apartment/cloud.00000.vtk");
  FRESCO_NEED_DATA("lobby/room_scan1.pcd");
  const std::string apartment = test::dataFolder() + "/apartment/cloud.00000.vtk";
  const std::string lobby = test::dataFolder() + "/lobby/room_scan1.pcd";
  ASSERT_EQ(run("filter", apartment + " " + path("a.pcd") + " -viewpoint 0 0 0 -veil 15 -outliers 16 3 -relative"), 0)
      << errors();
  const double share =
      static_cast<double>(readPoints(path("a.pcd")).size()) / static_cast<double>(readPoints(apartment).size());
  EXPECT_GT(share, 0.9);
  EXPECT_LT(share, 1.0);
  ASSERT_EQ(run("normals", lobby + " " + path("l.pcd") + " -bilateral 2"), 0) << errors();
  const PointSet set = readPoints(path("l.pcd"));
  Index towards = 0;
  for (Index i = 0; i < set.size(); ++i)
    towards += set.normals.col(i).dot(-set.points.col(i)) >= 0;
  EXPECT_GT(static_cast<double>(towards), 0.99 * static_cast<double>(set.size()));
}
} // namespace
} // namespace fresco
