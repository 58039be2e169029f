// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/colmap_model.h"
#include "io/colmap/lens_models.h"
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <sstream>
namespace fresco {
namespace {
using io::CameraEntry;

std::vector<CameraEntry> readCamerasText(const std::string& path)
{
  std::vector<CameraEntry> cameras;
  io::forEachLine(path, [&](const std::string& line, const std::string& where) {
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
} // namespace

CameraSet readColmap(const std::string& folder)
{
  const auto has = [&](const char* name) { return std::filesystem::exists(folder + "/" + name); };
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(folder + ": no such folder of cameras");
  if (has("cameras.txt") && has("images.txt"))
    return io::joinEntries(folder + "/images.txt", readCamerasText(folder + "/cameras.txt"),
                           io::readImagesText(folder + "/images.txt"));
  if (has("cameras.bin") && has("images.bin"))
    return io::joinEntries(folder + "/images.bin", io::readCamerasBinary(folder + "/cameras.bin"),
                           io::readImagesBinary(folder + "/images.bin"));
  throw std::runtime_error(folder + ": neither cameras.txt and images.txt nor cameras.bin and images.bin in it");
}
} // namespace fresco
