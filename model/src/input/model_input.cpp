// SPDX-License-Identifier: BSD-3-Clause
#include "input/model_input.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/image_io.h>
#include <fresco/io/pose_file.h>
#include <map>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

std::vector<std::string> scanFiles(const std::string& folder)
{
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string path = entry.path().string(), kind = extension(path);
    const bool hidden = entry.path().filename().string()[0] == '.';
    if (!hidden && isReadable(path, FileKind::points) && kind != ".txt" && kind != ".stl") // notes; no scans
      files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw std::runtime_error(folder + ": no scan (" + readableExtensions(FileKind::points) + ") in it");
  return files;
}

/// The scans in `files`, with the poses that the files themselves have.
void takeScans(ModelInput& input, const std::vector<std::string>& files)
{
  input.scans = scansOf(files, true);
  input.poses = posesOf(input.scans);
  if (std::none_of(input.poses.begin(), input.poses.end(), [](const Pose& pose) { return pose.has_value(); }))
    input.poses.clear();
  input.inside = picturesOf(input.scans);
}

bool isPicture(const std::string& path)
{
  const std::string kind = extension(path);
  return kind == ".jpg" || kind == ".jpeg" || kind == ".png" || kind == ".tif" || kind == ".tiff";
}

/// Pictures in a folder, sorted by name; none where there is no such folder.
template <typename Walk>
std::vector<std::string> pictureNames(const std::string& folder)
{
  std::vector<std::string> names;
  if (fs::is_directory(folder))
    for (const auto& entry : Walk(folder)) {
      const std::string name = fs::relative(entry.path(), folder).string();
      if (entry.is_regular_file() && entry.path().filename().string()[0] != '.' && isPicture(name) &&
          name.rfind("masks/", 0) != 0)
        names.push_back(name);
    }
  std::sort(names.begin(), names.end());
  return names;
}

/// Those of `panoramas/`, each named as its scan.
void readPanoramas(ModelInput& input)
{
  const std::string folder = input.folder + "/panoramas";
  if (!fs::is_directory(folder))
    return;
  std::map<std::string, Index> numbers; // of the files that are one scan
  for (std::size_t s = 0; s < input.scans.size(); ++s)
    if (input.scans[s].scan < 0)
      numbers[fs::path(input.scans[s].file).stem().string()] = s;
  for (const std::string& name : pictureNames<fs::directory_iterator>(folder)) {
    const std::string path = folder + "/" + name;
    const auto scan = numbers.find(fs::path(name).stem().string());
    if (scan == numbers.end())
      throw std::runtime_error(path + ": a panorama of no scan: none in " + input.folder + "/scans has this name");
    input.panoramas.push_back({path, scan->second});
  }
}

void readPhotographs(ModelInput& input)
{
  const std::string cameras = input.folder + "/cameras";
  input.images = input.folder + "/images";
  if (!fs::is_directory(cameras)) {
    input.unplaced = pictureNames<fs::recursive_directory_iterator>(input.images);
    return;
  }
  input.cameras = readColmap(cameras);
  input.sparse = readColmapPoints(cameras);
  for (const View& view : input.cameras.views)
    if (!fs::exists(input.images + "/" + view.image))
      throw std::runtime_error(input.images + "/" + view.image + ": no such photograph, but " + cameras + " names it");
}
} // namespace

std::vector<std::string> ModelInput::files() const
{
  std::vector<std::string> all;
  for (const ScanPath& scan : scans)
    if (all.empty() || all.back() != scan.file)
      all.push_back(scan.file);
  for (const PictureFile& picture : pictures()) {
    all.push_back(picture.file);
    if (!picture.mask.empty())
      all.push_back(picture.mask);
  }
  for (const char* name :
       {"poses.txt", "cameras/cameras.txt", "cameras/images.txt", "cameras/points3D.txt", "cameras/cameras.bin",
        "cameras/images.bin", "cameras/points3D.bin", "camera-intrinsics.txt"})
    if (fs::exists(folder + "/" + name))
      all.push_back(folder + "/" + name);
  if (rgbd)
    for (const RgbdFrame& frame : rgbd->frames)
      all.push_back(frame.depth);
  return all;
}

std::vector<PictureFile> ModelInput::pictures() const
{
  std::vector<PictureFile> all;
  for (const View& view : cameras.views)
    all.push_back({images + "/" + view.image, maskFileOf(images, view.image), &cameras.cameras[view.camera]});
  for (const std::string& name : unplaced)
    all.push_back({images + "/" + name, maskFileOf(images, name)});
  if (rgbd)
    for (const RgbdFrame& frame : rgbd->frames)
      all.push_back({frame.color, maskFileOf(folder, fs::path(frame.color).filename().string())});
  for (const Panorama& panorama : panoramas) {
    const fs::path file(panorama.file);
    all.push_back({panorama.file, maskFileOf(file.parent_path().string(), file.filename().string()), nullptr, true});
  }
  return all;
}

ModelInput readModelInput(const std::string& folder)
{
  ModelInput input;
  input.folder = folder;
  if (fs::is_regular_file(folder) && holdsScans(folder)) {
    takeScans(input, {folder});
    return input;
  }
  if (!fs::is_directory(folder))
    throw std::runtime_error(folder + ": no such folder");
  if (isRgbdFolder(folder)) {
    input.rgbd = readRgbdFolder(folder);
    if (input.rgbd->has_poses)
      for (const RgbdFrame& frame : input.rgbd->frames)
        input.poses.emplace_back(frame.T_world_camera.matrix());
    return input;
  }
  if (!fs::is_directory(folder + "/scans"))
    throw std::runtime_error(folder + ": neither a folder scans nor RGB-D frames (camera-intrinsics.txt) in it");
  takeScans(input, scanFiles(folder + "/scans"));
  if (fs::exists(folder + "/poses.txt")) {
    input.poses = readPoses(folder + "/poses.txt");
    if (input.poses.size() != input.scans.size())
      throw std::runtime_error(
          concat(folder, "/poses.txt: ", input.poses.size(), " poses for ", input.scans.size(), " scans"));
  }
  readPhotographs(input);
  readPanoramas(input);
  return input;
}

std::string describe(const ModelInput& input)
{
  const auto counted = [](std::size_t count, const char* what) {
    return concat(count, " ", what, count == 1 ? "" : "s");
  };
  if (input.rgbd)
    return counted(input.rgbd->frames.size(), "RGB-D frame") + (input.rgbd->has_poses ? "" : " without poses");
  const auto& inside = input.inside.pictures;
  const std::size_t panoramas_inside =
      std::count_if(inside.begin(), inside.end(), [](const ScanPicture& picture) { return picture.isPanorama(); });
  const std::size_t panoramas = input.panoramas.size() + panoramas_inside;
  const std::size_t photographs = input.cameras.views.size() + inside.size() - panoramas_inside;
  std::string text = counted(input.scans.size(), "scan");
  if (panoramas > 0)
    text += ", " + counted(panoramas, "panorama");
  if (photographs > 0)
    text += ", " + counted(photographs, "photograph");
  if (!input.unplaced.empty())
    text += ", " + counted(input.unplaced.size(), "photograph") + " without cameras";
  return input.hasPictures() ? text : text + ", no pictures: the texture comes from the points";
}

void checkPhotographs(const ModelInput& input, int threads)
{
  const std::vector<PictureFile> photographs = input.pictures();
  std::vector<std::string> problems(photographs.size() + input.inside.pictures.size());
  const auto look = [&](Index i) {
    const auto& [file, mask, camera, panorama] = photographs[i];
    try {
      const Image image = camera ? readImage(file, *camera) : readImage(file);
      if (panorama && image.width != 2 * image.height)
        problems[i] =
            concat(file, ": a panorama of ", image.width, "x", image.height, " pixels is not twice as wide as high");
      if (mask.empty())
        return;
      if (const Image area = readImage(mask); area.width != image.width || area.height != image.height)
        problems[i] = concat(mask, ": is ", area.width, "x", area.height, " pixels, its photograph ", image.width, "x",
                             image.height);
    } catch (const std::runtime_error& error) {
      problems[i] = error.what();
    }
  };
  parallelFor(photographs.size(), threads, look, 1);
  const auto lookInside = [&](Index i) {
    try {
      readPicture(input.inside.pictures[i]);
    } catch (const std::runtime_error& error) {
      problems[photographs.size() + i] = error.what();
    }
  };
  parallelFor(input.inside.pictures.size(), threads, lookInside, 1);
  for (const std::string& problem : problems)
    if (!problem.empty())
      throw std::runtime_error(problem);
}
} // namespace fresco::model
