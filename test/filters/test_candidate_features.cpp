// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/candidate_score.h"
#include "filters/clouds.h"
#include <algorithm>
#include <random>
using namespace fresco::filters;
namespace fresco {
namespace {
using Eigen::Vector3f;
using Features = NormalCandidateFeatures::Features;

/// Two planes that meet in a ridge along x, seen from above; the point lies on the one that falls towards +y.
std::vector<CandidateNeighbor> besideRidge(const Vector3f& falling_right, const Vector3f& falling_left)
{
  std::mt19937 generator(1);
  std::normal_distribution<float> noise(0, 0.001f);
  std::vector<CandidateNeighbor> neighbors;
  for (int column = -4; column <= 4; ++column)
    for (int row = -4; row <= 4; ++row) {
      const float x = 0.0101f * static_cast<float>(column), y = 0.0103f * static_cast<float>(row) + 0.0147f;
      const Vector3f& normal = y > 0 ? falling_right : falling_left;
      const float z = -y * normal.y() / normal.z() + 0.0147f * falling_right.y() / falling_right.z();
      if (column != 0 || row != 0)
        neighbors.push_back({{x, y - 0.0147f, z + noise(generator)}, normal, row < 2});
    }
  return neighbors;
}

const Vector3f right = Vector3f(0, 1, 1).normalized(), left = Vector3f(0, -1, 1).normalized(), down(0, 0, -1);

TEST(NormalCandidateFeatures, ChangeNeitherWithTheFrameNorTheUnitNorTheOrder)
{
  std::vector<CandidateNeighbor> neighbors = besideRidge(right, left);
  const Eigen::Matrix3f turn = test::someMotion().linear();
  std::vector<CandidateNeighbor> moved = neighbors;
  for (CandidateNeighbor& neighbor : moved) {
    neighbor.offset = 1000 * (turn * neighbor.offset);
    neighbor.normal = turn * neighbor.normal;
  }
  std::mt19937 generator(2);
  std::shuffle(moved.begin(), moved.end(), generator);
  for (const Vector3f& direction : {right, left, Vector3f(0.3f, 0.2f, 0.933f).normalized()}) {
    NormalCandidateFeatures here, there;
    here.set(neighbors, down, 0.001f);
    there.set(moved, turn * down, 1.f);
    const float to_own = direction.dot(right);
    const Features a = here.of({direction, 0.2f, to_own}), b = there.of({turn * direction, 0.2f, to_own});
    EXPECT_TRUE(a.allFinite());
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 0.01f) << (a - b).transpose();
  }
}

TEST(NormalCandidateFeatures, CountNeighborsOnThePlane)
{
  NormalCandidateFeatures features;
  features.set(besideRidge(right, left), down, 0.001f);
  const int all = 7 + 3 * 6; // inside, held, alike, other, in front, behind: of all neighbours
  const Features own = features.of({right, 0.2f, 1}), other = features.of({left, 0.2f, 0});
  const auto count = [](float logarithm) { return std::exp(logarithm) - 0.5f; };
  const double within = std::erf(1.2 / std::sqrt(2.0)) * (9 * 6 - 1); // share of a normal distribution
  EXPECT_NEAR(count(own[all]), within, 0.15 * within);
  EXPECT_NEAR(count(own[all + 1]), 9 * 6 - 1, 1); // rows -1 to 4
  EXPECT_NEAR(count(own[all + 2]), 9 * 6 - 1, 1);
  EXPECT_NEAR(count(own[all + 5]), 9 * 3, 1); // the other side falls away
  EXPECT_GT(count(own[all + 1]), count(other[all + 1]));
}

TEST(CandidateScore, IsGreatestForTheSurfaceOfThePointWhateverItsNormalIs)
{
  NormalCandidateFeatures features;
  features.set(besideRidge(right, left), down, 0.001f);
  for (const Vector3f& own : {right, left, Vector3f(0.7f, 0.1f, 0.7f).normalized()}) {
    const CandidateScore score(features.of({own, 0, 1}));
    const float of_right = score.of(features.of({right, 0.3f, own.dot(right) > 0.99f ? 1 : own.dot(right)}));
    for (const Vector3f& direction : {left, Vector3f(0.7f, 0.1f, 0.7f).normalized(), Vector3f(0, 0, 1)})
      EXPECT_GT(of_right, score.of(features.of({direction, 0.3f, std::min(0.99f, own.dot(direction))})));
  }
}

TEST(CandidateScore, IsFiniteForWhatNobodyHasSeen)
{
  const std::vector<CandidateNeighbor> none, twins(9, {Vector3f::Zero(), Vector3f::UnitZ(), true}),
      far(300, {Vector3f(1e6f, -1e6f, 1e6f), Vector3f::UnitX(), false});
  for (const auto& neighbors : {none, twins, far})
    for (const float noise : {1e-9f, 1e9f}) {
      NormalCandidateFeatures features;
      features.set(neighbors, down, noise);
      const Features own = features.of({Vector3f::UnitZ(), 0, 1});
      EXPECT_TRUE(own.allFinite()) << own.transpose();
      EXPECT_TRUE(std::isfinite(CandidateScore(own).of(own)));
    }
}
} // namespace
} // namespace fresco
