// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/indoor_view.h"
#include "rendering/picture.h"
#include "stages/stages.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <limits>
namespace fresco::model {
using namespace rendering;
namespace {
enum class From { inside, photograph, above };

struct Shot {
  std::string name, title;
  Shading shading;
  From from;
  std::size_t photograph = 0; ///< number among the photographs' places that are shown
};

const std::vector<Shot>& shots()
{
  static const std::vector<Shot> all = {
      {"inside_texture", "From inside, textured", Shading::Texture, From::inside},
      {"photograph_1_texture", "From where a photograph was taken, textured", Shading::Texture, From::photograph, 0},
      {"photograph_2_texture", "From where another photograph was taken", Shading::Texture, From::photograph, 1},
      {"photograph_3_texture", "From where a third photograph was taken", Shading::Texture, From::photograph, 2},
      {"above_texture", "From above without the ceiling, textured", Shading::Texture, From::above},
      {"inside_normals", "From inside, coloured by normal", Shading::Normals, From::inside},
      {"inside_gouraud", "From inside, surface alone", Shading::Gouraud, From::inside},
      {"above_normals", "From above, coloured by normal", Shading::Normals, From::above},
      {"above_gouraud", "From above, surface alone", Shading::Gouraud, From::above}};
  return all;
}

/// Where a photograph was taken, with its opening angle.
Viewpoint viewOf(const CameraModel& camera, const Eigen::Isometry3d& T_world_camera)
{
  Viewpoint view;
  view.eye = T_world_camera.translation();
  view.look = view.eye + T_world_camera.linear().col(2);
  view.up = -T_world_camera.linear().col(1);
  view.angle = 2 * std::atan(0.5 * camera.height / camera.fy) * 180.0 / pi;
  return view;
}

/// Views of the photographs that look about level; all of them where none does.
std::vector<Viewpoint> levelViews(const ModelInput& input, const Eigen::Vector3d& up)
{
  std::vector<Viewpoint> all, level;
  for (const View& view : input.cameras.views)
    all.push_back(viewOf(input.cameras.cameras[view.camera], view.T_camera_world.inverse()));
  if (input.rgbd)
    for (const RgbdFrame& frame : input.rgbd->frames)
      all.push_back(viewOf(input.rgbd->camera, frame.T_world_camera));
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

/// Upright direction: that of the frame for scans; for RGB-D frames, whose world may be tilted,
/// the mean of the cameras'.
std::optional<Eigen::Vector3d> uprightOf(const ModelInput& input)
{
  if (!input.rgbd)
    return Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const RgbdFrame& frame : input.rgbd->frames)
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

std::vector<std::string> pictureFiles(const ModelFiles& files)
{
  std::vector<std::string> paths;
  for (const Shot& shot : shots())
    paths.push_back(files.snapshots + "/" + shot.name + ".png");
  return paths;
}

Figures makePictures(const Job& job, const Progress& progress)
{
  const auto& [input, files, options] = job;
  const TexturedMesh model = readTexturedMesh(files.model_obj);
  const IndoorOptions indoor{uprightOf(input), static_cast<double>(options.width) / options.height, options.threads};
  const Viewpoint above = aboveView(model.mesh, indoor);
  const Viewpoint inside = insideView(model.mesh, indoor).value_or(above);
  const std::vector<Viewpoint> photographs =
      variedViews(levelViews(input, indoor.up.value_or(Eigen::Vector3d::UnitZ())), 3);
  PictureOptions picture;
  picture.width = options.width;
  picture.height = options.height;
  picture.threads = options.threads;
  Figures list = Figures::array();
  for (std::size_t i = 0; i < shots().size(); ++i) {
    const Shot& shot = shots()[i];
    report(progress, shot.name, double(i) / shots().size());
    picture.shading = shot.shading;
    picture.oversampling = shot.shading == Shading::Texture ? 2 : 1; // textures hold finer detail than the picture
    picture.view = shot.from == From::above ? above : shot.from == From::inside ? inside : photographs[shot.photograph];
    picture.cull_back_faces = shot.from == From::above;
    picture.no_colors = shot.shading == Shading::Gouraud;
    const Image image =
        shot.shading == Shading::Texture ? renderPicture(model, picture) : renderPicture(model.mesh, picture);
    writeImage(pictureFiles(files)[i], image);
    list.push_back(entryOf(shot, *picture.view));
  }
  return {{"up", listOf(indoor.up.value_or(Eigen::Vector3d::UnitZ()))}, {"pictures", list}};
}
} // namespace fresco::model
