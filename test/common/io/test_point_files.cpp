// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/test_io_data.h"
#include "io/points/row_file.h"
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <fstream>
#include <set>
#include <sys/resource.h>
#include <tuple>
#include <unistd.h>
namespace fresco::test {
namespace {
using Row = std::vector<double>;

/// What a set says of each point, in the frame of its origin.
std::multiset<Row> rowsOf(const PointSet& set)
{
  std::multiset<Row> rows;
  for (Index i = 0; i < set.size(); ++i) {
    Row row;
    const auto add = [&](const auto& columns) {
      for (Index k = 0; k < (columns.cols() > 0 ? columns.rows() : 0); ++k)
        row.push_back(std::isnan(static_cast<double>(columns(k, i))) ? 1e30 : static_cast<double>(columns(k, i)));
    };
    add(set.points);
    add(set.normals);
    add(set.colors);
    add(Eigen::RowVectorXf(set.intensities.transpose()));
    add(Eigen::RowVectorXf(set.confidences.transpose()));
    rows.insert(row);
  }
  return rows;
}

struct Read {
  std::multiset<Row> rows;
  Eigen::Vector3d origin;
  Index largest_window = 0;
};

Read readAll(const std::vector<std::string>& files, Index window)
{
  std::vector<ScanPath> paths;
  for (const std::string& file : files)
    paths.push_back({file});
  Read read;
  openPointFiles(paths, window)->read([&](const PointSet& set) {
    read.rows.merge(rowsOf(set));
    read.origin = set.origin;
    read.largest_window = std::max(read.largest_window, set.size());
    EXPECT_EQ(set.viewpoints.cols(), 0);
  });
  return read;
}

class PointFiles : public testing::Test {
protected:
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string write(const std::string& name, const PointSet& set) const
  {
    writePoints(path(name), set);
    return path(name);
  }
  void expectRefused(const std::vector<std::string>& files, const std::string& reason) const
  {
    try {
      readAll(files, 10);
      ADD_FAILURE() << reason;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(files.back()), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  std::string folder_ = scratchFolder();
};

TEST_F(PointFiles, WindowsHoldWhatTheFileHolds)
{
  PointSet set = fullPointSet(1000);
  set.viewpoints.resize(3, 0);
  PointSet far = set;
  far.origin = {448000, 5428000, 128}; // written as double
  for (const std::string& file :
       {write("a.ply", set), write("a.pcd", set), write("far.ply", far), write("a.xyz", set)}) {
    const PointSet whole = readPoints(file);
    for (const Index window : {64, 999, 100000}) {
      const Read read = readAll({file}, window);
      EXPECT_EQ(read.rows, rowsOf(whole)) << file;
      EXPECT_EQ(read.origin, whole.origin) << file;
      EXPECT_TRUE(read.largest_window <= window || file == path("a.xyz")) << file;
    }
  }
}

TEST_F(PointFiles, NeitherOrderNorWindowChangesThePoints)
{
  PointSet near = fullPointSet(300), far = fullPointSet(200), plain = fullPointSet(100);
  near.origin = {448000, 5428000, 128};
  far.origin = {448064, 5428000, 128};
  plain.points.array() += 100.f;
  plain.colors.resize(3, 0); // so no file's colours count
  const std::string a = write("a.ply", near), b = write("b.pcd", far), c = write("c.xyz", plain);
  const Read read = readAll({a, b, c}, 1000);
  EXPECT_EQ(read.rows.size(), 600U);
  EXPECT_EQ(read.rows.begin()->size(), 8U);
  EXPECT_EQ(readAll({c, b, a}, 7).rows, read.rows);
  EXPECT_EQ(readAll({b, a, c}, 250).origin, read.origin);
}

TEST_F(PointFiles, FilesThatDoNotGoTogetherAreNamed)
{
  PointSet bare = fullPointSet(50);
  bare.normals.resize(3, 0);
  const std::string good = write("good.ply", fullPointSet(50));
  expectRefused({good, write("bare.ply", bare)}, "no normals");
  expectRefused({good, path("none.ply")}, "no such file");
  std::filesystem::copy(good, path("short.ply"));
  std::filesystem::resize_file(path("short.ply"), std::filesystem::file_size(good) - 1);
  expectRefused({good, path("short.ply")}, "truncated");
  writeFile(path("faces.ply"),
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                std::string(12, '\0') + "\3");
  expectRefused({good, path("faces.ply")}, "truncated"); // where only the points are used, too
  writeFile(path("broken.ply"), "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n");
  expectRefused({good, path("broken.ply")}, "header");
  EXPECT_THROW(openPointFiles({}), std::invalid_argument);
  EXPECT_THROW(openPointFiles({{good}}, 0), std::invalid_argument);
}

TEST_F(PointFiles, FoldersStandForTheirFiles)
{
  std::filesystem::create_directories(path("in/deeper"));
  const std::string b = write("in/b.pcd", fullPointSet(9)), a = write("in/a.ply", fullPointSet(9));
  writeFile(path("in/poses.txt"), "1 0 0 0\n");
  EXPECT_EQ(pointFilesIn({path("in"), b}), (std::vector<std::string>{a, b, b}));
  EXPECT_THROW(pointFilesIn({path("in/deeper")}), std::runtime_error);
  EXPECT_THROW(pointFilesIn({path("none.ply")}), std::runtime_error);
}

TEST_F(PointFiles, MoreFilesThanAProcessMayOpen)
{
  constexpr int count = 100, most_open = 32;
  std::vector<std::string> files;
  for (int i = 0; i < count; ++i)
    files.push_back(write(std::to_string(i) + (i % 2 == 0 ? ".ply" : ".pcd"), fullPointSet(9)));
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit few = before;
  few.rlim_cur = most_open;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  EXPECT_EQ(readAll(files, 5).rows.size(), 9u * count);
  EXPECT_EQ(readAll(files, 10000).rows.size(), 9u * count);
  setrlimit(RLIMIT_NOFILE, &before);
}

TEST_F(PointFiles, MoreRowsThanAnIntCounts)
{
  const std::uint64_t rows = (std::uint64_t{1} << 31) + 5;
  writeFile(path("many.ply"), "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(rows) +
                                  "\nproperty uchar x\nproperty uchar y\nproperty uchar z\nend_header\n");
  const auto header = std::filesystem::file_size(path("many.ply"));
  std::error_code error;
  std::filesystem::resize_file(path("many.ply"), header + 3 * rows, error); // a hole: takes no space
  if (error)
    GTEST_SKIP() << "the disk cannot hold such a file";
  std::fstream file(path("many.ply"), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(-3, std::ios::end);
  file.write("\1\2\3", 3);
  file.close();
  const auto many = io::RowFile::open(path("many.ply"));
  ASSERT_TRUE(many);
  EXPECT_EQ(many->size(), static_cast<Index>(rows));
  const PointSet last = io::tableToPoints(many->read(many->size() - 2, many->size()));
  EXPECT_EQ(last.points.col(0), Eigen::Vector3f::Zero());
  EXPECT_EQ(last.points.col(1), Eigen::Vector3f(1, 2, 3));
  std::filesystem::remove(path("many.ply"));
}
} // namespace
} // namespace fresco::test
