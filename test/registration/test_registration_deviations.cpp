// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include "test_data.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <fresco/registration/core/scan_registration.h>
/// What registration claims of its own errors.
namespace fresco {
namespace {
using test::ScannedScene;

/// Two rooms measured with another noise, by other scanners.
ScannedScene measured(Index rays, double noise) { return test::scanTwoRooms(rays, noise); }

/// Error / deviation of each scan but the first, translations and rotations.
std::vector<double> errorRatios(const ScanRegistrationResult& result, const ScannedScene& scene)
{
  std::vector<double> ratios;
  for (std::size_t i = 1; i < scene.scans.size(); ++i) {
    const Eigen::Isometry3d found(result.poses[0]->inverse() * *result.poses[i]),
        truth = scene.truth[0].inverse() * scene.truth[i], difference = truth.inverse() * found;
    ratios.push_back(difference.translation().norm() / result.scans[i].translation_deviation);
    ratios.push_back(Eigen::AngleAxisd(difference.linear()).angle() / result.scans[i].rotation_deviation);
  }
  return ratios;
}

TEST(Deviations, ErrorsAreWithinThreeOfThem)
{
  std::vector<double> ratios;
  for (const Index rays : {6000, 9000, 13000, 20000})
    for (const double noise : {0.001, 0.004, 0.012}) {
      const ScannedScene scene = measured(rays, noise);
      const auto result = registerScans(scene.scans, test::disturbed(scene, 0.03, 1.0));
      for (const double ratio : errorRatios(result, scene))
        ratios.push_back(ratio);
    }
  std::sort(ratios.begin(), ratios.end());
  const auto beyond = ratios.end() - std::upper_bound(ratios.begin(), ratios.end(), 3.0);
  EXPECT_LE(100 * beyond, static_cast<Index>(ratios.size())) << "worst " << ratios.back();
  EXPECT_GT(ratios[ratios.size() / 2], 0.3) << "deviations are far wider than the errors";
  EXPECT_LT(ratios[ratios.size() / 2], 1.2);
}

TEST(Deviations, GrowWithTheNoise)
{
  double least = 0.0;
  for (const double noise : {0.002, 0.006, 0.018}) {
    const ScannedScene scene = measured(12000, noise);
    const auto result = registerScans(scene.scans, test::disturbed(scene, 0.02, 0.5));
    for (std::size_t i = 0; i < scene.scans.size(); ++i)
      EXPECT_GT(result.scans[i].translation_deviation, 0.0) << i;
    EXPECT_GT(result.scans[1].translation_deviation, 1.5 * least);
    least = result.scans[1].translation_deviation;
  }
}

// A scanner whose ranges are half a percent too long fits nowhere exactly: residuals grow, and so must what is claimed.
TEST(Deviations, GrowWhereScansDoNotFit)
{
  ScannedScene scene = measured(12000, 0.002);
  const auto start = test::disturbed(scene, 0.02, 0.5);
  const auto good = registerScans(scene.scans, start);
  scene.scans[1].points *= 1.005f;
  const auto bent = registerScans(scene.scans, start);
  EXPECT_GT(bent.scans[1].rms, 1.5 * good.scans[1].rms);
  EXPECT_GT(bent.scans[1].translation_deviation, 2.0 * good.scans[1].translation_deviation);
  for (const double ratio : errorRatios(bent, scene))
    EXPECT_LT(ratio, 3.0);
}

TEST(Deviations, InformationOfAPairIsThatOfItsError)
{
  const ScannedScene scene = measured(20000, 0.004);
  const auto result = registerScans(scene.scans, test::disturbed(scene, 0.03, 1.0));
  for (const PairResult& pair : result.pairs) {
    if (!pair.accepted)
      continue;
    const Eigen::SelfAdjointEigenSolver<PairResult::Matrix6d> solver(pair.information);
    EXPECT_GT(solver.eigenvalues()[0], 0.0) << pair.a << " and " << pair.b;
    EXPECT_LT((pair.information - pair.information.transpose()).norm(), 1e-6 * pair.information.norm());
    const Eigen::Isometry3d found(pair.T_a_b), truth = scene.truth[pair.a].inverse() * scene.truth[pair.b];
    const Eigen::AngleAxisd turn(found.linear() * truth.linear().transpose());
    Eigen::Matrix<double, 6, 1> error;
    error << turn.angle() * turn.axis(), found * pair.information_point - truth * pair.information_point;
    EXPECT_LT(error.dot(pair.information * error), 22.5) << "99.9 % of chi squared with 6 degrees of freedom";
    EXPECT_TRUE(found.isApprox(Eigen::Isometry3d(result.poses[pair.a]->inverse() * *result.poses[pair.b]), 1e-9));
  }
}

// Rooms that nothing tells apart: scans stay unplaced, but the true pose is among those that are reported.
TEST(Deviations, UndecidedPairsHaveTheTruthAmongTheirAlternatives)
{
  const ScannedScene scene = test::scanTwinRooms(false);
  const auto result = registerScans(scene.scans);
  Index undecided = 0, with_truth = 0;
  for (const PairResult& pair : result.pairs) {
    if (result.scans[pair.a].group == result.scans[pair.b].group || pair.alternatives.empty())
      continue;
    ++undecided;
    const Eigen::Matrix4d truth = (scene.truth[pair.a].inverse() * scene.truth[pair.b]).matrix();
    bool found = (pair.T_a_b - truth).norm() < 0.05;
    for (const AlternativePose& pose : pair.alternatives)
      found = found || (pose.T_a_b - truth).norm() < 0.05;
    with_truth += found ? 1 : 0;
  }
  EXPECT_GT(undecided, 0);
  EXPECT_GT(2 * with_truth, undecided);
}
} // namespace
} // namespace fresco
