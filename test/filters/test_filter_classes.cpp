// SPDX-License-Identifier: BSD-3-Clause
#include "filters/virtual_scan.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/filters/bilateral_normal_filter.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/filters/oriented_normal_estimation.h>
#include <fresco/filters/veil_point_removal.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
namespace fresco {
namespace {
using test::nan;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointXYZRGBNormal>;

Cloud::Ptr toCloud(const Points& points)
{
  auto cloud = pcl::make_shared<Cloud>();
  for (Index i = 0; i < points.cols(); ++i)
    cloud->push_back({points(0, i), points(1, i), points(2, i)});
  cloud->header.frame_id = "scanner";
  cloud->header.stamp = 77;
  cloud->sensor_origin_ << 0, 0, 5, 0;
  cloud->sensor_orientation_ = Eigen::Quaternionf(0.6f, 0, 0.8f, 0);
  return cloud;
}

template <typename A, typename B>
void expectSameFrame(const pcl::PointCloud<A>& a, const pcl::PointCloud<B>& b)
{
  EXPECT_EQ(a.header.frame_id, b.header.frame_id);
  EXPECT_EQ(a.header.stamp, b.header.stamp);
  EXPECT_EQ(a.sensor_origin_, b.sensor_origin_);
  EXPECT_EQ(a.sensor_orientation_.coeffs(), b.sensor_orientation_.coeffs());
}

TEST(OrientedNormalEstimation, IsTheCoreAndAgreesWithPcl)
{
  const Cloud::Ptr cloud = toCloud(test::withNoise(test::flatSquare(2000, 1).points, 0.01f, 2));
  OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(20);
  estimation.setKeepEdges(false);
  pcl::PointCloud<pcl::PointNormal> output;
  estimation.compute(output);
  NormalOptions options;
  options.k = 20;
  options.edges = false;
  const NormalField field = estimateNormals(toPointSet(*cloud), options);
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> theirs;
  theirs.setInputCloud(cloud);
  theirs.setKSearch(20);
  theirs.setViewPoint(0, 0, 5);
  pcl::PointCloud<pcl::Normal> truth;
  theirs.compute(truth);
  ASSERT_EQ(output.size(), cloud->size());
  expectSameFrame(output, *cloud);
  for (std::size_t i = 0; i < output.size(); ++i) {
    EXPECT_EQ(Eigen::Vector3f(output[i].getNormalVector3fMap()), field.normals.col(static_cast<Index>(i)));
    EXPECT_EQ(output[i].x, (*cloud)[i].x);
    EXPECT_LT(test::angleBetween(output[i].getNormalVector3fMap(), truth[i].getNormalVector3fMap()), 0.1f);
    EXPECT_NEAR(output[i].curvature, truth[i].curvature, 1e-4f);
  }
  EXPECT_EQ(estimation.getConfidences(), field.confidences);
}

TEST(OrientedNormalEstimation, IndicesSurfaceAndNonFinitePoints)
{
  const Cloud::Ptr cloud = toCloud(test::unitSphere(3000, 1).points);
  (*cloud)[8].x = nan;
  cloud->is_dense = false;
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setViewPointUnknown();
  pcl::PointCloud<pcl::Normal> all, some, on_surface;
  estimation.compute(all);
  EXPECT_TRUE(std::isnan(all[8].normal_x));
  EXPECT_FALSE(all.is_dense);
  EXPECT_GT(all[9].getNormalVector3fMap().dot((*cloud)[9].getVector3fMap()), 0.9f);
  const auto indices = pcl::make_shared<pcl::Indices>(pcl::Indices{9, 8, 100, 9});
  estimation.setIndices(indices);
  estimation.compute(some);
  ASSERT_EQ(some.size(), 4u);
  EXPECT_EQ(some[0].normal_x, all[9].normal_x);
  EXPECT_TRUE(std::isnan(some[1].normal_x));
  EXPECT_EQ(some[2].normal_y, all[100].normal_y);
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> other;
  other.setViewPointUnknown();
  other.setInputCloud(pcl::make_shared<Cloud>(*cloud, *indices));
  other.setSearchSurface(cloud);
  other.compute(on_surface);
  EXPECT_EQ(on_surface[2].normal_y, all[100].normal_y);
  EXPECT_TRUE(std::isnan(on_surface[1].normal_x));
  (*indices)[0] = 5000;
  EXPECT_THROW(estimation.compute(some), std::invalid_argument);
}

TEST(OrientedNormalEstimation, OrganizedEmptyAndContradictoryInput)
{
  const Cloud::Ptr cloud = toCloud(test::scanWithMixedPixels(0.01f, 0, 1).points);
  cloud->height = 10;
  cloud->width = static_cast<std::uint32_t>(cloud->size() / 10);
  cloud->resize(std::size_t{cloud->width} * 10);
  cloud->height = 10;
  cloud->width = static_cast<std::uint32_t>(cloud->size() / 10);
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  pcl::PointCloud<pcl::Normal> output;
  estimation.compute(output);
  EXPECT_EQ(output.width, cloud->width);
  EXPECT_EQ(output.height, 10u);
  estimation.setKSearch(5);
  estimation.setRadiusSearch(0.1);
  EXPECT_THROW(estimation.compute(output), std::invalid_argument);
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> empty;
  empty.setInputCloud(pcl::make_shared<Cloud>());
  empty.compute(output);
  EXPECT_TRUE(output.empty());
}

NormalCloud::Ptr noisyCube()
{
  const test::Cloud cube = test::cube(2000, 1);
  const Points normals = test::withNoise(cube.normals, 0.1f, 2).colwise().normalized();
  auto cloud = pcl::make_shared<NormalCloud>();
  for (Index i = 0; i < cube.points.cols(); ++i) {
    pcl::PointXYZRGBNormal point;
    point.getVector3fMap() = cube.points.col(i);
    point.getNormalVector3fMap() = normals.col(i);
    point.rgba = static_cast<std::uint32_t>(i) * 77u;
    point.curvature = static_cast<float>(i);
    cloud->push_back(point);
  }
  cloud->header.frame_id = "room";
  cloud->sensor_origin_ << 1, 2, 3, 0;
  cloud->width = 100;
  cloud->height = 20;
  (*cloud)[5].x = nan;
  cloud->is_dense = false;
  return cloud;
}

/// Planes through the same neighbours; where two are equally far but for rounding, one of them may differ.
void expectSameNormals(const pcl::PointCloud<pcl::Normal>& a, const pcl::PointCloud<pcl::Normal>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(pcl::isNormalFinite(a[i]), pcl::isNormalFinite(b[i])) << i;
    if (pcl::isNormalFinite(a[i])) {
      EXPECT_LT(test::angleBetween(a[i].getNormalVector3fMap(), b[i].getNormalVector3fMap()), 0.1f) << i; // degrees
      EXPECT_NEAR(a[i].curvature, b[i].curvature, 1e-5f) << i;
    }
  }
}

TEST(OrientedNormalEstimation, TakesNeighborsFromTheSearchMethod)
{
  const Cloud::Ptr cloud = toCloud(test::unitSphere(2000, 1).points);
  (*cloud)[8].x = nan;
  cloud->is_dense = false;
  const auto indices = pcl::make_shared<pcl::Indices>(pcl::Indices{9, 8, 100, 9, 1500});
  const auto some = pcl::make_shared<Cloud>(*cloud, *indices);
  for (const bool by_radius : {false, true})
    for (const bool on_surface : {false, true}) {
      OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> ours, theirs;
      theirs.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
      pcl::PointCloud<pcl::Normal> a, b;
      for (auto* estimation : {&ours, &theirs}) {
        by_radius ? estimation->setRadiusSearch(0.15) : estimation->setKSearch(12);
        estimation->setKeepEdges(false); // the refit beside edges has limits that the order of sums may tip
        estimation->setViewPoint(0, 0, 5);
        estimation->setInputCloud(on_surface ? some : cloud);
        if (on_surface)
          estimation->setSearchSurface(cloud);
        estimation->compute(estimation == &ours ? a : b);
      }
      expectSameNormals(a, b);
      if (on_surface)
        continue;
      for (auto* estimation : {&ours, &theirs}) {
        estimation->setIndices(indices);
        estimation->compute(estimation == &ours ? a : b);
      }
      EXPECT_EQ(a.size(), 5u);
      expectSameNormals(a, b);
    }
}

/// A search that always finds the same points.
struct Stubborn : pcl::search::KdTree<pcl::PointXYZ> {
  int nearestKSearch(const pcl::PointXYZ&, int k, pcl::Indices& indices, std::vector<float>& squared) const override
  {
    indices = {0, 1, 2};
    squared.assign(3, 0.f);
    return k < 3 ? k : 3;
  }
};

TEST(OrientedNormalEstimation, HasNoNeighborsBesideThoseOfTheSearchMethod)
{
  const Cloud::Ptr cloud = toCloud(test::unitSphere(500, 1).points);
  OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKeepEdges(false);
  estimation.setSearchMethod(pcl::make_shared<Stubborn>());
  estimation.setViewPointUnknown();
  pcl::PointCloud<pcl::Normal> output;
  estimation.compute(output);
  const Eigen::Vector3f a = (*cloud)[0].getVector3fMap(), b = (*cloud)[1].getVector3fMap(),
                        c = (*cloud)[2].getVector3fMap(), plane = (b - a).cross(c - a).normalized();
  for (const pcl::Normal& normal : output)
    EXPECT_GT(std::abs(plane.dot(normal.getNormalVector3fMap())), 0.999f);
}

template <typename Filter>
void expectCommonSetters(Filter& filter)
{
  filter.setThreads(3);
  EXPECT_EQ(filter.getNumberOfThreads(), 3);
  EXPECT_EQ(filter.getOptions().threads, 3);
  auto options = filter.getOptions();
  options.threads = 1;
  filter.setOptions(options);
  EXPECT_EQ(filter.getThreads(), 1);
  filter.setProgress([](std::string_view, double) { return false; });
}

TEST(FilterClasses, HaveSettersOfOneKindAndStopWhenAsked)
{
  const NormalCloud::Ptr cloud = noisyCube();
  NormalCloud output;
  BilateralNormalFilter<pcl::PointXYZRGBNormal> smoothing;
  VeilPointRemoval<pcl::PointXYZRGBNormal> removal;
  OrientedNormalEstimation<pcl::PointXYZRGBNormal, pcl::PointXYZRGBNormal> estimation;
  const auto expectStopped = [&](auto& filter, const auto& run) {
    expectCommonSetters(filter);
    filter.setViewPoint(0, 0, 5);
    filter.useSensorOriginAsViewPoint();
    filter.setInputCloud(cloud);
    EXPECT_THROW(run(), Cancelled);
  };
  expectStopped(smoothing, [&] { smoothing.filter(output); });
  expectStopped(removal, [&] { removal.filter(output); });
  expectStopped(estimation, [&] { estimation.compute(output); });
}

TEST(BilateralNormalFilterClass, IsTheCoreAndKeepsTheRest)
{
  const NormalCloud::Ptr cloud = noisyCube();
  BilateralNormalFilter<pcl::PointXYZRGBNormal> filter;
  filter.setInputCloud(cloud);
  filter.setRounds(2);
  filter.setSigmaN(20);
  filter.setSigmaD(0.15f);
  NormalCloud output;
  filter.filter(output);
  BilateralOptions options;
  options.rounds = 2;
  options.sigma_n = 20;
  options.sigma_d = 0.15f;
  const PointSet set = toPointSet(*cloud);
  const Points truth = smoothNormals(set.points, set.normals, options).normals;
  expectSameFrame(output, *cloud);
  EXPECT_EQ(output.width, 100u);
  EXPECT_EQ(output.height, 20u);
  EXPECT_FALSE(output.is_dense);
  for (std::size_t i = 0; i < output.size(); ++i) {
    EXPECT_EQ(Eigen::Vector3f(output[i].getNormalVector3fMap()), truth.col(static_cast<Index>(i)));
    EXPECT_EQ(output[i].rgba, (*cloud)[i].rgba);
    EXPECT_EQ(output[i].curvature, (*cloud)[i].curvature);
  }
  filter.filter(*cloud); // in place
  EXPECT_EQ((*cloud)[7].normal_x, output[7].normal_x);
  EXPECT_EQ(cloud->header.frame_id, "room");
}

TEST(BilateralNormalFilterClass, HonoursIndices)
{
  const NormalCloud::Ptr cloud = noisyCube();
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < 1000; ++i)
    indices->push_back(2 * i);
  BilateralNormalFilter<pcl::PointXYZRGBNormal> filter;
  filter.setInputCloud(cloud);
  filter.setIndices(indices);
  NormalCloud output;
  filter.filter(output);
  const PointSet set = toPointSet(*cloud, *indices);
  ASSERT_EQ(output.size(), 1000u);
  EXPECT_EQ(Eigen::Vector3f(output[9].getNormalVector3fMap()), smoothNormals(set.points, set.normals).normals.col(9));
  filter.setSigmaN(0);
  EXPECT_THROW(filter.filter(output), std::invalid_argument);
}

TEST(VeilPointRemovalClass, IsTheCoreInAllModes)
{
  Points points = test::scanWithMixedPixels(0.01f, 0.002f, 1).points;
  points.col(40).setConstant(nan);
  const Cloud::Ptr cloud = toCloud(points);
  cloud->is_dense = false;
  const auto kept = withoutMixedPixels(points, Eigen::Vector3f::Zero());
  const Index gone = points.cols() - static_cast<Index>(kept.size());
  VeilPointRemoval<pcl::PointXYZ> filter(true);
  filter.setInputCloud(cloud);
  filter.setViewPoint(0, 0, 0);
  pcl::Indices indices;
  filter.filter(indices);
  ASSERT_EQ(indices.size(), kept.size());
  EXPECT_TRUE(std::equal(indices.begin(), indices.end(), kept.begin()));
  EXPECT_EQ(static_cast<Index>(filter.getRemovedIndices()->size()), gone);
  Cloud output;
  filter.filter(output);
  EXPECT_EQ(output.size(), kept.size());
  EXPECT_TRUE(output.is_dense);
  expectSameFrame(output, *cloud);
  filter.setNegative(true);
  filter.filter(indices);
  EXPECT_EQ(static_cast<Index>(indices.size()), gone - 1); // the one that is not finite goes in both polarities
  EXPECT_EQ(filter.getRemovedIndices()->size(), kept.size() + 1);
  filter.setNegative(false);
  filter.setKeepOrganized(true);
  filter.filter(output);
  EXPECT_EQ(output.size(), cloud->size());
  EXPECT_FALSE(output.is_dense);
  EXPECT_EQ(std::count_if(output.begin(), output.end(), [](const auto& p) { return std::isnan(p.x); }), gone);
}

TEST(VeilPointRemovalClass, TakesTheViewpointFromTheCloudAndHonoursIndices)
{
  const Eigen::Isometry3f motion = test::someMotion();
  const Points points = test::scanWithMixedPixels(0.01f, 0.002f, 1).points;
  const Cloud::Ptr cloud = toCloud((motion.linear() * points).colwise() + motion.translation());
  cloud->sensor_origin_.head<3>() = motion.translation();
  VeilPointRemoval<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  pcl::Indices indices;
  filter.filter(indices);
  EXPECT_NEAR(static_cast<double>(indices.size()),
              static_cast<double>(withoutMixedPixels(points, Eigen::Vector3f::Zero()).size()), 3);
  const auto some = pcl::make_shared<pcl::Indices>(pcl::Indices{5, 6, 7});
  filter.setIndices(some);
  filter.filter(indices);
  EXPECT_EQ(indices, *some); // too few to judge
}

TEST(Outliers, AreThoseOfPcl)
{
  Points points = test::unitSphere(4000, 1).points;
  points.leftCols(30) = 1.5f * test::randomPoints(30, 3).array();
  const Cloud::Ptr cloud = toCloud(points);
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> theirs;
  theirs.setInputCloud(cloud);
  theirs.setMeanK(12);
  theirs.setStddevMulThresh(1.5);
  pcl::Indices truth;
  theirs.filter(truth);
  OutlierOptions options;
  options.k = 12;
  options.sigma = 1.5f;
  const auto kept = withoutOutliers(points, options);
  ASSERT_EQ(kept.size(), truth.size());
  EXPECT_TRUE(std::equal(kept.begin(), kept.end(), truth.begin()));
}
} // namespace
} // namespace fresco
