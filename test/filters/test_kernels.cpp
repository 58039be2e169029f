// SPDX-License-Identifier: BSD-3-Clause
#include "filters/clouds.h"
#include "normals/plane_kernels.h"
#include "search/knn_kernels.h"
#include "search/tree_items.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cstring>
#include <fresco/search/neighbors.h>
#include <numeric>
using namespace fresco::filters;
using namespace fresco::search;
namespace fresco {
namespace {
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Points of uneven density, with repeated points among them.
Points unevenPoints(Index count, unsigned seed)
{
  Points points = test::randomPoints(count, seed).array().cube();
  for (Index i = 0; i < count; i += 7)
    points.col(i) = points.col(i / 2);
  return points;
}

struct KnnResults {
  std::vector<float> squared, x, y, z, boxes, limits, sums;
  std::vector<int> position, only_position, ranks, chosen, close;
  explicit KnnResults(std::size_t room)
      : squared(room), x(room), y(room), z(room), position(room), only_position(room), ranks(room), chosen(room)
  {}
  bool operator==(const KnnResults& o) const
  {
    return squared == o.squared && x == o.x && y == o.y && z == o.z && boxes == o.boxes && limits == o.limits &&
           sums == o.sums && position == o.position && only_position == o.only_position && ranks == o.ranks &&
           chosen == o.chosen && close == o.close;
  }
};

KnnResults runAll(const KnnKernels& kernels, const PointTree& tree, float bound)
{
  const auto leaf_count = static_cast<std::size_t>(tree.leafCount()), stride = (leaf_count + 7) / 8 * 8;
  std::vector<int> leaves(leaf_count);
  std::iota(leaves.begin(), leaves.end(), 0);
  KnnResults r(8 * leaf_count + 16);
  const Eigen::Vector3f query = tree.point(tree.size() / 2);
  const float* coordinates = tree.leafCoordinates();
  const KnnLeaves all = {coordinates, leaves.data(), leaf_count};
  KnnPoints points = {r.squared.data(), r.x.data(), r.y.data(), r.z.data(), r.only_position.data()};
  const std::size_t found = points.count = kernels.closer(all, query.data(), bound, points);
  kernels.rank(r.squared.data(), found, r.ranks.data());
  points.position = r.position.data();
  EXPECT_EQ(kernels.offsets(all, query.data(), bound, points), found);
  for (std::size_t k = 1; k <= found; k = 2 * k + 1) {
    r.limits.push_back(kernels.limit(r.squared.data(), found, k, bound));
    r.sums.resize(r.sums.size() + 10);
    kernels.sum(points, r.limits.back(), r.sums.data() + r.sums.size() - 10, r.chosen.data());
  }
  r.boxes.assign(6 * stride, 0);
  const KnnBoxes boxes = {r.boxes.data(), leaf_count, stride};
  kernels.boxes(coordinates, boxes);
  r.close.resize(stride + 8);
  r.close.resize(kernels.closeBoxes(boxes, leaf_count / 2, bound, r.close.data()));
  for (auto* values : {&r.squared, &r.x, &r.y, &r.z})
    values->resize(found);
  for (auto* values : {&r.position, &r.only_position, &r.ranks})
    values->resize(found);
  r.chosen.clear(); // what is behind those chosen may differ
  return r;
}

TEST(KnnKernels, TheFastOnesGiveTheSameBits)
{
  if (!avx2KnnKernels())
    GTEST_SKIP() << "no AVX2";
  for (const Index count : {5, 64, 1001}) {
    const PointTree tree(unevenPoints(count, 6));
    for (const float bound : {0.f, 1e-4f, 0.01f, 0.3f, 100.f})
      EXPECT_TRUE(runAll(*avx2KnnKernels(), tree, bound) == runAll(portableKnnKernels(), tree, bound)) << bound;
  }
}

TEST(KnnKernels, RankCountsSmallerValuesAndLimitLeavesThatMany)
{
  const Points random = test::randomPoints(60, 3, 0, 1);
  for (const std::size_t count : {1, 7, 8, 20, 33, 60}) {
    std::vector<float> values(random.data(), random.data() + count);
    values.resize(count + 8);
    std::vector<int> ranks(count + 8);
    knnKernels().rank(values.data(), count, ranks.data());
    for (std::size_t k = 1; k <= count; ++k) {
      const auto below = [&](float limit) {
        return static_cast<std::size_t>(std::count_if(
            values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), [&](float v) { return v < limit; }));
      };
      EXPECT_EQ(static_cast<std::size_t>(ranks[k - 1]), below(values[k - 1]));
      EXPECT_EQ(below(knnKernels().limit(values.data(), count, k, 2.f)), k);
    }
  }
  std::vector<float> equal(28, 0.5f);
  EXPECT_LT(knnKernels().limit(equal.data(), 20, 7, 2.f), 0);
  EXPECT_EQ(knnKernels().limit(equal.data(), 20, 20, 2.f), 2.f);
}

TEST(KnnKernels, CloseBoxesMissNoLeafWithinReach)
{
  const PointTree tree(unevenPoints(800, 2));
  const auto count = static_cast<std::size_t>(tree.leafCount()), stride = (count + 7) / 8 * 8;
  std::vector<float> ends(6 * stride);
  std::vector<int> close(stride + 8);
  const KnnBoxes boxes = {ends.data(), count, stride};
  knnKernels().boxes(tree.leafCoordinates(), boxes);
  for (const std::size_t center : {0ul, 17ul, count - 1})
    for (const float reach : {0.f, 0.05f, 0.4f}) {
      const std::size_t found = knnKernels().closeBoxes(boxes, center, reach, close.data());
      for (Index i = 0; i < tree.size(); ++i)
        for (Index j = 8 * static_cast<Index>(center); j < std::min(tree.size(), 8 * static_cast<Index>(center) + 8);
             ++j)
          if ((tree.point(i) - tree.point(j)).norm() < 0.9999f * reach) {
            EXPECT_TRUE(std::binary_search(close.begin(), close.begin() + static_cast<std::ptrdiff_t>(found),
                                           static_cast<int>(i / 8)));
          }
    }
}

/// Sums over sets of points: spread as surfaces, as blobs, and on a line, coincident and none.
EightMoments someMoments(unsigned seed, std::vector<Points>& sets)
{
  EightMoments moments = {};
  for (unsigned s = 0; s < 8; ++s) {
    Points set = test::randomPoints(s == 7 ? 0 : 16 + s, seed + s);
    if (s < 3)
      set = Eigen::AngleAxisf(1.3f * static_cast<float>(s + seed), Eigen::Vector3f(1, 2, -1).normalized())
                .toRotationMatrix() *
            Points(Eigen::Vector3f(1, 0.6f, 0.02f * static_cast<float>(s)).asDiagonal() * set);
    if (s == 5)
      set.bottomRows(2).setZero();
    if (s == 6)
      set.setConstant(0.25f);
    moments.weight[s] = static_cast<float>(set.cols());
    for (Index i = 0; i < set.cols(); ++i) {
      const Eigen::Vector3f p = set.col(i);
      const float terms[9] = {p[0],        p[1],        p[2],        p[0] * p[0], p[0] * p[1],
                              p[0] * p[2], p[1] * p[1], p[1] * p[2], p[2] * p[2]};
      for (int t = 0; t < 9; ++t)
        moments.sums[t][s] += terms[t];
    }
    sets.push_back(set);
  }
  return moments;
}

TEST(PlaneKernels, FitIsThePlaneOfLeastVariance)
{
  for (const unsigned seed : {1u, 20u, 300u}) {
    std::vector<Points> sets;
    const EightMoments moments = someMoments(seed, sets);
    EightPlanes planes;
    planeKernels().fit(moments, planes);
    EXPECT_EQ(planes.planes, 0x1fu); // a line, a point and nothing are none
    for (unsigned s = 0; s < 5; ++s) {
      const Eigen::Vector3f mean = sets[s].rowwise().mean();
      const Points centered = sets[s].colwise() - mean;
      const Eigen::Matrix3d A = (centered * centered.transpose()).cast<double>() / static_cast<double>(sets[s].cols());
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> truth(A);
      const Eigen::Vector3d normal(planes.normal[0][s], planes.normal[1][s], planes.normal[2][s]);
      EXPECT_NEAR(normal.norm(), 1, 1e-6);
      EXPECT_NEAR(std::abs(normal.dot(truth.eigenvectors().col(0))), 1, 1e-6);
      EXPECT_NEAR(planes.curvature[s], truth.eigenvalues()[0] / A.trace(), 2e-6);
      EXPECT_NEAR(planes.variance[s], truth.eigenvalues()[0], 3e-6 * A.trace());
      EXPECT_LT((Eigen::Vector3f(planes.center[0][s], planes.center[1][s], planes.center[2][s]) - mean).norm(), 1e-6f);
    }
  }
}

TEST(PlaneKernels, TheFastOnesGiveTheSameBits)
{
  if (!avx2PlaneKernels())
    GTEST_SKIP() << "no AVX2";
  const PlaneKernels &fast = *avx2PlaneKernels(), &slow = portablePlaneKernels();
  std::vector<Points> sets;
  const EightMoments moments = someMoments(7, sets);
  EightPlanes a, b;
  fast.fit(moments, a);
  slow.fit(moments, b);
  ASSERT_EQ(a.planes, b.planes);
  for (unsigned s = 0; s < 8; ++s)
    if (a.planes >> s & 1u) {
      for (const auto member : {&EightPlanes::normal, &EightPlanes::center})
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_EQ((a.*member)[axis][s], (b.*member)[axis][s]);
    }
  for (unsigned s = 0; s < 5; ++s) {
    EXPECT_EQ(a.variance[s], b.variance[s]);
    EXPECT_EQ(a.curvature[s], b.curvature[s]);
  }
  Points random = test::randomPoints(400, 9);
  std::vector<float> rows(random.data(), random.data() + 1200);
  for (std::size_t row = 0; row < 150; ++row)
    rows[8 * row + 3] = row % 10 == 0 ? infinity : std::abs(rows[8 * row + 3]);
  for (const std::size_t count : {1, 8, 16, 21}) {
    std::vector<std::uint16_t> list(count);
    for (std::size_t j = 0; j < count; ++j)
      list[j] = static_cast<std::uint16_t>(37 * j % 60);
    const BestPlane one = fast.best(rows.data(), list.data(), count, rows.data() + 8, random.data() + 3);
    const BestPlane other = slow.best(rows.data(), list.data(), count, rows.data() + 8, random.data() + 3);
    EXPECT_EQ(one.score, other.score);
    EXPECT_EQ(one.closest, other.closest);
    EXPECT_EQ(one.which, other.which);
    const WeightedPoints points = {random.data(), random.data() + 400, random.data() + 801, count};
    std::array<float, 10> sums, same_sums;
    fast.weightedSums(points, random.data(), -3.f, sums.data());
    slow.weightedSums(points, random.data(), -3.f, same_sums.data());
    EXPECT_EQ(sums, same_sums);
  }
}

TEST(TreeItems, SelectMiddlePutsTheSmallerHalfFirst)
{
  for (const Index count : {1, 9, 16, 33, 300, 5000})
    for (const int kinds : {1, 3, 100000}) { // different values
      std::vector<TreeItem> items(count);
      for (Index i = 0; i < count; ++i)
        items[i] = {{0, static_cast<float>(i * 7919 % count % kinds), 0}, static_cast<int>(i)};
      TreeItem *begin = items.data(), *end = begin + count, *middle = begin + count / 2;
      selectMiddle(begin, middle, end, 1);
      const auto less = [](const TreeItem& a, const TreeItem& b) { return a.x[1] < b.x[1]; };
      if (middle > begin) {
        EXPECT_LE(std::max_element(begin, middle, less)->x[1], std::min_element(middle, end, less)->x[1]);
      }
      std::vector<bool> seen(items.size());
      for (const TreeItem& item : items)
        seen[item.column] = true;
      EXPECT_EQ(std::count(seen.begin(), seen.end(), true), count);
    }
}
} // namespace
} // namespace fresco
