// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.h"
#include "report/page.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/json_text.h>
#include <iomanip>
#include <optional>
#include <sstream>
namespace fresco::model {
namespace {
using Json = nlohmann::ordered_json;

std::string shown(const Json& value)
{
  if (value.is_number_float()) {
    std::ostringstream text;
    text << std::setprecision(4) << value.get<double>();
    return text.str();
  }
  return value.is_string() ? value.get<std::string>() : jsonText(value, -1);
}

/// What describes the pictures, or each photograph, is left out.
ModelStage publicStage(const StageRecord& record)
{
  ModelStage stage{record.name, record.seconds, record.cpu_seconds, record.peak_megabytes, record.resumed, {}, {}};
  if (record.figures.is_object())
    stage.warnings = record.figures.value("warnings", stage.warnings);
  for (const auto& [name, value] : record.figures.items())
    if (name != "pictures" && name != "up" && name != "places" && name.rfind("photograph_", 0) != 0)
      stage.figures.emplace_back(name, shown(value));
  return stage;
}

Json toJson(const Report& report)
{
  Json json{{"input", report.input},
            {"kind", report.kind},
            {"seconds", report.seconds},
            {"stages", Json::array()},
            {"pictures", Json::array()}};
  for (const StageRecord& stage : report.stages) {
    Json figures = stage.figures;
    figures.erase("pictures");
    figures.erase("up");
    figures.erase("places");
    json["stages"].push_back({{"name", stage.name},
                              {"seconds", stage.seconds},
                              {"cpu_seconds", stage.cpu_seconds},
                              {"peak_megabytes", stage.peak_megabytes},
                              {"resumed", stage.resumed},
                              {"figures", figures}});
  }
  for (const ReportPicture& picture : report.pictures)
    json["pictures"].push_back({{"file", picture.file}, {"title", picture.title}});
  return json;
}

/// Nothing where the mesh is not like a building in metres: a report without a plan is still one.
std::optional<RoomFacts> factsOf(const Report& report, const ModelFiles& files)
{
  if (!report.isWhole())
    return {};
  try {
    return measureRooms(report, files);
  } catch (const std::invalid_argument&) {
    return {};
  }
}
} // namespace

Eigen::Vector3d vectorOf(const nlohmann::ordered_json& object, const char* name)
{
  const auto values = object.value(name, std::vector<double>{0, 0, 1});
  return Eigen::Vector3d(values.at(0), values.at(1), values.at(2));
}

std::string fixed(double value, int digits)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

Report makeReport(const std::string& input, const std::vector<StageRecord>& stages, double seconds)
{
  Report report{input, "", stages, {}, Eigen::Vector3d::UnitZ(), seconds};
  if (!report.isWhole())
    return report;
  const Json& figures = stages.back().figures;
  report.up = vectorOf(figures, "up");
  for (const Json& picture : figures["pictures"])
    report.pictures.push_back({picture.value("file", ""), picture.value("title", ""), picture.value("textured", false),
                               vectorOf(picture, "eye"), vectorOf(picture, "look"), picture.value("angle", 0.0)});
  return report;
}

ModelReport publicReport(const Report& report)
{
  ModelReport result;
  result.input = report.kind;
  for (const StageRecord& stage : report.stages)
    result.stages.push_back(publicStage(stage));
  for (const ReportPicture& picture : report.pictures)
    result.pictures.push_back(picture.file);
  result.seconds = report.seconds;
  return result;
}

void writeReport(const Report& report, const ModelFiles& files)
{
  const std::optional<RoomFacts> facts = factsOf(report, files);
  if (facts) {
    OutputGroup plans;
    writeFile(files.folder + "/plan.svg", planSvg(facts->plan, facts->stations));
    writeFile(files.folder + "/plan.dxf", planDxf(facts->plan));
    writeFile(files.folder + "/plan.json", planJson(facts->plan));
    plans.commit();
  }
  OutputGroup outputs;
  writeFile(files.report_json, jsonText(toJson(report), 2));
  writeFile(files.report_html, reportPage(report, files, facts));
  outputs.commit();
}
} // namespace fresco::model

std::string fresco::stageSummary(const ModelStage& stage)
{
  using model::fixed;
  std::string line = stage.name + (stage.resumed ? " (earlier run)" : "") + ": " + fixed(stage.seconds, 1) + " s, " +
                     fixed(stage.cpu_seconds, 1) + " s of CPU, " + fixed(stage.peak_megabytes, 0) + " MB";
  for (const auto& [name, value] : stage.figures)
    if (value.find_first_of("{[") == std::string::npos)
      line += ", " + name + " " + value;
  return line;
}
