// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/ranks/reconstruct_part.h"
#include "surface/poisson/volumetric_shapes.h"
#include "thread_ranks.h"
#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <initializer_list>
#include <limits>
#include <random>
namespace fresco::test {
namespace {
/// Every n-th point, in windows.
class Share : public PointStream {
public:
  Share(const PointSet& set, int rank, int ranks) : set_(set)
  {
    for (Index i = rank; i < set.size(); i += ranks)
      indices_.push_back(i);
  }

  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    constexpr Index window = 7000;
    for (auto begin = indices_.begin(); begin != indices_.end();) {
      const auto end = begin + std::min<Index>(window, indices_.end() - begin);
      receive(selectPoints(set_, std::vector<Index>(begin, end)));
      begin = end;
    }
  }

private:
  const PointSet& set_;
  std::vector<Index> indices_;
};

std::vector<VolumetricPart> partsOf(const PointSet& points, const VolumetricOptions& options, int ranks,
                                    const poisson::RankOptions& division)
{
  std::vector<VolumetricPart> parts(ranks);
  ThreadRanks::run(ranks, [&](Exchange& exchange) {
    parts[exchange.rank()] = poisson::reconstructPart(std::make_unique<Share>(points, exchange.rank(), ranks), options,
                                                      {}, division, exchange);
  });
  return parts;
}

/// Puts the columns of a part where they belong. @return how many there are
template <typename Matrix>
Index place(const Matrix& part, const std::vector<VolumetricPart::Run>& runs, Matrix& whole)
{
  Index at = 0;
  for (const VolumetricPart::Run& run : runs) {
    whole.middleCols(run.first, run.count) = part.middleCols(at, run.count);
    at += run.count;
  }
  EXPECT_EQ(at, part.cols());
  return at;
}

TriangleMesh joined(const std::vector<VolumetricPart>& parts)
{
  TriangleMesh mesh;
  const TriangleMesh& first = parts[0].result.mesh;
  mesh.origin = first.origin;
  const Index n = parts[0].vertex_count;
  mesh.vertices.setConstant(3, n, -1e30f);
  mesh.faces.setConstant(3, parts[0].face_count, -1);
  if (std::any_of(parts.begin(), parts.end(), [](const VolumetricPart& p) { return p.result.mesh.colors.cols() > 0; }))
    mesh.colors.setZero(3, n);
  Index vertices = 0, faces = 0;
  for (const VolumetricPart& part : parts) {
    const TriangleMesh& own = part.result.mesh;
    vertices += place(own.vertices, part.vertices, mesh.vertices);
    faces += place(own.faces, part.faces, mesh.faces);
    if (mesh.colors.cols() > 0)
      place(own.colors, part.vertices, mesh.colors);
    for (const auto& [name, values] : own.fields) {
      Eigen::RowVectorXf whole = mesh.fields[name].size() == n ? mesh.fields[name].transpose().eval()
                                                               : Eigen::RowVectorXf::Constant(n, -1e30f);
      place(Eigen::RowVectorXf(values.transpose()), part.vertices, whole);
      mesh.fields[name] = whole.transpose();
    }
    EXPECT_EQ(part.vertex_count, n);
    EXPECT_EQ(part.face_count, mesh.faceCount());
  }
  EXPECT_EQ(vertices, n);
  EXPECT_EQ(faces, mesh.faceCount());
  return mesh;
}

std::vector<std::uint64_t> randomRanges(int ranks, int shared_depth, std::mt19937& random)
{
  std::vector<std::uint64_t> first(1, 0);
  for (int r = 1; r < ranks; ++r)
    first.push_back(random() % poisson::Partition::atomCount(shared_depth));
  std::sort(first.begin(), first.end());
  return first;
}

void expectSame(const VolumetricResult& expected, const std::vector<VolumetricPart>& parts)
{
  const TriangleMesh mesh = joined(parts);
  for (const VolumetricPart& part : parts) {
    EXPECT_EQ(part.result.used_points, expected.used_points);
    EXPECT_EQ(part.result.left_out_points, expected.left_out_points);
    EXPECT_EQ(part.result.residual, expected.residual);
    EXPECT_EQ(part.result.cells, expected.cells);
    EXPECT_EQ(part.result.cell_size, expected.cell_size);
    EXPECT_EQ(part.result.trim_depth, expected.trim_depth);
  }
  ASSERT_EQ(mesh.vertexCount(), expected.mesh.vertexCount());
  ASSERT_EQ(mesh.faceCount(), expected.mesh.faceCount());
  EXPECT_EQ(mesh.origin, expected.mesh.origin);
  EXPECT_TRUE(mesh.vertices == expected.mesh.vertices);
  EXPECT_TRUE(mesh.faces == expected.mesh.faces);
  ASSERT_EQ(mesh.colors.cols(), expected.mesh.colors.cols());
  EXPECT_TRUE(mesh.colors == expected.mesh.colors);
  ASSERT_EQ(mesh.fields.size(), expected.mesh.fields.size());
  for (const auto& [name, values] : expected.mesh.fields)
    EXPECT_TRUE(mesh.fields.at(name) == values) << name;
}

/// The same bytes on any number of ranks and for any ranges.
void expectSameOnRanks(const PointSet& points, VolumetricOptions options, int shared_depth,
                       std::initializer_list<int> numbers)
{
  std::mt19937 random(static_cast<unsigned>(points.size()));
  options.threads = 1;
  poisson::Ghosts::poison = true;
  const VolumetricResult expected = reconstructVolumetric(points, options);
  for (const int ranks : numbers) {
    SCOPED_TRACE(ranks);
    poisson::RankOptions division;
    division.shared_depth = shared_depth;
    if (ranks == 3)
      expectSame(expected, partsOf(points, options, ranks, division));
    division.first_atoms = randomRanges(ranks, shared_depth, random);
    expectSame(expected, partsOf(points, options, ranks, division));
  }
}

VolumetricOptions withDepths(int depth, int min_depth)
{
  VolumetricOptions options;
  options.depth = depth;
  options.min_depth = min_depth;
  return options;
}

/// Points with noise across the surface, all attributes, and some that cannot be used.
PointSet attributedTorus(Index count, float noise)
{
  PointSet set = torus(count, 0.3, 7);
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0.f, noise);
  std::uniform_real_distribution<float> unit(0.f, 1.f);
  for (Index i = 0; i < count; ++i)
    set.points.col(i) += normal(random) * set.normals.col(i);
  set.colors = (set.normals.array() * 127.f + 128.f).cast<std::uint8_t>();
  set.intensities = Eigen::VectorXf::NullaryExpr(count, [&] { return 4000.f * unit(random) - 900.f; });
  set.confidences = Eigen::VectorXf::NullaryExpr(count, [&] { return std::exp(3.f * unit(random)); });
  set.points.leftCols(3) *= 1000.f;
  set.points(1, 100) = std::numeric_limits<float>::quiet_NaN();
  set.confidences[300] = 0.f;
  return set;
}

PointSet part(const PointSet& set, const std::function<bool(const Eigen::Vector3f&)>& takes)
{
  std::vector<Index> indices;
  for (Index i = 0; i < set.size(); ++i)
    if (takes(set.points.col(i)))
      indices.push_back(i);
  return selectPoints(set, indices);
}

TEST(VolumetricRanks, SphereIsTheSame) { expectSameOnRanks(sphere(20000), withDepths(7, 4), 5, {1, 2, 3, 4, 5, 6, 7}); }

TEST(VolumetricRanks, SparseBoxWithLeavesOfManySizesIsTheSame)
{
  expectSameOnRanks(box(3000, 2), withDepths(8, 3), 5, {3, 6});
}

TEST(VolumetricRanks, AttributesNoiseAndWeightsAreTheSame)
{
  VolumetricOptions options = withDepths(8, 5);
  options.confidence = true;
  expectSameOnRanks(attributedTorus(30000, 0.f), options, 6, {2, 5});
  expectSameOnRanks(attributedTorus(30000, 0.01f), options, 5, {4, 7});
}

TEST(VolumetricRanks, ScatteredPointsAndThinSheetsAreTheSame)
{
  PointSet points = sheet(30000, 0.005f);
  std::mt19937 random(5);
  std::normal_distribution<float> offset(0.f, 0.002f);
  for (Index i = 0; i < points.size(); ++i)
    points.points(0, i) += offset(random);
  addScattered(points, 1500, 0.7f);
  expectSameOnRanks(points, withDepths(8, 3), 5, {2, 5});
}

TEST(VolumetricRanks, SurfaceClosedFarFromPointsIsTheSame)
{
  const PointSet open = part(sphere(20000), [](const Eigen::Vector3f& p) { return p.z() > 0.2f || p.x() < -0.3f; });
  expectSameOnRanks(open, withDepths(7, 2), 5, {3, 7});
}

/// Rank 0 trims the whole mesh, with all attributes.
TEST(VolumetricRanks, TrimmedOpenSurfaceIsTheSame)
{
  const auto isTaken = [](const Eigen::Vector3f& p) { return p.x() < 0.4f && p.norm() < 10.f; };
  const PointSet open = part(attributedTorus(20000, 0.f), isTaken);
  VolumetricOptions options = withDepths(7, 5);
  options.trim_levels = 1.5f;
  const VolumetricResult closed = reconstructVolumetric(open, withDepths(7, 5));
  EXPECT_LT(reconstructVolumetric(open, options).mesh.faceCount(), closed.mesh.faceCount());
  expectSameOnRanks(open, options, 5, {2, 3, 7});
  options.trim_levels = 0.f;
  options.trim = 5.5f;
  expectSameOnRanks(part(sphere(20000), isTaken), options, 5, {4});
}

/// Single points with random normals make components that are removed, some of them on several ranks.
TEST(VolumetricRanks, SmallComponentsAreRemovedAlike)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<float> unit(-1.2f, 1.2f);
  PointSet set = sphere(15000);
  for (Index i = 0; i < 300; ++i) {
    set.points.col(i) = Eigen::Vector3f::NullaryExpr([&] { return unit(random); });
    set.normals.col(i) = Eigen::Vector3f::NullaryExpr([&] { return unit(random); }).normalized();
  }
  expectSameOnRanks(set, withDepths(7, 4), 5, {3, 5});
}

TEST(VolumetricRanks, RankZeroMakesShallowOctrees)
{
  const PointSet points = attributedTorus(5000, 0.f);
  VolumetricOptions options = withDepths(6, 5);
  const VolumetricResult expected = reconstructVolumetric(points, options);
  const std::vector<VolumetricPart> parts = partsOf(points, options, 3, {});
  expectSame(expected, parts);
  EXPECT_EQ(parts[1].result.mesh.vertexCount(), 0);
  options.trim = 4.f;
  expectSame(reconstructVolumetric(points, options), partsOf(points, options, 3, {}));
}

TEST(VolumetricRanks, RanksWithoutPointsTakePart)
{
  const PointSet points = attributedTorus(10000, 0.f);
  const VolumetricOptions options = withDepths(7, 5);
  poisson::RankOptions division;
  division.shared_depth = 5;
  std::vector<VolumetricPart> parts(4);
  ThreadRanks::run(4, [&](Exchange& exchange) {
    const PointSet none;
    const PointSet& own = exchange.rank() == 2 ? points : none;
    parts[exchange.rank()] =
        poisson::reconstructPart(std::make_unique<Share>(own, 0, 1), options, {}, division, exchange);
  });
  expectSame(reconstructVolumetric(points, options), parts);
}

TEST(VolumetricRanks, WhatAllRanksRefuse)
{
  poisson::RankOptions division;
  division.shared_depth = 5;
  const PointSet points = sphere(2000), none;
  EXPECT_THROW(partsOf(points, withDepths(7, 6), 2, division), std::invalid_argument);
  EXPECT_THROW(partsOf(none, withDepths(7, 5), 2, division), std::invalid_argument);
}

/// Attributes that only some ranks' points have.
TEST(VolumetricRanks, UnlikePointsAreRefused)
{
  PointSet plain = sphere(2000), colored = plain;
  colored.colors.setZero(3, colored.size());
  const auto run = [&](Exchange& exchange) {
    const PointSet& own = exchange.rank() == 0 ? plain : colored;
    poisson::reconstructPart(std::make_unique<Share>(own, 0, 1), withDepths(5, 4), {}, {}, exchange);
  };
  EXPECT_THROW(ThreadRanks::run(2, run), std::invalid_argument);
}
} // namespace
} // namespace fresco::test
