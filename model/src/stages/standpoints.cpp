// SPDX-License-Identifier: BSD-3-Clause
#include "stages/standpoints.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/io/pose_file.h>
#include <limits>
namespace fresco::model {
using rendering::Viewpoint;
namespace {
constexpr double looking_angle = 62; ///< degrees, of a person looking around
} // namespace

Viewpoint viewOf(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera)
{
  Viewpoint view;
  view.eye = T_world_camera.translation();
  view.look = view.eye + T_world_camera.linear().col(2);
  view.up = -T_world_camera.linear().col(1);
  view.angle = camera.projection == CameraProjection::spherical
                   ? looking_angle
                   : 2 * std::atan(0.5 * camera.height / camera.fy) * 180.0 / pi;
  return view;
}

std::vector<Viewpoint> viewsFromScans(const Job& job, const TriangleMesh& mesh, const Eigen::Vector3d& up)
{
  const Eigen::Vector3d middle =
      mesh.origin + 0.5 * (mesh.vertices.rowwise().minCoeff() + mesh.vertices.rowwise().maxCoeff()).cast<double>();
  std::vector<Viewpoint> views;
  std::vector<Eigen::Vector3d> places = job.input.sensor_path;
  if (!job.input.is_cloud)
    for (const Pose& pose : readPoses(job.files.poses))
      if (pose)
        places.emplace_back(pose->topRightCorner<3, 1>());
  for (const Eigen::Vector3d& eye : places) {
    Eigen::Vector3d ahead = middle - eye;
    ahead -= ahead.dot(up) * up;
    if (ahead.norm() < 1e-3)
      ahead = up.unitOrthogonal();
    views.push_back({eye, eye + ahead.normalized(), up, looking_angle});
  }
  return views;
}

bool isLevel(const Viewpoint& view, const Eigen::Vector3d& up)
{
  return std::abs((view.look - view.eye).dot(up)) < 0.5; // 30 degrees up or down
}

std::vector<Viewpoint> levelViews(const Job& job, const Eigen::Vector3d& up)
{
  std::vector<Viewpoint> all, level;
  const CameraSet cameras = placedCameras(job);
  for (const View& view : cameras.views)
    all.push_back(viewOf(cameras.cameras[view.camera], view.T_camera_world.inverse()));
  if (job.input.rgbd)
    for (const RgbdFrame& frame : placedFrames(job))
      all.push_back(viewOf(job.input.rgbd->camera, frame.T_world_camera));
  std::copy_if(all.begin(), all.end(), std::back_inserter(level),
               [&](const Viewpoint& view) { return isLevel(view, up); });
  return level.empty() ? all : level;
}

std::vector<std::size_t> variedViews(const std::vector<Viewpoint>& views, std::size_t count)
{
  const auto difference = [](const Viewpoint& a, const Viewpoint& b) {
    return (a.eye - b.eye).norm() + 2.0 * ((a.look - a.eye) - (b.look - b.eye)).norm(); // a metre counts as 30 degrees
  };
  std::vector<double> nearest(views.size(), std::numeric_limits<double>::infinity()); // difference from the chosen ones
  std::vector<std::size_t> numbers;
  for (std::size_t next = 0; numbers.size() < count;
       next = std::max_element(nearest.begin(), nearest.end()) - nearest.begin()) {
    numbers.push_back(next);
    for (std::size_t v = 0; v < views.size(); ++v)
      nearest[v] = std::min(nearest[v], difference(views[v], views[next]));
  }
  return numbers;
}

std::vector<Viewpoint> chosen(const std::vector<Viewpoint>& views, const std::vector<std::size_t>& numbers)
{
  std::vector<Viewpoint> found;
  for (const std::size_t number : numbers)
    found.push_back(views[number]);
  return found;
}

std::optional<Eigen::Vector3d> uprightOf(const Job& job)
{
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  if (!job.input.rgbd) {
    if (job.input.is_cloud && job.input.sensor_path.empty())
      for (const View& view : placedCameras(job).views)
        up -= view.T_camera_world.linear().row(1).transpose();
    return up.norm() > 0 ? up.normalized().eval() : Eigen::Vector3d::UnitZ();
  }
  for (const RgbdFrame& frame : placedFrames(job))
    up -= frame.T_world_camera.linear().col(1);
  return up.norm() > 0 ? std::optional<Eigen::Vector3d>(up.normalized()) : std::nullopt;
}
} // namespace fresco::model
