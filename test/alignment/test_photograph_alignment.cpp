// SPDX-License-Identifier: BSD-3-Clause
#include "blots.h"
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/core/constants.h>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>
#include <random>
namespace {
using namespace fresco;
using Eigen::Vector3d;
const Vector3d size(5, 4, 2.6); // of a bare room, metres

/// Where a ray from inside meets the room's walls.
Vector3d wallAt(const Vector3d& eye, const Vector3d& beam)
{
  double range = 1e9;
  for (int k = 0; k < 3; ++k)
    if (beam[k] != 0)
      range = std::min(range, ((beam[k] > 0 ? size[k] : 0) - eye[k]) / beam[k]);
  return eye + range * beam;
}

/// Intensities as seen from three places, every 2 cm or so. @param painted from: shifts the blots, so that another room comes out
PointSet scanned(const Vector3d& painted = Vector3d::Zero())
{
  constexpr Index count = 240000;
  PointSet scans;
  scans.points.resize(3, count);
  scans.intensities.resize(count);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (Index i = 0; i < count; ++i) {
    const Vector3d p = wallAt(Vector3d(1 + i % 3 * 1.4, 1 + i % 2 * 1.8, 1.3),
                              Vector3d(normal(random), normal(random), normal(random)));
    scans.points.col(i) = p.cast<float>();
    scans.intensities[i] = 7.f * test::blotted(p + painted);
  }
  return scans;
}

struct Photographs {
  CameraSet set;
  SparsePoints points;
  std::vector<Image> images;
};

/// Of one wall and what is beside it, with sparse points that are off by a centimetre.
Photographs photographed()
{
  Photographs out;
  CameraModel camera;
  camera.width = 320, camera.height = 240, camera.fx = camera.fy = 280, camera.cx = 160, camera.cy = 120;
  out.set.cameras = {camera};
  std::mt19937 random(2);
  std::normal_distribution<double> error(0, 0.01);
  for (int v = 0; v < 6; ++v) {
    const double angle = 0.1 * v - 0.25;
    View view;
    Eigen::Matrix3d R;
    R << std::sin(angle), -std::cos(angle), 0, 0, 0, -1, std::cos(angle), std::sin(angle), 0;
    const Vector3d eye(2.3 + 0.1 * (v % 3), 2.6 - 0.25 * v, 1.2 + 0.1 * (v % 2));
    view.T_camera_world.linear() = R;
    view.T_camera_world.translation() = -R * eye;
    out.set.views.push_back(view);
    Image image(camera.width, camera.height, 1);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Vector3d place = wallAt(eye, R.transpose() * unproject(camera, {x + 0.5, y + 0.5}));
        *image.pixel(x, y) = test::blotted(place);
        if (x % 6 > 0 || y % 6 > 0)
          continue;
        SparsePoint point;
        point.position = place + Vector3d(error(random), error(random), error(random));
        point.track = {{v, {x + 0.5, y + 0.5}}};
        out.points.push_back(point);
      }
    out.images.push_back(image);
  }
  return out;
}

CameraAlignmentOptions withImages(const Photographs& photographs)
{
  CameraAlignmentOptions options;
  options.photograph = [&photographs](Index view) { return photographs.images[view]; };
  return options;
}

Similarity ownFrame()
{
  Similarity T;
  T.scale = 7;
  T.R = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  T.t = Vector3d(20, -4, 9);
  return T;
}

/// @param threads of the search and of the library that finds features
CameraAlignmentResult alignedBy(int threads, const Photographs& photographs)
{
  CameraAlignmentOptions options = withImages(photographs);
  options.threads = threads;
  cv::setNumThreads(threads);
  return alignCameras(photographs.set, photographs.points, scanned(), options);
}

TEST(PhotographAlignment, OneWallOfABareRoomIsFoundByWhatItShows)
{
  Photographs photographs = photographed();
  const Similarity T = ownFrame();
  transformCameras(T, photographs.set, photographs.points);
  const CameraAlignmentResult found = alignedBy(2, photographs);
  EXPECT_GT(found.matches, 20);
  EXPECT_EQ(alignedBy(1, photographs).T_scans_cameras.matrix(), found.T_scans_cameras.matrix());
  const Similarity rest = found.T_scans_cameras * T;  // identity but for the error
  for (const View& view : photographed().set.views) { // the sparse points are off by 1 cm
    const Vector3d ahead = wallAt(view.center(), view.T_camera_world.linear().row(2).transpose());
    EXPECT_LT((rest * ahead - ahead).norm(), 0.02);
    EXPECT_LT((rest * view.center() - view.center()).norm(), 0.02);
  }
}

TEST(PhotographAlignment, OtherPaintIsNotMatched)
{
  Photographs photographs = photographed();
  transformCameras(ownFrame(), photographs.set, photographs.points);
  EXPECT_THROW(alignCameras(photographs.set, photographs.points, scanned({100, 100, 100}), withImages(photographs)),
               std::runtime_error);
}
} // namespace
