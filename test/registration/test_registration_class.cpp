// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include <atomic>
#include <fresco/registration/point_to_plane_registration.h>
#include <fresco/registration/scan_registration.h>
#include <gtest/gtest.h>
#include <pcl/point_types.h>
namespace fresco {
namespace {
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Pair = PointToPlaneRegistration<pcl::PointXYZ, pcl::PointXYZ>;

const test::ScannedScene& scene()
{
  static const test::ScannedScene scanned = test::scanTwoRooms();
  return scanned;
}

Cloud::Ptr cloudOf(std::size_t scan)
{
  Cloud::Ptr cloud(new Cloud);
  toPointCloud(scene().scans[scan], *cloud);
  return cloud;
}

Eigen::Matrix4f guessOf(std::size_t source, std::size_t target)
{
  return (scene().truth[target].inverse() * scene().truth[source] * Eigen::Translation3d(0.1, 0.05, 0))
      .matrix()
      .cast<float>();
}

TEST(PointToPlaneClass, EqualsTheCore)
{
  Pair pair;
  pair.setInputSource(cloudOf(1));
  pair.setInputTarget(cloudOf(0));
  Cloud aligned;
  pair.align(aligned, guessOf(1, 0));
  const auto core = alignPointToPlane(scene().scans[1], scene().scans[0], guessOf(1, 0).cast<double>());
  EXPECT_TRUE(pair.hasConverged());
  EXPECT_LT((pair.getFinalTransformation().cast<double>() - core.T_target_source).norm(), 1e-5);
  const Eigen::Isometry3d truth = scene().truth[0].inverse() * scene().truth[1];
  EXPECT_LT((pair.getFinalTransformation().cast<double>() - truth.matrix()).norm(), 0.01);
  ASSERT_EQ(aligned.size(), cloudOf(1)->size());
  const Eigen::Vector3f expected = (pair.getFinalTransformation() * (*cloudOf(1))[5].getVector4fMap()).head<3>();
  EXPECT_LT((aligned[5].getVector3fMap() - expected).norm(), 1e-5f);
  EXPECT_LT(pair.getFitnessScore(0.01), 0.01);
}

TEST(PointToPlaneClass, IndicesAndPointsThatAreNotNumbers)
{
  Cloud::Ptr source = cloudOf(1), target = cloudOf(0);
  for (std::size_t i = 0; i < source->size(); i += 7)
    (*source)[i].x = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < target->size(); i += 9)
    (*target)[i].y = std::numeric_limits<float>::quiet_NaN();
  source->is_dense = target->is_dense = false;
  pcl::IndicesPtr half(new pcl::Indices);
  for (int i = 0; i < static_cast<int>(source->size()); i += 2)
    half->push_back(i);
  Pair pair;
  pair.setInputSource(source);
  pair.setInputTarget(target);
  pair.setIndices(half);
  Cloud aligned;
  pair.align(aligned, guessOf(1, 0));
  EXPECT_TRUE(pair.hasConverged());
  EXPECT_EQ(aligned.size(), half->size());
  EXPECT_TRUE(std::isfinite(pair.getFitnessScore()));
}

TEST(PointToPlaneClass, NoOverlapDoesNotConverge)
{
  Pair pair;
  pair.setInputSource(cloudOf(1));
  pair.setInputTarget(cloudOf(0));
  pair.setMaxCorrespondenceDistance(0.05);
  Eigen::Matrix4f away = Eigen::Matrix4f::Identity();
  away(0, 3) = 100.f;
  Cloud aligned;
  pair.align(aligned, away);
  EXPECT_FALSE(pair.hasConverged());
}

/// PCL's tree, which counts its searches.
class CountingTree : public pcl::search::KdTree<pcl::PointXYZ> {
public:
  using Base = pcl::search::KdTree<pcl::PointXYZ>;
  using Base::nearestKSearch;
  int nearestKSearch(const pcl::PointXYZ& point, int k, pcl::Indices& indices,
                     std::vector<float>& squared) const override
  {
    ++searches;
    return Base::nearestKSearch(point, k, indices, squared);
  }
  mutable std::atomic<int> searches{0};
};

TEST(PointToPlaneClass, SearchMethodsOfPclGiveTheSame)
{
  Pair own, given;
  const pcl::shared_ptr<CountingTree> target_tree(new CountingTree), source_tree(new CountingTree);
  given.setSearchMethodTarget(target_tree);
  given.setSearchMethodSource(source_tree);
  const Cloud::Ptr source = cloudOf(1), target = cloudOf(0);
  Cloud aligned;
  for (Pair* pair : {&own, &given}) {
    pair->setInputSource(source);
    pair->setInputTarget(target);
    pair->align(aligned, guessOf(1, 0));
    EXPECT_TRUE(pair->hasConverged());
  }
  EXPECT_GT(target_tree->searches, 10000);
  EXPECT_GT(source_tree->searches, 10000);
  EXPECT_LT((own.getFinalTransformation() - given.getFinalTransformation()).norm(), 1e-5f);
  EXPECT_NEAR(own.getResult().overlap, given.getResult().overlap, 1e-3);
  EXPECT_EQ(target_tree->getInputCloud(), target); // as pcl::Registration left it
  EXPECT_NEAR(own.getFitnessScore(), given.getFitnessScore(), 1e-5);
  const Eigen::Matrix4f first = given.getFinalTransformation();
  given.align(aligned, guessOf(1, 0));
  EXPECT_EQ(given.getFinalTransformation(), first); // the prepared target is used again
}

TEST(PointToPlaneClass, OneTreeForBothCloudsServesTheTarget)
{
  Pair own, given;
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>);
  given.setSearchMethodTarget(tree);
  given.setSearchMethodSource(tree);
  Cloud aligned;
  for (Pair* pair : {&own, &given}) {
    pair->setInputSource(cloudOf(1));
    pair->setInputTarget(cloudOf(0));
    pair->align(aligned, guessOf(1, 0));
  }
  EXPECT_LT((own.getFinalTransformation() - given.getFinalTransformation()).norm(), 1e-5f);
}

TEST(PointToPlaneClass, OptionsAndProgress)
{
  Pair pair;
  PointToPlaneOptions options;
  options.max_distance = 0.3f;
  options.max_iterations = 7;
  options.min_motion = 0.002f;
  options.samples = 900;
  options.threads = 2;
  pair.setOptions(options);
  EXPECT_EQ(pair.getMaximumIterations(), 7);
  EXPECT_EQ(pair.getThreads(), 2);
  EXPECT_FLOAT_EQ(pair.getOptions().max_distance, 0.3f);
  EXPECT_FLOAT_EQ(pair.getOptions().min_motion, 0.002f);
  EXPECT_EQ(pair.getOptions().samples, 900);
  pair.setOptions({});
  EXPECT_EQ(pair.getOptions().max_distance, 0.f);
  pair.setProgress([](std::string_view, double) { return false; });
  pair.setInputSource(cloudOf(1));
  pair.setInputTarget(cloudOf(0));
  Cloud aligned;
  EXPECT_THROW(pair.align(aligned, guessOf(1, 0)), std::runtime_error);
}

TEST(PointToPlaneClass, TooFewPointsThrow)
{
  Pair pair;
  Cloud::Ptr few(new Cloud(3, 1));
  (*few)[1].x = (*few)[2].y = 1.f;
  pair.setInputSource(few);
  pair.setInputTarget(cloudOf(0));
  Cloud aligned;
  EXPECT_THROW(pair.align(aligned), std::invalid_argument);
}

TEST(ScanRegistrationClass, EqualsTheCoreAndMovesTheClouds)
{
  ScanRegistration<pcl::PointXYZ> registration;
  const auto start = test::disturbed(scene(), 0.05, 2.0);
  std::vector<PointSet> scans;
  for (const std::size_t i : {0, 1, 2}) {
    EXPECT_EQ(registration.addPointCloud(cloudOf(i), start[i]), i);
    scans.push_back(scene().scans[i]);
  }
  const auto& result = registration.compute();
  const auto core = registerScans(scans, {start[0], start[1], start[2]});
  EXPECT_EQ(result.poses, core.poses);
  const Cloud moved = registration.getTransformedCloud(1);
  const Eigen::Vector3d expected =
      (registration.getTransformation(1) * (*cloudOf(1))[3].getVector4fMap().cast<double>()).head<3>();
  EXPECT_LT((moved[3].getVector3fMap().cast<double>() - expected).norm(), 1e-4);
  EXPECT_LT((moved.sensor_origin_.head<3>().cast<double>() - core.poses[1]->topRightCorner<3, 1>()).norm(), 1e-5);
  EXPECT_EQ(registration.getConcatenatedCloud().size(), cloudOf(0)->size() + cloudOf(1)->size() + cloudOf(2)->size());
  EXPECT_THROW(registration.addPointCloud(nullptr), std::invalid_argument);
  EXPECT_THROW(registration.getTransformation(17), std::invalid_argument);
}
} // namespace
} // namespace fresco
