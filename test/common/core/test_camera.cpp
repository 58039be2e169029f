// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include <cstring>
#include <fresco/core/camera.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
namespace {
using namespace fresco;

CameraModel lens() { return {640, 480, 585.0, 580.0, 322.5, 238.25, -0.21, 0.08, 1.5e-3, -7e-4}; }

CameraSet cameraSet()
{
  CameraSet set;
  set.cameras = {lens(), {1280, 960, 1000.0, 1010.0, 640.0, 480.0, 0, 0, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(0.3 + i, Eigen::Vector3d(1, i, -2).normalized()).toRotationMatrix();
    T.translation() = Eigen::Vector3d(0.1 * i, -1.5, 2.0 / 3.0);
    set.views.push_back({"photo " + std::to_string(i) + ".jpg", i % 2, T});
  }
  return set;
}

void writeText(const std::string& path, const std::string& text)
{
  OutputFile file(path);
  file.write(text);
  file.commit();
}

class Binary {
public:
  template <typename T>
  Binary& put(T value)
  {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  std::string bytes;
};

/// The binary model of cameraSet(), by COLMAP's description of the format; each image with two feature points.
std::pair<std::string, std::string> binaryModel(const CameraSet& set)
{
  Binary cameras, images;
  cameras.put<std::uint64_t>(2);
  const CameraModel &a = set.cameras[0], &b = set.cameras[1];
  cameras.put<std::uint32_t>(11).put<std::int32_t>(4).put<std::uint64_t>(640).put<std::uint64_t>(480);
  for (const double value : {a.fx, a.fy, a.cx, a.cy, a.k1, a.k2, a.p1, a.p2})
    cameras.put(value);
  cameras.put<std::uint32_t>(12).put<std::int32_t>(1).put<std::uint64_t>(1280).put<std::uint64_t>(960);
  for (const double value : {b.fx, b.fy, b.cx, b.cy})
    cameras.put(value);
  images.put<std::uint64_t>(set.views.size());
  for (std::size_t i = 0; i < set.views.size(); ++i) {
    const View& view = set.views[i];
    const Eigen::Quaterniond q(view.T_camera_world.linear());
    images.put<std::uint32_t>(static_cast<std::uint32_t>(100 - i)); // read back in the order of ids
    for (const double value : {q.w(), q.x(), q.y(), q.z()})
      images.put(value);
    for (int k = 0; k < 3; ++k)
      images.put(view.T_camera_world.translation()[k]);
    images.put<std::uint32_t>(view.camera == 0 ? 11 : 12);
    images.bytes.append(view.image.c_str(), view.image.size() + 1);
    images.put<std::uint64_t>(2);
    for (int k = 0; k < 2; ++k)
      images.put(1.0).put(2.0).put<std::int64_t>(-1);
  }
  return {cameras.bytes, images.bytes};
}

TEST(Camera, UnprojectInvertsProject)
{
  for (int y = 0; y <= 480; y += 40)
    for (int x = 0; x <= 640; x += 40) {
      const Eigen::Vector2d pixel(x, y);
      EXPECT_LT((project(lens(), 2.5 * unproject(lens(), pixel)) - pixel).norm(), 1e-9) << pixel.transpose();
    }
}

TEST(Camera, CenterOfViewMapsToZero)
{
  for (const View& view : cameraSet().views)
    EXPECT_LT((view.T_camera_world * view.center()).norm(), 1e-12);
}

TEST(Colmap, TextRoundTrip)
{
  const std::string folder = test::scratchFolder();
  const CameraSet set = cameraSet();
  writeColmap(folder + "/cameras", set);
  const CameraSet back = readColmap(folder + "/cameras");
  ASSERT_EQ(back.cameras.size(), 2U);
  ASSERT_EQ(back.views.size(), 3U);
  EXPECT_EQ(back.cameras[0].k1, lens().k1);
  EXPECT_EQ(back.cameras[0].p2, lens().p2);
  EXPECT_EQ(back.cameras[1].cy, 480.0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.views[i].image, set.views[i].image);
    EXPECT_EQ(back.views[i].camera, set.views[i].camera);
    EXPECT_TRUE(back.views[i].T_camera_world.isApprox(set.views[i].T_camera_world, 1e-12));
  }
}

TEST(Colmap, BinaryEqualsTextAndEveryCutIsAnError)
{
  const std::string folder = test::scratchFolder();
  const CameraSet set = cameraSet();
  const auto [cameras, images] = binaryModel(set);
  writeText(folder + "/cameras.bin", cameras);
  writeText(folder + "/images.bin", images);
  const CameraSet back = readColmap(folder);
  ASSERT_EQ(back.views.size(), 3U);
  EXPECT_EQ(back.views[0].image, set.views[2].image);
  EXPECT_EQ(back.cameras[0].p1, lens().p1);
  EXPECT_TRUE(back.views[2].T_camera_world.isApprox(set.views[0].T_camera_world, 1e-12));
  for (std::size_t cut = 1; cut < images.size(); cut += 5) {
    writeText(folder + "/images.bin", images.substr(0, cut));
    EXPECT_THROW(readColmap(folder), std::runtime_error) << cut;
  }
}

TEST(Colmap, EveryModelHasItsParameters)
{
  const std::string folder = test::scratchFolder();
  writeText(folder + "/images.txt", "1 1 0 0 0 0 0 0 1 a.jpg\n\n");
  const auto camera = [&](const std::string& line) {
    writeText(folder + "/cameras.txt", line);
    return readColmap(folder).cameras[0];
  };
  EXPECT_EQ(camera("1 SIMPLE_PINHOLE 64 48 50 32 24").fy, 50);
  EXPECT_EQ(camera("1 PINHOLE 64 48 50 51 32 24").fy, 51);
  EXPECT_EQ(camera("1 SIMPLE_RADIAL 64 48 50 32 24 0.1").k1, 0.1);
  EXPECT_EQ(camera("1 RADIAL 64 48 50 32 24 0.1 0.2").k2, 0.2);
  EXPECT_EQ(camera("1 OPENCV 64 48 50 51 32 24 .1 .2 .3 .4").p2, 0.4);
  EXPECT_EQ(camera("1 OPENCV_FISHEYE 64 48 50 51 32 24 .1 .2 .3 .4").k4, 0.4);
  EXPECT_EQ(camera("1 FULL_OPENCV 64 48 50 51 32 24 .1 .2 .3 .4 .5 .6 .7 .8").k6, 0.8);
  EXPECT_EQ(camera("1 SIMPLE_RADIAL_FISHEYE 64 48 50 32 24 .1").projection, CameraProjection::fisheye);
  EXPECT_EQ(camera("1 RADIAL_FISHEYE 64 48 50 32 24 .1 .2").fy, 50);
  EXPECT_EQ(camera("1 THIN_PRISM_FISHEYE 64 48 50 51 32 24 .1 .2 .3 .4 .5 .6 .7 .8").sy1, 0.8);
  EXPECT_EQ(camera("1 FOV 64 48 50 51 32 24 .9").omega, 0.9);
  const char* aria = "1 RAD_TAN_THIN_PRISM_FISHEYE 64 48 50 51 32 24 .1 .2 .3 .4 .5 .6 .7 .8 .01 .02 .03 .04";
  EXPECT_EQ(camera(aria).k6, 0.6);
  EXPECT_EQ(camera(aria).p2, 0.7);
  EXPECT_EQ(camera(aria).sy1, 0.03);
  for (const char* bad :
       {"1 FISHEYE 64 48 50 32 24", "1 PINHOLE 64 48 50 32 24", "1 PINHOLE 0 48 50 51 32 24",
        "1 PINHOLE 64 48 -50 51 32 24", "1 PINHOLE 64 48 nan 51 32 24", "x", "2 PINHOLE 64 48 50 51 32 24"})
    EXPECT_THROW(camera(bad), std::runtime_error) << bad;
}

TEST(Colmap, AnEmptyListOfPointsIsNone)
{
  const std::string folder = test::scratchFolder();
  writeColmap(folder, cameraSet());
  writeText(folder + "/points3D.txt", ""); // as COLMAP's manual wants it beside known poses
  EXPECT_TRUE(readColmapPoints(folder).empty());
  const auto [cameras, images] = binaryModel(cameraSet());
  std::filesystem::create_directory(folder + "/binary");
  writeText(folder + "/binary/cameras.bin", cameras);
  writeText(folder + "/binary/images.bin", images);
  writeText(folder + "/binary/points3D.bin", "");
  EXPECT_THROW(readColmapPoints(folder + "/binary"), std::runtime_error) << "which begins with their number";
}

TEST(Colmap, MissingFilesAreNamed)
{
  const std::string folder = test::scratchFolder();
  EXPECT_THROW(readColmap(folder), std::runtime_error);
  EXPECT_THROW(readColmap(folder + "/nothing"), std::runtime_error);
}
} // namespace
