// SPDX-License-Identifier: BSD-3-Clause
#include "answer/page_sources.h"
#include "answer/report.h"
#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/json_text.h>
namespace fresco {
namespace registration {
namespace {
// Seen from above: each group turned so that its scans' up directions are up.
class Plans {
public:
  explicit Plans(const ScanRegistrationResult& result) : result_(result)
  {
    std::vector<Eigen::Vector3d> ups(result.groups, Eigen::Vector3d::Zero());
    for (const ScanResult& scan : result.scans)
      if (scan.group >= 0)
        ups[scan.group] += scan.T_group_scan.topLeftCorner<3, 3>() * scan.up;
    for (const Eigen::Vector3d& up : ups) // one and the other may cancel
      T_plan_group_.emplace_back(up.norm() > 0.1 ? Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ())
                                                 : Eigen::Quaterniond::Identity());
  }

  /// Of a point of a scan.
  Eigen::Vector2d place(const ScanResult& scan, const Eigen::Vector3d& point) const
  {
    const Eigen::Vector3d in_group = (scan.T_group_scan * point.homogeneous()).head<3>();
    return (T_plan_group_[scan.group] * in_group).head<2>();
  }

  /// Plan of the larger group from that of the one that is not placed: a matrix by columns, as SVG has them.
  Json motion(const CandidatePlace& place) const
  {
    const Eigen::Isometry3d T = T_plan_group_[result_.scans[place.beside].group] *
                                Eigen::Isometry3d(place.T_larger_group) * T_plan_group_[place.group].inverse();
    Json columns = Json::array();
    for (const int column : {0, 1, 3})
      for (const int row : {0, 1})
        columns.push_back(T.matrix()(row, column));
    return columns;
  }

  Json scan(Index i, const ScanRegistrationOptions& options) const
  {
    const ScanResult& scan = result_.scans[i];
    Json json = {
        {"file", scanName(options, i)},   {"name", std::filesystem::path(scanName(options, i)).filename().string()},
        {"placed", scan.placed},          {"group", scan.duplicate_of < 0 ? scan.group : -1},
        {"problem", scan.problem},        {"hint", scan.hint},
        {"probability", scan.probability}};
    if (scan.group < 0)
      return json;
    const Eigen::Vector2d station = place(scan, scan.found_viewpoint.value_or(Eigen::Vector3d::Zero()));
    json["station"] = {station.x(), station.y()};
    Json& outline = json["outline"] = Json::array(); // in voxels: x, y, x, y ...
    for (Index k = 0; k < scan.outline.cols(); ++k)
      for (const double value : place(scan, scan.outline.col(k).cast<double>()))
        outline.push_back(std::lround(value / result_.voxel));
    return json;
  }

private:
  const ScanRegistrationResult& result_;
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> T_plan_group_;
};

std::string pageData(const ScanRegistrationResult& result, const ScanRegistrationOptions& options)
{
  const Plans plans(result);
  Json json;
  json["voxel"] = result.voxel;
  json["groups"] = result.groups;
  json["hints"] = result.hints;
  for (const char* list : {"scans", "candidates"})
    json[list] = Json::array();
  for (std::size_t i = 0; i < result.scans.size(); ++i)
    json["scans"].push_back(plans.scan(i, options));
  for (const CandidatePlace& place : result.candidates) {
    Json& candidate = json["candidates"].emplace_back(candidateJson(place, options));
    candidate["motion"] = plans.motion(place);
  }
  std::string text = jsonText(json, -1);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c"); // no end of the script
  return text;
}
} // namespace
} // namespace registration

std::string registrationPage(const ScanRegistrationResult& result, const ScanRegistrationOptions& options)
{
  using namespace registration;
  return concat("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>Registration</title>\n"
                "<style>",
                page_css, "</style></head><body>\n<main></main>\n<script type=\"application/json\" id=\"data\">",
                pageData(result, options), "</script>\n<script>", page_js, "</script></body></html>\n");
}
} // namespace fresco
