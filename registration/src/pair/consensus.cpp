// SPDX-License-Identifier: BSD-3-Clause
#include "pair/consensus.h"
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdint>
namespace fresco::registration {
namespace {
constexpr float angle_tolerance = 0.35f; // of cosines between normals and with the line between the points
constexpr float shortest = 4.f; // tolerances between two points of a pair: nearer ones say little of a rotation
constexpr std::size_t seeds_most = 300;
constexpr int word_bits = 64;

class BitMatrix {
public:
  explicit BitMatrix(std::size_t size) : words_((size + word_bits - 1) / word_bits), bits_(size * words_, 0) {}
  void set(std::size_t i, std::size_t j) { bits_[i * words_ + j / word_bits] |= std::uint64_t(1) << (j % word_bits); }
  bool get(std::size_t i, std::size_t j) const { return (bits_[i * words_ + j / word_bits] >> (j % word_bits)) & 1u; }
  int common(std::size_t i, std::size_t j) const
  {
    int count = 0;
    for (std::size_t w = 0; w < words_; ++w)
      count += __builtin_popcountll(bits_[i * words_ + w] & bits_[j * words_ + w]);
    return count;
  }

private:
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

// Corresponding points and normals, gathered side by side.
struct MatchedPoints {
  Points a, b, normals_a, normals_b;
};

MatchedPoints gather(const ScanFeatures& a, const ScanFeatures& b, const std::vector<Correspondence>& matches)
{
  MatchedPoints points;
  const Index n = matches.size();
  for (Points* matrix : {&points.a, &points.b, &points.normals_a, &points.normals_b})
    matrix->resize(3, n);
  for (Index k = 0; k < n; ++k) {
    const Correspondence& match = matches[k];
    points.a.col(k) = a.points.col(match.a);
    points.b.col(k) = b.points.col(match.b);
    points.normals_a.col(k) = a.normals.col(match.a);
    points.normals_b.col(k) = b.normals.col(match.b);
  }
  return points;
}

bool agree(const MatchedPoints& m, Index i, Index j, float tolerance)
{
  const Eigen::Vector3f da = m.a.col(j) - m.a.col(i), db = m.b.col(j) - m.b.col(i);
  const float la = da.norm(), lb = db.norm();
  if (std::abs(la - lb) > tolerance || std::min(la, lb) < shortest * tolerance)
    return false;
  const auto near = [](float x, float y) { return std::abs(x - y) < angle_tolerance; };
  return near(m.normals_a.col(i).dot(m.normals_a.col(j)), m.normals_b.col(i).dot(m.normals_b.col(j))) &&
         near(m.normals_a.col(i).dot(da) / la, m.normals_b.col(i).dot(db) / lb) &&
         near(m.normals_a.col(j).dot(da) / la, m.normals_b.col(j).dot(db) / lb);
}

BitMatrix agreement(const MatchedPoints& points, float tolerance)
{
  const Index n = points.a.cols();
  BitMatrix matrix(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i)
    for (Index j = i + 1; j < n; ++j)
      if (agree(points, i, j, tolerance)) {
        matrix.set(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        matrix.set(static_cast<std::size_t>(j), static_cast<std::size_t>(i));
      }
  return matrix;
}

struct Seed {
  int common;
  std::size_t i, j;
};

// For each correspondence the partner with which it shares the most agreeing others; most first.
std::vector<Seed> findSeeds(const BitMatrix& matrix, std::size_t n)
{
  std::vector<Seed> seeds;
  for (std::size_t i = 0; i < n; ++i) {
    Seed best{0, i, i};
    for (std::size_t j = 0; j < n; ++j)
      if (matrix.get(i, j)) {
        const int common = matrix.common(i, j);
        if (common > best.common)
          best = {common, i, j};
      }
    if (best.common > 0)
      seeds.push_back(best);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed& x, const Seed& y) { return x.common > y.common; });
  return seeds;
}

// Least squares rotation and translation of points and, with the weight of a lever of `lever`, normals (Arun et al.
// 1987).
Eigen::Isometry3d fitPose(const MatchedPoints& m, const std::vector<Index>& set, float lever)
{
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  for (const Index k : set) {
    mean_a += m.a.col(k).cast<double>();
    mean_b += m.b.col(k).cast<double>();
  }
  mean_a /= static_cast<double>(set.size());
  mean_b /= static_cast<double>(set.size());
  Eigen::Matrix3d W = Eigen::Matrix3d::Zero();
  for (const Index k : set) {
    W += (m.a.col(k).cast<double>() - mean_a) * (m.b.col(k).cast<double>() - mean_b).transpose();
    W += lever * lever * m.normals_a.col(k).cast<double>() * m.normals_b.col(k).cast<double>().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(W, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  T.translation() = mean_a - T.linear() * mean_b;
  return T;
}

std::vector<Index> agreeingMatches(const MatchedPoints& m, const Eigen::Isometry3d& T_a_b, float tolerance)
{
  const Eigen::Isometry3f T = T_a_b.cast<float>();
  std::vector<Index> set;
  for (Index k = 0; k < m.a.cols(); ++k)
    if ((T * m.b.col(k) - m.a.col(k)).squaredNorm() < tolerance * tolerance &&
        m.normals_a.col(k).dot(T.linear() * m.normals_b.col(k)) > 0.7f)
      set.push_back(k);
  return set;
}
} // namespace

double poseDistance(const Eigen::Isometry3d& first, const Eigen::Isometry3d& second, double size)
{
  const Eigen::Isometry3d difference = first.inverse() * second;
  return difference.translation().norm() + size * Eigen::AngleAxisd(difference.linear()).angle();
}

Hypotheses findConsensus(const ScanFeatures& a, const ScanFeatures& b, const std::vector<Correspondence>& matches,
                         const ConsensusOptions& options)
{
  const MatchedPoints points = gather(a, b, matches);
  const BitMatrix matrix = agreement(points, options.tolerance);
  const std::vector<Seed> seeds = findSeeds(matrix, matches.size());
  Hypotheses found;
  std::vector<char> spent(matches.size(), 0);
  std::size_t grown = 0;
  for (std::size_t s = 0; s < seeds.size() && grown < seeds_most; ++s) {
    if (spent[seeds[s].i] || spent[seeds[s].j])
      continue;
    ++grown;
    std::vector<Index> set = {static_cast<Index>(seeds[s].i), static_cast<Index>(seeds[s].j)};
    for (std::size_t k = 0; k < matches.size(); ++k)
      if (matrix.get(seeds[s].i, k) && matrix.get(seeds[s].j, k))
        set.push_back(static_cast<Index>(k));
    Hypothesis hypothesis;
    for (int round = 0; round < 3 && set.size() >= 3; ++round) {
      hypothesis.T_a_b = fitPose(points, set, 2.f * options.tolerance);
      set = agreeingMatches(points, hypothesis.T_a_b, 1.5f * options.tolerance);
      hypothesis.votes = static_cast<Index>(set.size());
    }
    for (const Index k : set)
      spent[k] = options.exclusive;
    const auto same = [&](const Hypothesis& other) {
      return poseDistance(other.T_a_b, hypothesis.T_a_b, options.size) < 4.0 * options.tolerance;
    };
    if (hypothesis.votes >= 3 && std::none_of(found.begin(), found.end(), same))
      found.push_back(hypothesis);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.votes > y.votes; });
  found.resize(std::min(found.size(), options.most));
  return found;
}
} // namespace fresco::registration
