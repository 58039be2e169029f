// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/noise.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/sensors/laser.h>
#include <fresco/simulation/sensors/random.h>
namespace fresco::simulation {
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
constexpr double pi = 3.14159265358979;              // 15 digits: with more of them the scans would have other bytes
constexpr double lowest = -pi / 3, highest = pi / 2; // elevations
constexpr int hexagon = 6;             // rays of the first ring around the middle of a beam; the next have 12, 18 ...
constexpr float same_surface = 0.004f; // metres off the plane that the middle of the beam meets

void validate(const LaserOptions& o)
{
  require(o.points >= 100 && o.points <= 100000000, "laser: ", o.points, " points are not in 100..100000000");
  require(o.noise >= 0.f && o.noise <= 1.f, "laser: noise ", o.noise, " m is not in 0..1");
  require(o.beam_radius >= 0.f && o.beam_radius < 1.f && o.divergence >= 0.f && o.divergence < 0.1f, "laser: bad beam");
  require(o.pulse >= 0.f && o.max_range >= 0.f, "laser: pulse or range is negative");
  require(o.rings >= 1 && o.rings <= 16, "laser: ", o.rings, " rings are not in 1..16");
}

/// The beams of a scan: rows of equal elevation.
struct Grid {
  Index rows = 1, columns = 1;
  Vector3d direction(Index beam) const
  {
    const double elevation = lowest + (highest - lowest) * (beam / columns + 0.5) / rows;
    const double azimuth = 2 * pi * (beam % columns) / columns;
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }
};

Grid gridOf(double beams)
{
  const double step = std::sqrt(2 * pi * (highest - lowest) / beams);
  return {std::max<Index>(1, std::lround((highest - lowest) / step)), std::max<Index>(1, std::lround(2 * pi / step))};
}

/// A ray beside the middle of a beam.
struct RimRay {
  float part, cosine, sine; ///< radii from the middle, bearing
};

/// Evenly over the disc of the beam: with one ring half of the light lies inside.
std::vector<RimRay> rimOf(int rings)
{
  std::vector<RimRay> rays;
  for (int ring = 1; ring <= rings; ++ring)
    for (int k = 0; k < hexagon * ring; ++k) {
      const float angle = 2.f * static_cast<float>(pi) * k / (hexagon * ring);
      rays.push_back({static_cast<float>(1.05 * ring / (rings + 0.5)), std::cos(angle), std::sin(angle)});
    }
  return rays;
}

/// One beam and what came back.
struct Return {
  float range = -1.f; ///< metres, negative: nothing
  int face = -1;
  bool mixed = false;
  float deviation = 0.f; ///< of the noise, metres
  float intensity = 0.f; ///< 1 = a white surface seen frontally at 1 m
  Eigen::Matrix<std::uint8_t, 3, 1> color;
};

class Laser {
public:
  Laser(const LitScene& lit, const Eigen::Matrix4d& T_world_scan, const LaserOptions& options, int number)
      : lit_(lit), R_(T_world_scan.topLeftCorner<3, 3>()),
        center_((T_world_scan.topRightCorner<3, 1>() - lit.scene.mesh.origin).cast<float>()), options_(options),
        number_(number), brightness_(brightness()), unit_(sceneUnit(lit.scene)),
        max_range_(options.max_range > 0.f ? options.max_range
                   : lit.scene.furnished   ? 30.f
                                           : 1e30f),
        rim_(rimOf(options.rings))
  {}

  /// Share of beams that meet a surface, from a coarse sweep.
  double hitShare() const
  {
    const Grid coarse = gridOf(20000.0);
    const Index beams = coarse.rows * coarse.columns;
    const Index hits = parallelSum(beams, options_.threads, Index(0),
                                   [&](Index b) { return Index(middle(coarse.direction(b)).face >= 0 ? 1 : 0); });
    return static_cast<double>(hits) / beams;
  }

  Return measure(const Vector3d& direction, Index beam) const
  {
    CounterRandom random(options_.seed, 1000 + number_, beam);
    constexpr double sent_back = 0.1; // share of the beams that return from each face of a clear pane
    const RayHit hit = behindGlass(worldRay(direction), [&] { return random.uniform() >= sent_back; });
    if (hit.face < 0 || hit.distance > max_range_)
      return {};
    const float cosine = std::fabs(faceNormal(lit_.scene.mesh, hit.face).dot(worldRay(direction).direction));
    if (random.uniform() >= answerProbability(hit, cosine))
      return {};
    Return back;
    back.face = hit.face;
    back.range = hit.distance;
    if (options_.veil)
      widen(direction, hit, back);
    const double grazing = std::sqrt(std::max(cosine, 0.12f));
    const double deviation = options_.noise * (0.6 + 0.1 * back.range) / grazing;
    back.deviation = deviation;
    back.range += static_cast<float>(deviation * random.gaussian());
    if (options_.intensity) {
      constexpr double speckle = 0.03; // deviation of a beam's strength on one surface, relative
      back.intensity = brightness_ * reflectance(hit) * cosine / (hit.distance * hit.distance) *
                       std::exp(speckle * random.gaussian());
    }
    const Vector3f color = brightness_ * surfaceColor(lit_, hit, 2.f * radius(hit.distance));
    back.color = (255.f * color).array().round().max(0.f).min(255.f).cast<std::uint8_t>();
    return back;
  }

private:
  float brightness() const { return CounterRandom(options_.seed, 71, number_).uniformFloat(0.92, 1.08); }
  Ray worldRay(const Vector3d& direction) const { return {center_, (R_ * direction).cast<float>().normalized()}; }
  RayHit middle(const Vector3d& direction) const { return lit_.rays.intersect(worldRay(direction)); }

  /// What a ray meets behind the clear panes that `passes()` lets it through.
  template <class Passes>
  RayHit behindGlass(Ray ray, const Passes& passes) const
  {
    constexpr float past = 1e-3f; // metres behind a face: on its other side
    RayHit hit = lit_.rays.intersect(ray);
    float passed = 0.f;
    while (hit.face >= 0 && materialAt(lit_.scene, hit.face).clear && passes()) {
      passed += hit.distance + past;
      ray.origin += (hit.distance + past) * ray.direction;
      hit = lit_.rays.intersect(ray);
    }
    hit.distance += passed;
    return hit;
  }

  float radius(float range) const { return options_.beam_radius + options_.divergence * range; }

  float reflectance(const RayHit& hit) const
  {
    return std::pow(surfaceAlbedo(lit_.scene, hit, 2.f * radius(hit.distance)).mean(), 2.2f);
  }

  /// Dark, glassy and obliquely met surfaces often send too little light back.
  double answerProbability(const RayHit& hit, float cosine) const
  {
    const float far = hit.distance / unit_, distance = std::min(1.f, 36.f / (far * far));
    const float answer = smoothStep(0.003f, 0.02f, reflectance(hit) * cosine * distance);
    const double glass = materialAt(lit_.scene, hit.face).glass ? 0.25 : 1.0;
    return glass * answer * smoothStep(0.02f, 0.08f, cosine);
  }

  bool isApart(const RayHit& a, const RayHit& b) const { return std::fabs(a.distance - b.distance) > options_.pulse; }

  float strength(const RayHit& hit, const Ray& ray) const
  {
    const float reflectance = std::pow(surfaceAlbedo(lit_.scene, hit, 0.02f).mean(), 2.2f);
    return reflectance * std::fabs(faceNormal(lit_.scene.mesh, hit.face).dot(ray.direction)) + 1e-6f;
  }

  /// Traces the rim of the beam; where it meets another surface the range is a weighted mean of both, or that of the
  /// stronger one if they are far apart.
  void widen(const Vector3d& direction, const RayHit& hit, Return& back) const
  {
    const Ray axis = worldRay(direction);
    const Vector3f u = axis.direction.unitOrthogonal(), v = axis.direction.cross(u),
                   normal = faceNormal(lit_.scene.mesh, hit.face);
    const float plane = normal.dot(axis.direction) * hit.distance;
    thread_local std::vector<std::pair<RayHit, Ray>> rim; // what the rays beside the middle meet
    rim.clear();
    bool elsewhere = false;
    for (const RimRay& beside : rim_) {
      const float spread = beside.part * radius(hit.distance) / hit.distance;
      const Ray ray{center_, (axis.direction + spread * (beside.cosine * u + beside.sine * v)).normalized()};
      const bool pane = materialAt(lit_.scene, hit.face).clear;
      const RayHit other = behindGlass(ray, [&] { return !pane; });
      if (other.face < 0)
        continue;
      const bool apart = isApart(other, hit);
      const bool off = std::fabs(other.distance * ray.direction.dot(normal) - plane) > same_surface;
      back.mixed = back.mixed || (off && !apart);
      elsewhere = elsewhere || off || apart;
      rim.emplace_back(other, ray);
    }
    if (!elsewhere)
      return;
    float near_sum = strength(hit, axis), near_weight = near_sum, far_sum = 0.f, far_weight = 0.f;
    near_sum *= hit.distance;
    for (const auto& [other, ray] : rim) {
      const bool apart = isApart(other, hit);
      const float weight = strength(other, ray);
      (apart ? far_sum : near_sum) += weight * other.distance;
      (apart ? far_weight : near_weight) += weight;
    }
    if (far_weight > near_weight) {
      back.range = far_sum / far_weight;
      back.mixed = true;
    } else if (back.mixed) {
      back.range = near_sum / near_weight;
    }
  }

  const LitScene& lit_;
  Eigen::Matrix3d R_;
  Vector3f center_;
  const LaserOptions& options_;
  std::uint64_t number_;
  float brightness_, unit_, max_range_;
  std::vector<RimRay> rim_;
};
} // namespace

Eigen::Matrix4d randomPose(const Vector3d& station, std::uint64_t seed, int number)
{
  CounterRandom random(seed, 81, number);
  const double yaw = random.uniform(0, 2 * pi), towards = random.uniform(0, 2 * pi),
               tilt = random.uniform(0, 3) * pi / 180;
  const Eigen::AngleAxisd lean(tilt, Vector3d(std::cos(towards), std::sin(towards), 0));
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() = (lean * Eigen::AngleAxisd(yaw, Vector3d::UnitZ())).toRotationMatrix();
  pose.topRightCorner<3, 1>() = station;
  return pose;
}

LaserScan scanScene(const LitScene& lit, const Eigen::Matrix4d& T_world_scan, const LaserOptions& options, int number)
{
  validate(options);
  const Laser laser(lit, T_world_scan, options, number);
  const double share = std::max(laser.hitShare(), 0.01);
  const Grid grid = gridOf(options.points / share);
  const Index beams = grid.rows * grid.columns;
  std::vector<Return> returns(beams);
  parallelFor(beams, options.threads, [&](Index b) { returns[b] = laser.measure(grid.direction(b), b); });
  const Index count = std::count_if(returns.begin(), returns.end(), [](const Return& r) { return r.range > 0.f; });
  LaserScan scan;
  scan.points.points.resize(3, count);
  scan.points.colors.resize(3, options.intensity ? 0 : count);
  scan.points.intensities.resize(options.intensity ? count : 0);
  scan.points.viewpoints = Points::Zero(3, 1);
  Index next = 0;
  for (Index b = 0; b < beams; ++b) {
    const Return& back = returns[b];
    if (back.range <= 0.f)
      continue;
    scan.points.points.col(next) = (back.range * grid.direction(b)).cast<float>();
    if (options.intensity)
      scan.points.intensities[next++] = back.intensity;
    else
      scan.points.colors.col(next++) = back.color;
    scan.faces.push_back(back.face);
    scan.mixed.push_back(back.mixed);
    scan.deviations.push_back(back.deviation);
  }
  return scan;
}
} // namespace fresco::simulation
