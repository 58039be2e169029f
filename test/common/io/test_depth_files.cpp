// SPDX-License-Identifier: BSD-3-Clause
#include "common/float_files.h"
#include "test_data.h"
#include <filesystem>
#include <fresco/core/camera.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/text_rows.h>
#include <map>
namespace {
using namespace fresco;
using namespace fresco::test;

Floats slope()
{
  Floats image{37, 21, {}};
  for (int i = 0; i < image.width * image.height; ++i)
    image.values.push_back(0.5f + 0.004f * i);
  image.values[5] = NAN, image.values[6] = -1, image.values[7] = 900, image.values[8] = INFINITY;
  return image;
}

std::map<std::string, std::string> files(const Floats& image)
{
  return {{"low.pfm", pfmBytes(image)},
          {"high.pfm", pfmBytes(image, false)},
          {"float.npy", npyBytes(image)},
          {"double.npy", npyBytes(image, true)},
          {"low.tiff", tiffBytes(image)},
          {"high.tiff", tiffBytes(image, false)},
          {"low_p.tiff", tiffBytes(image, true, true)},
          {"high_p.tiff", tiffBytes(image, false, true)}};
}

TEST(DepthFiles, MetresAreKeptToATenthOfAMillimetre)
{
  const std::string folder = scratchFolder();
  const Floats image = slope();
  for (const auto& [name, bytes] : files(image)) {
    const std::string path = folder + "/" + name;
    writeFile(path, bytes);
    const ImageSize size = readImageSize(path);
    EXPECT_EQ(size.width, image.width) << name;
    EXPECT_EQ(size.height, image.height) << name;
    const DepthFile file = readDepthFile(path);
    ASSERT_EQ(file.image.data.size(), image.values.size()) << name;
    EXPECT_TRUE(file.in_metres);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      if (i >= 5 && i <= 8)
        EXPECT_EQ(file.image.data[i], 0) << name << " " << i;
      else
        EXPECT_NEAR(file.image.data[i] * metres_unit, image.values[i], 0.51 * metres_unit) << name << " " << i;
    EXPECT_THROW(readImage(path), std::runtime_error) << name;
    EXPECT_THROW(readImage16(path), std::runtime_error) << name;
  }
}

TEST(DepthFiles, WholeNumbersStayAsTheyAre)
{
  const std::string path = scratchFolder() + "/depth.png";
  const Image16 image{2, 2, {0, 1, 1000, 65535}};
  writeImage(path, image);
  const DepthFile file = readDepthFile(path);
  EXPECT_FALSE(file.in_metres);
  EXPECT_EQ(file.image.data, image.data);
  writeImage(path, Image(2, 2));
  EXPECT_THROW(readDepthFile(path), std::runtime_error);
}

TEST(DepthFiles, DamagedOnesAreRefused)
{
  const std::string folder = scratchFolder();
  for (const auto& [name, bytes] : files(slope()))
    for (const double share : {0.02, 0.3, 0.9}) {
      const std::string path = folder + "/" + name;
      writeFile(path, std::string_view(bytes).substr(0, std::size_t(share * bytes.size())));
      EXPECT_THROW(readDepthFile(path), std::runtime_error) << name << " " << share;
    }
  for (const char* text : {"Pf\n0 4\n-1\n", "Pf\n4 1e9\n-1\n", "Pf\nx 4\n-1\n", "\x93NUMPY\x01", "Pf\n"}) {
    writeFile(folder + "/bad", text);
    EXPECT_THROW(readDepthFile(folder + "/bad"), std::runtime_error) << text;
  }
}

TEST(TextRows, CellsHoweverTheyAreParted)
{
  const std::string path = scratchFolder() + "/rows.csv";
  writeFile(path, "# a comment\r\n1, 2;\t3 | 4\r\n\r\n\"a name.jpg\" +5 nan # six\n");
  const auto rows = readTextRows(path);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"1", "2", "3", "4"}));
  EXPECT_EQ(rows[1][0], "a name.jpg");
  EXPECT_EQ(numberIn(path, rows[1][1]), 5);
  EXPECT_TRUE(std::isnan(numberIn(path, rows[1][2])));
  EXPECT_THROW(numberIn(path, "five"), std::runtime_error);
  EXPECT_THROW(readMatrix(path, 2, 2), std::runtime_error);
  writeFile(path, "1, 2\n3, 4\n");
  EXPECT_EQ(readMatrix(path, 2, 2), (Eigen::Matrix2d() << 1, 2, 3, 4).finished());
  EXPECT_THROW(readMatrix(path, 3, 3), std::runtime_error);
}

TEST(TextRows, PosesBecomeRotationsAgain)
{
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T(0, 0) = 1.004;
  T(1, 3) = 5;
  const Pose pose = rigidPose("x", T);
  ASSERT_TRUE(pose);
  EXPECT_TRUE(isRigid(*pose, 1e-12));
  EXPECT_EQ((*pose)(1, 3), 5);
  T(0, 0) = NAN;
  EXPECT_FALSE(rigidPose("x", T));
  T(0, 0) = 2;
  EXPECT_THROW(rigidPose("x", T), std::runtime_error);
}
} // namespace
