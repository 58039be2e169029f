// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/registration/core/point_to_plane_registration.h>
#include <functional>
#include <random>
namespace fresco::benchmark {
using Poses = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;

inline double processorSeconds() { return 1.0 * std::clock() / CLOCKS_PER_SEC; }

struct PoseError {
  double distance = 0.0, degrees = 0.0;
};

/// @param middle point of the moved scan at which the distance is taken
inline PoseError errorOf(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth, const Eigen::Vector3d& middle)
{
  return {(found * middle - truth * middle).norm(),
          Eigen::AngleAxisd(truth.linear().transpose() * found.linear()).angle() * degrees_per_radian};
}

/// Scans with their true poses.
struct RegistrationInput {
  std::vector<PointSet> scans;
  Poses truth; ///< world from scan
  std::vector<Eigen::Vector3d> middles;
  float voxel = 0.f; ///< that suits all of them

  Eigen::Isometry3d relative(std::size_t a, std::size_t b) const { return truth[a].inverse() * truth[b]; }
};

/// @param words TRUTH.txt SCAN SCAN...
inline RegistrationInput readRegistrationInput(const std::vector<std::string>& words)
{
  RegistrationInput input;
  const auto poses = readPoses(words[0]);
  require(poses.size() + 1 == words.size(), words[0], ": ", poses.size(), " poses for ", words.size() - 1, " scans");
  for (std::size_t i = 1; i < words.size(); ++i) {
    require(poses[i - 1].has_value(), words[0], ": a true pose is missing");
    input.scans.push_back(readPoints(words[i]));
    input.truth.emplace_back(*poses[i - 1]);
    input.voxel = std::max(input.voxel, registrationVoxel(input.scans.back()));
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (Index k = 0; k < input.scans.back().size(); ++k)
      if (input.scans.back().points.col(k).allFinite()) {
        sum += input.scans.back().points.col(k).cast<double>();
        count += 1.0;
      }
    input.middles.push_back(sum / count);
  }
  return input;
}

/// Motions of a given size in random directions about random axes; the same for every method.
class Disturbances {
public:
  Disturbances(double distance, double degrees) : distance_(distance), angle_(degrees * radians_per_degree) {}
  Eigen::Isometry3d next()
  {
    const Eigen::Vector3d shift = unit(), axis = unit();
    return Eigen::Translation3d(distance_ * shift) * Eigen::AngleAxisd(angle_, axis);
  }

private:
  Eigen::Vector3d unit()
  {
    Eigen::Vector3d v;
    do
      for (int k = 0; k < 3; ++k)
        v[k] = random_() / 2147483648.0 - 1.0;
    while (v.norm() > 1.0 || v.norm() < 0.1);
    return v.normalized();
  }
  std::mt19937 random_{1};
  double distance_, angle_;
};
} // namespace fresco::benchmark
