// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/colmap/lens_models.h"
#include "io/points/text_numbers.h"
#include <cstdint>
#include <fresco/core/camera.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <string>
#include <vector>
/// Parts that COLMAP's text and binary models share. `where` names file and place in errors.
namespace fresco::io {
struct CameraEntry {
  std::uint64_t id = 0;
  CameraModel model;
};

struct ImageEntry {
  std::uint64_t id = 0, camera = 0;
  std::string name;
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Vector2d> pixels; ///< of its feature points; empty unless asked for
};

/// use(line, where) for lines that are no comments, without blanks at their ends; `where` names file and line.
template <typename Use>
void forEachLine(const std::string& path, const Use& use)
{
  const std::string content = readFile(path);
  for (TextScanner lines(content); !lines.done();) {
    const std::size_t number = lines.line();
    const std::string_view line = lines.restOfLine();
    if (line.empty() || line[0] != '#')
      use(line, concat(path, ": line ", number));
  }
}

/// The next word of a line as a number. @throws std::runtime_error "`where`: wants `what`"
template <typename T>
T nextNumber(TextScanner& words, const std::string& where, const char* what)
{
  try {
    return parseNumber<T>(words.word());
  } catch (const std::runtime_error&) {
    throw std::runtime_error(concat(where, ": wants ", what));
  }
}

/// @throws std::runtime_error naming `where`
CameraModel makeCamera(const LensModel& lens, std::uint64_t width, std::uint64_t height,
                       const std::vector<double>& parameters, const std::string& where);

/// @param q quaternion w x y z, normalised here
Eigen::Isometry3d makePose(const double (&q)[4], const double (&t)[3], const std::string& where);

/// Views in the order of their ids. @throws std::runtime_error if an image names an unknown camera or there is none
CameraSet joinEntries(const std::string& path, const std::vector<CameraEntry>& cameras, std::vector<ImageEntry> images);

std::vector<CameraEntry> readCamerasBinary(const std::string& path);
std::vector<ImageEntry> readImagesBinary(const std::string& path, bool with_pixels = false);
std::vector<ImageEntry> readImagesText(const std::string& path, bool with_pixels = false);
} // namespace fresco::io
