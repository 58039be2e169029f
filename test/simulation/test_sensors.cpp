// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/scene/scene_builder.h>
#include <fresco/simulation/sensors/laser.h>
#include <fresco/simulation/sensors/photograph.h>
#include <fresco/simulation/sensors/views.h>
#include <gtest/gtest.h>
#include <memory>
using namespace fresco;
using namespace fresco::simulation;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
/// The conference room under coarse light, built once for all tests.
struct Room {
  Scene scene = makeScene("conference_room", 0.4f);
  RayScene rays{scene.mesh};
  Lightmap light = bakeLight(scene, rays, coarse());
  LitScene lit{scene, rays, light};
  ScenePlaces samples = sampleSurface(scene, 2000, 1);
  PlanningInput planning{scene, rays, samples, 1, 0};

  static LightingOptions coarse()
  {
    LightingOptions options;
    options.spacing = 0.4f;
    options.gather_packets = 1;
    return options;
  }
};

const Room& room()
{
  static const Room the_room;
  return the_room;
}

Eigen::Matrix4d poseAt(const Vector3d& station) { return randomPose(station, 3, 0); }

LaserOptions quiet(int points)
{
  LaserOptions options;
  options.points = points;
  options.noise = 0.f;
  options.veil = false;
  return options;
}

/// Distance of world points to the plane of their face; also fails where a point lies outside of its face.
double offPlane(const Scene& scene, int face, const Vector3d& p)
{
  const auto corner = [&](int k) -> Vector3d {
    return scene.mesh.vertices.col(scene.mesh.faces(k, face)).cast<double>();
  };
  const Vector3d a = corner(0), n = (corner(1) - a).cross(corner(2) - a).normalized();
  return std::fabs((p - a).dot(n));
}

/// A square of side 2 * half in the plane z = 0, white.
Scene plain(float half)
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << -half, half, half, -half, -half, -half, half, half, 0, 0, 0, 0;
  mesh.faces.resize(3, 2);
  mesh.faces << 0, 0, 1, 2, 2, 3;
  mesh.colors = Colors::Constant(3, 4, 230);
  return meshScene(mesh);
}

Eigen::Matrix4d upright(double height)
{
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose(2, 3) = height;
  return pose;
}
} // namespace

TEST(VirtualLaser, SeesThroughClearPanes)
{
  SceneBuilder builder("two halves", 1.f);
  Material glass;
  glass.clear = true;
  const int paint = builder.add({}), clear = builder.add(glass);
  builder.beginObject("box");
  builder.boxes(
      {{{-2, -2, -2}, {4, 2, 2}, allSides(paint), false}, {{1, -2, -2}, {1.02f, 2, 2}, allSides(clear), true}}, true);
  const Scene scene = builder.finish();
  const RayScene rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, Room::coarse());
  LaserOptions options = quiet(20000);
  options.veil = true;
  const LaserScan scan = scanScene({scene, rays, light}, upright(0.0), options, 0);
  Index pane = 0, behind = 0;
  for (Index i = 0; i < scan.points.size(); ++i) {
    pane += std::fabs(scan.points.points(0, i) - 1.f) < 0.01f ? 1 : 0;
    behind += scan.points.points(0, i) > 1.1f ? 1 : 0;
  }
  EXPECT_GT(behind, scan.points.size() / 10);
  EXPECT_NEAR(static_cast<double>(pane) / static_cast<double>(behind), 0.19 / 0.81, 0.08);
}

TEST(VirtualLaser, WithoutNoiseEveryPointLiesOnTheTruth)
{
  const Eigen::Matrix4d pose = poseAt({1.0, 2.2, 1.5});
  const LaserScan scan = scanScene(room().lit, pose, quiet(20000), 0);
  ASSERT_GT(scan.points.size(), 15000);
  double worst = 0;
  for (Index i = 0; i < scan.points.size(); ++i) {
    const Vector3d p = (pose * scan.points.points.col(i).cast<double>().homogeneous()).head<3>();
    worst = std::max(worst, offPlane(room().scene, scan.faces[i], p));
    EXPECT_FALSE(scan.mixed[i]);
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(VirtualLaser, WideBeamsMixRangesAtDepthJumpsOnly)
{
  const Eigen::Matrix4d pose = poseAt({1.0, 2.2, 1.5});
  LaserOptions options = quiet(40000);
  options.veil = true;
  const LaserScan scan = scanScene(room().lit, pose, options, 0);
  int mixed = 0, off = 0;
  double worst_clean = 0;
  for (Index i = 0; i < scan.points.size(); ++i) {
    const Vector3d p = (pose * scan.points.points.col(i).cast<double>().homogeneous()).head<3>();
    const double away = offPlane(room().scene, scan.faces[i], p);
    if (scan.mixed[i])
      ++mixed, off += away > 0.01 ? 1 : 0;
    else
      worst_clean = std::max(worst_clean, away);
  }
  EXPECT_GT(mixed, scan.points.size() / 500);
  EXPECT_LT(mixed, scan.points.size() / 5);
  EXPECT_GT(off, mixed / 20);
  EXPECT_LT(worst_clean, 1e-4);
}

TEST(VirtualLaser, NothingComesBackAtGrazingAngles)
{
  const Scene scene = plain(200.f);
  const RayScene rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, {});
  LaserOptions options = quiet(50000);
  options.max_range = 200.f;
  const LaserScan scan = scanScene({scene, rays, light}, upright(1.5), options, 0);
  double farthest = 0;
  int within_2 = 0, from_4_to_6 = 0;
  for (Index i = 0; i < scan.points.size(); ++i) {
    const double r = scan.points.points.col(i).head<2>().norm();
    farthest = std::max(farthest, r);
    within_2 += r < 2 ? 1 : 0;
    from_4_to_6 += r > 4 && r < 6 ? 1 : 0;
  }
  EXPECT_GT(farthest, 8.0);
  EXPECT_LT(farthest, 75.0) << "cosine below 0.02";
  EXPECT_GT(within_2 / 4.0, 3.0 * from_4_to_6 / 20.0) << "points per area fall with distance";
}

TEST(VirtualLaser, NoiseHasItsSizeAndGrowsWithRange)
{
  const Scene scene = plain(20.f);
  const RayScene rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, {});
  LaserOptions options = quiet(60000);
  options.noise = 0.01f;
  const auto deviation = [&](double height) { // straight below, within 50 degrees of the normal
    const LaserScan scan = scanScene({scene, rays, light}, upright(height), options, 0);
    double sum = 0, count = 0;
    for (Index i = 0; i < scan.points.size(); ++i) {
      const Vector3d p = scan.points.points.col(i).cast<double>();
      const double range = p.norm(), cosine = -p.z() / range;
      if (cosine > 0.8 && height / cosine < 1.2 * height)
        sum += std::pow(range - height / cosine, 2), count += 1;
    }
    return std::sqrt(sum / count);
  };
  const double at_4 = deviation(3.6), at_10 = deviation(10.0); // ranges up to 1.25 times the height
  EXPECT_NEAR(at_4, 0.01, 0.0015);
  EXPECT_GT(at_10, 1.3 * at_4);
}

TEST(VirtualLaser, DoesNotDependOnThreadsAndDependsOnTheSeed)
{
  const Eigen::Matrix4d pose = poseAt({-2.8, -1.5, 1.4});
  LaserOptions options;
  options.points = 5000;
  options.threads = 1;
  const LaserScan one = scanScene(room().lit, pose, options, 2);
  options.threads = 4;
  const LaserScan four = scanScene(room().lit, pose, options, 2);
  EXPECT_EQ(one.points.points, four.points.points);
  EXPECT_EQ(one.points.colors, four.points.colors);
  options.seed = 2;
  const LaserScan other = scanScene(room().lit, pose, options, 2);
  EXPECT_NE(one.points.points.leftCols(100), other.points.points.leftCols(100));
}

TEST(VirtualLaser, RefusesBadOptions)
{
  const auto refused = [](auto change) {
    LaserOptions options;
    change(options);
    EXPECT_THROW(scanScene(room().lit, upright(1.5), options, 0), std::invalid_argument);
  };
  refused([](LaserOptions& o) { o.points = 0; });
  refused([](LaserOptions& o) { o.noise = -1.f; });
  refused([](LaserOptions& o) { o.noise = std::nanf(""); });
  refused([](LaserOptions& o) { o.max_range = -1.f; });
  refused([](LaserOptions& o) { o.divergence = 1.f; });
  refused([](LaserOptions& o) { o.pulse = -1.f; });
}

TEST(VirtualPlaces, StationsKeepTheirDistanceAndSeeTheRoom)
{
  const Points stations = chooseStations(room().planning, 4);
  ASSERT_EQ(stations.cols(), 4);
  for (Index k = 0; k < 4; ++k) {
    EXPECT_GT((room().samples.positions.colwise() - stations.col(k)).colwise().norm().minCoeff(), 0.5f);
    EXPECT_LT(std::fabs(stations(0, k)), 3.5f);
    EXPECT_LT(std::fabs(stations(1, k)), 2.5f);
    EXPECT_GT(stations(2, k), 1.f);
  }
  const Eigen::MatrixXf sees = viewQuality(room().planning, stations, 4.f);
  EXPECT_GT((sees.colwise().maxCoeff().array() > 0.f).cast<double>().mean(), 0.6); // undersides and backs are hidden
  EXPECT_THROW(chooseStations(room().planning, 0), std::invalid_argument);
  EXPECT_THROW(chooseStations(room().planning, 100000), std::runtime_error);
}

TEST(VirtualPlaces, TheStairwellLinksTwoStoreys)
{
  const Scene scene = makeOffice({4, 2, 2}, 2.f);
  const RayScene rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, Room::coarse());
  const ScenePlaces samples = sampleSurface(scene, 2000, 1);
  const PlanningInput planning{scene, rays, samples, 1, 0};
  const Points stations = chooseStations(planning, 6);
  EXPECT_EQ(stations.leftCols(2), (Points(3, 2) << scene.stations[0], scene.stations[1]).finished());
  const Eigen::ArrayXXf sees = (viewQuality(planning, stations, 4.f).array() > 0.f).cast<float>();
  const auto shared = [&](Index a, Index b) { return (sees.row(a) * sees.row(b)).sum() / sees.row(b).sum(); };
  EXPECT_GT(shared(0, 1), 0.3f) << "foot and landing";
  float from_below = 0.f, from_above = 0.f;
  for (Index k = 2; k < stations.cols(); ++k)
    (stations(2, k) < scene.floors[1] ? from_below : from_above) += shared(1, k);
  EXPECT_GT(from_below, 0.f);
  EXPECT_GT(from_above, 0.3f);
  for (const Index k : {0, 1, 2}) {
    const Eigen::Matrix4d pose = poseAt(stations.col(k).cast<double>());
    const LaserScan scan = scanScene({scene, rays, light}, pose, quiet(3000), k);
    for (Index i = 0; i < scan.points.size(); ++i)
      EXPECT_LT(
          offPlane(scene, scan.faces[i], (pose * scan.points.points.col(i).cast<double>().homogeneous()).head<3>()),
          1e-4);
  }
  EXPECT_THROW(chooseStations(planning, 1), std::invalid_argument);
}

TEST(VirtualPlaces, PosesAreRigidAndNearlyUpright)
{
  for (int k = 0; k < 50; ++k) {
    const Eigen::Matrix4d pose = randomPose({1, 2, 3}, 7, k);
    const Eigen::Matrix3d R = pose.topLeftCorner<3, 3>();
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12);
    EXPECT_GT(R(2, 2), std::cos(3.001 * 0.0174532925));
    EXPECT_EQ(pose.col(3), Eigen::Vector4d(1, 2, 3, 1));
  }
}

namespace {
CameraModel smallCamera()
{
  CameraModel camera;
  camera.width = 161, camera.height = 121; // odd: the last block is cut
  camera.fx = camera.fy = 145, camera.cx = 80.5, camera.cy = 60.5;
  return camera;
}
} // namespace

TEST(VirtualCamera, PixelsShowTheSurfaceThatProjectsThere)
{
  CameraModel camera = smallCamera();
  camera.width = 480, camera.height = 360, camera.fx = camera.fy = 430, camera.cx = 240, camera.cy = 180;
  const CameraSet set = chooseViews(room().planning, camera, 3);
  ASSERT_EQ(set.views.size(), 3u);
  for (const View& view : set.views) {
    const Image image = takePhotograph(room().lit, {camera, view, {}}, 0);
    int compared = 0, agree = 0;
    for (Index s = 0; s < room().samples.positions.cols(); ++s) {
      const Vector3d world = room().samples.positions.col(s).cast<double>(), local = view.T_camera_world * world;
      if (local.z() < 0.1)
        continue;
      const Eigen::Vector2d pixel = project(camera, local);
      const Vector3f from = view.center().cast<float>();
      const RayHit hit = room().rays.intersect({from, world.cast<float>() - from});
      if (!(pixel.array() > 0).all() || pixel.x() >= camera.width || pixel.y() >= camera.height ||
          std::fabs(hit.distance - 1.f) > 1e-3f)
        continue;
      const Vector3f truth = 255.f * surfaceColor(room().lit, hit, static_cast<float>(local.z() / camera.fx));
      const std::uint8_t* shown = image.pixel(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
      ++compared;
      agree += (truth - Vector3f(shown[0], shown[1], shown[2])).cwiseAbs().maxCoeff() < 12.f ? 1 : 0;
    }
    EXPECT_GT(compared, 100);
    EXPECT_GT(agree, 0.85 * compared); // others lie at edges, where a pixel mixes surfaces
  }
}

TEST(VirtualCamera, ExposureIsAGainOnDisplayValues)
{
  const CameraModel camera = smallCamera();
  const View view = chooseViews(room().planning, camera, 1).views[0];
  const Image truth = takePhotograph(room().lit, {camera, view, {}}, 1);
  Exposure exposure;
  exposure.gain = {0.9f, 0.8f, 0.85f};
  const Image darker = takePhotograph(room().lit, {camera, view, exposure}, 4);
  for (std::size_t i = 0; i < truth.data.size(); ++i)
    EXPECT_NEAR(darker.data[i], exposure.gain[static_cast<Index>(i % 3)] * truth.data[i], 1.01f);
}

TEST(VirtualCamera, ResponseIsACurveAfterTheExposure)
{
  const CameraModel camera = smallCamera();
  const View view = chooseViews(room().planning, camera, 1).views[0];
  Exposure exposure;
  exposure.gain = {0.7f, 0.6f, 0.8f};
  const Image straight = takePhotograph(room().lit, {camera, view, exposure}, 1);
  exposure.response = 0.6f;
  const Image curved = takePhotograph(room().lit, {camera, view, exposure}, 4);
  for (std::size_t i = 0; i < straight.data.size(); ++i) {
    const double v = straight.data[i] / 255.0; // to half a level; the curve is at most 1.3 times as steep
    EXPECT_NEAR(curved.data[i], 255 * (0.4 * v + 0.6 * (3 * v * v - 2 * v * v * v)), 1.2);
  }
  exposure.response = -0.1f;
  EXPECT_THROW(takePhotograph(room().lit, {camera, view, exposure}, 1), std::invalid_argument);
}

TEST(VirtualCamera, ExposuresSpreadAsAsked)
{
  float least = 9, most = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Exposure exposure = randomExposure(1, k, 0.2f);
    least = std::min(least, exposure.gain[1]), most = std::max(most, exposure.gain[1]);
    EXPECT_LT(std::fabs(exposure.gain[0] / exposure.gain[1] - 1.f), 0.0501f);
  }
  EXPECT_GT(least, 0.7999f);
  EXPECT_LT(least, 0.83f);
  EXPECT_LT(most, 1.2001f);
  EXPECT_GT(most, 1.17f);
  EXPECT_THROW(randomExposure(1, 0, -0.1f), std::invalid_argument);
}

TEST(VirtualCamera, DoesNotDependOnThreads)
{
  const CameraModel camera = smallCamera();
  const View view = chooseViews(room().planning, camera, 1).views[0];
  Exposure exposure = randomExposure(4, 5, 0.2f);
  exposure.noise = 2.f;
  EXPECT_EQ(takePhotograph(room().lit, {camera, view, exposure}, 1).data,
            takePhotograph(room().lit, {camera, view, exposure}, 4).data);
  EXPECT_THROW(takePhotograph(room().lit, {CameraModel{}, view, exposure}, 1), std::invalid_argument);
}

TEST(VirtualCamera, ViewsShowMostOfTheRoom)
{
  CameraModel camera = smallCamera();
  const CameraSet set = chooseViews(room().planning, camera, 30);
  Eigen::VectorXi seen = Eigen::VectorXi::Zero(room().samples.positions.cols());
  for (const View& view : set.views) {
    const Eigen::MatrixXf sees = viewQuality(room().planning, view.center().cast<float>(), 3.f);
    for (Index s = 0; s < seen.size(); ++s) {
      const Vector3d local = view.T_camera_world * room().samples.positions.col(s).cast<double>();
      const bool inside = local.z() > 0.1 && (project(camera, local).array() > 0).all() &&
                          project(camera, local).x() < camera.width && project(camera, local).y() < camera.height;
      seen[s] += inside && sees(0, s) > 0.f ? 1 : 0;
    }
  }
  EXPECT_GT((seen.array() > 0).cast<double>().mean(), 0.75);
  EXPECT_GT((seen.array() > 1).cast<double>().mean(), 0.65);
  EXPECT_THROW(chooseViews(room().planning, camera, 0), std::invalid_argument);
}
