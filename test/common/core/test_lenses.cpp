// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include <cmath>
#include <fresco/core/camera.h>
#include <fresco/core/constants.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <random>
namespace {
using namespace fresco;

struct Lens {
  const char* model; ///< COLMAP's name; "" = it has none
  CameraModel camera;
  double widest; ///< radians from the axis up to which the model is one to one
};

/// A camera of each model, with parameters as of real lenses.
std::vector<Lens> lenses()
{
  CameraModel plane{1000, 800, 585, 580, 512.5, 388.25, 0, 0, 0, 0};
  CameraModel brown = plane;
  brown.k1 = -0.21, brown.k2 = 0.08, brown.p1 = 1.5e-3, brown.p2 = -7e-4;
  CameraModel rational = brown;
  rational.k3 = 0.01, rational.k4 = 0.05, rational.k5 = -0.01, rational.k6 = 0.002;
  CameraModel fisheye = plane;
  fisheye.projection = CameraProjection::fisheye;
  fisheye.k1 = -0.03, fisheye.k2 = 0.005, fisheye.k3 = -8e-4, fisheye.k4 = 5e-5;
  CameraModel prism = fisheye;
  prism.p1 = 1e-3, prism.p2 = -5e-4, prism.sx1 = 1e-3, prism.sy1 = 2e-3;
  CameraModel field = plane;
  field.omega = 1.1;
  CameraModel aria = prism;
  aria.projection = CameraProjection::fisheye_in_turn;
  aria.k5 = 4e-5, aria.k6 = -1e-5, aria.sx2 = -3e-4, aria.sy2 = 2e-4;
  CameraModel frame = brown;
  frame.k3 = 0.02, frame.r8 = -0.01, frame.skew = -0.7;
  return {{"PINHOLE", plane, 1.4},
          {"OPENCV", brown, 0.6},
          {"FULL_OPENCV", rational, 0.6},
          {"OPENCV_FISHEYE", fisheye, 1.9},
          {"THIN_PRISM_FISHEYE", prism, 1.5},
          {"FOV", field, 1.2},
          {"RAD_TAN_THIN_PRISM_FISHEYE", aria, 1.5},
          {"", sphericalCamera(4096, 2048), 4},
          {"", frame, 0.6}};
}

/// Directions at most `widest` from the axis, of different lengths.
std::vector<Eigen::Vector3d> points(double widest)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Vector3d> all;
  while (all.size() < 2000) {
    const Eigen::Vector3d q(uniform(random), uniform(random), uniform(random));
    if (q.norm() > 0.1 && std::acos(q.normalized().z()) < widest)
      all.push_back(q);
  }
  return all;
}

TEST(Lenses, DirectionInvertsProject)
{
  for (const auto& [model, camera, widest] : lenses())
    for (const Eigen::Vector3d& q : points(widest)) {
      const Eigen::Vector2d pixel = project(camera, q);
      EXPECT_LT((direction(camera, pixel) - q.normalized()).norm(), 1e-12) << model;
      EXPECT_LT((project(camera, 3 * q) - pixel).norm(), 1e-9) << model; // a pixel sees along a ray
      if (camera.projection != CameraProjection::spherical && std::acos(q.normalized().z()) < 1.5) {
        EXPECT_LT((unproject(camera, pixel) - q / q.z()).norm(), 1e-9 / q.normalized().z()) << model;
      }
    }
}

/// The formulas of COLMAP's and OpenCV's documentation, for one point each.
TEST(Lenses, ModelsAreThoseOfTheirDocumentation)
{
  const Eigen::Vector3d q(0.3, -0.2, 1);
  const std::vector<Lens> all = lenses();
  const double x = 0.3, y = -0.2, r2 = x * x + y * y;
  const CameraModel& f = all[2].camera;
  const double radial =
      (1 + f.k1 * r2 + f.k2 * r2 * r2 + f.k3 * r2 * r2 * r2) / (1 + f.k4 * r2 + f.k5 * r2 * r2 + f.k6 * r2 * r2 * r2);
  const double u = x * radial + 2 * f.p1 * x * y + f.p2 * (r2 + 2 * x * x);
  EXPECT_NEAR(project(f, q).x(), f.fx * u + f.cx, 1e-9);
  const CameraModel& e = all[3].camera;
  const double angle = std::atan(std::sqrt(r2)), a2 = angle * angle;
  const double bent = angle * (1 + a2 * (e.k1 + a2 * (e.k2 + a2 * (e.k3 + a2 * e.k4))));
  EXPECT_NEAR(project(e, q).y(), e.fy * bent * y / std::sqrt(r2) + e.cy, 1e-9);
  const CameraModel& p = all[4].camera;
  const double v = angle * y / std::sqrt(r2), w = angle * x / std::sqrt(r2); // before distortion
  const double prism = v + v * (bent / angle - 1) + 2 * p.p2 * w * v + p.p1 * (a2 + 2 * v * v) + p.sy1 * a2;
  EXPECT_NEAR(project(p, q).y(), p.fy * prism + p.cy, 1e-9);
  const CameraModel& d = all[5].camera;
  const double r = std::sqrt(r2), angle_of_view = std::atan(2 * r * std::tan(d.omega / 2)) / d.omega;
  EXPECT_NEAR(project(d, q).x(), d.fx * angle_of_view * x / r + d.cx, 1e-9);
  EXPECT_NEAR(project(d, {1e-3, 0, 1}).x(), d.fx * std::atan(2e-3 * std::tan(d.omega / 2)) / d.omega + d.cx, 1e-9);
  const CameraModel& s = all[6].camera;
  const double scale = 1 + a2 * (s.k1 + a2 * (s.k2 + a2 * (s.k3 + a2 * (s.k4 + a2 * (s.k5 + a2 * s.k6)))));
  const double a = w * scale, b = v * scale, t2 = a * a + b * b; // p0 of the files is p2 here, p1 is p1
  EXPECT_NEAR(project(s, q).x(),
              s.fx * (a + 2 * s.p1 * a * b + s.p2 * (t2 + 2 * a * a) + s.sx1 * t2 + s.sx2 * t2 * t2) + s.cx, 1e-9);
  EXPECT_NEAR(project(s, q).y(),
              s.fy * (b + 2 * s.p2 * a * b + s.p1 * (t2 + 2 * b * b) + s.sy1 * t2 + s.sy2 * t2 * t2) + s.cy, 1e-9);
}

TEST(Lenses, APanoramaSeesAllAround)
{
  const CameraModel camera = sphericalCamera(4096, 2048);
  EXPECT_LT((project(camera, {0, 0, 5}) - Eigen::Vector2d(2048, 1024)).norm(), 1e-9); // ahead: the middle
  EXPECT_LT((project(camera, {5, 0, 0}) - Eigen::Vector2d(3072, 1024)).norm(), 1e-9); // to the right
  EXPECT_LT((project(camera, {0, 5, 5}) - Eigen::Vector2d(2048, 1536)).norm(), 1e-9); // downwards
  EXPECT_NEAR(std::abs(project(camera, {0, 0, -5}).x() - 2048), 2048, 1e-9);          // behind: the left or right edge
  EXPECT_LT((direction(camera, {0, 700}) - direction(camera, {4096, 700})).norm(), 1e-12); // which are one
  EXPECT_THROW(sphericalCamera(4096, 2047), std::invalid_argument);
  EXPECT_THROW(sphericalCamera(0, 0), std::invalid_argument);
  EXPECT_THROW(unproject(camera, {0, 0}), std::invalid_argument);
}

TEST(Lenses, WideDirectionsOfAFisheyeStayInFront)
{
  CameraModel camera{1000, 1000, 300, 300, 500, 500, 0, 0, 0, 0};
  camera.projection = CameraProjection::fisheye;
  EXPECT_LT(direction(camera, {500 + 300 * 2.0, 500}).z(), 0); // 2 radians: behind
  const Eigen::Vector3d ray = unproject(camera, {500 + 300 * 2.0, 500});
  EXPECT_EQ(ray.z(), 1);
  EXPECT_NEAR(ray.x(), std::tan(89 * radians_per_degree), 1e-9);
}

TEST(Lenses, ColmapFilesKeepEveryModel)
{
  const std::string folder = test::scratchFolder();
  CameraSet set;
  for (const Lens& lens : lenses())
    if (*lens.model)
      set.cameras.push_back(lens.camera);
  set.views.resize(1);
  set.views[0].image = "a.jpg";
  writeColmap(folder, set);
  const CameraSet back = readColmap(folder);
  const std::string text = readFile(folder + "/cameras.txt");
  ASSERT_EQ(back.cameras.size(), set.cameras.size());
  for (std::size_t i = 0; i < set.cameras.size(); ++i) {
    EXPECT_NE(text.find(std::string(" ") + lenses()[i].model + " "), std::string::npos);
    for (const Eigen::Vector3d& q : points(lenses()[i].widest))
      EXPECT_EQ(project(back.cameras[i], q), project(set.cameras[i], q));
  }
  for (const Lens& lens : lenses())
    if (!*lens.model) {
      set.cameras[0] = lens.camera;
      EXPECT_THROW(writeColmap(folder, set), std::invalid_argument);
    }
}
} // namespace
