// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_model.h"
#include "track_triangulation.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <fresco/registration/core/surface_points.h>
#include <set>
#include <tuple>
namespace fresco::alignment {
namespace {
using Eigen::Vector3d;

Vector3d medianPoint(const Eigen::Matrix3Xd& points)
{
  Vector3d middle;
  for (int k = 0; k < 3; ++k)
    middle[k] = median(std::vector<double>(points.row(k).begin(), points.row(k).end()));
  return middle;
}

Similarity normalization(const Eigen::Matrix3Xd& points)
{
  const Vector3d middle = medianPoint(points);
  const Eigen::VectorXd distances = (points.colwise() - middle).colwise().norm();
  const double radius = median(std::vector<double>(distances.begin(), distances.end()));
  Similarity T;
  T.scale = radius > 0 ? 1 / radius : 1;
  T.t = -T.scale * middle;
  return T;
}

Vector3d nearestEye(const CameraSet& set, const SparsePoint& point)
{
  Vector3d best = set.views[point.track[0].view].center();
  for (const Observation& observation : point.track)
    if (const Vector3d eye = set.views[observation.view].center();
        (eye - point.position).squaredNorm() < (best - point.position).squaredNorm())
      best = eye;
  return best;
}

/// Normal of the plane through the point and two neighbours that most of the others lie near to; zero where they do not.
/// Half of the neighbours may be wrong: least median of squares (Rousseeuw 1984).
Vector3d robustNormal(const Eigen::Matrix3Xd& points, const Vector3d& center, const std::vector<Neighbor>& around)
{
  constexpr std::size_t tried = 11; // of the nearest: 55 pairs, of which with half outliers a quarter is right
  constexpr double flat = 0.12;     // of the reach: random points come to 0.2
  const double reach = std::sqrt(double(around.back().squared_distance));
  Vector3d best = Vector3d::Zero();
  double least = flat * reach;
  std::vector<double> heights(around.size());
  for (std::size_t i = 1; i < std::min(tried + 1, around.size()); ++i)
    for (std::size_t k = 1; k < i; ++k) {
      const Vector3d a = points.col(around[i].index) - center, b = points.col(around[k].index) - center;
      const Vector3d normal = a.cross(b);
      if (!(normal.norm() > 0.3 * a.norm() * b.norm()))
        continue;
      for (std::size_t n = 0; n < around.size(); ++n)
        heights[n] = std::abs(normal.dot(points.col(around[n].index) - center)) / normal.norm();
      if (const double height = rankedValue(heights, heights.size() * 9 / 20); height < least) {
        least = height;
        best = normal.normalized();
      }
    }
  return best;
}

/// The plane fitted to those of its neighbours that lie near to it.
Vector3d fittedNormal(const Eigen::Matrix3Xd& points, const Vector3d& center, const std::vector<Neighbor>& around,
                      const Vector3d& normal)
{
  std::vector<std::pair<double, int>> heights;
  for (const Neighbor& neighbor : around)
    heights.emplace_back(std::abs(normal.dot(points.col(neighbor.index) - center)), neighbor.index);
  std::sort(heights.begin(), heights.end());
  heights.resize(heights.size() / 2);
  Vector3d mean = Vector3d::Zero();
  for (const auto& near : heights)
    mean += points.col(near.second) / static_cast<double>(heights.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& near : heights)
    covariance += (points.col(near.second) - mean) * (points.col(near.second) - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

void findNormals(SparseModel& model, int threads)
{
  constexpr int neighbors = 24; // a dozen right ones where half are wrong
  const Eigen::Matrix3Xd places = model.points(Eigen::all, model.spread);
  const PointTree tree(places.cast<float>(), threads);
  model.normals.setZero(3, places.cols());
  parallelFor(places.cols(), threads, [&](Index i) {
    std::vector<Neighbor> around;
    tree.nearest(places.col(i).cast<float>(), neighbors, around);
    if (const Vector3d normal = robustNormal(places, places.col(i), around); normal != Vector3d::Zero())
      model.normals.col(i) = fittedNormal(places, places.col(i), around, normal);
  });
  registration::SurfacePoints level;
  level.points = places.cast<float>();
  level.normals = model.normals.cast<float>();
  level.surface_variation = Eigen::VectorXf::Zero(places.cols());
  model.order = registration::normalSpaceOrder(level);
}
} // namespace

SparseModel makeSparseModel(const CameraSet& set, const SparsePoints& points, int threads)
{
  constexpr double farthest = 6; // median distances: beyond are distant outliers
  SparseModel model;
  Eigen::Matrix3Xd places(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    places.col(i) = points[i].position;
  const Similarity T = model.T_model_cameras = normalization(places);
  std::vector<Index> kept;
  for (Index i = 0; i < places.cols(); ++i)
    if (!points[i].track.empty() && (T * places.col(i)).norm() <= farthest)
      kept.push_back(i);
  const Index count = kept.size();
  model.points.resize(3, count);
  model.seen.resize(3, count);
  model.eyes.resize(3, count);
  model.colors.resize(3, count);
  const Eigen::Matrix3Xd seen = triangulateTracks(set, points, threads);
  std::set<std::tuple<int, int, int>> taken;
  for (Index i = 0; i < count; ++i) {
    const SparsePoint& point = points[kept[i]];
    model.points.col(i) = T * point.position;
    model.seen.col(i) = T * seen.col(kept[i]);
    model.eyes.col(i) = T * nearestEye(set, point);
    model.colors.col(i) = point.color.cast<float>();
    const Eigen::Vector3i at = (model.points.col(i) / (0.5 * vote_cell)).array().floor().cast<int>();
    if (taken.insert({at.x(), at.y(), at.z()}).second)
      model.spread.push_back(i);
  }
  if (!model.spread.empty())
    findNormals(model, threads);
  return model;
}
} // namespace fresco::alignment
