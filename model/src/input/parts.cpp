// SPDX-License-Identifier: BSD-3-Clause
#include "input/parts.h"
#include "input/standpoint.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/camera_files.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/listed.h>
#include <fresco/io/text_rows.h>
#include <map>
#include <set>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

/// "PCD", "E57 and LAS".
std::string kindsOf(const std::vector<std::string>& names)
{
  std::set<std::string> kinds;
  for (const std::string& name : names) {
    std::string kind = extension(name).substr(1);
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::toupper(c); });
    kinds.insert(kind);
  }
  std::string text;
  for (const std::string& kind : kinds)
    text += (text.empty() ? "" : " and ") + kind;
  return text;
}

/// The files that are one scan, by the stems of their names.
std::map<std::string, Index> scansByName(const ModelInput& input)
{
  std::map<std::string, Index> numbers;
  for (std::size_t s = 0; s < input.scans.size(); ++s)
    if (input.scans[s].scan < 0)
      numbers[stemOf(input.scans[s].file)] = s;
  return numbers;
}
} // namespace

std::string readablePoints() { return readableExtensions(FileKind::points); }

std::string roughOnly()
{
  return "photographs alone give a rough model, whose size in metres is not known, of the points that structure from "
         "motion finds: for a fine one run colmap's patch_match_stereo and stereo_fusion (they want a CUDA card) and "
         "give the project folder, or add scans";
}

void takeScans(ModelInput& input, const Survey& found, const std::vector<std::string>& names)
{
  std::vector<std::string> files;
  for (const std::string& name : names)
    files.push_back(found.at(name));
  input.scans = scansOf(files, true);
  input.poses = posesOf(input.scans);
  if (std::none_of(input.poses.begin(), input.poses.end(), [](const Pose& pose) { return pose.has_value(); }))
    input.poses.clear();
  input.inside = picturesOf(input.scans);
  input.found.push_back(concat(counted(files.size(), "file"), " of points (", kindsOf(names),
                               "): ", counted(input.scans.size(), "scan"),
                               input.poses.empty() ? "" : " with poses of their own"));
}

std::vector<std::string> cloudsIn(const Survey& found)
{
  const std::vector<std::string> all = found.match("<points>");
  std::vector<std::string> clouds;
  std::copy_if(all.begin(), all.end(), std::back_inserter(clouds),
               [&](const std::string& name) { return !holdsFaces(found.at(name)); });
  return clouds.empty() ? all : clouds;
}

void takePoses(ModelInput& input, const Survey& found)
{
  if (!found.has("poses.txt"))
    return;
  input.poses = readPoses(found.at("poses.txt"));
  if (input.poses.size() != input.scans.size())
    throw std::runtime_error(concat(found.at("poses.txt"), ": ", input.poses.size(), " poses for ", input.scans.size(),
                                    " scans: a line each is wanted ('none' where it is not known)"));
  const auto unknown = std::count(input.poses.begin(), input.poses.end(), std::nullopt);
  input.found.push_back(
      unknown > 0 && unknown < Index(input.poses.size())
          ? concat("poses.txt: ", input.poses.size() - unknown, " start poses; those of ", unknown, " scans are found")
          : "poses.txt: the first pose gives the frame; with -use_poses all are taken as they are");
}

void takeAsCloud(ModelInput& input, const Survey& found)
{
  input.is_cloud = true;
  if (input.poses.empty())
    input.poses.assign(input.scans.size(), Pose(Eigen::Matrix4d::Identity()));
  input.found.push_back("the points are one cloud in one frame, which the model keeps");
  if (!found.has("trajectory.txt"))
    return;
  const std::string path = found.at("trajectory.txt");
  for (const auto& row : readTextRows(path)) {
    if (row.size() < 3)
      throw std::runtime_error(path + ": wants lines of x y z, or of time x y z and whatever else");
    const int first = row.size() == 3 ? 0 : 1;
    Eigen::Vector3d place;
    for (int k = 0; k < 3; ++k)
      place[k] = numberIn(path, row[first + k]);
    if (!place.allFinite())
      continue;
    input.sensor_path.push_back(place);
    if (first == 1)
      input.sensor_times.push_back(numberIn(path, row[0]));
  }
  if (!std::is_sorted(input.sensor_times.begin(), input.sensor_times.end()))
    throw std::runtime_error(path + ": its lines are not in the order of time: sort them");
  if (input.sensor_times.size() != input.sensor_path.size())
    input.sensor_times.clear();
  input.found.push_back(concat("trajectory.txt: ", counted(input.sensor_path.size(), "place"), " of the sensor"));
}

void takeUnplaced(ModelInput& input, const Survey& found, const std::string& images)
{
  input.images = images.empty() ? found.path() : found.at(images);
  const std::string below = images.empty() ? "" : images + "/";
  for (const char* level : {"<pictures>", "*/<pictures>"})
    for (const std::string& name : found.match(below + level))
      if (const std::string own = name.substr(below.size()); own.rfind("masks/", 0) != 0)
        input.unplaced.push_back(own);
  std::sort(input.unplaced.begin(), input.unplaced.end());
  if (!input.unplaced.empty())
    input.found.push_back(
        concat(counted(input.unplaced.size(), "photograph"), " without cameras: the program colmap finds them"));
}

void takeCameras(ModelInput& input, const Survey& found, const std::string& cameras, const std::string& images)
{
  input.images = images.empty() ? found.path() : found.at(images);
  input.camera_folder = cameras;
  CameraFile file = readCameraFile(cameras, input.images);
  input.cameras = std::move(file.set);
  input.sparse = std::move(file.points);
  input.found.push_back(concat(counted(input.cameras.views.size(), "photograph"), " with cameras (",
                               fs::path(cameras).lexically_relative(found.path()).string(),
                               input.sparse.empty() ? ")" : concat(", ", input.sparse.size(), " points)")));
}

void takePhotographs(ModelInput& input, const Survey& found)
{
  const std::string images = found.has("images/") ? "images" : "";
  std::vector<std::string> cameras;
  if (found.has("cameras/"))
    cameras = {found.at("cameras")};
  else
    for (const char* pattern : camera_files)
      for (const std::string& name : found.match(pattern))
        if (!cameraFileIn(found.at(name)).empty())
          cameras.push_back(found.at(name));
  if (cameras.size() > 1)
    throw std::runtime_error(cameras[0] + " and " + listed({cameras.begin() + 1, cameras.end()}, 3) +
                             ": several files of cameras: move all but one elsewhere");
  if (!cameras.empty())
    takeCameras(input, found, cameras[0], images);
  else if (!images.empty())
    takeUnplaced(input, found, images);
}

void takePanoramas(ModelInput& input, const Survey& found, const std::string& pattern)
{
  const std::map<std::string, Index> numbers = scansByName(input);
  for (const std::string& name : found.match(pattern)) {
    const auto scan = numbers.find(stemOf(name));
    if (scan == numbers.end())
      throw std::runtime_error(found.at(name) + ": a panorama of no scan: none has this name");
    input.panoramas.push_back({found.at(name), scan->second});
  }
  if (!input.panoramas.empty())
    input.found.push_back(counted(input.panoramas.size(), "panorama") + " named as the scans");
}

void takePicturesBeside(ModelInput& input, const Survey& found)
{
  const std::map<std::string, Index> numbers = scansByName(input);
  input.images = found.path();
  for (const std::string& name : found.match("<pictures>"))
    if (const auto scan = numbers.find(stemOf(name)); scan != numbers.end())
      input.panoramas.push_back({found.at(name), scan->second});
    else
      input.unplaced.push_back(name);
  if (!input.panoramas.empty())
    input.found.push_back(counted(input.panoramas.size(), "panorama") + " named as the scans");
  if (!input.unplaced.empty())
    input.found.push_back(
        concat(counted(input.unplaced.size(), "photograph"), " without cameras: the program colmap finds them"));
}
} // namespace fresco::model
