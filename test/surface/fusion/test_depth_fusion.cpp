// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/pose_refinement.h"
#include "fusion/vote_kernels.h"
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fresco/surface/core/depth_fusion.h>
#include <gtest/gtest.h>
#include <limits>
#include <random>
namespace fresco {
namespace {
constexpr double radius = 0.3; // of a ball in the corner of a room; the room is the octant of positive coordinates
const Eigen::Vector3d ball(0.7, 0.7, 0.6);

/// Distance along a ray to the corner's walls and the ball, or to the walls alone.
double castRay(const Eigen::Vector3d& from, const Eigen::Vector3d& along, bool with_ball)
{
  double nearest = 1e9;
  for (int k = 0; k < 3; ++k)
    if (along[k] < 0)
      nearest = std::min(nearest, -from[k] / along[k]);
  const double a = along.squaredNorm(), b = along.dot(from - ball), c = (from - ball).squaredNorm() - radius * radius;
  if (with_ball && b * b > a * c && b < 0)
    nearest = std::min(nearest, (-b - std::sqrt(b * b - a * c)) / a);
  return nearest;
}

double distanceToScene(const Eigen::Vector3d& p)
{
  return std::min({std::abs(p.x()), std::abs(p.y()), std::abs(p.z()), std::abs((p - ball).norm() - radius)});
}

Eigen::Isometry3d lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

/// Frames around the corner; what they measure belongs to `true_poses`, what they say of their poses may differ.
struct Scene {
  std::vector<Eigen::Isometry3d> true_poses;
  DepthFrames frames;
  Index without_ball = 0; ///< so many frames at the end do not see the ball

  explicit Scene(int count)
  {
    frames.camera = {120, 90, 100.0, 100.0, 60.0, 45.0, 0, 0, 0, 0};
    for (int i = 0; i < count; ++i) {
      const double angle = 0.15 + 1.27 * i / count;
      const Eigen::Vector3d eye(0.2 + 1.8 * std::cos(angle), 0.2 + 1.8 * std::sin(angle), 0.8 + 0.4 * (i % 3));
      true_poses.push_back(lookAt(eye, ball));
    }
    frames.T_world_camera = true_poses;
    frames.depth = [this](Index f) { return depthOf(f); };
  }
  Scene(const Scene&) = delete;

  DepthImage depthOf(Index f) const
  {
    const CameraModel& camera = frames.camera;
    DepthImage depth(camera.height, camera.width);
    const bool with_ball = f < Index(true_poses.size()) - without_ball;
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d beam = true_poses[f].linear() * unproject(camera, {u + 0.5, v + 0.5});
        depth(v, u) = castRay(true_poses[f].translation(), beam, with_ball);
      }
    return depth;
  }
};

DepthFusionOptions options(double cell = 0.02)
{
  DepthFusionOptions result;
  result.cell = cell;
  return result;
}

std::vector<double> distances(const PointSet& set)
{
  std::vector<double> result;
  for (Index i = 0; i < set.size(); ++i)
    result.push_back(distanceToScene(set.points.col(i).cast<double>()));
  std::sort(result.begin(), result.end());
  return result;
}

TEST(DepthFusion, PointsLieOnTheSurfaceAndNormalsPointToTheCameras)
{
  const Scene scene(12);
  for (const double cell : {0.04, 0.02}) {
    const PointSet set = fuseDepthImages(scene.frames, options(cell)).points;
    ASSERT_GT(set.size(), 1.0 / (cell * cell));
    const std::vector<double> d = distances(set);
    EXPECT_LT(d[d.size() / 2], 0.05 * cell);       // planes seen by many: exact
    EXPECT_LT(d[d.size() * 95 / 100], 0.6 * cell); // creases are rounded over a cell
    Index towards = 0;
    for (Index i = 0; i < set.size(); ++i) {
      EXPECT_NEAR(set.normals.col(i).norm(), 1.f, 1e-4f);
      towards += set.normals.col(i).dot(set.viewpoints.col(i) - set.points.col(i)) > 0.f;
    }
    EXPECT_GT(towards, set.size() * 97 / 100);
  }
}

TEST(DepthFusion, ThreadsDoNotMatterAndOrderOfFramesHardly)
{
  Scene scene(9), reversed(9);
  DepthFusionOptions one = options(), four = options();
  one.threads = 1;
  four.threads = 4;
  one.refine_poses = four.refine_poses = true;
  const DepthFusionResult a = fuseDepthImages(scene.frames, one), b = fuseDepthImages(scene.frames, four);
  EXPECT_EQ(a.points.points, b.points.points);
  EXPECT_EQ(a.points.normals, b.points.normals);
  std::reverse(reversed.true_poses.begin(), reversed.true_poses.end());
  reversed.frames.T_world_camera = reversed.true_poses;
  const PointSet forwards = fuseDepthImages(scene.frames, options()).points;
  const PointSet backwards = fuseDepthImages(reversed.frames, options()).points;
  EXPECT_NEAR(forwards.size(), backwards.size(), 0.005 * forwards.size()); // rounding decides at a few cells
  const Eigen::Vector3f shift = forwards.points.rowwise().mean() - backwards.points.rowwise().mean();
  EXPECT_LT(shift.norm(), 1e-3f);
}

TEST(DepthFusion, MovedCamerasGiveMovedPoints)
{
  const Scene scene(9);
  Scene moved(9);
  const Eigen::Isometry3d T =
      Eigen::Translation3d(3.0, -5.0, 1.5) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  for (Eigen::Isometry3d& pose : moved.frames.T_world_camera)
    pose = T * pose;
  const PointSet set = fuseDepthImages(scene.frames, options()).points;
  const PointSet there = fuseDepthImages(moved.frames, options()).points;
  EXPECT_NEAR(set.size(), there.size(), 0.15 * set.size()); // planes cut more cells of a slanting grid
  const std::vector<double> d = distances(transformPoints(there, T.inverse().matrix()));
  EXPECT_LT(d[d.size() / 2], 0.001);
}

TEST(DepthFusion, WhatMostFramesSeeThroughIsNotThere)
{
  Scene scene(12);
  const auto onBall = [](const PointSet& set) {
    Index count = 0;
    for (Index i = 0; i < set.size(); ++i)
      count += std::abs((set.points.col(i).cast<double>() - ball).norm() - radius) < 0.02;
    return count;
  };
  const Index always = onBall(fuseDepthImages(scene.frames, options()).points);
  scene.without_ball = 9;
  const Index seldom = onBall(fuseDepthImages(scene.frames, options()).points);
  EXPECT_GT(always, 500);
  EXPECT_LT(seldom, always / 20);
}

TEST(DepthFusion, RefinementBringsFramesOntoOneSurface)
{
  Scene scene(16);
  std::mt19937 random(5);
  std::normal_distribution<double> shift(0.0, 0.012), turn(0.0, 0.006);
  for (Eigen::Isometry3d& pose : scene.frames.T_world_camera) {
    const Eigen::Vector3d axis(turn(random), turn(random), turn(random));
    pose.rotate(Eigen::AngleAxisd(axis.norm(), axis.normalized()));
    pose.translation() += Eigen::Vector3d(shift(random), shift(random), shift(random));
  }
  DepthFusionOptions refine = options();
  refine.refine_poses = true;
  const DepthFusionResult result = fuseDepthImages(scene.frames, refine);
  // What frames are off by against each other: the common motion of all has no meaning.
  const auto spread = [&](const std::vector<Eigen::Isometry3d>& poses) {
    const Eigen::Isometry3d T_0 = poses[0] * scene.true_poses[0].inverse();
    double sum = 0;
    for (std::size_t i = 1; i < poses.size(); ++i)
      sum += (T_0.inverse() * poses[i] * scene.true_poses[i].inverse() * ball - ball).squaredNorm();
    return std::sqrt(sum / (poses.size() - 1));
  };
  EXPECT_LT(spread(result.T_world_camera), 0.4 * spread(scene.frames.T_world_camera));
  const std::vector<Eigen::Isometry3d> kept = fuseDepthImages(scene.frames, options()).T_world_camera;
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(kept[i].matrix(), scene.frames.T_world_camera[i].matrix());
}

TEST(DepthFusion, AMovedFrameComesToRestOnTheSurface)
{
  const Scene scene(9);
  fusion::DistanceGrid grid(0.02, 0.08);
  std::vector<fusion::DepthFrame> frames;
  for (Index f = 0; f < 9; ++f) {
    frames.emplace_back(scene.frames.camera, scene.depthOf(f), scene.true_poses[f], 1);
    grid.allocate(frames.back(), 1);
  }
  for (const fusion::DepthFrame& frame : frames)
    grid.integrate(frame, nullptr, 1, 1);
  grid.finish(nullptr, 1);
  const Eigen::Isometry3d& truth = scene.true_poses[4];
  Eigen::Isometry3d moved = truth * Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized());
  moved.translation() += Eigen::Vector3d(0.01, -0.008, 0.012);
  const auto apart = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a * ball - b * ball).norm();
  };
  const Eigen::Isometry3d once = fusion::alignToGrid(grid, frames[4], moved, moved, 1),
                          twice = fusion::alignToGrid(grid, frames[4], once, moved, 1);
  EXPECT_LT(apart(once, truth), 0.5 * apart(moved, truth));
  EXPECT_LT(apart(twice, once), 0.001 * apart(moved, once)) << "it had not come to rest";
}

TEST(DepthFusion, FramesWithoutDepthGiveNoPoints)
{
  Scene scene(2);
  scene.frames.depth = [](Index f) {
    return DepthImage::Constant(90, 120, f == 0 ? 0.f : std::numeric_limits<float>::quiet_NaN());
  };
  EXPECT_EQ(fuseDepthImages(scene.frames, options()).points.size(), 0);
}

TEST(DepthFusion, KernelsOfAllProcessorsAgree)
{
  if (!fusion::avx2VoteKernels())
    GTEST_SKIP() << "no AVX2";
  const Scene scene(1);
  const DepthImage depth = scene.depthOf(0); // with silhouettes
  const CameraModel& camera = scene.frames.camera;
  const fusion::DepthPixels image{depth.data(), camera.width, camera.height, 100.f, 100.f, 59.5f, 44.5f};
  const std::vector<float> reference(fusion::brick_size, 0.01f);
  for (const float u : {-0.95f, -0.4f, -0.1f, 0.2f}) { // bricks across the border, too
    const fusion::BrickView view{{u, -0.2f, 1.2f}, {{0.06f, 0.01f, 0.f}, {-0.01f, 0.06f, 0.02f}, {0.f, -0.02f, 0.06f}}};
    std::vector<float> votes[2];
    for (const bool fast : {false, true}) {
      const auto& kernels = fast ? *fusion::avx2VoteKernels() : fusion::portableVoteKernels();
      votes[fast].assign(2 * fusion::brick_size + 1, 0.f);
      for (const float* mean : {static_cast<const float*>(nullptr), reference.data()})
        votes[fast].back() += kernels.vote(image, view, {0.02f, 0.08f, 1.25f, 0.04f},
                                           {mean, votes[fast].data(), votes[fast].data() + fusion::brick_size});
    }
    EXPECT_EQ(votes[0], votes[1]);
    EXPECT_GT(votes[0].back(), 0.f) << u;
  }
}

TEST(DepthFusion, BadInputIsRefused)
{
  Scene scene(2);
  for (const double cell : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(fuseDepthImages(scene.frames, options(cell)), std::invalid_argument);
  DepthFusionOptions bad = options();
  bad.truncation = 1;
  EXPECT_THROW(fuseDepthImages(scene.frames, bad), std::invalid_argument);
  bad = options();
  bad.free_weight = 0;
  EXPECT_THROW(fuseDepthImages(scene.frames, bad), std::invalid_argument);
  EXPECT_THROW(fuseDepthImages(DepthFrames{}, options()), std::invalid_argument);
  const auto stop = [](std::string_view, double fraction) { return fraction < 0.5; };
  EXPECT_THROW(fuseDepthImages(scene.frames, options(), stop), Cancelled);
  scene.frames.T_world_camera[1].linear() *= 1.1;
  EXPECT_THROW(fuseDepthImages(scene.frames, options()), std::invalid_argument);
  Scene other(2);
  other.frames.depth = [](Index) { return DepthImage::Ones(90, 100); };
  EXPECT_THROW(fuseDepthImages(other.frames, options()), std::invalid_argument);
}
} // namespace
} // namespace fresco
