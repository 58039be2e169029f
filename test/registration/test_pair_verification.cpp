// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_verification.h"
#include "registration/look_alike_scenes.h"
#include <fresco/registration/core/point_to_plane_registration.h>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
// Rooms whose scans share much, or only what a door shows.
struct PreparedScene {
  explicit PreparedScene(const test::ScannedScene& scanned) : scene(scanned)
  {
    const PointSet& first = scene.scans.front();
    const Thinning thinning(registrationVoxel(first), scanSize(first), narrowness(first));
    for (const PointSet& scan : scene.scans)
      scans.push_back(prepareScan(scan, thinning, 1));
  }
  Eigen::Isometry3d truth(std::size_t a, std::size_t b) const
  {
    return Eigen::Translation3d(-scans[a].center) * scene.truth[a].inverse() * scene.truth[b] *
           Eigen::Translation3d(scans[b].center);
  }
  double voxel() const { return scans.front().levels[check_level].voxel; }

  test::ScannedScene scene;
  std::vector<PreparedScan> scans;
};

PoseHypothesis hypothesisAt(const Eigen::Isometry3d& T_a_b)
{
  PoseHypothesis hypothesis;
  hypothesis.T_a_b = T_a_b;
  hypothesis.votes = many_votes;
  return hypothesis;
}

// Calls body(pair, truth) for all pairs of scans that overlap.
template <typename Body>
void forPairs(const PreparedScene& place, const Body& body)
{
  constexpr double least_overlap = 0.1;
  for (std::size_t a = 0; a < place.scans.size(); ++a)
    for (std::size_t b = a + 1; b < place.scans.size(); ++b) {
      SCOPED_TRACE(testing::Message() << "scans " << a << " and " << b);
      const PairGeometry pair(place.scans[a], place.scans[b]);
      const Eigen::Isometry3d truth = place.truth(a, b);
      if (checkPair(pair.a, pair.b, truth, check_level).overlap >= least_overlap)
        body(pair, truth);
    }
}

// Coarse surfaces draw scans that share little by half a metre.
TEST(PairVerification, TruePosesAreKept)
{
  for (const test::ScannedScene& scene : {test::scanTwoRooms(), test::scanTwinRooms(true, 20000)}) {
    const PreparedScene place(scene);
    forPairs(place, [&](const PairGeometry& pair, const Eigen::Isometry3d& truth) {
      const VerifiedHypothesis verified = verifyHypothesis(pair, hypothesisAt(truth));
      EXPECT_LT(poseDistance(verified.T_a_b, truth, pair.size), 0.5 * place.voxel());
      EXPECT_FALSE(clearlyWorse(verified.check.violation, 0.0));
    });
  }
}

// Also if a start nearby was tried before, and went astray.
TEST(PairVerification, TrueStartsAreTriedWhateverCameBefore)
{
  const PreparedScene place(test::roomsInARow(true).scene);
  forPairs(place, [&](const PairGeometry& pair, const Eigen::Isometry3d& truth) {
    for (const int degrees : {0, 90, 180, 240, 300}) {
      const double angle = degrees * M_PI / 180.0;
      FoundHypotheses found;
      found.features = {hypothesisAt(Eigen::Translation3d(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0) * truth)};
      found.planes = {hypothesisAt(truth)};
      VerifiedHypotheses verified = verifyHypotheses(pair, found, {});
      EXPECT_NE(findNear(pair, verified, truth, 0.5 * place.voxel()), verified.end()) << degrees;
    }
  });
}
} // namespace
} // namespace fresco::registration
