// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "job/files.h"
#include "job/stage_log.h"
#include <Eigen/Core>
#include <fresco/model/build_model.h>
namespace fresco::model {
/// A picture of the model and where it was taken from, world coordinates.
struct ReportPicture {
  std::string file; ///< relative to the folder
  std::string title;
  bool textured = false;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero(), look = Eigen::Vector3d::Zero();
  double angle = 0; ///< vertical opening angle, degrees; 0 = not known
};

struct Report {
  std::string input; ///< folder
  std::string kind;  ///< what is in it
  std::vector<StageRecord> stages;
  std::vector<ReportPicture> pictures;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< upright direction
  double seconds = 0;                            ///< of this run

  bool isWhole() const { return stages.back().name == "pictures"; } ///< else it ended before
};

/// Three numbers of a list; the z axis where it is missing.
Eigen::Vector3d vectorOf(const nlohmann::ordered_json& object, const char* name);

/// With so many digits behind the point.
std::string fixed(double value, int digits);

/// @param stages not empty; a whole run ends with that of the pictures, see makePictures()
Report makeReport(const std::string& input, const std::vector<StageRecord>& stages, double seconds);

/// What the caller of buildModel() gets.
ModelReport publicReport(const Report& report);

/// report.json: times, memory and figures per stage, and report.html: the same with the pictures inside,
/// readable offline.
void writeReport(const Report& report, const ModelFiles& files);
} // namespace fresco::model
