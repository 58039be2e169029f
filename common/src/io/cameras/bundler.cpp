// SPDX-License-Identifier: BSD-3-Clause
// bundle.out of Bundler 0.3 and 0.4, which VisualSfM, COLMAP and Metashape write, too: Snavely, "Bundler v0.4 User's Manual",
// section 5. Cameras look along -z with y up; pixels count from the middle of the photograph, upwards. Names stand in a list
// beside it.
#include "io/cameras/camera_format.h"
#include <filesystem>
#include <fresco/io/file.h>
#include <set>
namespace fresco::io {
namespace {
namespace fs = std::filesystem;

/// A line of the list: NAME, or NAME 0 FOCAL_LENGTH.
std::string nameOf(std::string line)
{
  const std::size_t last = line.find_last_of(" \t"), before = last == line.npos ? last : line.rfind(" 0", last);
  return before != line.npos && before + 2 == last ? line.substr(0, before) : line;
}

std::vector<std::string> listedNames(const CameraFileBuilder& cameras, std::size_t count)
{
  std::string list;
  std::size_t found = 0;
  for (const std::string& folder : {cameras.folder(), cameras.folder() + "/.."}) // of Bundler itself: bundle/bundle.out
    for (const fs::directory_entry& entry : std::set<fs::directory_entry>(fs::directory_iterator(folder), {})) {
      const std::string file = entry.path().filename().string();
      if (!entry.is_regular_file() || entry.file_size() == 0 || extension(file) != ".txt" ||
          file.find("list") == file.npos)
        continue;
      std::vector<std::string> names;
      const std::string content = readFile(entry.path().string());
      for (TextScanner lines(content); !lines.done();)
        if (const std::string line(lines.restOfLine()); !line.empty())
          names.push_back(nameOf(line));
      if (names.size() == count)
        return names;
      list = entry.path().string(), found = names.size();
    }
  throw std::runtime_error(list.empty() ? "wants the names of the photographs in a file list.txt beside it"
                                        : concat("has ", count, " cameras, but ", list, " has ", found, " names"));
}
} // namespace

void addPoints(Words& words, const PointRows& rows, CameraFileBuilder& cameras)
{
  for (std::size_t i = 0; i < rows.count; ++i) {
    const Eigen::Vector3d position = words.vector<3>(), color = words.vector<3>();
    std::vector<Observation> track;
    for (auto left = words.number<std::size_t>(); left > 0; --left) {
      const auto camera = words.number<std::size_t>();
      words.number(); // of its feature
      const Eigen::Vector2d place = words.vector<2>();
      expect(camera < rows.views.size(), "point ", i + 1, " names camera ", camera, " of ", rows.views.size());
      if (const int view = rows.views[camera]; view >= 0)
        track.push_back({view, cameras.middleOf(view) + Eigen::Vector2d(place.x(), rows.down * place.y())});
    }
    cameras.addPoint(position, color, track);
  }
}

bool isBundler(std::string_view head) { return head.rfind("# Bundle file", 0) == 0; }

void readBundler(const std::string& content, CameraFileBuilder& cameras)
{
  Words words{TextScanner(content)};
  const auto count = words.number<std::size_t>(), points = words.number<std::size_t>();
  const std::vector<std::string> names = listedNames(cameras, count);
  std::vector<int> views;
  for (const std::string& name : names) {
    const Eigen::Vector3d lens = words.vector<3>(); // f k1 k2
    const Eigen::Matrix3d R = words.matrix();
    const Eigen::Vector3d t = words.vector<3>();
    const bool placed = lens[0] > 0;
    CameraModel camera = placed ? cameras.cameraOf(name) : CameraModel();
    camera.fx = camera.fy = lens[0], camera.k1 = lens[1], camera.k2 = lens[2];
    views.push_back(placed ? cameras.addView(name, camera, withTurnedAxes(rigid(R, t))) : -1);
  }
  addPoints(words, {points, views, -1}, cameras);
}
} // namespace fresco::io
