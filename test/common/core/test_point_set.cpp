// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <fresco/core/point_set.h>
#include <fresco/core/point_table.h>
#include <gtest/gtest.h>
namespace {
using namespace fresco;

PointSet randomSet(Index n, Index viewpoints)
{
  PointSet set;
  set.points = Points::Random(3, n);
  set.normals = Points::Random(3, n).colwise().normalized();
  set.colors = Colors::Random(3, n);
  set.intensities = Eigen::VectorXf::Random(n);
  set.confidences = Eigen::VectorXf::Random(n).cwiseAbs();
  set.viewpoints = Points::Random(3, viewpoints);
  return set;
}

TEST(PointSet, SelectKeepsEverythingInOrder)
{
  const PointSet set = randomSet(20, 20);
  const PointSet some = selectPoints(set, {7, 3, 3});
  ASSERT_EQ(some.size(), 3);
  EXPECT_EQ(some.points.col(0), set.points.col(7));
  EXPECT_EQ(some.normals.col(1), set.normals.col(3));
  EXPECT_EQ(some.colors.col(2), set.colors.col(3));
  EXPECT_EQ(some.intensities[0], set.intensities[7]);
  EXPECT_EQ(some.viewpoints.col(1), set.viewpoints.col(3));
  EXPECT_THROW(selectPoints(set, {20}), std::invalid_argument);
  EXPECT_THROW(selectPoints(set, {-1}), std::invalid_argument);
}

TEST(PointSet, MergeKeepsViewpointOfEachPoint)
{
  const PointSet a = randomSet(5, 1), b = randomSet(4, 1);
  const PointSet both = mergePoints(a, b);
  ASSERT_EQ(both.size(), 9);
  ASSERT_EQ(both.viewpoints.cols(), 9);
  EXPECT_EQ(both.viewpoints.col(4), a.viewpoints.col(0));
  EXPECT_EQ(both.viewpoints.col(5), b.viewpoints.col(0));
  EXPECT_EQ(both.intensities[8], b.intensities[3]);
  EXPECT_EQ(mergePoints(a, a).viewpoints.cols(), 1);
}

TEST(PointSet, MergeMeetsDifferentOrigins)
{
  PointSet a = randomSet(3, 1), b = randomSet(2, 0);
  a.origin = {500000.0, 4000000.0, 100.0};
  b.origin = {500010.0, 4000000.0, 90.0};
  const PointSet both = mergePoints(a, b);
  EXPECT_EQ(both.origin, a.origin);
  EXPECT_TRUE(both.points.col(3).isApprox(b.points.col(0) + Eigen::Vector3f(10, 0, -10), 1e-6f));
  EXPECT_EQ(both.viewpoints.cols(), 0);
}

TEST(PointSet, MergeDropsWhatOneLacks)
{
  PointSet a = randomSet(3, 3), b = randomSet(2, 2);
  b.colors.resize(3, 0);
  EXPECT_EQ(mergePoints(a, b).colors.cols(), 0);
  EXPECT_EQ(mergePoints(a, PointSet()).size(), 3);
  EXPECT_EQ(mergePoints(PointSet(), b).size(), 2);
}

TEST(PointSet, TransformThereAndBack)
{
  const PointSet set = randomSet(50, 50);
  Eigen::Isometry3d T = Eigen::Translation3d(1, -2, 3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const PointSet moved = transformPoints(set, T.matrix());
  EXPECT_TRUE(moved.normals.isApprox((T.linear() * set.normals.cast<double>()).cast<float>(), 1e-5f));
  const PointSet back = transformPoints(moved, T.inverse().matrix());
  EXPECT_TRUE(back.points.isApprox(set.points, 1e-5f));
  EXPECT_TRUE(back.viewpoints.isApprox(set.viewpoints, 1e-5f));
  EXPECT_TRUE(back.normals.isApprox(set.normals, 1e-5f));
}

TEST(PointSet, ValidateChecksCounts)
{
  PointSet set = randomSet(5, 1);
  EXPECT_NO_THROW(validatePointSet(set));
  set.viewpoints.resize(3, 4);
  EXPECT_THROW(validatePointSet(set), std::invalid_argument);
}
TEST(PointTable, FurtherColumnsAreFieldsOfAMesh)
{
  using namespace core;
  PointTable table;
  for (const char* name : xyz_names)
    table.addColumn(name, Scalar::float32);
  table.addColumn("quality", Scalar::float32);
  table.addColumn("uv", Scalar::float32, 2);
  table.allocate(2);
  for (Index row = 0; row < 2; ++row)
    for (std::size_t k = 0; k < 6; ++k)
      reinterpret_cast<float*>(table.data.data())[6 * row + k] = float(10 * row + k);
  const TriangleMesh mesh = tableToMesh(table);
  EXPECT_EQ(mesh.fields.size(), 3U);
  for (const auto& [name, column] : {std::pair("quality", 3), std::pair("uv_0", 4), std::pair("uv_1", 5)}) {
    ASSERT_EQ(mesh.fields.count(name), 1U) << name;
    EXPECT_EQ(mesh.fields.at(name), Eigen::Vector2f(column, 10 + column));
  }
}
} // namespace
