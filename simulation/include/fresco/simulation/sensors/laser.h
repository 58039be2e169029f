// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_set.h>
#include <fresco/simulation/sensors/lighting.h>
namespace fresco::simulation {
/// A laser that turns about its station: 360 degrees around, from 60 degrees below the horizon to the zenith.
struct LaserOptions {
  int points = 150000;        ///< beams that meet a surface per scan, about; >= 100
  float noise = 0.0025f;      ///< metres, deviation of the range at 4 m on a white surface seen frontally, >= 0
  bool veil = true;           ///< beams have a width: at depth jumps ranges mix
  float beam_radius = 0.002f; ///< metres at the exit, >= 0
  float divergence = 0.0006f; ///< radians, growth of the radius per metre, >= 0
  float pulse = 0.4f;         ///< metres; surfaces further apart within a beam are told apart, the stronger one counts
  int rings = 1;              ///< of rays around the middle of a beam: 6, then 12 more ...
  float max_range = 0.f;      ///< metres, >= 0; 0 = 30 in rooms, without limit for meshes
  bool intensity = false;     ///< points get the strength of the answer in place of a colour
  std::uint64_t seed = 1;
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

struct LaserScan {
  PointSet points;         ///< in the sensor's own frame, with colours or intensities, viewpoint (0, 0, 0)
  std::vector<int> faces;  ///< per point, the face that the middle of the beam met
  std::vector<bool> mixed; ///< per point, whether its range belongs to more than one surface or to a neighbouring one
  std::vector<float> deviations; ///< per point, of the noise of its range, metres
};

/// Pose of scan `number` at a station: any yaw, a tilt of up to 3 degrees. World from scan, 4x4 rigid.
Eigen::Matrix4d randomPose(const Eigen::Vector3d& station, std::uint64_t seed, int number);

/// @param T_world_scan 4x4 rigid; the scan's number keeps the random numbers of scans apart
/// @throws std::invalid_argument if an option is out of range
LaserScan scanScene(const LitScene& lit, const Eigen::Matrix4d& T_world_scan, const LaserOptions& options, int number);
} // namespace fresco::simulation
