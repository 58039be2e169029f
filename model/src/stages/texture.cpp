// SPDX-License-Identifier: BSD-3-Clause
#include "stages/photograph_places.h"
#include "stages/placed_points.h"
#include "stages/stages.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/texture/core/point_texture.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <set>
namespace fresco::model {
namespace {
/// Where a panorama was taken, in the frame of its scan: where the scanner stood.
Eigen::Isometry3d panoramaPose(const ScanPath& path, double direction)
{
  const PointSet scan = readPoints(path);
  Eigen::Isometry3d T_scan_camera = Eigen::Isometry3d::Identity();
  if (scan.viewpoints.cols() == 1)
    T_scan_camera.translation() = scan.origin + scan.viewpoints.col(0).cast<double>();
  const double angle = direction / degrees_per_radian;
  T_scan_camera.linear().col(2) << std::cos(angle), std::sin(angle), 0;
  T_scan_camera.linear().col(1) << 0, 0, -1;
  T_scan_camera.linear().col(0) << std::sin(angle), -std::cos(angle), 0;
  return T_scan_camera;
}

/// @param poses of the scans; panoramas of scans without a place are left out
std::vector<TextureView> panoramaViews(const Job& job, const std::vector<Pose>& poses)
{
  std::vector<TextureView> views;
  for (const Panorama& panorama : job.input.panoramas) {
    if (!poses.at(panorama.scan))
      continue;
    const ImageSize image = readImageSize(panorama.file);
    TextureView next;
    next.camera = sphericalCamera(image.width, image.height);
    next.T_camera_world = (Eigen::Isometry3d(*poses[panorama.scan]) *
                           panoramaPose(job.input.scans[panorama.scan], job.options.panorama_direction))
                              .inverse();
    next.path = panorama.file;
    next.mirrored = job.options.panorama_mirrored;
    views.push_back(std::move(next));
  }
  return views;
}

/// Pictures inside of files of scans, unpacked into a folder of their own; those of scans without a place are left out.
std::vector<TextureView> scanPictureViews(const Job& job, const std::vector<Pose>& poses)
{
  std::vector<TextureView> views;
  for (const ScanPicture& picture : job.input.inside.pictures) {
    if (!poses.at(picture.scan))
      continue;
    makeFolder(job.files.pictures);
    const CameraPicture taken = readPicture(picture);
    const std::string of = std::filesystem::path(picture.file).stem().string();
    const std::string stem = concat(job.files.pictures, "/", of, "_picture_", picture.number + 1);
    TextureView next;
    next.camera = taken.camera;
    next.T_camera_world = picture.T_camera_scan * Eigen::Isometry3d(*poses[picture.scan]).inverse();
    next.path = stem + (taken.as_stored && picture.what.encoding == ScanImage::Encoding::jpeg ? ".jpg" : ".png");
    if (taken.as_stored)
      writeFile(next.path, readScanImageBytes(picture.file, picture.number));
    else
      writeImage(next.path, taken.image);
    if (!taken.mask.empty())
      writeImage(next.mask_path = stem + "_mask.png", taken.mask);
    views.push_back(std::move(next));
  }
  return views;
}

/// @param poses of scans, or of the frames of an RGB-D folder, world from camera
std::vector<TextureView> viewsOf(const Job& job, const std::vector<Pose>& poses)
{
  const ModelInput& input = job.input;
  std::vector<TextureView> views = panoramaViews(job, poses);
  for (TextureView& view : scanPictureViews(job, poses))
    views.push_back(std::move(view));
  const CameraSet cameras = placedCameras(job);
  for (const View& view : cameras.views) {
    TextureView next;
    next.camera = cameras.cameras[view.camera];
    next.T_camera_world = view.T_camera_world;
    next.path = input.images + "/" + view.image;
    views.push_back(std::move(next));
  }
  if (input.rgbd)
    for (std::size_t f = 0; f < input.rgbd->frames.size(); ++f) {
      if (!poses.at(f))
        continue;
      TextureView next;
      next.camera = input.rgbd->frames[f].color_camera;
      next.T_camera_world = Eigen::Isometry3d(*poses.at(f)).inverse();
      next.path = input.rgbd->frames[f].color;
      views.push_back(std::move(next));
    }
  std::map<std::string, std::string> masks;
  for (const PictureFile& picture : input.pictures())
    masks[picture.file] = picture.mask;
  for (TextureView& view : views)
    if (const auto mask = masks.find(view.path); mask != masks.end()) // those in files of scans have theirs
      view.mask_path = mask->second;
  return views;
}

/// Removes the pictures and masks of an earlier model that had others: more atlases, or another format.
void removeOldPictures(const ModelFiles& files, std::size_t masks)
{
  namespace fs = std::filesystem;
  std::set<std::string> present;
  for (std::size_t i = 0; i < masks; ++i)
    present.insert(fs::path(maskPath(files.model_obj, i, masks)).filename());
  std::ifstream materials(fs::path(files.model_obj).replace_extension(".mtl"));
  for (std::string word; materials >> word;)
    if (word == "map_Kd" && materials >> word)
      present.insert(word);
  const std::regex ours("model(_mask)?(_[0-9]+)?\\.(png|jpg)");
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(fs::path(files.model_obj).parent_path()))
    if (const std::string name = entry.path().filename(); std::regex_match(name, ours) && present.count(name) == 0)
      old.push_back(entry.path());
  for (const fs::path& path : old)
    fs::remove(path);
}

TexturedModelWriter writerOf(const Job& job)
{
  return TexturedModelWriter({{job.files.model_obj, job.options.quality}, {job.files.full_glb, job.options.quality}});
}

AtlasSink sinkOf(TexturedModelWriter& writer)
{
  return [&](const Image& atlas, const Image& mask) { writer.addAtlas(atlas, mask); };
}

/// Of a TextureResult or PointTextureResult, the figures that both have.
template <typename Result>
Figures figuresOf(const Result& result)
{
  return {{"coverage", result.coverage},
          {"charts", result.charts},
          {"atlases", result.model.atlases.size()},
          {"atlas_width", result.model.atlases.empty() ? 0 : result.model.atlases[0].width},
          {"atlas_used", result.used},
          {"texel", result.texel},
          {"warnings", result.warnings}};
}

Figures textureFromPoints(const Job& job, TriangleMesh mesh, const Progress& progress)
{
  static constexpr const char* looks[] = {"nothing: no colours, no intensities", "colours of the points",
                                          "intensities of the points"};
  constexpr Index most_points = 20000000; // about 2 GB while they are painted
  PointTextureOptions texture;
  texture.texel = job.options.texel;
  texture.atlas = job.options.atlas;
  texture.threads = job.options.threads;
  texture.tile_faces = job.options.tile_faces;
  TexturedModelWriter output = writerOf(job);
  const PointTextureResult result = reconstructPointTexture(
      std::move(mesh), PlacedPoints(job.files.points).sample(most_points), texture, progress, sinkOf(output));
  output.finish(result.model, result.masks);
  removeOldPictures(job.files, result.masks.size());
  Figures figures = {{"made_of", looks[int(result.look)]}};
  figures.update(figuresOf(result));
  if (result.look == PointLook::intensities)
    figures.update({{"range_exponent", result.range_exponent}, {"incidence_exponent", result.incidence_exponent}});
  return figures;
}

Figures textureFromViews(const Job& job, TriangleMesh mesh, const std::vector<TextureView>& views,
                         const Progress& progress)
{
  const ModelInput& input = job.input;
  TextureOptions texture = job.stages.texture;
  texture.texel = job.options.texel;
  texture.atlas = job.options.atlas;
  texture.tile_faces = job.options.tile_faces;
  TexturedModelWriter output = writerOf(job);
  TextureResult result = reconstructTexture(std::move(mesh), views, texture, progress, sinkOf(output));
  output.finish(result.model, result.masks);
  removeOldPictures(job.files, result.masks.size());
  const std::size_t given = input.panoramas.size() + input.inside.pictures.size() + placedCameras(job).views.size();
  if (views.size() < given)
    result.warnings.push_back(concat(given - views.size(), " pictures are not used: their scans have no place"));
  const auto isPanorama = [](const TextureView& view) { return view.camera.projection == CameraProjection::spherical; };
  const std::size_t panoramas = std::count_if(views.begin(), views.end(), isPanorama);
  Figures figures = {
      {"made_of", panoramas == 0              ? "photographs"
                  : panoramas == views.size() ? "panoramas"
                                              : "photographs and panoramas"},
      {"photographs", views.size()},
      {"photographs_used", result.views_used},
      {"masks", std::count_if(views.begin(), views.end(), [](const auto& v) { return !v.mask_path.empty(); })},
      {"cameras", result.refined ? "refined" : "left as given"},
      {"disagreement_before_pixels", result.disagreement_before},
      {"disagreement_after_pixels", result.disagreement_after}};
  for (std::size_t v = 0; v < result.fits.size(); ++v)
    figures["photograph_fits"].push_back({{"photograph", views[v].path},
                                          {"places", result.fits[v].matches},
                                          {"median_pixels", result.fits[v].median},
                                          {"nine_tenths_below_pixels", result.fits[v].upper}});
  for (std::size_t v = 0; v < result.blank.size(); ++v)
    if (result.blank[v] > 0)
      figures["photograph_blanks"].push_back({{"photograph", views[v].path}, {"share", result.blank[v]}});
  figures.update(figuresOf(result));
  for (const auto& [phase, seconds] : result.seconds)
    figures["seconds"][phase] = seconds;
  return figures;
}
} // namespace

Figures makeTexture(const Job& job, const Progress& progress)
{
  TriangleMesh mesh = readMesh(job.files.mesh);
  const std::vector<TextureView> views = viewsOf(job, readPoses(job.files.poses));
  Figures figures = views.empty() ? textureFromPoints(job, std::move(mesh), progress)
                                  : textureFromViews(job, std::move(mesh), views, progress);
  for (const std::string& warning : job.input.inside.warnings)
    figures["warnings"].push_back(warning);
  figures["places"] = writePhotographPlaces(job, views);
  std::filesystem::remove_all(job.files.pictures);
  return figures;
}
} // namespace fresco::model
