// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/test_io_data.h"
#include <fresco/io/cloud_file.h>
#include <fresco/io/point_io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
namespace {
using namespace fresco;
using test::fullPointSet;
using test::sameValues;

void expectSame(const PointSet& a, const PointSet& b, const std::string& what)
{
  EXPECT_TRUE(sameValues(a.points, b.points)) << what;
  EXPECT_TRUE(sameValues(a.normals, b.normals)) << what;
  EXPECT_TRUE(a.colors.size() == b.colors.size() && a.colors == b.colors) << what;
  EXPECT_TRUE(sameValues(a.intensities, b.intensities)) << what;
  EXPECT_TRUE(sameValues(a.confidences, b.confidences)) << what;
  EXPECT_TRUE(sameValues(a.viewpoints, b.viewpoints)) << what;
  EXPECT_EQ(a.origin, b.origin) << what;
}

PointSet bare(Index count)
{
  PointSet set;
  set.points = test::randomPoints(count, 21, 3.f);
  return set;
}

TEST(PointIo, EveryAttributeSurvivesEveryFormat)
{
  const std::string folder = test::scratchFolder();
  for (const char* type : {"pcd", "ply", "xyz", "txt", "asc"}) {
    const std::string path = folder + "/cloud." + type;
    const PointSet set = fullPointSet(101);
    writePoints(path, set);
    expectSame(readPoints(path), set, type);
    writePoints(path, bare(7));
    expectSame(readPoints(path), bare(7), type);
  }
}

TEST(PointIo, ManyPointsAreWrittenInParts)
{
  const std::string folder = test::scratchFolder();
  for (const Index count : {(Index{1} << 19) + 1, (Index{1} << 20) + 1}) {
    PointSet set = fullPointSet(count);
    writePoints(folder + "/cloud.ply", set);
    expectSame(readPoints(folder + "/cloud.ply"), set, "a viewpoint each");
    set.viewpoints = Points::Constant(3, 1, 0.5f);
    set.colors.resize(3, 0);
    writePoints(folder + "/cloud.ply", set);
    expectSame(readPoints(folder + "/cloud.ply"), set, "one viewpoint");
  }
}

TEST(PointIo, SubsetsOfAttributesSurvive)
{
  const std::string folder = test::scratchFolder();
  for (const char* type : {"pcd", "ply", "xyz"})
    for (int mask = 0; mask < 16; ++mask) {
      PointSet set = fullPointSet(30), some;
      some.points = set.points;
      if (mask & 1)
        some.normals = set.normals;
      if (mask & 2)
        some.colors = set.colors;
      if (mask & 4)
        some.intensities = set.intensities;
      if (mask & 8)
        some.confidences = set.confidences;
      writePoints(folder + "/some." + type, some);
      expectSame(readPoints(folder + "/some." + type), some, type + std::to_string(mask));
    }
}

TEST(PointIo, OneViewpointGoesIntoTheHeader)
{
  const std::string folder = test::scratchFolder();
  PointSet set = bare(9);
  set.viewpoints.resize(3, 1);
  set.viewpoints << 0.1f, -2.f, 1.7f;
  for (const char* type : {"pcd", "ply"}) {
    writePoints(folder + "/cloud." + type, set);
    expectSame(readPoints(folder + "/cloud." + type), set, type);
  }
}

TEST(PointIo, LargeCoordinatesKeepTheirAccuracy)
{
  const std::string folder = test::scratchFolder();
  PointSet set = fullPointSet(200);
  set.points.col(100).setZero();
  set.origin = Eigen::Vector3d(691245.125, 5335001.5, 512.25);
  for (const char* type : {"pcd", "ply", "xyz"}) {
    const std::string path = folder + "/utm." + type;
    writePoints(path, set);
    const PointSet back = readPoints(path);
    EXPECT_LT(test::worldDistance(set, set.points, back, back.points), 2e-6) << type; // float over an extent of 10 m
    EXPECT_LT(test::worldDistance(set, set.viewpoints, back, back.viewpoints), 2e-6) << type;
    EXPECT_LT(back.points.cwiseAbs().maxCoeff(), 20.f) << type;
  }
}

TEST(PointIo, DoublesThatFloatHoldsKeepOriginZero)
{
  const std::string path = test::scratchFolder() + "/double.ply";
  test::writeText(path,
                  "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
                  "end_header\n0.1 0.2 0.3\n5.7 2 3\n");
  const PointSet set = readPoints(path);
  EXPECT_EQ(set.origin, Eigen::Vector3d::Zero());
  EXPECT_EQ(set.points.col(0), Eigen::Vector3f(0.1f, 0.2f, 0.3f));
}

TEST(PointIo, FloatFilesAreKeptAsTheyAreHoweverLarge)
{
  const std::string path = test::scratchFolder() + "/large.pcd";
  PointSet set = bare(50);
  set.points.array() += 1e6f;
  writePoints(path, set);
  expectSame(readPoints(path), set, "large");
}

TEST(PointIo, TextWithoutNamesIsRecognised)
{
  const std::string path = test::scratchFolder() + "/cloud.xyz";
  test::writeText(path, "1 2 3 255 0 10\n4,5;6\t1 2 3\r\n\r\n7 8 9 0 0 0");
  PointSet set = readPoints(path);
  ASSERT_EQ(set.size(), 3);
  EXPECT_EQ(set.points.col(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(set.colors(0, 0), 255);
  EXPECT_EQ(set.colors(2, 1), 3);
  test::writeText(path, "// a comment\n1 2 3 0.6 0 -0.8\n4 5 6 1 0 0\n");
  set = readPoints(path);
  EXPECT_EQ(set.normals.col(0), Eigen::Vector3f(0.6f, 0.f, -0.8f));
  test::writeText(path, "2\n1 2 3 -1250 10 20 30\n4 5 6 -1300 40 50 60\n"); // a count, then x y z intensity r g b
  set = readPoints(path);
  ASSERT_EQ(set.size(), 2);
  EXPECT_EQ(set.intensities[1], -1300.f);
  EXPECT_EQ(set.colors(2, 0), 30);
  test::writeText(path, "//X Y Z Intensity R G B\n1 2 3 7 10 20 30\n");
  set = readPoints(path);
  EXPECT_EQ(set.intensities[0], 7.f);
  EXPECT_EQ(set.colors(0, 0), 10);
  test::writeText(path, "1 nan 3\n");
  EXPECT_TRUE(std::isnan(readPoints(path).points(1, 0)));
}

TEST(PointIo, PclReadsWhatWeWrite)
{
  const std::string folder = test::scratchFolder();
  const PointSet set = fullPointSet(64);
  writePoints(folder + "/cloud.pcd", set);
  writePoints(folder + "/cloud.ply", set);
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud;
  for (const char* type : {"pcd", "ply"}) {
    const std::string path = folder + "/cloud." + type;
    ASSERT_EQ(type == std::string("pcd") ? pcl::io::loadPCDFile(path, cloud) : pcl::io::loadPLYFile(path, cloud), 0);
    ASSERT_EQ(cloud.size(), 64U);
    EXPECT_FALSE(cloud.is_dense);
    for (Index i = 0; i < 20; ++i) {
      const auto& point = cloud[i];
      EXPECT_EQ(point.getVector3fMap(), set.points.col(i)) << type;
      EXPECT_EQ(point.getNormalVector3fMap(), set.normals.col(i)) << type;
      EXPECT_EQ(point.r, set.colors(0, i)) << type;
      EXPECT_EQ(point.b, set.colors(2, i)) << type;
    }
  }
}

pcl::PointCloud<pcl::PointXYZRGB> organisedCloud()
{
  pcl::PointCloud<pcl::PointXYZRGB> cloud(8, 5);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto value = static_cast<float>(i);
    cloud[i].getVector3fMap() << 0.1f * value, -value, 1.f / (1.f + value);
    cloud[i].r = static_cast<std::uint8_t>(3 * i);
    cloud[i].g = 7;
    cloud[i].b = static_cast<std::uint8_t>(255 - i);
  }
  cloud[3].x = std::numeric_limits<float>::quiet_NaN();
  cloud.is_dense = false;
  cloud.sensor_origin_ = Eigen::Vector4f(1.f, 2.f, 3.f, 0.f);
  cloud.sensor_orientation_ = Eigen::Quaternionf(Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitY()));
  return cloud;
}

TEST(CloudFile, ReadsAllThatPclWrites)
{
  const std::string folder = test::scratchFolder();
  const auto cloud = organisedCloud();
  pcl::io::savePCDFileASCII(folder + "/ascii.pcd", cloud);
  pcl::io::savePCDFileBinary(folder + "/binary.pcd", cloud);
  pcl::io::savePCDFileBinaryCompressed(folder + "/compressed.pcd", cloud);
  for (const char* name : {"ascii", "binary", "compressed"}) {
    const CloudFile file = readCloud(folder + "/" + name + ".pcd");
    EXPECT_EQ(file.cloud.width, 8U) << name;
    EXPECT_EQ(file.cloud.height, 5U) << name;
    EXPECT_FALSE(file.cloud.is_dense) << name;
    EXPECT_EQ(file.sensor_origin, cloud.sensor_origin_) << name;
    EXPECT_TRUE(file.sensor_orientation.isApprox(cloud.sensor_orientation_, 1e-5f)) << name;
    pcl::PCLPointCloud2 copy = file.cloud;
    for (auto& field : copy.fields) // PCL's ASCII writer declares the packed colour as an integer
      if (field.name == "rgb")
        field.datatype = pcl::PCLPointField::FLOAT32;
    pcl::PointCloud<pcl::PointXYZRGB> back;
    pcl::fromPCLPointCloud2(copy, back);
    EXPECT_NEAR(back[11].x, cloud[11].x, 1e-4) << name; // PCL's ASCII keeps 8 digits
    EXPECT_EQ(back[11].r, cloud[11].r) << name;
    EXPECT_TRUE(std::isnan(back[3].x)) << name;
    const PointSet set = toPointSet(file);
    EXPECT_EQ(set.colors(2, 4), 251) << name;
    EXPECT_EQ(set.viewpoints, Points(Eigen::Vector3f(1, 2, 3))) << name;
  }
}

TEST(CloudFile, PclReadsWhatWeWrite)
{
  const std::string folder = test::scratchFolder();
  const auto cloud = organisedCloud();
  CloudFile file;
  pcl::toPCLPointCloud2(cloud, file.cloud);
  file.sensor_origin = cloud.sensor_origin_;
  file.sensor_orientation = cloud.sensor_orientation_;
  writeCloud(folder + "/plain.pcd", file);
  writeCloud(folder + "/small.pcd", file, true);
  for (const char* name : {"plain", "small"}) {
    pcl::PointCloud<pcl::PointXYZRGB> back;
    ASSERT_EQ(pcl::io::loadPCDFile(folder + "/" + name + ".pcd", back), 0) << name;
    ASSERT_EQ(back.size(), cloud.size()) << name;
    EXPECT_EQ(back.width, 8U) << name;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_TRUE(i == 3 ? std::isnan(back[i].x) : back[i].getVector3fMap() == cloud[i].getVector3fMap()) << name;
      EXPECT_EQ(back[i].rgba & 0xffffffU, cloud[i].rgba & 0xffffffU) << name;
    }
    EXPECT_EQ(back.sensor_origin_, cloud.sensor_origin_) << name;
    EXPECT_TRUE(back.sensor_orientation_.isApprox(cloud.sensor_orientation_, 1e-6f)) << name;
  }
}

CloudFile oddFields()
{
  CloudFile file;
  auto& cloud = file.cloud;
  const auto add = [&](const char* name, std::uint8_t type, unsigned count, unsigned bytes) {
    pcl::PCLPointField field;
    field.name = name;
    field.datatype = type;
    field.count = count;
    field.offset = cloud.point_step;
    cloud.fields.push_back(field);
    cloud.point_step += bytes;
  };
  using F = pcl::PCLPointField;
  add("x", F::FLOAT64, 1, 8);
  add("y", F::FLOAT64, 1, 8);
  add("z", F::FLOAT64, 1, 8);
  add("label", F::UINT32, 1, 4);
  add("_", F::UINT8, 3, 3);
  add("ring", F::UINT16, 1, 2);
  add("histogram", F::FLOAT32, 5, 20);
  add("echo", F::INT8, 1, 1);
  cloud.width = 20;
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (unsigned i = 0; i < 20; ++i)
    for (unsigned k = 0; k < cloud.point_step; ++k)
      cloud.data[i * cloud.point_step + k] = static_cast<std::uint8_t>(31 * i + 7 * k);
  for (unsigned i = 0; i < 20; ++i)
    for (unsigned k = 0; k < 3; ++k) {
      const double value = 4.5e6 + i + 0.001 * k;
      std::memcpy(&cloud.data[i * cloud.point_step + 8 * k], &value, 8);
    }
  return file;
}

TEST(CloudFile, EveryFieldSurvives)
{
  const std::string folder = test::scratchFolder();
  const CloudFile file = oddFields();
  for (const bool compressed : {false, true}) {
    writeCloud(folder + "/odd.pcd", file, compressed);
    const CloudFile once = readCloud(folder + "/odd.pcd");
    ASSERT_EQ(once.cloud.fields.size(), 7U); // the padding is dropped
    for (const auto& field : once.cloud.fields) {
      const auto original = std::find_if(file.cloud.fields.begin(), file.cloud.fields.end(),
                                         [&](const auto& other) { return other.name == field.name; });
      EXPECT_EQ(field.datatype, original->datatype) << field.name;
      EXPECT_EQ(field.count, original->count) << field.name;
      const std::size_t bytes = field.count * static_cast<std::size_t>(pcl::getFieldSize(field.datatype));
      for (unsigned i = 0; i < 20; ++i)
        EXPECT_EQ(std::memcmp(&once.cloud.data[i * once.cloud.point_step + field.offset],
                              &file.cloud.data[i * file.cloud.point_step + original->offset], bytes),
                  0)
            << field.name;
    }
  }
  const PointSet set = toPointSet(file);
  EXPECT_NEAR(set.origin.x() + static_cast<double>(set.points(0, 7)), 4.5e6 + 7, 1e-6);
}

TEST(CloudFile, ToAndFromPointSet)
{
  PointSet set = fullPointSet(33);
  expectSame(toPointSet(toCloudFile(set)), set, "cloud file");
  CloudFile broken = toCloudFile(set);
  broken.cloud.data.resize(broken.cloud.data.size() - 1);
  EXPECT_THROW(toPointSet(broken), std::invalid_argument);
  broken = toCloudFile(set);
  broken.cloud.fields[0].offset = 10000;
  EXPECT_THROW(toPointSet(broken), std::invalid_argument);
  broken = toCloudFile(set);
  broken.cloud.fields[0].name = "u";
  EXPECT_THROW(toPointSet(broken), std::invalid_argument);
}

TEST(PointIo, ErrorsNameFileAndReason)
{
  const std::string folder = test::scratchFolder();
  const auto expectError = [](const std::string& path, const char* reason) {
    const std::string error = test::errorOf([&] { readPoints(path); });
    EXPECT_NE(error.find(path), std::string::npos) << error;
    EXPECT_NE(error.find(reason), std::string::npos) << error;
  };
  expectError(folder + "/missing.pcd", "no such file");
  expectError(folder, "not a file of points");
  std::filesystem::create_directory(folder + "/folder.ply");
  expectError(folder + "/folder.ply", "folder");
  test::writeText(folder + "/empty.ply", "");
  expectError(folder + "/empty.ply", "empty");
  test::writeText(folder + "/image.png", "x");
  expectError(folder + "/image.png", "not a file of points");
  test::writeText(folder + "/none.pcd",
                  "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\n"
                  "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA ascii\n");
  expectError(folder + "/none.pcd", "no points");
  test::writeText(folder + "/none.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n");
  expectError(folder + "/none.ply", "no vertices");
  test::writeText(folder + "/flat.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float u\nend_header\n1\n");
  expectError(folder + "/flat.ply", "x y z");
  test::writeText(folder + "/huge.pcd",
                  "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2000000000\nHEIGHT 1\n"
                  "POINTS 2000000000\nDATA binary\n1234");
  expectError(folder + "/huge.pcd", "truncated");
  test::writeText(folder + "/bad.xyz", "1 2 3\n1 2\n");
  expectError(folder + "/bad.xyz", "line 2");
  EXPECT_NE(test::errorOf([&] { writePoints(folder + "/cloud.docx", bare(3)); }).find("cannot write"),
            std::string::npos);
}

TEST(PointIo, FailedWritesLeaveNothingAndTouchNothing)
{
  const std::string folder = test::scratchFolder();
  EXPECT_THROW(writePoints(folder + "/no/such/folder/cloud.pcd", bare(3)), std::runtime_error);
  writePoints(folder + "/cloud.ply", bare(3));
  PointSet broken = bare(4);
  broken.normals.setZero(3, 2);
  EXPECT_THROW(writePoints(folder + "/cloud.ply", broken), std::invalid_argument);
  EXPECT_EQ(readPoints(folder + "/cloud.ply").size(), 3);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(PointIo, RealFiles)
{
  FRESCO_NEED_DATA("lobby/room_scan1.pcd");
  FRESCO_NEED_DATA("apartment/cloud.00000.vtk");
  const PointSet lobby = readPoints(test::dataFolder() + "/lobby/room_scan1.pcd");
  EXPECT_EQ(lobby.size(), 112586);
  EXPECT_EQ(lobby.viewpoints, Points(Eigen::Vector3f::Zero()));
  pcl::PointCloud<pcl::PointXYZ> peer;
  ASSERT_EQ(pcl::io::loadPCDFile(test::dataFolder() + "/lobby/room_scan1.pcd", peer), 0);
  for (Index i = 0; i < lobby.size(); ++i)
    ASSERT_TRUE(sameValues(Eigen::Vector3f(lobby.points.col(i)), Eigen::Vector3f(peer[i].getVector3fMap())));
  const PointSet apartment = readPoints(test::dataFolder() + "/apartment/cloud.00000.vtk");
  EXPECT_EQ(apartment.size(), 24989);
  EXPECT_EQ(apartment.points.col(0), Eigen::Vector3f(-3.79521f, 0.0131325f, -0.95763f));
  EXPECT_EQ(apartment.viewpoints.cols(), 0);
}
} // namespace
