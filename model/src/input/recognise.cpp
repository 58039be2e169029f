// SPDX-License-Identifier: BSD-3-Clause
#include "input/frame_files.h"
#include <algorithm>
#include <fresco/io/file.h>
#include <fresco/io/listed.h>
#include <regex>
#include <set>
namespace fresco::model {
namespace {
std::vector<const char*> withCameras(std::vector<const char*> others)
{
  others.insert(others.end(), std::begin(camera_files), std::end(camera_files));
  return others;
}

const std::vector<Layout>& layouts()
{
  using R = Reading;
  static const std::vector<Layout> table = {
      {"scans in scans/",
       {R::scans, R::cloud},
       {"scans/"},
       withCameras({"poses.txt", "trajectory.txt", "cameras/", "images/", "panoramas/", "masks/"}),
       readScansFolder},
      {"scans or a cloud",
       {R::scans, R::cloud},
       {"<points>|*.laz"},
       withCameras(
           {"*.laz", "poses.txt", "trajectory.txt", "<pictures>", "cameras/", "images/", "panoramas/", "masks/"}),
       readFlatPoints},
      {"photographs in images/",
       {R::photographs},
       {"images/<pictures>|images/*/<pictures>"},
       withCameras({"cameras/", "masks/"}),
       readPhotographsAlone},
      {"photographs", {R::photographs}, {"<pictures>"}, withCameras({"cameras/", "masks/"}), readPhotographsAlone},
      {"a video", {R::photographs}, {"<videos>"}, {}, readVideo},
      {"COLMAP project",
       {R::cloud, R::photographs},
       {"images/|dense/images/|dense/0/images/", "sparse/|dense/sparse/|dense/0/sparse/"},
       withCameras({"dense/", "*.ply", "*.db", "stereo/", "*.sh", "masks/"}),
       readColmapProject},
      {"scanner export with a table of panoramas",
       {R::cloud},
       {"*pano*.csv|pano*/*pano*.csv|info/*pano*.csv|*pano*.txt", "<points>"},
       {"<pictures>", "*.mtl", "pano/", "panos/", "panorama/", "panoramas/", "info/"},
       readScannerExport},
      {"exported model with textures",
       {R::cloud},
       {"*.obj", "*.mtl"},
       withCameras({"<points>", "<pictures>", "textures/", "trajectory.txt", "*.pdf", "cameras/", "images/"}),
       readExportedModel},
      {"7-Scenes RGB-D",
       {R::rgbd},
       {"frame-*.depth.png"},
       {"camera-intrinsics.txt", "frame-*", "poses.txt", "masks/"},
       nullptr,
       readSevenScenes},
      {"TUM RGB-D",
       {R::rgbd},
       {"rgb*/|color*/", "depth*/", "rgb.txt|associations.txt|association.txt",
        "depth.txt|associations.txt|association.txt"},
       {"associations.txt", "association.txt", "groundtruth.txt", "camera-intrinsics.txt", "accelerometer.txt"},
       nullptr,
       readTum},
      {"Open3D RGB-D",
       {R::rgbd},
       {"color/|image/|rgb/", "depth/", "camera_intrinsic.json|intrinsic.json|camera.json"},
       {"trajectory.log", "trajectory.txt", "*.json"},
       nullptr,
       readOpen3d},
      {"Redwood RGB-D",
       {R::rgbd},
       {"rgb/|image/|color/", "depth/", "depth/*-*.png|*.log|*-traj.txt"},
       {},
       nullptr,
       readOpen3d},
      {"ScanNet", {R::rgbd}, {"color/", "depth/", "pose/", "intrinsic/"}, {"*.txt"}, nullptr, readScanNet},
      {"Stray Scanner",
       {R::rgbd},
       {"rgb.mp4|rgb/<pictures>", "depth/", "odometry.csv", "camera_matrix.csv"},
       {"confidence/", "imu.csv"},
       nullptr,
       readStrayScanner},
      {"Polycam raw data",
       {R::rgbd},
       {"keyframes/corrected_images/|keyframes/images/", "keyframes/corrected_cameras/|keyframes/cameras/",
        "keyframes/depth/"},
       {"keyframes/", "*.glb", "thumbnail.jpg", "polycam.mp4", "mesh_info.json"},
       nullptr,
       readPolycam},
      {"Matterport3D",
       {R::rgbd},
       {"undistorted_color_images/<pictures>", "undistorted_depth_images/", "undistorted_camera_parameters/*.conf"},
       {"*/"},
       nullptr,
       readMatterport},
  };
  return table;
}

std::string topOf(const std::string& name) { return name.substr(0, name.find('/')); }

/// A layout and how well it fits.
struct Candidate {
  const Layout* layout;
  std::set<std::string> takes;             ///< names at the top of the folder
  std::vector<std::string> there, missing; ///< marks, as messages have them

  bool fits() const { return missing.empty(); }
  const char* reading() const { return reading_names[int(layout->readings[0])]; }
};

/// Of all layouts, or of those that what is asked for may be.
std::vector<Candidate> candidates(const Survey& found, std::optional<Reading> asked)
{
  std::vector<Candidate> all;
  for (const Layout& layout : layouts()) {
    const auto& readings = layout.readings;
    if (asked && std::find(readings.begin(), readings.end(), *asked) == readings.end())
      continue;
    Candidate next{&layout, {}, {}, {}};
    for (const auto* list : {&layout.marks, &layout.optional})
      for (const std::string pattern : *list) {
        const std::vector<std::string> names = found.match(pattern);
        std::transform(names.begin(), names.end(), std::inserter(next.takes, next.takes.end()), topOf);
        if (list == &layout.marks)
          (names.empty() ? next.missing : next.there).push_back(std::regex_replace(pattern, std::regex("\\|"), " or "));
      }
    all.push_back(std::move(next));
  }
  return all;
}

/// Any files of a sort: what lies beside the parts of another layout may be whatever else was made of them.
bool isPlain(const Candidate& one)
{
  return one.layout->marks.size() == 1 && std::string(one.layout->marks[0]).find('<') != std::string::npos;
}

/// Whether all that `less` takes is taken by `more`, too, and more of it; of two that take the same, the one that asks for more.
bool isPartOf(const Candidate& less, const Candidate& more)
{
  if (isPlain(less) != isPlain(more))
    return isPlain(less);
  const bool within = std::includes(more.takes.begin(), more.takes.end(), less.takes.begin(), less.takes.end());
  return within && (more.takes.size() > less.takes.size() || more.layout->marks.size() > less.layout->marks.size());
}

/// The layout of which most is there, and what it misses.
std::string nearest(const std::vector<Candidate>& all)
{
  double best = 0.49; // less than half of a layout is another one
  std::string text;
  for (const auto& [layout, takes, there, missing] : all)
    if (const double share = double(there.size()) / layout->marks.size(); share > best) {
      best = share;
      text = concat("; nearest is ", layout->name, ": ", listed(there, 4), there.size() == 1 ? " is" : " are",
                    " there, ", listed(missing, 4), missing.size() == 1 ? " is" : " are", " missing");
    }
  return text;
}

/// A folder inside that would be understood.
std::string understoodBelow(const Survey& found)
{
  constexpr int most_asked = 20;
  int asked = 0;
  for (const std::string& folder : found.folders())
    if (folder.find('/') == std::string::npos && ++asked <= most_asked) {
      const std::vector<Candidate> all = candidates(Survey(found.at(folder)), {});
      if (std::any_of(all.begin(), all.end(), [](const Candidate& one) { return one.fits(); }))
        return concat("; ", found.at(folder), " would be understood");
    }
  return "";
}

[[noreturn]] void throwUnknown(const Survey& found, const std::vector<Candidate>& all, std::optional<Reading> asked)
{
  std::vector<std::string> kinds;
  for (const auto& [kind, count] : found.kinds())
    kinds.push_back(concat(count, " ", kind.empty() ? "without extension" : kind));
  if (kinds.empty())
    throw std::runtime_error(found.path() + ": an empty folder; docs/inputs.md lists what is understood");
  const std::string closest = nearest(all), near = closest.empty() ? understoodBelow(found) : closest;
  throw std::runtime_error(
      concat(found.path(), ": nothing ", asked ? concat("for -as ", reading_names[int(*asked)], " ") : "",
             "in it is understood (", listed(kinds, 5), ")", near, "; docs/inputs.md lists the layouts"));
}

/// A layout of which one mark of several is missing, while what is there makes another layout fit: rather that than the other.
void requireNoNearMiss(const Survey& found, const std::vector<Candidate>& all, const Candidate& chosen)
{
  for (const Candidate& one : all)
    if (one.missing.size() == 1 && one.layout->marks.size() > chosen.layout->marks.size() + 1 &&
        std::includes(one.takes.begin(), one.takes.end(), chosen.takes.begin(), chosen.takes.end()))
      throw std::runtime_error(concat(found.path(), "/", one.missing[0], ": is missing; all else is there of ",
                                      one.layout->name, ". Add it, or say -as ", chosen.reading(), " for ",
                                      chosen.layout->name));
}

Candidate theLayout(const Survey& found, std::optional<Reading> asked)
{
  const std::vector<Candidate> all = candidates(found, asked);
  std::vector<const Candidate*> kept;
  for (const Candidate& one : all)
    if (one.fits() && std::none_of(all.begin(), all.end(),
                                   [&](const Candidate& other) { return other.fits() && isPartOf(one, other); }))
      kept.push_back(&one);
  if (kept.empty())
    throwUnknown(found, all, asked);
  if (kept.size() > 1)
    throw std::runtime_error(concat(found.path(), ": may be ", kept[0]->layout->name, " (-as ", kept[0]->reading(),
                                    ") or ", kept[1]->layout->name, " (-as ", kept[1]->reading(),
                                    "): say which, or move one of them elsewhere"));
  if (!asked)
    requireNoNearMiss(found, all, *kept[0]);
  return *kept[0];
}

/// What lies at the top of the folder and no part of the layout is.
std::string unused(const Survey& found, const Candidate& chosen)
{
  std::set<std::string> others;
  for (const std::string& file : found.files())
    if (chosen.takes.count(topOf(file)) == 0)
      others.insert(topOf(file));
  return listed({others.begin(), others.end()}, 6);
}

std::optional<Reading> readingOf(const std::string& name)
{
  for (int k = 0; k < 4; ++k)
    if (name == reading_names[k])
      return Reading(k);
  require(name.empty(), "model: -as ", name, " is none of scans, cloud, rgbd, photographs");
  return {};
}
} // namespace

ModelInput readModelInput(const std::string& path, const std::string& as, double depth_unit)
{
  const std::optional<Reading> asked = readingOf(as);
  const Survey found(path);
  const Candidate chosen = theLayout(found, asked);
  ModelInput input;
  input.folder = path;
  input.layout = chosen.layout->name;
  if (chosen.layout->frames)
    takeFrames(input, chosen.layout->frames(found, input), depth_unit);
  else
    chosen.layout->read(found, asked, input);
  if (const std::string others = unused(found, chosen); !others.empty() && !found.isFile())
    input.found.push_back("not used: " + others);
  return input;
}
} // namespace fresco::model
