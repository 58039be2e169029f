// SPDX-License-Identifier: BSD-3-Clause
#include "photograph_matches.h"
#include "sparse_model.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
namespace fresco::alignment {
namespace {
using Eigen::Vector3d;
using Chosen = std::vector<Index>;

/// Two columns of points that correspond.
struct Columns {
  Eigen::Matrix3Xd places, points; ///< of the surface, of the cameras' frame
};

Similarity similarityOf(const Columns& all, const Chosen& chosen)
{
  const Eigen::Matrix4d M = Eigen::umeyama(Eigen::Matrix3Xd(all.points(Eigen::all, chosen)),
                                           Eigen::Matrix3Xd(all.places(Eigen::all, chosen)));
  Similarity T;
  T.scale = std::cbrt(M.topLeftCorner<3, 3>().determinant());
  T.R = M.topLeftCorner<3, 3>() / T.scale;
  T.t = M.topRightCorner<3, 1>();
  return T;
}

Chosen agreeing(const Columns& all, const Similarity& T, double tolerance)
{
  Chosen chosen;
  const double most = tolerance * T.scale;
  for (Index i = 0; i < all.points.cols(); ++i)
    if ((T * all.points.col(i) - all.places.col(i)).squaredNorm() < most * most)
      chosen.push_back(i);
  return chosen;
}

/// Cells of sparse points: many features of one thing count once.
Index distinct(const Columns& all, const Chosen& chosen, double cell)
{
  std::set<std::tuple<int, int, int>> cells;
  for (const Index i : chosen) {
    const Eigen::Array3i at = (all.points.col(i) / cell).array().floor().cast<int>();
    cells.insert({at.x(), at.y(), at.z()});
  }
  return static_cast<Index>(cells.size());
}

/// Whether three pairs are about similar triangles of a scale in range.
bool isSimilar(const Columns& all, const Chosen& three, const std::pair<double, double>& scales, double tolerance)
{
  constexpr double unlike = 1.25; // of scales by two edges: points are off by a tenth of the edges
  double least = 1e300, most = 0;
  for (int k = 0; k < 3; ++k) {
    const Index a = three[k], b = three[(k + 1) % 3];
    const double edge = (all.points.col(a) - all.points.col(b)).norm();
    if (edge < 2 * tolerance)
      return false;
    const double scale = (all.places.col(a) - all.places.col(b)).norm() / edge;
    least = std::min(least, scale);
    most = std::max(most, scale);
  }
  return most < unlike * least && least > scales.first && most < scales.second;
}

MatchedSimilarity bestOf(const Columns& all, const std::pair<double, double>& scales, double tolerance)
{
  constexpr int tried = 200000; // with a fortieth of the matches right, three right ones are drawn three times
  std::mt19937 random(1);
  MatchedSimilarity best;
  Chosen inliers;
  const Index count = all.points.cols();
  const auto draw = [&] { return static_cast<Index>(random() % static_cast<std::uint64_t>(count)); };
  for (int k = 0; k < tried && count >= 3; ++k) {
    const Chosen three{draw(), draw(), draw()};
    if (!isSimilar(all, three, scales, tolerance))
      continue;
    const Similarity T = similarityOf(all, three);
    const Chosen chosen = agreeing(all, T, tolerance);
    if (chosen.size() > inliers.size()) {
      inliers = chosen;
      best.T_surface_cameras = T;
    }
  }
  for (int k = 0; k < settling && inliers.size() >= 3; ++k) {
    best.T_surface_cameras = similarityOf(all, inliers);
    inliers = agreeing(all, best.T_surface_cameras, tolerance);
  }
  best.votes = distinct(all, inliers, tolerance);
  return best;
}
} // namespace

std::array<MatchedSimilarity, 2> agreeOnSimilarities(const std::vector<SurfaceMatch>& matches,
                                                     const SparsePoints& points,
                                                     const std::pair<double, double>& scales, double tolerance)
{
  Columns all{Eigen::Matrix3Xd(3, matches.size()), Eigen::Matrix3Xd(3, matches.size())};
  for (std::size_t i = 0; i < matches.size(); ++i) {
    all.places.col(i) = matches[i].place;
    all.points.col(i) = points[matches[i].point].position;
  }
  std::array<MatchedSimilarity, 2> found;
  for (MatchedSimilarity& one : found) {
    one = bestOf(all, scales, tolerance);
    const Chosen gone = agreeing(all, one.T_surface_cameras, 3 * tolerance);
    Chosen rest;
    for (Index i = 0, g = 0; i < all.points.cols(); ++i)
      if (g < static_cast<Index>(gone.size()) && gone[g] == i)
        ++g;
      else
        rest.push_back(i);
    all = {Eigen::Matrix3Xd(all.places(Eigen::all, rest)), Eigen::Matrix3Xd(all.points(Eigen::all, rest))};
  }
  return found;
}
} // namespace fresco::alignment
