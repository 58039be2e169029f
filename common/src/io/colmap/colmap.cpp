// SPDX-License-Identifier: BSD-3-Clause
#include "io/colmap/colmap_model.h"
#include <filesystem>
#include <fresco/io/colmap.h>
namespace fresco {
namespace {
using io::CameraEntry;
using io::LensModel;

std::vector<CameraEntry> readCamerasText(const std::string& path)
{
  std::vector<CameraEntry> cameras;
  io::forEachLine(path, [&](std::string_view line, const std::string& where) {
    constexpr const char* wanted = "CAMERA_ID MODEL WIDTH HEIGHT PARAMS";
    if (line.empty())
      return;
    io::TextScanner words(line);
    const auto id = io::nextNumber<std::uint64_t>(words, where, wanted);
    const LensModel& lens = io::lensModelNamed(std::string(words.word()), where);
    const auto width = io::nextNumber<std::uint64_t>(words, where, wanted);
    const auto height = io::nextNumber<std::uint64_t>(words, where, wanted);
    std::vector<double> parameters;
    while (!words.atLineEnd())
      parameters.push_back(io::nextNumber<double>(words, where, wanted));
    cameras.push_back({id, io::makeCamera(lens, width, height, parameters, where)});
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
