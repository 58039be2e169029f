// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <fresco/tracking/core/rgbd_tracking.h>
#include <vector>
namespace fresco::test {
/// A room of 5 x 4 x 2.6 m with boxes in it, all with a pattern of random cells, seen by an ideal RGB-D camera.
class RgbdRoom {
public:
  explicit RgbdRoom(unsigned seed = 1) : seed_(seed) {}

  struct Hit {
    double depth = 1e9; ///< in units of the ray
    double gray = 0;
  };

  Hit cast(const Eigen::Vector3d& from, const Eigen::Vector3d& along) const
  {
    Hit hit;
    for (int box = 0; box < 4; ++box)
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          const double plane = (side ? high_[box] : low_[box])[axis];
          const double s = (plane - from[axis]) / along[axis];
          const Eigen::Vector3d at = from + s * along;
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          if (s > 1e-6 && s < hit.depth && at[u] >= low_[box][u] && at[u] <= high_[box][u] && at[v] >= low_[box][v] &&
              at[v] <= high_[box][v])
            hit = {s, pattern(at[u], at[v], 6 * box + 2 * axis + side)};
        }
    return hit;
  }

  /// @param color may look from beside the depth camera with another focal length
  RgbdImage shoot(const Eigen::Isometry3d& T, const CameraModel& depth, const CameraModel& color,
                  const Eigen::Vector3d& color_from_depth = Eigen::Vector3d::Zero()) const
  {
    RgbdImage image{Image(color.width, color.height, 1), {depth.width, depth.height, {}}};
    for (int y = 0; y < depth.height; ++y)
      for (int x = 0; x < depth.width; ++x) {
        const Eigen::Vector3d ray((x + 0.5 - depth.cx) / depth.fx, (y + 0.5 - depth.cy) / depth.fy, 1);
        image.depth.data.push_back(
            static_cast<std::uint16_t>(1000 * cast(T.translation(), T.linear() * ray).depth + 0.5));
      }
    for (int y = 0; y < color.height; ++y)
      for (int x = 0; x < color.width; ++x) {
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
          const Eigen::Vector3d ray((x + 0.25 + 0.5 * (k % 2) - color.cx) / color.fx,
                                    (y + 0.25 + 0.5 * (k / 2) - color.cy) / color.fy, 1);
          sum += cast(T * Eigen::Vector3d(-color_from_depth), T.linear() * ray).gray;
        }
        *image.color.pixel(x, y) = static_cast<std::uint8_t>(sum / 4 + 0.5);
      }
    return image;
  }

private:
  double pattern(double u, double v, unsigned face) const
  {
    constexpr double cell = 0.15; // metres
    const auto random = [&](int i, int j) {
      unsigned h = (i * 73856093u) ^ (j * 19349663u) ^ ((face + 31 * seed_) * 83492791u);
      h = (h ^ (h >> 15)) * 0x2c1b3c6du;
      h = (h ^ (h >> 12)) * 0x297a2d39u;
      return (h ^ (h >> 15)) % 200 + 20.0;
    };
    return random(static_cast<int>(std::floor(u / cell)), static_cast<int>(std::floor(v / cell)));
  }

  unsigned seed_;
  const Eigen::Vector3d low_[4] = {{0, 0, 0}, {3.2, 0.2, 0}, {3.9, 2.2, 0}, {2.0, 3.2, 0}};
  const Eigen::Vector3d high_[4] = {{5, 4, 2.6}, {4.2, 1.0, 0.9}, {4.8, 3.0, 1.6}, {3.0, 3.9, 0.7}};
};

inline CameraModel smallCamera(double focal = 140)
{
  CameraModel camera;
  camera.width = 160, camera.height = 120;
  camera.fx = camera.fy = focal;
  camera.cx = 80, camera.cy = 60;
  return camera;
}

/// From the middle of the room towards the boxes, swinging there and back.
inline Eigen::Isometry3d swing(double phase)
{
  const double yaw = 0.5 * std::sin(phase), pitch = -0.15 + 0.1 * std::sin(2 * phase);
  const Eigen::Vector3d forward(std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch));
  const Eigen::Vector3d right(std::sin(yaw), -std::cos(yaw), 0);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << right, forward.cross(right), forward;
  T.translation() << 1.2 + 0.3 * std::sin(phase), 1.9 + 0.3 * std::cos(phase), 1.3;
  return T;
}

inline std::vector<Eigen::Isometry3d> swingPoses(int count)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int f = 0; f < count; ++f)
    poses.push_back(swing(6.283185307 * f / count));
  return poses;
}

inline std::vector<RgbdImage> shootAll(const std::vector<Eigen::Isometry3d>& poses, const RgbdRoom& room = RgbdRoom())
{
  std::vector<RgbdImage> images;
  for (const Eigen::Isometry3d& T : poses)
    images.push_back(room.shoot(T, smallCamera(), smallCamera()));
  return images;
}

inline RgbdVideo videoOf(const std::vector<RgbdImage>& images)
{
  RgbdVideo video;
  video.camera = smallCamera();
  video.count = images.size();
  video.read = [&images](Index f) { return images[f]; };
  return video;
}

/// Largest distance between estimated and true places, relative to the first frame that has a pose, metres.
inline double worstError(const std::vector<Pose>& found, const std::vector<Eigen::Isometry3d>& truth)
{
  double worst = 0;
  Eigen::Matrix4d gauge = Eigen::Matrix4d::Zero();
  for (std::size_t f = 0; f < truth.size(); ++f) {
    if (!found[f])
      continue;
    if (gauge.isZero())
      gauge = truth[f].matrix() * found[f]->inverse();
    worst = std::max(worst, (gauge * *found[f] - truth[f].matrix()).col(3).norm());
  }
  return worst;
}
} // namespace fresco::test
