// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/registration/core/pose_graph.h>
#include <gtest/gtest.h>
#include <random>
using namespace fresco::registration;
namespace fresco {
namespace {
struct Ring {
  IsometryVector truth, chained; ///< poses on a circle, and the same built up from the edges one after the other
  PoseEdges edges;               ///< from each to the next, disturbed; the last closes the loop
};

Ring makeRing(int count, double noise)
{
  std::mt19937 random(3);
  const auto uniform = [&] { return 2.0 * (random() / 4294967296.0) - 1.0; };
  Ring ring;
  for (int i = 0; i < count; ++i)
    ring.truth.push_back(Eigen::AngleAxisd(2.0 * M_PI * i / count, Eigen::Vector3d(0.2, 0.1, 1).normalized()) *
                         Eigen::Translation3d(5, 0, 0) * Eigen::Isometry3d::Identity());
  ring.chained.push_back(ring.truth[0]);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d shift(uniform(), uniform(), uniform()), turn(uniform(), uniform(), uniform());
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>((i + 1) % count);
    const Eigen::Isometry3d error = Eigen::Translation3d(noise * shift) *
                                    Eigen::AngleAxisd(noise * turn.norm() / 5.0, turn.normalized()) *
                                    Eigen::Isometry3d::Identity();
    ring.edges.push_back({i, (i + 1) % count, ring.truth[a].inverse() * ring.truth[b] * error, 1.0});
    if (b != 0)
      ring.chained.push_back(ring.chained[a] * ring.edges.back().T_a_b);
  }
  return ring;
}

double worst(const IsometryVector& poses, const IsometryVector& truth)
{
  double error = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    error = std::max(error, (poses[i].translation() - truth[i].translation()).norm());
  return error;
}

PoseGraphOptions ringOptions()
{
  PoseGraphOptions options;
  options.size = 5.0;
  options.tolerance = 0.5;
  return options;
}

TEST(PoseGraph, ExactEdgesGiveExactPoses)
{
  const Ring ring = makeRing(8, 0.0);
  IsometryVector start = ring.truth;
  for (std::size_t i = 1; i < start.size(); ++i)
    start[i] = start[i] * Eigen::Translation3d(0.1, -0.05, 0.08) * Eigen::AngleAxisd(0.04, Eigen::Vector3d::UnitY());
  EXPECT_LT(worst(optimizePoseGraph(start, ring.edges, ringOptions()), ring.truth), 1e-6);
}

TEST(PoseGraph, ClosingTheLoopSpreadsTheError)
{
  const Ring ring = makeRing(24, 0.05);
  const IsometryVector poses = optimizePoseGraph(ring.chained, ring.edges, ringOptions());
  EXPECT_LT(worst(poses, ring.truth), worst(ring.chained, ring.truth));
  EXPECT_EQ(poses[0].matrix(), ring.chained[0].matrix());
}

TEST(PoseGraph, OneWrongEdgeHasLittleWeight)
{
  Ring ring = makeRing(8, 0.0);
  ring.edges.push_back({0, 4, ring.truth[1], 1.0});
  EXPECT_LT(worst(optimizePoseGraph(ring.truth, ring.edges, ringOptions()), ring.truth), 0.02);
}

TEST(PoseGraph, FixedPosesStay)
{
  const Ring ring = makeRing(8, 0.05);
  PoseGraphOptions options = ringOptions();
  options.fixed = {0, 0, 1, 0, 0, 1, 0, 0};
  const IsometryVector poses = optimizePoseGraph(ring.chained, ring.edges, options);
  EXPECT_EQ(poses[2].matrix(), ring.chained[2].matrix());
  EXPECT_EQ(poses[5].matrix(), ring.chained[5].matrix());
}
} // namespace
} // namespace fresco
