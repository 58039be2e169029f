// SPDX-License-Identifier: BSD-3-Clause
#include "stages/standpoints.h"
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/rendering/indoor_view.h>
#include <fresco/rendering/picture.h>
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

std::vector<std::string> pictureFiles(const Job& job)
{
  std::vector<std::string> paths;
  for (const Shot& shot : shots(job.input))
    paths.push_back(job.files.snapshots + "/" + shot.name + ".png");
  return paths;
}

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
  places = chosen(places, variedViews(places, 3));
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
