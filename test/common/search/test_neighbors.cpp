// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include <algorithm>
#include <fresco/filters/core/local_sampling.h>
#include <fresco/search/batch_knn.h>
#include <fresco/search/compressed_neighbor_lists.h>
#include <fresco/search/neighbors.h>
#include <numeric>
namespace fresco {
namespace {
using test::nan;

/// Points of uneven density, with equal coordinates and repeated points among them.
Points unevenPoints(Index count, unsigned seed)
{
  Points points = test::randomPoints(count, seed).array().cube();
  for (Index i = 0; i < count; i += 7)
    points.col(i) = points.col(i / 2);
  points.row(1).head(count / 4).setConstant(0.25f);
  return points;
}

std::vector<float> sortedDistances(const Points& points, const Eigen::Vector3f& query)
{
  std::vector<float> distances;
  for (Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite())
      distances.push_back((points.col(i) - query).squaredNorm());
  std::sort(distances.begin(), distances.end());
  return distances;
}

void expectDistances(const std::vector<Neighbor>& found, const Points& points, const Eigen::Vector3f& query)
{
  const std::vector<float> truth = sortedDistances(points, query);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].squared_distance, truth[i], 1e-6f * truth[i]);
    EXPECT_NEAR((points.col(found[i].index) - query).squaredNorm(), truth[i], 1e-6f * truth[i]);
  }
}

TEST(PointTree, FindsWhatASearchOfAllPointsFinds)
{
  for (const Index count : {1, 2, 7, 8, 9, 17, 500, 3000}) {
    Points points = unevenPoints(count, 3);
    if (count > 100)
      points.col(11).setConstant(nan);
    const PointTree tree(points);
    const Points queries = test::randomPoints(40, 5, -1.5f, 1.5f);
    std::vector<Neighbor> found;
    for (Index q = 0; q < queries.cols(); ++q) {
      const Eigen::Vector3f query = q % 2 ? Eigen::Vector3f(queries.col(q)) : Eigen::Vector3f(points.col(q % count));
      if (!query.allFinite())
        continue;
      for (const int k : {1, 5, 40}) {
        tree.nearest(query, k, found);
        EXPECT_EQ(static_cast<Index>(found.size()), std::min<Index>(k, tree.size()));
        expectDistances(found, points, query);
      }
      EXPECT_EQ(tree.nearest(query).squared_distance, found.front().squared_distance);
      tree.within(query, 0.4f, found);
      const auto truth = sortedDistances(points, query);
      EXPECT_EQ(static_cast<std::ptrdiff_t>(found.size()),
                std::upper_bound(truth.begin(), truth.end(), 0.16f) - truth.begin());
      expectDistances(found, points, query);
    }
  }
}

TEST(PointTree, EmptySetsAndOddQueries)
{
  const PointTree none(Points(3, 0)), bad(Points::Constant(3, 20, nan));
  std::vector<Neighbor> found(3);
  for (const PointTree* tree : {&none, &bad}) {
    EXPECT_EQ(tree->size(), 0);
    EXPECT_EQ(tree->nearest(Eigen::Vector3f::Zero()).index, -1);
    tree->nearest(Eigen::Vector3f::Zero(), 3, found);
    EXPECT_TRUE(found.empty());
    EXPECT_EQ(nearestLists(*tree, 5).size(), 0);
  }
  const PointTree tree(test::randomPoints(100, 1));
  EXPECT_EQ(tree.nearest(Eigen::Vector3f::Constant(nan)).index, -1);
  EXPECT_EQ(tree.nearest(Eigen::Vector3f::Constant(9), 1.f).index, -1);
  EXPECT_THROW(tree.nearest(Eigen::Vector3f::Zero(), 0, found), std::invalid_argument);
  EXPECT_THROW(tree.within(Eigen::Vector3f::Zero(), nan, found), std::invalid_argument);
  EXPECT_THROW(nearestLists(tree, 0), std::invalid_argument);
  EXPECT_THROW(nearestLists(tree, -1), std::invalid_argument);
  EXPECT_THROW(radiusLists(tree, Eigen::VectorXf::Ones(5), 10), std::invalid_argument);
  EXPECT_THROW(radiusLists(tree, -Eigen::VectorXf::Ones(1), 10), std::invalid_argument);
}

TEST(PointTree, ManyEqualPointsAndHugeCoordinatesEnd)
{
  Points points = Points::Zero(3, 200000);
  points.col(5).setConstant(3e38f);
  points.col(6).setConstant(-3e38f);
  const PointTree tree(points);
  const NeighborLists lists = nearestLists(tree, 8);
  for (Index i = 0; i < lists.size(); i += 1000)
    EXPECT_EQ(lists.count(i), 8);
  EXPECT_TRUE(sampleAreas(tree).allFinite());
  EXPECT_GT(sampleAreas(tree).minCoeff(), 0);
}

TEST(PointTree, PointWithoutOthersInRangeIsItsOwnNeighbourAtNoDistance)
{
  Points points(3, 2);
  points << 3e38f, -3e38f, 3e38f, -3e38f, 3e38f, -3e38f;
  const PointTree tree(points);
  BatchKnn group(tree);
  group.enter(0, 1);
  group.gather(group.expectedReach(2), 100);
  for (Index i = 0; i < 2; ++i) {
    group.nearest(i, 2);
    int positions[2] = {-1, -1};
    group.ordered(positions);
    EXPECT_EQ(positions[0], i);
    EXPECT_EQ(positions[1], i);
    float sums[10];
    group.sum(sums);
    EXPECT_EQ(sums[9], 0.f) << "largest squared distance";
  }
}

TEST(PointTree, ListsHoldThePointAndDoNotDependOnThreads)
{
  const PointTree tree(unevenPoints(30000, 9), 1), same_tree(unevenPoints(30000, 9), 4);
  EXPECT_EQ(tree.columns(), same_tree.columns());
  const NeighborLists one = nearestLists(tree, 12, 1), four = nearestLists(tree, 12, 4);
  EXPECT_EQ(one.index, four.index);
  const Eigen::VectorXf radii = Eigen::VectorXf::Constant(1, 0.02f);
  const NeighborLists near_one = radiusLists(tree, radii, 20, 1), near_four = radiusLists(tree, radii, 20, 4);
  EXPECT_EQ(near_one.index, near_four.index);
  EXPECT_EQ(near_one.begin, near_four.begin);
  for (Index i = 0; i < tree.size(); i += 100) {
    EXPECT_NE(std::find(near_one.first(i), near_one.last(i), i), near_one.last(i));
    EXPECT_LE(near_one.count(i), 21);
    for (const int* j = near_one.first(i); j != near_one.last(i); ++j)
      EXPECT_LE((tree.point(*j) - tree.point(i)).norm(), 0.02f * 1.00001f);
    std::vector<Neighbor> found;
    tree.nearest(tree.point(i), 12, found);
    for (int k = 0; k < 12; ++k)
      EXPECT_NEAR((tree.point(one.first(i)[k]) - tree.point(i)).squaredNorm(), found[k].squared_distance, 1e-8f);
  }
}

/// Positions of the k nearest of point i, by distance, then position.
std::vector<int> nearestOfAll(const PointTree& tree, Index i, std::size_t k)
{
  std::vector<PointTree::Key> keys;
  for (Index j = 0; j < tree.size(); ++j) {
    const Eigen::Vector3f d = tree.point(j) - tree.point(i);
    keys.push_back(PointTree::key(d.x() * d.x() + d.y() * d.y() + d.z() * d.z(), j));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> positions;
  for (std::size_t j = 0; j < std::min(k, keys.size()); ++j)
    positions.push_back(PointTree::position(keys[j]));
  return positions;
}

TEST(PointTree, NearestListsAreThoseOfASearchOfAllPoints)
{
  Points grid(3, 900); // many points at the same distance
  for (Index i = 0; i < grid.cols(); ++i)
    grid.col(i) << static_cast<float>(i % 30), static_cast<float>(i / 30), 0.f;
  Points far = unevenPoints(2000, 4);
  far.rightCols(1000).colwise() += Eigen::Vector3f(50, 0, 0);
  for (const Points& points : {grid, far, unevenPoints(700, 5)}) {
    const PointTree tree(points);
    for (const int k : {1, 9, 16, 150}) {
      const NeighborLists lists = nearestLists(tree, k);
      for (Index i = 0; i < tree.size(); i += 3)
        EXPECT_EQ(std::vector<int>(lists.first(i), lists.last(i)), nearestOfAll(tree, i, static_cast<std::size_t>(k)));
    }
  }
}

std::vector<int> withinOfAll(const PointTree& tree, Index i, float radius)
{
  std::vector<int> positions;
  for (Index j = 0; j < tree.size(); ++j) {
    const Eigen::Vector3f d = tree.point(j) - tree.point(i);
    if (d.x() * d.x() + d.y() * d.y() + d.z() * d.z() <= radius * radius)
      positions.push_back(static_cast<int>(j));
  }
  return positions;
}

TEST(PointTree, RadiusListsAreThoseOfASearchOfAllPoints)
{
  Points far = unevenPoints(6000, 4);
  far.rightCols(1000).colwise() += Eigen::Vector3f(50, 0, 0);
  const PointTree tree(far);
  Eigen::VectorXf radii(tree.size()); // of which some hold more leaves than are searched at once
  for (Index i = 0; i < radii.size(); ++i)
    radii[i] = i % 900 == 0 ? 100.f : 0.01f * static_cast<float>(i % 11);
  const NeighborLists lists = radiusLists(tree, radii, 10000);
  for (Index i = 0; i < tree.size(); i += 15)
    EXPECT_EQ(std::vector<int>(lists.first(i), lists.last(i)), withinOfAll(tree, i, radii[i]));
}

TEST(PointTree, CompressedListsHoldTheSame)
{
  for (const Index count : {0, 1, 9, 5000}) {
    const PointTree tree(unevenPoints(count, 8));
    for (const float radius : {0.f, 0.05f, 10.f})
      for (const int most : {1, 20, 300}) {
        const Eigen::VectorXf radii = Eigen::VectorXf::Constant(1, radius);
        const NeighborLists lists = radiusLists(tree, radii, most);
        Index i = 0;
        std::vector<int> found;
        for (const CompressedLists& range : compressedRadiusLists(tree, radii, most, 2)) {
          EXPECT_EQ(range.begin, i);
          CompressedReader reader(range);
          for (; i < range.end; ++i) {
            reader.next(found);
            ASSERT_EQ(found, std::vector<int>(lists.first(i), lists.last(i)));
            EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
          }
        }
        EXPECT_EQ(i, tree.size());
      }
  }
}

TEST(PointTree, ImageListsAreTheNearestAroundAPixel)
{
  const Index width = 40, height = 30;
  Points image(3, width * height);
  for (Index i = 0; i < image.cols(); ++i)
    image.col(i) << 0.1f * static_cast<float>(i % width), 0.1f * static_cast<float>(i / width), 0.f;
  image.col(5 * width + 5).setConstant(nan);
  const NeighborLists lists = imageLists(image, width, 9);
  ASSERT_EQ(lists.size(), image.cols());
  EXPECT_EQ(lists.count(5 * width + 5), 0);
  const Index inner = 20 * width + 20;
  for (const int* j = lists.first(inner); j != lists.last(inner); ++j)
    EXPECT_LE((image.col(*j) - image.col(inner)).norm(), 0.15f);
  EXPECT_EQ(lists.count(inner), 9);
  EXPECT_EQ(lists.count(0), 9);
  EXPECT_EQ(lists.index, imageLists(image, width, 9, 3).index);
  EXPECT_THROW(imageLists(image, 7, 9), std::invalid_argument);
}

TEST(SampleAreas, AddUpToTheAreaAtAnyDensity)
{
  for (const Index count : {2000, 50000}) {
    const PointTree tree(test::unitSphere(count, 4).points);
    EXPECT_NEAR(sampleAreas(tree).sum(), 12.566f, 0.8f) << count;
  }
}
} // namespace
} // namespace fresco
