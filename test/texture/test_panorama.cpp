// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/blank_pixels.h"
#include "photographs/photo_store.h"
#include "photographs/view_parts.h"
#include "texture/texture_scene.h"
#include <gtest/gtest.h>
namespace fresco::texture {
namespace {
using namespace fresco::test;

/// A room seen from inside.
TriangleMesh room()
{
  TriangleMesh mesh;
  appendBox({-1, -1.2f, -0.8f}, {1, 1, 1}, true, mesh);
  return mesh;
}

TextureView panorama(const Eigen::Vector3d& eye, const Pattern& pattern, int height = 256, double gain = 1)
{
  TextureView view;
  view.camera = sphericalCamera(2 * height, height);
  view.T_camera_world = lookAt(eye, eye + Eigen::Vector3d(1, 0.3, 0.1));
  view.image = Image(2 * height, height);
  const Eigen::Isometry3d T_world_camera = view.T_camera_world.inverse();
  const TriangleMesh mesh = room();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const Eigen::Vector3d d = T_world_camera.linear() * direction(view.camera, {x + 0.5, y + 0.5});
      const Eigen::Vector3d color = gain * pattern(eye + hitDistance(mesh, eye, d) * d);
      for (int c = 0; c < 3; ++c)
        view.image.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(std::clamp(color[c], 0.0, 255.0)));
    }
  return view;
}

std::vector<TextureView> panoramas(const Pattern& pattern, int height = 256)
{
  return {panorama({0.3, 0.2, 0}, pattern, height), panorama({-0.4, 0.1, 0.2}, pattern, height, 0.9),
          panorama({0, -0.5, 0.1}, pattern, height, 1.1)};
}

/// Without what takes long and has nothing to do with panoramas.
TextureOptions quick()
{
  TextureOptions options;
  options.rounds = 0;
  return options;
}

TEST(Panorama, PartsShowEveryDirection)
{
  const std::vector<TextureView> views{panorama({0, 0, 0}, waves)};
  const std::vector<ViewPart> parts = partsOf(views);
  ASSERT_EQ(parts.size(), 6u);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d ray(normal(random), normal(random), normal(random));
    int shown = 0; // well inside of the border
    for (const ViewPart& part : parts) {
      EXPECT_TRUE((part.R_part_view * part.R_part_view.transpose()).isIdentity());
      EXPECT_EQ(part.R_part_view.determinant(), 1);
      const Eigen::Vector3d q = part.R_part_view * ray;
      if (q.z() > 0) {
        const Eigen::Vector2d p = project(part.camera, q) / part.camera.width;
        shown += p.minCoeff() > 0.09 && p.maxCoeff() < 0.91;
      }
    }
    EXPECT_GE(shown, 1) << ray.transpose();
  }
}

TEST(Panorama, PartsShowWhatAPinholeCameraWould)
{
  const std::vector<TextureView> views{panorama({0.3, 0.2, 0}, waves)};
  for (const ViewPart& part : partsOf(views)) {
    const Image cut = cutPanorama(wrapPanorama(views[0].image), part);
    const TextureView taken = photograph(room(), waves, part.camera, part.R_part_view * views[0].T_camera_world);
    double error = 0;
    for (std::size_t i = 0; i < cut.data.size(); ++i)
      error += std::abs(int(cut.data[i]) - int(taken.image.data[i]));
    EXPECT_LT(error / static_cast<double>(cut.data.size()), 1.0);
  }
}

TEST(Panorama, MirroredOnesShowTheSame)
{
  TextureView mirrored = panorama({0.3, 0.2, 0}, waves);
  const Image image = mirrored.image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      std::copy_n(image.pixel(image.width - 1 - x, y), 3, mirrored.image.pixel(x, y));
  mirrored.mirrored = true;
  TextureView plain = mirrored;
  plain.image = image;
  plain.mirrored = false;
  const std::vector<TextureView> views{plain, mirrored};
  const std::vector<ViewPart> parts = partsOf(views);
  for (int k = 0; k < 6; ++k) {
    const Image a = cutPanorama(wrapPanorama(image), parts[k]),
                b = cutPanorama(wrapPanorama(mirrored.image), parts[6 + k]);
    int largest = 0; // rounding
    for (std::size_t i = 0; i < a.data.size(); ++i)
      largest = std::max(largest, std::abs(int(a.data[i]) - int(b.data[i])));
    EXPECT_LE(largest, 1);
  }
}

TEST(Panorama, WhatTheScannerLeavesBlackIsNotPainted)
{
  const auto bright = [](const Eigen::Vector3d& p) -> Eigen::Vector3d { return waves(p).array().max(60); };
  std::vector<TextureView> views{panorama({0.3, 0.2, 0}, bright)};
  EXPECT_TRUE(blankPixels(views[0].image).empty());
  Image& image = views[0].image;
  for (int y = 220; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      std::fill_n(image.pixel(x, y), 3, 3);
  const TextureResult result = reconstructTexture(room(), views, quick());
  EXPECT_LT(result.coverage, 0.999);
  EXPECT_GT(result.coverage, 0.8);
  const Image& atlas = result.model.atlases[0];
  int dark = 0;
  for (std::size_t i = 0; i < atlas.data.size(); i += 3)
    dark +=
        result.masks[0].data[i / 3] == 255 && atlas.data[i] < 20 && atlas.data[i + 1] < 20 && atlas.data[i + 2] < 20;
  EXPECT_EQ(dark, 0) << "what nobody saw continues what is around it";
}

TEST(Panorama, RoomIsTexturedAsWhole)
{
  const TextureResult result = reconstructTexture(room(), panoramas(waves), quick());
  EXPECT_GT(result.coverage, 0.999);
  ASSERT_EQ(result.cameras.size(), 3u);
  ASSERT_EQ(result.gains.cols(), 3);
  EXPECT_EQ(result.views_used, 3);
  EXPECT_LT(result.face_view.maxCoeff(), 3);
  for (const PlacedCamera& camera : result.cameras)
    EXPECT_EQ(camera.camera.projection, CameraProjection::spherical);
  EXPECT_NEAR(result.gains(1, 2) / result.gains(1, 1), 0.9 / 1.1, 0.02);
  const double gain = result.gains(1, 0); // the overall brightness is not known
  EXPECT_LT(colorError(
                result.model, [&](const auto& p) { return Eigen::Vector3d(gain * waves(p)); }, 60)
                .mean,
            3);
}

TEST(Panorama, SixDegreesAreRefined)
{
  const TriangleMesh mesh = room();
  std::vector<TextureView> views = panoramas(detailed, 320);
  const std::vector<TextureView> truth = views;
  const Eigen::Vector3d turns[] = {{0.005, -0.01, 0.007}, {-0.01, 0.005, 0.005}, {0.007, 0.005, -0.01}};
  for (int k = 0; k < 3; ++k) {
    views[k].T_camera_world.prerotate(Eigen::AngleAxisd(turns[k].norm(), turns[k].normalized()));
    views[k].T_camera_world.pretranslate(Eigen::Vector3d(0.3 * turns[k].y(), 0.3 * turns[k].z(), 0.3 * turns[k].x()));
  }
  const TextureResult result = reconstructTexture(mesh, views, quick());
  EXPECT_TRUE(result.refined);
  EXPECT_LT(result.disagreement_after, 0.5 * result.disagreement_before);
  const auto turn = [&](const Eigen::Isometry3d& T, int k) {
    return Eigen::AngleAxisd((T * truth[k].T_camera_world.inverse()).linear()).angle();
  };
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(turn(result.cameras[k].T_camera_world, k), 0.3 * turn(views[k].T_camera_world, k)) << k;
}

TEST(Panorama, ThreadsDoNotMatterAndWrongShapesAreRefused)
{
  TextureOptions one = quick(), four = quick();
  one.refine = four.refine = false;
  one.threads = 1;
  four.threads = 4;
  std::vector<TextureView> views = panoramas(waves, 128);
  EXPECT_TRUE(sameAtlases(reconstructTexture(room(), views, one), reconstructTexture(room(), views, four)));
  views[1].camera.height += 1;
  EXPECT_THROW(reconstructTexture(room(), views), std::invalid_argument);
}
} // namespace
} // namespace fresco::texture
