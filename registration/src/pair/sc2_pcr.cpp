// SPDX-License-Identifier: BSD-3-Clause
#include "scan/lists.h"
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
namespace {
constexpr Index fewest_votes = 3; // points that fix a rigid motion

// A symmetric matrix of zeros and ones.
class BitMatrix {
public:
  explicit BitMatrix(Index size) : words_((size + 63) / 64), bits_(size * words_, 0) {}
  void set(Index i, Index j) { bits_[i * words_ + j / 64] |= std::uint64_t(1) << (j % 64); }
  bool get(Index i, Index j) const { return (bits_[i * words_ + j / 64] >> (j % 64)) & 1u; }
  // Product of row i and column j.
  int product(Index i, Index j) const
  {
    int count = 0;
    for (Index w = 0; w < words_; ++w)
      count += __builtin_popcountll(bits_[i * words_ + w] & bits_[j * words_ + w]);
    return count;
  }

private:
  Index words_;
  std::vector<std::uint64_t> bits_;
};

// Corresponding points x_i, y_i and their normals, side by side.
struct MatchedPoints {
  Points a, b, normals_a, normals_b;
};

MatchedPoints gather(const OrientedPoints& a, const OrientedPoints& b, const std::vector<Correspondence>& matches)
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

// First-order compatibility of two correspondences: the distance that the paper thresholds,
// d_ij = | |x_i - x_j| - |y_i - y_j| | <= d_thr, and the same of the angles of the normals with each other and with the
// line between the points.
bool compatible(const MatchedPoints& m, Index i, Index j, float tolerance)
{
  constexpr float angle_tolerance = 0.35f; // of cosines: 20 degrees where two directions are perpendicular
  constexpr float shortest = 4.f;          // tolerances between two points: nearer ones say little of a rotation
  const Eigen::Vector3f da = m.a.col(j) - m.a.col(i), db = m.b.col(j) - m.b.col(i);
  const float la = da.norm(), lb = db.norm();
  if (std::abs(la - lb) > tolerance || std::min(la, lb) < shortest * tolerance)
    return false;
  const auto near = [](float x, float y) { return std::abs(x - y) < angle_tolerance; };
  return near(m.normals_a.col(i).dot(m.normals_a.col(j)), m.normals_b.col(i).dot(m.normals_b.col(j))) &&
         near(m.normals_a.col(i).dot(da) / la, m.normals_b.col(i).dot(db) / lb) &&
         near(m.normals_a.col(j).dot(da) / la, m.normals_b.col(j).dot(db) / lb);
}

// Matrix C of hard thresholded first-order compatibilities: C_ij = 1 where i and j are compatible.
BitMatrix firstOrderCompatibility(const MatchedPoints& points, float tolerance)
{
  const Index n = points.a.cols();
  BitMatrix C(n);
  for (Index i = 0; i < n; ++i)
    for (Index j = i + 1; j < n; ++j)
      if (compatible(points, i, j, tolerance)) {
        C.set(i, j);
        C.set(j, i);
      }
  return C;
}

// Second-order compatibility SC2_ij = C_ij * sum_k C_ik C_kj: how many correspondences are compatible with both.
int secondOrderCompatibility(const BitMatrix& C, Index i, Index j) { return C.get(i, j) ? C.product(i, j) : 0; }

struct Seed {
  int compatibility; // of the second order
  Index i, j;
};

// For each correspondence the partner of the largest second-order compatibility; largest first.
std::vector<Seed> selectSeeds(const BitMatrix& C, Index n)
{
  std::vector<Seed> seeds;
  for (Index i = 0; i < n; ++i) {
    Seed best{0, i, i};
    for (Index j = 0; j < n; ++j) {
      const int compatibility = secondOrderCompatibility(C, i, j);
      if (compatibility > best.compatibility)
        best = {compatibility, i, j};
    }
    if (best.compatibility > 0)
      seeds.push_back(best);
  }
  sortFalling(seeds, &Seed::compatibility);
  return seeds;
}

// The seed and all that is compatible with both of its correspondences.
std::vector<Index> consensusSet(const BitMatrix& C, const Seed& seed, Index n)
{
  std::vector<Index> set = {seed.i, seed.j};
  for (Index k = 0; k < n; ++k)
    if (C.get(seed.i, k) && C.get(seed.j, k))
      set.push_back(k);
  return set;
}

// Least squares rotation and translation of points and, with the weight of a lever of `lever`, normals (Arun, Huang,
// Blostein 1987, "Least-Squares Fitting of Two 3-D Point Sets").
Eigen::Isometry3d fitPose(const MatchedPoints& m, const std::vector<Index>& set, float lever)
{
  const double count = set.size();
  Eigen::Vector3d mean_a = Eigen::Vector3d::Zero(), mean_b = Eigen::Vector3d::Zero();
  for (const Index k : set) {
    mean_a += m.a.col(k).cast<double>();
    mean_b += m.b.col(k).cast<double>();
  }
  mean_a /= count;
  mean_b /= count;
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

// Correspondences that agree with a pose.
std::vector<Index> inliers(const MatchedPoints& m, const Eigen::Isometry3d& T_a_b, float tolerance)
{
  const Eigen::Isometry3f T = T_a_b.cast<float>();
  std::vector<Index> set;
  for (Index k = 0; k < m.a.cols(); ++k)
    if ((T * m.b.col(k) - m.a.col(k)).squaredNorm() < tolerance * tolerance &&
        m.normals_a.col(k).dot(T.linear() * m.normals_b.col(k)) > 0.7f)
      set.push_back(k);
  return set;
}

// Pose of a consensus set; the set becomes the inliers of the pose.
PoseHypothesis estimateHypothesis(const MatchedPoints& points, const Sc2PcrOptions& options, std::vector<Index>& set)
{
  PoseHypothesis hypothesis;
  for (int round = 0; round < 3 && static_cast<Index>(set.size()) >= fewest_votes; ++round) {
    hypothesis.T_a_b = fitPose(points, set, 2.f * options.tolerance);
    set = inliers(points, hypothesis.T_a_b, 1.5f * options.tolerance);
    hypothesis.votes = set.size();
  }
  return hypothesis;
}
} // namespace

double poseDistance(const Eigen::Isometry3d& first, const Eigen::Isometry3d& second, double size)
{
  const Eigen::Isometry3d difference = first.inverse() * second;
  return difference.translation().norm() + size * Eigen::AngleAxisd(difference.linear()).angle();
}

PoseHypotheses runSc2Pcr(const OrientedPoints& a, const OrientedPoints& b, const std::vector<Correspondence>& matches,
                         const Sc2PcrOptions& options)
{
  constexpr int most_seeds = 300; // bounds the time
  const Index n = matches.size();
  const MatchedPoints points = gather(a, b, matches);
  const BitMatrix C = firstOrderCompatibility(points, options.tolerance);
  PoseHypotheses found;
  std::vector<char> spent(n, 0);
  int used = 0;
  for (const Seed& seed : selectSeeds(C, n)) {
    if (spent[seed.i] || spent[seed.j])
      continue;
    if (used++ == most_seeds)
      break;
    std::vector<Index> set = consensusSet(C, seed, n);
    const PoseHypothesis hypothesis = estimateHypothesis(points, options, set);
    for (const Index k : set)
      spent[k] = options.exclusive;
    const auto same = [&](const PoseHypothesis& other) {
      return poseDistance(other.T_a_b, hypothesis.T_a_b, options.size) < 4.0 * options.tolerance;
    };
    if (hypothesis.votes >= fewest_votes && std::none_of(found.begin(), found.end(), same))
      found.push_back(hypothesis);
  }
  keepLargest(found, options.most, &PoseHypothesis::votes);
  return found;
}
} // namespace fresco::registration
