// SPDX-License-Identifier: BSD-3-Clause
#include "track_triangulation.h"
#include "sparse_model.h"
#include <Eigen/Cholesky>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::alignment {
namespace {
using Eigen::Matrix3d;
using Eigen::Vector3d;

struct TrackRay {
  Vector3d eye, direction; ///< direction of length 1
  double focal = 0;        ///< pixels per radian
};

std::vector<TrackRay> raysOf(const CameraSet& set, const SparsePoint& point)
{
  std::vector<TrackRay> rays;
  for (const Observation& observation : point.track) {
    const View& view = set.views[observation.view];
    const CameraModel& camera = set.cameras[view.camera];
    if (observation.pixel.allFinite() && camera.fx > 0 && camera.fy > 0)
      rays.push_back({view.center(), view.T_camera_world.linear().transpose() * direction(camera, observation.pixel),
                      std::sqrt(camera.fx * camera.fy)});
  }
  return rays;
}

/// Whether one of the rays differs enough from the first to tell a distance.
bool differ(const std::vector<TrackRay>& rays)
{
  constexpr double least_sine = 0.026; // 1.5 degrees, as structure from motion asks of new points
  for (const TrackRay& ray : rays)
    if (ray.direction.cross(rays[0].direction).norm() > least_sine)
      return true;
  return false;
}

/// The place nearest to the rays by distances in pixels, as the distances of `place` tell these.
Vector3d nearestToRays(const std::vector<TrackRay>& rays, const Vector3d& place)
{
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const TrackRay& ray : rays) {
    const Matrix3d across = Matrix3d::Identity() - ray.direction * ray.direction.transpose();
    const double weight = ray.focal * ray.focal / (place - ray.eye).squaredNorm();
    A += weight * across;
    b += weight * across * ray.eye;
  }
  return A.ldlt().solve(b);
}

/// Whether all rays pass in front of their cameras within some pixels.
bool meet(const std::vector<TrackRay>& rays, const Vector3d& place)
{
  constexpr double most = 4; // pixels: beyond, structure from motion takes an observation for wrong
  for (const TrackRay& ray : rays) {
    const Vector3d sight = place - ray.eye;
    if (!(ray.direction.dot(sight) > 0 && ray.focal * ray.direction.cross(sight.normalized()).norm() < most))
      return false;
  }
  return true;
}
} // namespace

Eigen::Matrix3Xd triangulateTracks(const CameraSet& set, const SparsePoints& points, int threads)
{
  Eigen::Matrix3Xd places(3, points.size());
  parallelFor(places.cols(), threads, [&](Index i) {
    places.col(i) = points[i].position;
    const std::vector<TrackRay> rays = raysOf(set, points[i]);
    if (!differ(rays))
      return;
    Vector3d place = points[i].position;
    for (int step = 0; step < settling; ++step)
      place = nearestToRays(rays, place);
    if (meet(rays, place))
      places.col(i) = place;
  });
  return places;
}
} // namespace fresco::alignment
