// SPDX-License-Identifier: BSD-3-Clause
// Registration by several ranks comes to what one process alone comes to, bit by bit.
#include "exchange_laws.h"
#include "registration/registration_scene.h"
#include "thread_ranks.h"
#include <fresco/registration/core/scan_registration.h>
#include <mutex>
#include <set>
namespace fresco {
namespace {
using test::ScannedScene;
using test::ThreadRanks;

TEST(ThreadRanks, Laws)
{
  for (const int count : {1, 2, 3, 7})
    ThreadRanks::run(count, test::expectExchangeLaws);
}

/// With one more that cannot be read and a duplicate of the first.
ScanSource sourceOf(const ScannedScene& scene)
{
  const Index count = scene.scans.size();
  return {count + 2, [&scene, count](Index i) {
            if (i == count)
              throw std::runtime_error("damaged");
            return scene.scans[i == count + 1 ? 0 : i];
          }};
}

void expectSame(const ScanRegistrationResult& found, const ScanRegistrationResult& wanted)
{
  EXPECT_EQ(found.poses, wanted.poses);
  EXPECT_EQ(found.rms, wanted.rms);
  EXPECT_EQ(found.voxel, wanted.voxel);
  ASSERT_EQ(found.scans.size(), wanted.scans.size());
  for (std::size_t i = 0; i < found.scans.size(); ++i) {
    EXPECT_EQ(found.scans[i].problem, wanted.scans[i].problem);
    EXPECT_EQ(found.scans[i].duplicate_of, wanted.scans[i].duplicate_of);
    EXPECT_EQ(found.scans[i].T_group_scan, wanted.scans[i].T_group_scan);
    EXPECT_EQ(found.scans[i].translation_deviation, wanted.scans[i].translation_deviation);
  }
  ASSERT_EQ(found.pairs.size(), wanted.pairs.size());
  for (std::size_t i = 0; i < found.pairs.size(); ++i) {
    EXPECT_EQ(std::pair(found.pairs[i].a, found.pairs[i].b), std::pair(wanted.pairs[i].a, wanted.pairs[i].b));
    EXPECT_EQ(found.pairs[i].T_a_b, wanted.pairs[i].T_a_b);
    EXPECT_EQ(found.pairs[i].violation, wanted.pairs[i].violation);
    EXPECT_EQ(found.pairs[i].alternatives.size(), wanted.pairs[i].alternatives.size());
  }
}

TEST(RegistrationRanks, SameResultFromAnyNumber)
{
  const ScannedScene scene = test::scanTwoRooms(20000);
  ScanRegistrationOptions options;
  options.threads = 1;
  const ScanRegistrationResult alone = registerScans(sourceOf(scene), {}, options);
  EXPECT_GE(std::count_if(alone.scans.begin(), alone.scans.end(), [](const ScanResult& s) { return s.placed; }), 4);
  for (const int count : {1, 2, 5})
    ThreadRanks::run(count, [&](Exchange& ranks) {
      ScanSource scans = sourceOf(scene);
      scans.ranks = &ranks;
      expectSame(registerScans(scans, {}, options), alone);
    });
}

TEST(RegistrationRanks, EachReadsItsOwnScansOnly)
{
  const ScannedScene scene = test::scanTwoRooms(10000);
  std::mutex mutex;
  std::vector<std::set<int>> readers(scene.scans.size());
  ThreadRanks::run(2, [&](Exchange& ranks) {
    ScanSource scans(scene.scans.size(), [&](Index i) {
      const std::lock_guard<std::mutex> lock(mutex);
      readers[i].insert(ranks.rank());
      return scene.scans[i];
    });
    scans.ranks = &ranks;
    ScanRegistrationOptions options;
    options.threads = 1;
    registerScans(scans, {}, options);
  });
  for (const std::set<int>& reader : readers)
    EXPECT_EQ(reader.size(), 1U);
}

// The first scans have no points; the origin of all comes from the first that has.
TEST(RegistrationRanks, PlacedScansAreSharedOutWithOneOrigin)
{
  const auto scene = test::scanTwoRooms(3000);
  const Index count = 7;
  const auto read = [&](Index i) { return i < 2 ? PointSet() : scene.scans[i % scene.scans.size()]; };
  std::vector<Pose> poses(count, Eigen::Matrix4d::Identity().eval());
  poses[3].reset();
  for (Index i = 0; i < count; ++i)
    if (poses[i])
      poses[i]->topRightCorner<3, 1>() = Eigen::Vector3d(5e5 + static_cast<double>(i), 4e6, 0);
  std::map<Index, PointSet> wanted;
  forEachPlacedScan(
      ScanSource(count, read), poses, [&](Index i, PointSet scan) { wanted[i] = std::move(scan); }, 1);
  EXPECT_EQ(wanted.size(), 4U);
  for (const int size : {2, 3, 6}) {
    std::mutex mutex;
    std::map<Index, PointSet> found;
    ThreadRanks::run(size, [&](Exchange& ranks) {
      ScanSource scans(count, read);
      scans.ranks = &ranks;
      const auto keep = [&](Index i, PointSet scan) {
        const std::lock_guard<std::mutex> lock(mutex);
        EXPECT_EQ(found.count(i), 0U);
        found[i] = std::move(scan);
      };
      forEachPlacedScan(scans, poses, keep, 1);
    });
    ASSERT_EQ(found.size(), wanted.size());
    for (const auto& [i, scan] : wanted) {
      EXPECT_EQ(found[i].origin, scan.origin);
      EXPECT_EQ(found[i].points, scan.points);
      EXPECT_EQ(found[i].normals, scan.normals);
    }
  }
}

TEST(RegistrationRanks, AnErrorOfOneEndsAll)
{
  const ScannedScene scene = test::scanTwoRooms(3000);
  const auto run = [&](Exchange& ranks) {
    ScanSource scans(scene.scans.size(), [&](Index i) {
      PointSet scan = scene.scans[i];
      if (i == 1)
        scan.normals.resize(3, 1); // malformed
      return scan;
    });
    scans.ranks = &ranks;
    registerScans(scans);
  };
  EXPECT_THROW(ThreadRanks::run(2, run), std::invalid_argument);
}
} // namespace
} // namespace fresco
