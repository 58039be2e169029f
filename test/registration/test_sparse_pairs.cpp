// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/placement.h"
#include "registration/registration_scene.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
#include <limits>
/// Pairs of scans that share only places far from either scanner.
namespace fresco::registration {
namespace {
// Two stations near the ends of a furnished hall, placed with an error.
struct Hall {
  std::vector<PreparedScan> scans;
  IsometryVector truth;
  ScanRegistrationOptions options;

  explicit Hall(Index rays)
  {
    test::Boxes boxes;
    test::addRoom(boxes, {0, 0, 0}, {36, 6, 3.4}, std::numeric_limits<double>::quiet_NaN());
    test::addFurniture(boxes, {0.5, 0.5, 0}, {35.5, 5.5, 0}, 14, 5);
    for (const double x : {3.0, 33.0}) {
      const Eigen::Isometry3d pose = test::stationPose({x, 3, 1.6}, x, 0.01);
      const PointSet scan = test::scanBoxes(boxes, pose, rays, 0.004, static_cast<unsigned>(x));
      if (scans.empty())
        options.voxel = static_cast<float>(registrationVoxel(scan));
      scans.push_back(prepareScan(scan, Thinning(options.voxel, scanSize(scan), narrowness(scan)), 0));
      truth.push_back(pose * Eigen::Translation3d(scans.back().center));
    }
    options.max_distance = 20.f * options.voxel;
  }

  Placement refined() const
  {
    Placement placement;
    placement.members = {0, 1};
    placement.poses = {truth[0], Eigen::Translation3d(0.03, -0.02, 0.02) * truth[1]};
    refinePlacement(scans, options, placement, {});
    return placement;
  }

  double error(const Placement& placement) const
  {
    const Eigen::Isometry3d found = placement.poses[0].inverse() * placement.poses[1];
    return (found.translation() - (truth[0].inverse() * truth[1]).translation()).norm();
  }
};

bool hasCoarse(const Placement& placement)
{
  return std::any_of(placement.joint.pairs.begin(), placement.joint.pairs.end(),
                     [](const JointPair& pair) { return pair.coarse && pair.matches > 0; });
}

// Thirty metres apart, fifteen from each to the middle: there the points of a scan lie further apart than fine cells are wide.
TEST(SparsePairs, CoarseSurfacesHoldWhatFineOnesDoNotShare)
{
  const Hall sparse(20000), dense(150000);
  const Placement by_coarse = sparse.refined(), by_fine = dense.refined();
  EXPECT_TRUE(hasCoarse(by_coarse));
  EXPECT_LT(dense.error(by_fine), 0.005);
  EXPECT_LT(sparse.error(by_coarse), 3.0 * positionDeviation(by_coarse.joint, 1));
  EXPECT_LT(sparse.error(by_coarse), 0.03);
}

// Coarse surfaces accept a pair if and only if they hold it well; a scan that is held loosely is told from one that is not.
TEST(SparsePairs, PairsAreAcceptedWhereTheyHoldWell)
{
  for (const Index rays : {5000, 9000, 20000}) {
    const Hall hall(rays);
    const Placement placement = hall.refined();
    const bool firm = positionDeviation(placement.joint, 1) <= hall.scans[1].size / voxels_per_size;
    for (const PairResult& pair : placement.pairs)
      if (pair.matches > 0 && hasCoarse(placement) && pair.overlap >= hall.options.min_overlap &&
          pair.violation <= hall.options.max_violation) {
        EXPECT_EQ(pair.accepted, firm) << rays;
      }
    EXPECT_TRUE(!isLoose(hall.scans[1], placement, 1) || !firm) << rays;
  }
}
} // namespace
} // namespace fresco::registration
