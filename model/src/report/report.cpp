// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.h"
#include "viewer/viewer.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/json_text.h>
#include <iomanip>
#include <sstream>
namespace fresco::model {
namespace {
using Json = nlohmann::ordered_json;

std::string fixed(double value, int digits)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

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
    if (name != "pictures" && name != "up" && name.rfind("photograph_", 0) != 0)
      stage.figures.emplace_back(name, shown(value));
  return stage;
}

Eigen::Vector3d vectorOf(const Json& object, const char* name)
{
  const auto values = object.value(name, std::vector<double>{0, 0, 1});
  return Eigen::Vector3d(values.at(0), values.at(1), values.at(2));
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

std::string stageTable(const Report& report)
{
  std::string html = "<table><tr><th>stage<th>time, s<th>CPU, s<th>peak memory, MB<th>figures</tr>\n";
  for (const StageRecord& stage : report.stages) {
    html += "<tr><td>" + escapedHtml(stage.name) + (stage.resumed ? " (earlier run)" : "") + "<td>" +
            fixed(stage.seconds, 1) + "<td>" + fixed(stage.cpu_seconds, 1) + "<td>" + fixed(stage.peak_megabytes, 0) +
            "<td>";
    for (const auto& [name, value] : publicStage(stage).figures)
      html += "<span><b>" + escapedHtml(name) + "</b> " + escapedHtml(value) + "</span> ";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

/// How far each photograph is off from the others, the worst first; "" where that is not known.
std::string fitTable(const Report& report)
{
  std::vector<Json> fits;
  for (const StageRecord& stage : report.stages)
    for (const Json& fit : stage.figures.value("photograph_fits", Json::array()))
      fits.push_back(fit);
  if (fits.empty())
    return "";
  std::stable_sort(fits.begin(), fits.end(), [](const Json& a, const Json& b) {
    return a.value("median_pixels", 0.0) > b.value("median_pixels", 0.0);
  });
  std::string html = "<details><summary>How far photographs are off from each other</summary><table><tr><th>photograph"
                     "<th>places<th>median, pixels<th>nine tenths below, pixels</tr>\n";
  for (const Json& fit : fits)
    html += "<tr><td>" + escapedHtml(fit.value("photograph", "")) + "<td>" + std::to_string(fit.value("places", 0)) +
            "<td>" + fixed(fit.value("median_pixels", 0.0), 2) + "<td>" +
            fixed(fit.value("nine_tenths_below_pixels", 0.0), 2) + "</tr>\n";
  return html + "</table></details>\n";
}

std::string viewer(const Report& report, const ModelFiles& files)
{
  ViewerOptions options;
  options.up = report.up;
  for (const ReportPicture& picture : report.pictures)
    if (picture.textured && picture.angle > 0)
      options.places.push_back({picture.title, picture.eye, picture.look, picture.angle});
  return "<div class=\"viewer\">" + viewerElement(readFile(files.viewer_glb), options) + "</div>\n";
}

std::string toHtml(const Report& report, const ModelFiles& files)
{
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>fresco model</title>\n"
      "<style>body{font:15px/1.5 sans-serif;margin:2em auto;max-width:1200px;padding:0 1em;color:#222}"
      "table{border-collapse:collapse}td,th{border-bottom:1px solid #ccc;padding:.3em .8em;text-align:left;"
      "vertical-align:top}td span{white-space:nowrap;margin-right:1em;display:inline-block}"
      ".viewer{height:min(75vh,800px);margin:1em 0}"
      "figure{margin:1.5em 0}img{max-width:100%;border:1px solid #ddd}figcaption{color:#555}"
      "</style></head><body>\n<h1>fresco model</h1>\n<p>Input: " +
      escapedHtml(report.input) + " (" + escapedHtml(report.kind) + "). Time of this run: " + fixed(report.seconds, 1) +
      " s. Model: <code>model.glb</code>, <code>model.obj</code>; mesh: <code>mesh.ply</code>; poses: "
      "<code>poses.txt</code>.</p>\n" +
      viewer(report, files) + stageTable(report) + fitTable(report);
  for (const ReportPicture& picture : report.pictures)
    html += "<figure><img alt=\"" + escapedHtml(picture.title) + "\" src=\"data:image/png;base64," +
            base64(readFile(files.folder + "/" + picture.file)) + "\"><figcaption>" + escapedHtml(picture.title) +
            "</figcaption></figure>\n";
  return html + "</body></html>\n";
}
} // namespace

Report makeReport(const std::string& input, const std::vector<StageRecord>& stages, double seconds)
{
  Report report{input, "", stages, {}, Eigen::Vector3d::UnitZ(), seconds};
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
  OutputGroup outputs;
  writeFile(files.report_html, toHtml(report, files));
  writeFile(files.report_json, jsonText(toJson(report), 2));
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
