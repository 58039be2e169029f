// SPDX-License-Identifier: BSD-3-Clause
#include "stages/stages.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/rendering/indoor_view.h>
#include <fresco/rendering/picture.h>
#include <limits>
namespace fresco::model {
using namespace rendering;
namespace {
enum class From { inside, place, above };

struct Shot {
  std::string name, title;
  Shading shading;
  From from;
  std::size_t place = 0; ///< number among the places of photographs, else of scans, that are shown
};

std::vector<Shot> shots(const ModelInput& input)
{
  const std::string what = input.rgbd || !input.cameras.views.empty() || input.findsCameras() ? "photograph" : "scan",
                    taken = what + " was taken";
  return {{"inside_texture", "From inside, textured", Shading::Texture, From::inside},
          {what + "_1_texture", "From where a " + taken + ", textured", Shading::Texture, From::place, 0},
          {what + "_2_texture", "From where another " + taken, Shading::Texture, From::place, 1},
          {what + "_3_texture", "From where a third " + taken, Shading::Texture, From::place, 2},
          {"above_texture", "From above without the ceiling, textured", Shading::Texture, From::above},
          {"inside_normals", "From inside, coloured by normal", Shading::Normals, From::inside},
          {"inside_gouraud", "From inside, surface alone", Shading::Gouraud, From::inside},
          {"above_normals", "From above, coloured by normal", Shading::Normals, From::above},
          {"above_gouraud", "From above, surface alone", Shading::Gouraud, From::above}};
}

constexpr double looking_angle = 62; ///< degrees, of a person looking around

/// Where a photograph was taken, with its opening angle.
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

/// From where each scan was taken, level to the middle of the model.
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

/// Views of the photographs that look about level; all of them where none does.
std::vector<Viewpoint> levelViews(const Job& job, const Eigen::Vector3d& up)
{
  std::vector<Viewpoint> all, level;
  const CameraSet cameras = placedCameras(job);
  for (const View& view : cameras.views)
    all.push_back(viewOf(cameras.cameras[view.camera], view.T_camera_world.inverse()));
  if (job.input.rgbd)
    for (const RgbdFrame& frame : placedFrames(job))
      all.push_back(viewOf(job.input.rgbd->camera, frame.T_world_camera));
  for (const Viewpoint& view : all)
    if (std::abs((view.look - view.eye).dot(up)) < 0.5) // 30 degrees up or down
      level.push_back(view);
  return level.empty() ? all : level;
}

/// `count` views that differ most in place and direction, the first one first (farthest point sampling).
std::vector<Viewpoint> variedViews(const std::vector<Viewpoint>& views, std::size_t count)
{
  const auto difference = [](const Viewpoint& a, const Viewpoint& b) {
    return (a.eye - b.eye).norm() + 2.0 * ((a.look - a.eye) - (b.look - b.eye)).norm(); // a metre counts as 30 degrees
  };
  std::vector<Viewpoint> chosen = {views.front()};
  while (chosen.size() < count) {
    const auto nearest = [&](const Viewpoint& view) {
      double least = std::numeric_limits<double>::infinity();
      for (const Viewpoint& other : chosen)
        least = std::min(least, difference(view, other));
      return least;
    };
    chosen.push_back(*std::max_element(
        views.begin(), views.end(), [&](const Viewpoint& a, const Viewpoint& b) { return nearest(a) < nearest(b); }));
  }
  return chosen;
}

/// Upright direction: that of the frame for scans; for RGB-D frames and projects of photographs, whose world may be tilted,
/// the mean of the cameras'.
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
Figures listOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Figures entryOf(const Shot& shot, const Viewpoint& view)
{
  return {{"file", "snapshots/" + shot.name + ".png"},
          {"title", shot.title},
          {"textured", shot.shading == Shading::Texture},
          {"eye", listOf(view.eye)},
          {"look", listOf(view.look)},
          {"angle", view.angle}};
}
} // namespace

std::vector<std::string> pictureFiles(const Job& job)
{
  std::vector<std::string> paths;
  for (const Shot& shot : shots(job.input))
    paths.push_back(job.files.snapshots + "/" + shot.name + ".png");
  return paths;
}

namespace {
/// How all pictures of one shading are made.
PictureOptions optionsFor(Shading shading, const ModelOptions& options, const TexturedMesh& model)
{
  PictureOptions picture;
  picture.width = options.width;
  picture.height = options.height;
  picture.threads = options.threads;
  picture.shading = shading == Shading::Texture && model.atlases.empty() ? Shading::Gouraud : shading;
  picture.oversampling = 2; // textures and small faces hold finer detail than the picture
  picture.no_colors = shading == Shading::Gouraud;
  return picture;
}
} // namespace

Figures makePictures(const Job& job, const Progress& progress)
{
  const auto& [input, files, options, stages, ranks] = job;
  const TexturedMesh model = readTexturedMesh(files.model_obj);
  const Eigen::Vector3d up = uprightOf(job).value_or(Eigen::Vector3d::UnitZ());
  const IndoorOptions indoor{uprightOf(job), static_cast<double>(options.width) / options.height, options.threads};
  const auto [from_inside, above] = indoorViews(model.mesh, indoor);
  const Viewpoint inside = from_inside.value_or(above);
  std::vector<Viewpoint> places = levelViews(job, up);
  if (places.empty())
    places = viewsFromScans(job, model.mesh, up);
  if (places.empty()) // a cloud that does not tell where it was seen from
    places = {inside};
  places = variedViews(places, 3);
  const std::vector<Shot> all = shots(input);
  Figures list = Figures::array();
  int made = 0;
  for (const Shading shading : {Shading::Texture, Shading::Normals, Shading::Gouraud}) {
    PictureSeries series(model, optionsFor(shading, options, model));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Shot& shot = all[i];
      if (shot.shading != shading)
        continue;
      report(progress, shot.name, double(made++) / all.size());
      const bool is_above = shot.from == From::above;
      const Viewpoint& view = is_above ? above : shot.from == From::inside ? inside : places[shot.place];
      writeImage(pictureFiles(job)[i], series.draw(view, is_above));
      list[i] = entryOf(shot, view);
    }
  }
  return {{"up", listOf(up)}, {"pictures", list}};
}
} // namespace fresco::model
