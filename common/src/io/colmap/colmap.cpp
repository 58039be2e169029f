// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/colmap_model.h"
#include "io/colmap/lens_models.h"
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <iomanip>
#include <sstream>
namespace fresco {
namespace {
using io::CameraEntry;
using io::ImageEntry;

/// Lines that are neither empty nor comments, with their numbers.
template <typename Use>
void forEachLine(const std::string& path, const Use& use)
{
  std::istringstream lines(readFile(path));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    if (line.empty() || line[0] != '#')
      use(line, concat(path, ": line ", number));
  }
}

std::vector<CameraEntry> readCamerasText(const std::string& path)
{
  std::vector<CameraEntry> cameras;
  forEachLine(path, [&](const std::string& line, const std::string& where) {
    if (line.find_first_not_of(" \t") == std::string::npos)
      return;
    std::istringstream words(line);
    std::uint64_t id = 0, width = 0, height = 0;
    std::string model;
    if (!(words >> id >> model >> width >> height))
      throw std::runtime_error(where + ": wants CAMERA_ID MODEL WIDTH HEIGHT PARAMS");
    std::vector<double> parameters;
    for (double value; words >> value;)
      parameters.push_back(value);
    cameras.push_back({id, io::makeCamera(model, width, height, parameters, where)});
  });
  return cameras;
}

/// Every image has two lines: the pose, then its feature points, which may be an empty line.
std::vector<ImageEntry> readImagesText(const std::string& path)
{
  std::vector<ImageEntry> images;
  bool points_line = false;
  forEachLine(path, [&](const std::string& line, const std::string& where) {
    const bool skip = points_line;
    points_line = !points_line;
    if (skip)
      return;
    if (line.find_first_not_of(" \t") == std::string::npos) {
      points_line = false;
      return;
    }
    std::istringstream words(line);
    ImageEntry image;
    double q[4], t[3];
    if (!(words >> image.id >> q[0] >> q[1] >> q[2] >> q[3] >> t[0] >> t[1] >> t[2] >> image.camera))
      throw std::runtime_error(where + ": wants IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    std::getline(words >> std::ws, image.name);
    image.T_camera_world = io::makePose(q, t, where);
    images.push_back(image);
  });
  return images;
}
} // namespace

CameraSet readColmap(const std::string& folder)
{
  const auto has = [&](const char* name) { return std::filesystem::exists(folder + "/" + name); };
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(folder + ": no such folder of cameras");
  if (has("cameras.txt") && has("images.txt"))
    return io::joinEntries(folder + "/images.txt", readCamerasText(folder + "/cameras.txt"),
                           readImagesText(folder + "/images.txt"));
  if (has("cameras.bin") && has("images.bin"))
    return io::joinEntries(folder + "/images.bin", io::readCamerasBinary(folder + "/cameras.bin"),
                           io::readImagesBinary(folder + "/images.bin"));
  throw std::runtime_error(folder + ": neither cameras.txt and images.txt nor cameras.bin and images.bin in it");
}

void writeColmap(const std::string& folder, const CameraSet& set)
{
  makeFolder(folder);
  std::ostringstream cameras, images;
  cameras << std::setprecision(17) << "# Camera list with one line of data per camera:\n"
          << "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras: " << set.cameras.size() << "\n";
  for (std::size_t c = 0; c < set.cameras.size(); ++c) {
    const CameraModel& m = set.cameras[c];
    const io::LensModel& lens = io::lensModelOf(m);
    cameras << c + 1 << " " << lens.name << " " << m.width << " " << m.height;
    for (double CameraModel::*parameter : lens.parameters)
      cameras << " " << m.*parameter;
    cameras << "\n";
  }
  images << std::setprecision(17) << "# Image list with two lines of data per image:\n"
         << "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
         << "# Number of images: " << set.views.size() << "\n";
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    const View& view = set.views[v];
    const Eigen::Quaterniond q(view.T_camera_world.linear());
    const Eigen::Vector3d t = view.T_camera_world.translation();
    images << v + 1 << " " << q.w() << " " << q.x() << " " << q.y() << " " << q.z() << " " << t.x() << " " << t.y()
           << " " << t.z() << " " << view.camera + 1 << " " << view.image << "\n\n";
  }
  writeFile(folder + "/points3D.txt", "# 3D point list with one line of data per point:\n# Number of points: 0\n");
  writeFile(folder + "/cameras.txt", cameras.str());
  writeFile(folder + "/images.txt", images.str());
}
} // namespace fresco
