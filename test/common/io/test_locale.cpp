// SPDX-License-Identifier: BSD-3-Clause
// Files do not depend on the locale of the program. With FRESCO_HOSTILE_LOCALE set, the other suites of io run in one, too.
#include "common/io/test_io_data.h"
#include <clocale>
#include <cstdlib>
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <locale>
namespace {
using namespace fresco;

/// 1.234,5 in C++, and in C where such a locale is installed.
void setHostileLocale()
{
  struct Punctuation : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale::global(std::locale(std::locale::classic(), new Punctuation));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"})
    if (std::setlocale(LC_ALL, name))
      return;
}

void setClassicLocale()
{
  std::locale::global(std::locale::classic());
  std::setlocale(LC_ALL, "C");
}

class HostileRun : public testing::Environment {
  void SetUp() override
  {
    if (std::getenv("FRESCO_HOSTILE_LOCALE"))
      setHostileLocale();
  }
};
[[maybe_unused]] const testing::Environment* const registered = testing::AddGlobalTestEnvironment(new HostileRun);

/// What all writers write of large numbers and small ones, file by file.
std::vector<std::string> written()
{
  const std::string folder = test::scratchFolder();
  PointSet points = test::fullPointSet(20000);
  points.origin = {1234567.5, 0.25, -3};
  points.points.col(10000).setZero();
  std::vector<std::string> files;
  for (const char* type : {"pcd", "ply", "xyz", "csv", "e57", "las"}) {
    files.push_back(folder + "/points." + type);
    writePoints(files.back(), points);
  }
  TriangleMesh mesh = test::fullMesh(40);
  mesh.origin = {1234567.5, 0.25, -3};
  for (const char* type : {"ply", "obj"}) {
    files.push_back(folder + "/mesh." + type);
    writeMesh(files.back(), mesh);
  }
  TexturedMesh model = test::fullTexturedMesh(40, 2);
  for (const char* type : {"ply", "obj", "glb"}) {
    files.push_back(folder + "/model." + type);
    writeTexturedMesh(files.back(), model);
  }
  files.push_back(folder + "/model.mtl");
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topRightCorner<3, 1>() << 1234.5, 1e-7, -98765.25;
  files.push_back(folder + "/poses.txt");
  writePoses(files.back(), {Pose(T), Pose()});
  CameraSet cameras;
  cameras.cameras.push_back({4000, 3000, 3210.5, 3210.5, 2000.25, 1500, 0, 0, 0, 0});
  cameras.views.resize(1200);
  for (View& view : cameras.views)
    view.image = "a.jpg";
  writeColmap(folder + "/cameras", cameras);
  for (const char* name : {"cameras.txt", "images.txt", "points3D.txt"})
    files.push_back(folder + "/cameras/" + name);
  std::vector<std::string> contents;
  for (const std::string& file : files)
    contents.push_back(file.substr(file.rfind('/')) + "\n" + readFile(file));
  EXPECT_EQ((*readPoses(folder + "/poses.txt")[0])(0, 3), 1234.5);
  EXPECT_EQ(readColmap(folder + "/cameras").cameras[0].fx, 3210.5);
  for (const char* type : {"pcd", "ply", "xyz", "csv", "e57"})
    EXPECT_LT(test::worldDistance(points, points.points.leftCols(10000).eval(), readPoints(folder + "/points." + type),
                                  readPoints(folder + "/points." + type).points.leftCols(10000).eval()),
              1e-5)
        << type;
  EXPECT_EQ(readMesh(folder + "/mesh.obj").faces, mesh.faces);
  EXPECT_EQ(readTexturedMesh(folder + "/model.glb").mesh.faceCount(), model.mesh.faceCount());
  return contents;
}

TEST(Locale, FilesAreTheSameInAnyLocale)
{
  setClassicLocale();
  const std::vector<std::string> classic = written();
  setHostileLocale();
  const std::vector<std::string> hostile = written();
  EXPECT_EQ(concat("line ", 1234567, ": ", 0.5), "line 1234567: 0.5"); // what messages say
  ASSERT_EQ(classic.size(), hostile.size());
  for (std::size_t i = 0; i < classic.size(); ++i)
    EXPECT_TRUE(classic[i] == hostile[i]) << classic[i].substr(0, 400) << "\n" << hostile[i].substr(0, 400);
  const std::string tiny = test::scratchFolder() + "/tiny.xyz";
  test::writeText(tiny, "1.5e-400 -1e999 1.25\n0.001e9223372036854775807 1e-9223372036854775808 0\n");
  const PointSet points = readPoints(tiny);
  EXPECT_EQ(points.points(0, 0), 0.f);
  EXPECT_TRUE(std::isinf(points.points(1, 0)) && points.points(1, 0) < 0);
  EXPECT_TRUE(std::isinf(points.points(0, 1)));
  EXPECT_EQ(points.points(1, 1), 0.f);
  if (!std::getenv("FRESCO_HOSTILE_LOCALE"))
    setClassicLocale();
}
} // namespace
