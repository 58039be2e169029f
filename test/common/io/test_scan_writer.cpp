// SPDX-License-Identifier: BSD-3-Clause
// Scans go out as they came in: poses, fields, pictures.
#include "common/io/test_io_data.h"
#include <cstdlib>
#include <fresco/core/poses.h>
#include <fresco/io/point_io.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_writer.h>
#include <pcl/common/io.h>
namespace {
using namespace fresco;

/// A cloud of every type of field, organised, with points that are not finite.
CloudFile cloudOfEveryType()
{
  CloudFile file = toCloudFile(test::fullPointSet(12));
  pcl::PCLPointCloud2& cloud = file.cloud;
  const auto old_step = cloud.point_step;
  const std::vector<std::uint8_t> old = cloud.data;
  for (const auto type : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) { // of pcl::PCLPointField
    pcl::PCLPointField field;
    field.name = "type_" + std::to_string(type);
    field.datatype = std::uint8_t(type);
    field.count = 1;
    field.offset = cloud.point_step;
    cloud.point_step += std::uint32_t(pcl::getFieldSize(field.datatype));
    cloud.fields.push_back(field);
  }
  cloud.width = 4;
  cloud.height = 3;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.assign(12 * cloud.point_step, 0);
  for (std::size_t i = 0; i < 12; ++i) {
    std::copy_n(&old[i * old_step], old_step, &cloud.data[i * cloud.point_step]);
    for (std::size_t k = old_step; k < cloud.point_step; ++k)
      cloud.data[i * cloud.point_step + k] = std::uint8_t(37 * i + k) & 0x3F;
  }
  return file;
}

void expectSameFields(const CloudFile& a, const CloudFile& b)
{
  ASSERT_EQ(a.cloud.width, b.cloud.width);
  ASSERT_EQ(a.cloud.height, b.cloud.height);
  for (const auto& field : a.cloud.fields) {
    const auto other =
        std::find_if(b.cloud.fields.begin(), b.cloud.fields.end(), [&](const auto& f) { return f.name == field.name; });
    ASSERT_NE(other, b.cloud.fields.end()) << field.name;
    const auto bytes = std::size_t(pcl::getFieldSize(field.datatype));
    for (std::size_t i = 0; i < 12; i += i == 5 ? 2 : 1) // the one between is not finite
      EXPECT_EQ(std::memcmp(&a.cloud.data[i * a.cloud.point_step + field.offset],
                            &b.cloud.data[i * b.cloud.point_step + other->offset], bytes),
                0)
          << field.name << i;
  }
}

TEST(ScanWriter, PosesFieldsAndPicturesOfE57Stay)
{
  const std::string path = test::scratchFolder() + "/a.e57";
  PlacedCloud first{"first <&>", Eigen::Isometry3d(Eigen::Translation3d(431000.25, 5, -1)), cloudOfEveryType()},
      second{"", {}, {}};
  first.T_file_scan->linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  ScanPicture pinhole, sphere;
  pinhole.bytes = std::string(5000, 'j');
  pinhole.mask = "mask";
  pinhole.description.projection = ScanImage::Projection::pinhole;
  pinhole.description.name = "front";
  pinhole.description.scan = 0;
  pinhole.description.width = 640;
  pinhole.description.focal_length = 0.02;
  pinhole.description.T_file_image = first.T_file_scan;
  sphere.bytes = "png";
  sphere.description.encoding = ScanImage::Encoding::png;
  sphere.description.projection = ScanImage::Projection::spherical;
  sphere.description.pixel_width = 0.001;
  writeScans(path, {first, second}, {pinhole, sphere});
  const std::vector<PlacedCloud> back = readPlacedClouds(path);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].name, first.name);
  EXPECT_LT((back[0].T_file_scan->matrix() - first.T_file_scan->matrix()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_FALSE(back[1].T_file_scan);
  expectSameFields(first.cloud, back[0].cloud);
  EXPECT_TRUE(toPointSet(back[0].cloud).points.col(6).array().isNaN().all());
  const std::vector<ScanPicture> pictures = readScanPictures(path);
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(pictures[0].bytes, pinhole.bytes);
  EXPECT_EQ(pictures[0].mask, "mask");
  EXPECT_EQ(pictures[0].description.name, "front");
  EXPECT_EQ(pictures[0].description.scan, 0);
  EXPECT_EQ(pictures[0].description.focal_length, 0.02);
  EXPECT_TRUE(pictures[0].description.T_file_image->isApprox(*first.T_file_scan));
  EXPECT_EQ(pictures[1].bytes, "png");
  EXPECT_EQ(pictures[1].description.pixel_width, 0.001);
  EXPECT_FALSE(pictures[1].description.T_file_image);
}

// A survey at new poses: every field, the pictures with their scans, and coordinates of a country's grid.
TEST(ScanWriter, ScansGoToTheirNewPosesWithTheirPictures)
{
  const std::string folder = test::scratchFolder();
  const Eigen::Isometry3d before(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
  Eigen::Isometry3d after(Eigen::Translation3d(431000.25, 5.4e6, 12) * Eigen::AngleAxisd(2, Eigen::Vector3d::UnitZ()));
  ScanPicture of_first, of_none;
  of_first.bytes = of_none.bytes = "png";
  of_first.description.scan = 1;
  of_first.description.encoding = of_none.description.encoding = ScanImage::Encoding::png;
  of_first.description.T_file_image = before * Eigen::Translation3d(0, 0, 1);
  writeScans(folder + "/a.e57",
             {{"left out", Eigen::Isometry3d::Identity(), cloudOfEveryType()}, {"kept", before, cloudOfEveryType()}},
             {of_none, of_first});
  writeCloud(folder + "/b.pcd", cloudOfEveryType());
  const std::vector<ScanPath> scans = {{folder + "/a.e57", 0}, {folder + "/a.e57", 1}, {folder + "/b.pcd"}};
  writeScansAt(folder + "/out.e57", scans, {Pose(), after.matrix(), before.matrix()});
  const std::vector<PlacedCloud> back = readPlacedClouds(folder + "/out.e57");
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0].name, "kept");
  EXPECT_LT((back[0].T_file_scan->matrix() - after.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((back[1].T_file_scan->matrix() - before.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  for (const PlacedCloud& cloud : back)
    expectSameFields(cloudOfEveryType(), cloud.cloud);
  const std::vector<ScanPicture> pictures = readScanPictures(folder + "/out.e57");
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_EQ(pictures[0].description.scan, 0);
  const Eigen::Isometry3d T_scan_image = after.inverse() * *pictures[0].description.T_file_image;
  EXPECT_LT((T_scan_image.translation() - Eigen::Vector3d(0, 0, 1)).norm(), 1e-8);
  EXPECT_THROW(writeScansAt(folder + "/no.e57", scans, {}), std::invalid_argument);
}

TEST(ScanWriter, CloudsOfManyPointsComeBack)
{
  const std::string folder = test::scratchFolder();
  PointSet set = test::fullPointSet(70001); // several packets and windows
  for (const char* type : {"e57", "las"}) {
    const std::string path = folder + "/a." + type;
    const bool las = type == std::string("las");
    if (las)
      set.points.col(set.size() / 2).setZero(); // NaN has no place there
    writePoints(path, set);
    const PointSet back = readPoints(path);
    ASSERT_EQ(back.size(), set.size()) << type;
    const Index half = set.size() / 2;
    EXPECT_LE((back.points.leftCols(half) - set.points.leftCols(half)).cwiseAbs().maxCoeff(), las ? 1e-6f : 0.f)
        << type;
    EXPECT_TRUE(test::sameValues(back.normals, set.normals)) << type;
    EXPECT_EQ(back.colors, set.colors) << type;
    EXPECT_TRUE(test::sameValues(back.intensities, set.intensities)) << type;
    EXPECT_TRUE(test::sameValues(back.confidences, set.confidences)) << type;
    EXPECT_TRUE(test::sameValues(back.viewpoints, set.viewpoints)) << type;
  }
}

TEST(ScanWriter, TheSensorOfOneCloudIsKeptInE57)
{
  const std::string path = test::scratchFolder() + "/a.e57";
  PointSet set = test::fullPointSet(20);
  set.viewpoints = Points(Eigen::Vector3f(1, 2, 3));
  writePoints(path, set);
  const PointSet back = readPoints(path);
  EXPECT_EQ(back.viewpoints, set.viewpoints);
  EXPECT_LE((back.points.leftCols(10) - set.points.leftCols(10)).cwiseAbs().maxCoeff(), 1e-6f);
}

TEST(ScanWriter, LazByTheProgram)
{
  if (std::system("laszip -h >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "SKIPPED: the program laszip is not installed";
  const std::string path = test::scratchFolder() + "/a.laz";
  PointSet set = test::fullPointSet(100);
  writePoints(path, set);
  EXPECT_EQ(readPoints(path).size(), 99);
}
} // namespace
