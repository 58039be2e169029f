// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/model_input.h"
#include "input/survey.h"
#include <filesystem>
#include <optional>
#include <string>
#include <vector>
namespace fresco::model {
/// Name of a file without folder and extension.
inline std::string stemOf(const std::string& path) { return std::filesystem::path(path).stem().string(); }

/// What the things in a folder are taken for.
enum class Reading {
  scans,       ///< each from one place, in a frame of its own
  cloud,       ///< points in one frame, seen from many places
  rgbd,        ///< colour and depth images of a camera
  photographs, ///< alone
};
constexpr const char* reading_names[] = {"scans", "cloud", "rgbd", "photographs"};

/// Files that may tell the cameras of photographs: readCameraFile() looks into them. With the names that Bundler has beside.
constexpr const char* camera_files[] = {"*.xml", "*.out", "*.nvm", "*.json", "*list.txt"};

/// How a program or device lays out what it exports. Each has a file in layouts/ and a row in the table of recognise.cpp.
struct Layout {
  const char* name;                  ///< "TUM RGB-D"
  std::vector<Reading> readings;     ///< the first is the usual one
  std::vector<const char*> marks;    ///< patterns of Survey::match() that tell it: all must be there
  std::vector<const char*> optional; ///< what it takes besides
  /// Takes what lies there into `input`, whose folder is set.
  /// @param asked what the user wants it taken for, where that is said
  /// @throws std::runtime_error naming the file that is wrong, and the cure
  void (*read)(const Survey&, std::optional<Reading> asked, ModelInput& input);
  RgbdParts (*frames)(const Survey&, ModelInput& input) = nullptr; ///< the same of RGB-D, instead of `read`
};

void readScansFolder(const Survey& found, std::optional<Reading> asked, ModelInput& input);
void readFlatPoints(const Survey& found, std::optional<Reading> asked, ModelInput& input);
void readPhotographsAlone(const Survey& found, std::optional<Reading> asked, ModelInput& input);
void readVideo(const Survey& found, std::optional<Reading> asked, ModelInput& input);
void readColmapProject(const Survey& found, std::optional<Reading> asked, ModelInput& input);
void readScannerExport(const Survey& found, std::optional<Reading> asked, ModelInput& input);
void readExportedModel(const Survey& found, std::optional<Reading> asked, ModelInput& input);
RgbdParts readSevenScenes(const Survey& found, ModelInput& input);
RgbdParts readTum(const Survey& found, ModelInput& input);
RgbdParts readOpen3d(const Survey& found, ModelInput& input);
RgbdParts readScanNet(const Survey& found, ModelInput& input);
RgbdParts readStrayScanner(const Survey& found, ModelInput& input);
RgbdParts readPolycam(const Survey& found, ModelInput& input);
RgbdParts readMatterport(const Survey& found, ModelInput& input);
} // namespace fresco::model
