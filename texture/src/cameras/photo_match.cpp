// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/photo_match.h"
#include "cameras/patch_search.h"
#include "views/patch_mesh.h"
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <numeric>
namespace fresco::texture {
namespace {
constexpr double depth_agreement = 0.02; // share of the distance: a mesh may err so much and be the same surface

struct Corner {
  Eigen::Vector2d pixel; ///< of the photograph
  Eigen::Vector3d point, normal;
};

class Matcher {
public:
  Matcher(const RayScene& scene, const std::vector<MatchPhoto>& photos, const CameraState& state,
          const MatchOptions& options)
      : scene_(scene), photos_(photos), pose_(state.pose), options_(options)
  {
    for (std::size_t v = 0; v < photos.size(); ++v)
      views_.emplace_back(state.cameras[state.group[v]], state.T_camera_mesh[v], Eigen::Vector3d::Zero());
  }

  std::vector<PhotoMatch> run() const
  {
    const Index n = photos_.size();
    std::vector<std::vector<Corner>> corners(photos_.size());
    parallelFor(
        n, options_.threads, [&](Index v) { corners[v] = cornersOnSurface(v); }, 1);
    std::vector<std::vector<PhotoMatch>> matches(photos_.size());
    parallelFor(
        n, options_.threads, [&](Index v) { matches[v] = matchesOf(v, corners[v]); }, 1);
    std::vector<PhotoMatch> all;
    for (const auto& some : matches)
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }

private:
  std::vector<Corner> cornersOnSurface(Index v) const
  {
    std::vector<Corner> out;
    for (const Eigen::Vector2f& place : photos_[v].corners) {
      Corner corner;
      corner.pixel = place.cast<double>() / photos_[v].pyramid.scale;
      if (lift(v, corner))
        out.push_back(corner);
    }
    return out;
  }

  /// Finds the surface under a corner and its plane from what lies around it. @return false where there is none, or
  /// where it is bent or seen too obliquely
  bool lift(Index v, Corner& corner) const
  {
    const Eigen::Vector3f from = views_[v].center();
    const double reach = (patch_radius + 1) / photos_[v].pyramid.scale;
    const Eigen::Vector2d offsets[5] = {{0, 0}, {reach, 0}, {-reach, 0}, {0, reach}, {0, -reach}};
    Eigen::Matrix<double, 3, 5> points;
    for (int k = 0; k < 5; ++k) {
      const Eigen::Vector3f ray = views_[v].ray(corner.pixel + offsets[k]);
      const RayHit hit = scene_.intersect({from, ray});
      if (hit.face < 0)
        return false;
      points.col(k) = (from + hit.distance * ray).cast<double>();
    }
    corner.point = points.col(0);
    const Eigen::Vector3d ray = corner.point - from.cast<double>();
    corner.normal = (points.col(1) - points.col(2)).cross(points.col(3) - points.col(4)).stableNormalized();
    if (corner.normal.dot(ray) > 0)
      corner.normal = -corner.normal;
    const Eigen::Matrix<double, 1, 5> off = corner.normal.transpose() * (points.colwise() - corner.point);
    return -corner.normal.dot(ray.normalized()) > steep_cosine &&
           off.cwiseAbs().maxCoeff() < 0.5 * depth_agreement * ray.norm();
  }

  static double planeDistance(const Corner& corner, const Eigen::Vector3d& from, const Eigen::Vector3d& ray)
  {
    return corner.normal.dot(corner.point - from) / corner.normal.dot(ray);
  }

  bool sees(int v, const Corner& corner, Eigen::Vector2d& pixel) const
  {
    const Eigen::Vector3f p = views_[v](corner.point.cast<float>());
    const CameraModel& camera = views_[v].camera();
    if (!(p.z() > 0 && p.x() > 0 && p.y() > 0 && p.x() < camera.width && p.y() < camera.height))
      return false;
    const Eigen::Vector3f ray = corner.point.cast<float>() - views_[v].center();
    if (!(-corner.normal.dot(ray.cast<double>().normalized()) > steep_cosine))
      return false;
    pixel = p.head<2>().cast<double>();
    return scene_.intersect({views_[v].center(), ray}).distance > 1 - depth_agreement;
  }

  /// Views that see most of the corners; fewer and fewer of those that see less, for long baselines.
  std::vector<int> partnersOf(int from, const std::vector<Corner>& corners) const
  {
    constexpr int sampled = 4; // every so many corners: enough to rank the views
    std::vector<int> shared(photos_.size(), 0), order(photos_.size());
    Eigen::Vector2d pixel;
    const Index n = photos_.size(), most = options_.partners;
    for (int v = 0; v < n; ++v)
      for (std::size_t i = 0; i < corners.size() && pose_[v] != pose_[from]; i += sampled)
        shared[v] += sampled * sees(v, corners[i], pixel);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return shared[a] > shared[b]; });
    std::vector<int> out;
    double step = 1;
    for (double rank = 0; rank < n && static_cast<Index>(out.size()) < most; rank += step) {
      const int v = order[rank];
      if (shared[v] < fewest_samples)
        break;
      out.push_back(v);
      step *= 1.25;
    }
    return out;
  }

  std::vector<PhotoMatch> matchesOf(int from, const std::vector<Corner>& corners) const
  {
    std::vector<PhotoMatch> out;
    for (const int to : partnersOf(from, corners))
      for (const Corner& corner : corners) {
        PhotoMatch match{from, to, corner.pixel, {}, corner.point, corner.normal};
        if (find(match, corner))
          out.push_back(match);
      }
    return out;
  }

  bool find(PhotoMatch& match, const Corner& corner) const
  {
    Eigen::Vector2d expected;
    if (!sees(match.to, corner, expected))
      return false;
    const double a = photos_[match.from].pyramid.scale, b = photos_[match.to].pyramid.scale;
    Eigen::Matrix2d T_to_from; // pixels of `to` per pixel of `from`
    const Eigen::Vector3d center = views_[match.from].center().cast<double>();
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d ray = views_[match.from].ray(corner.pixel + Eigen::Vector2d::Unit(k)).cast<double>();
      const Eigen::Vector3d beside = center + planeDistance(corner, center, ray) * ray;
      T_to_from.col(k) = views_[match.to](beside.cast<float>()).head<2>().cast<double>() - expected;
    }
    T_to_from *= b / a;
    const double zoom = std::abs(T_to_from.determinant());
    if (!(zoom > 0.2 && zoom < 5))
      return false;
    const PatchQuery query{photos_[match.from].pyramid,       photos_[match.to].pyramid,
                           (corner.pixel * a).cast<float>(),  (expected * b).cast<float>(),
                           T_to_from.inverse().cast<float>(), static_cast<float>(options_.search * b)};
    Eigen::Vector2f place;
    if (!findPatch(query, place) || !photos_[match.to].uses(place))
      return false;
    match.pixel_to = place.cast<double>() / b;
    return true;
  }

  const RayScene& scene_;
  const std::vector<MatchPhoto>& photos_;
  const std::vector<int>& pose_; ///< of a view; those of one pose agree by themselves
  const MatchOptions& options_;
  std::vector<Projector> views_;
};
} // namespace

std::vector<PhotoMatch> matchPhotos(const RayScene& scene, const std::vector<MatchPhoto>& photos,
                                    const CameraState& state, const MatchOptions& options)
{
  return Matcher(scene, photos, state, options).run();
}
} // namespace fresco::texture
