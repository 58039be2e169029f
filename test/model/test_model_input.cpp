// SPDX-License-Identifier: BSD-3-Clause
#include "input/model_input.h"
#include "test_data.h"
#include <fresco/io/file.h>
#include <fresco/io/point_io.h>
namespace fresco::model {
namespace {
/// Two stations, the first of one point, the second without any.
std::string stations()
{
  const std::string header = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  return "1\n1\n" + header + "0 0 0 1\n1 2 3 0.5\n0\n0\n" + header + "10 0 0 1\n";
}

TEST(ModelInput, AFileOfScansStandsForAFolder)
{
  const std::string path = test::scratchFolder() + "/house.ptx";
  writeFile(path, stations());
  const ModelInput input = readModelInput(path);
  ASSERT_EQ(input.scans.size(), 2u);
  ASSERT_EQ(input.poses.size(), 2u);
  EXPECT_EQ((*input.poses[1])(0, 3), 10);
  EXPECT_EQ(input.files(), std::vector<std::string>{path});
  EXPECT_EQ(readPoints(input.scans[0]).size(), 1);
  EXPECT_EQ(readPoints(input.scans[1]).size(), 0);
}

TEST(ModelInput, StationsInAFolderAreScans)
{
  const std::string folder = test::scratchFolder();
  makeFolder(folder + "/scans");
  writeFile(folder + "/scans/b.ptx", stations());
  writeFile(folder + "/scans/a.xyz", "1 2 3\n");
  const ModelInput input = readModelInput(folder);
  ASSERT_EQ(input.scans.size(), 3u);
  EXPECT_FALSE(input.poses[0]);
  EXPECT_TRUE(input.poses[2]);
  EXPECT_EQ(input.files().size(), 2u);
  writeFile(folder + "/poses.txt", "none\n");
  EXPECT_THROW(readModelInput(folder), std::runtime_error); // one pose for three scans
}

TEST(ModelInput, ScansWithoutPosesBringNone)
{
  const std::string folder = test::scratchFolder();
  makeFolder(folder + "/scans");
  writeFile(folder + "/scans/a.xyz", "1 2 3\n");
  EXPECT_TRUE(readModelInput(folder).poses.empty());
  const ModelInput alone = readModelInput(folder + "/scans/a.xyz");
  EXPECT_EQ(alone.scans.size(), 1u);
  EXPECT_TRUE(alone.is_cloud); // a point does not tell where it was seen from
  EXPECT_FALSE(readModelInput(folder + "/scans/a.xyz", "scans").is_cloud);
}
} // namespace
} // namespace fresco::model
