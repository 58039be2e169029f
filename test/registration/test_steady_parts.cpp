// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/free_motion.h"
#include "refinement/steady_parts.h"
#include "registration/registration_scene.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
/// Parts of a group that move against each other easily.
namespace fresco::registration {
namespace {
struct Refined {
  std::vector<PreparedScan> scans;
  ScanPointers members;
  JointOptions options;
  JointResult joint;
};

/// From the true poses; scan `anchor` holds the frame.
Refined refined(const test::ScannedScene& scene, Index anchor, float voxel)
{
  Refined result;
  for (const PointSet& scan : scene.scans)
    result.scans.push_back(prepareScan(scan, Thinning(voxel), 0));
  IsometryVector truth;
  for (std::size_t i = 0; i < scene.scans.size(); ++i) {
    result.members.push_back(&result.scans[i]);
    truth.push_back(scene.truth[i] * Eigen::Translation3d(result.scans[i].center));
  }
  result.options.max_distance = 4.f * voxel;
  result.options.min_overlap = 0.5f * ScanRegistrationOptions().min_overlap; // as placements do
  result.options.first_level = check_level;
  result.options.covariances = result.options.cuts = result.options.coarse_pairs = true;
  result.options.anchors = {anchor};
  result.joint = refineJointly(result.members, truth, result.options, {});
  return result;
}

using Partition = std::set<std::vector<Index>>;

std::set<Partition> partitions(const LooseCuts& cuts)
{
  std::set<Partition> found;
  for (const LooseCut& cut : cuts)
    found.insert({cut.body, cut.rest});
  return found;
}

const LooseCut* cutBetween(const LooseCuts& cuts, const Partition& parts)
{
  const auto found = std::find_if(cuts.begin(), cuts.end(), [&](const auto& cut) {
    return Partition{cut.body, cut.rest} == parts;
  });
  return found == cuts.end() ? nullptr : &*found;
}

constexpr float voxel = 0.02f;

TEST(LooseCuts, PartAllScansOfAGroup)
{
  const Refined niches = refined(test::scanNiches(), 0, voxel);
  ASSERT_FALSE(niches.joint.cuts.empty());
  for (const LooseCut& cut : niches.joint.cuts) {
    EXPECT_FALSE(cut.body.empty() || cut.rest.empty());
    EXPECT_TRUE(std::binary_search(cut.body.begin(), cut.body.end(), cut.about));
    std::vector<Index> all = cut.body;
    all.insert(all.end(), cut.rest.begin(), cut.rest.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, (std::vector<Index>{0, 1, 2, 3}));
  }
}

// Two scans of a niche each: it is between the niches that little holds, whoever holds the frame.
TEST(LooseCuts, DoNotDependOnTheScanThatHoldsTheFrame)
{
  const Partition between = {{0, 1}, {2, 3}};
  const test::ScannedScene scene = test::scanNiches();
  const Refined first = refined(scene, 0, voxel);
  ASSERT_TRUE(cutBetween(first.joint.cuts, between));
  const double share = findWeakestMotion(cutBetween(first.joint.cuts, between)->information)->share;
  EXPECT_LT(share, 0.01);
  for (const Index anchor : {1, 2, 3}) {
    const LooseCuts cuts = refined(scene, anchor, voxel).joint.cuts;
    EXPECT_EQ(partitions(cuts), partitions(first.joint.cuts)) << anchor;
    ASSERT_TRUE(cutBetween(cuts, between)) << anchor;
    EXPECT_NEAR(findWeakestMotion(cutBetween(cuts, between)->information)->share, share, 0.1 * share) << anchor;
  }
}

TEST(SteadyParts, PlacesThatWallsHoldDoNotMove)
{
  const Refined rooms = refined(test::scanTwoRooms(), 0, 0.03f);
  ASSERT_FALSE(rooms.joint.cuts.empty());
  for (const LooseCut& cut : rooms.joint.cuts)
    EXPECT_FALSE(findUnsteadyMotion(rooms.members, rooms.joint.poses, cut, rooms.options));
}

// A place that is none of rest moves, and it is told which way.
TEST(SteadyParts, WhatMovesIsTold)
{
  const Refined niches = refined(test::scanNiches(), 0, voxel);
  const LooseCut* cut = cutBetween(niches.joint.cuts, {{0, 1}, {2, 3}});
  ASSERT_TRUE(cut);
  IsometryVector poses = niches.joint.poses;
  for (const Index i : cut->body)
    poses[i].pretranslate(Eigen::Vector3d(0.0, 0.0, 2.5 * voxel)); // off the floor
  const auto motion = findUnsteadyMotion(niches.members, poses, *cut, niches.options);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->translation.norm(), 1.0, 1e-6);
  EXPECT_LT(motion->translation.z(), -0.1) << "back, and along the corridor, where nothing holds it";
  EXPECT_LT(std::abs(motion->translation.y()), 0.1);
}
} // namespace
} // namespace fresco::registration
