// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include <fresco/search/nearest_grid.h>
#include <limits>
namespace fresco {
namespace {
// Both say the same of places near the points and far from them.
void expectSame(const Points& points, float reach, float cell, const Points& queries)
{
  const PointTree tree(points);
  const NearestGrid grid(tree, reach, cell);
  EXPECT_EQ(grid.reach(), reach);
  Index found = 0;
  for (Index q = 0; q < queries.cols(); ++q)
    for (const float distance : {0.3f * reach, reach}) {
      const Neighbor truth = tree.nearest(queries.col(q), distance), near = grid.nearest(queries.col(q), distance);
      ASSERT_EQ(near.index < 0, truth.index < 0) << queries.col(q).transpose() << " within " << distance;
      ASSERT_EQ(near.squared_distance, truth.squared_distance);
      if (near.index >= 0) {
        ASSERT_EQ((points.col(near.index) - queries.col(q)).squaredNorm(),
                  (points.col(truth.index) - queries.col(q)).squaredNorm());
        ++found;
      }
    }
  EXPECT_GT(found, 0);
}

Points somePoints()
{
  Points points = test::randomPoints(3000, 1);
  points.row(2).head(2000) = 0.2f * points.row(0).head(2000); // most lie in a plane
  points.col(7).setConstant(test::nan);
  points.col(8) = points.col(9);
  return points;
}

TEST(NearestGrid, FindsWhatTheTreeFinds)
{
  const Points points = somePoints(), queries = test::randomPoints(3000, 2, -1.3f, 1.3f);
  for (const float cell : {0.03f, 0.1f, 0.5f})
    for (const float cells : {1.f, 2.f, 4.f})
      expectSame(points, cells * cell, cell, queries);
}

TEST(NearestGrid, PlacesOnTheEdgesOfCells)
{
  Points points = (10.f * somePoints()).array().round() / 8.f, queries = points;
  queries.row(0).array() += 0.125f;
  queries.row(1).array() -= 0.25f;
  expectSame(points, 0.25f, 0.125f, queries);
  expectSame(points, 0.25f, 0.125f, points);
}

TEST(NearestGrid, FarFromTheOrigin)
{
  const Eigen::Vector3f far(3000.f, -5000.f, 40.f);
  expectSame(somePoints().colwise() + far, 0.2f, 0.1f, test::randomPoints(3000, 2).colwise() + far);
}

TEST(NearestGrid, EmptySetsOddQueriesAndBadInput)
{
  const NearestGrid none(PointTree(Points(3, 0)), 1.f, 0.5f);
  EXPECT_EQ(none.nearest(Eigen::Vector3f::Zero(), 1.f).index, -1);
  const PointTree tree(somePoints());
  const NearestGrid grid(tree, 0.2f, 0.1f);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float x : {test::nan, infinity, -infinity, 1e30f, -1e30f, 2e5f})
    EXPECT_EQ(grid.nearest({x, 0.f, 0.f}, 0.2f).index, -1) << x;
  EXPECT_THROW(NearestGrid(tree, 0.2f, 0.f), std::invalid_argument);
  EXPECT_THROW(NearestGrid(tree, -1.f, 0.1f), std::invalid_argument);
  EXPECT_THROW(NearestGrid(tree, 4.f, 0.1f), std::invalid_argument);
  EXPECT_THROW(NearestGrid(PointTree(Points::Constant(3, 1, 2e5f)), 0.2f, 0.1f), std::invalid_argument);
}
} // namespace
} // namespace fresco
