// SPDX-License-Identifier: BSD-3-Clause
#include "report/page.h"
#include "viewer/viewer.h"
#include "viewer/viewer_sources.h"
#include <algorithm>
#include <filesystem>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/json_text.h>
#include <fresco/io/mesh_io.h>
#include <optional>
namespace fresco::model {
namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// A figure of the first stage that has it; nothing where it is absent or no number.
std::optional<double> figure(const Report& report, const char* name)
{
  for (const StageRecord& stage : report.stages)
    if (stage.figures.is_object() && stage.figures.contains(name) && stage.figures[name].is_number())
      return stage.figures[name].get<double>();
  return {};
}

std::string card(const std::string& name, const std::string& value)
{
  return "<div><dt>" + name + "</dt><dd>" + value + "</dd></div>\n";
}

std::string cards(const RoomFacts& facts)
{
  const Eigen::Vector3d& size = facts.size;
  std::string html = "<dl class=\"cards\">\n";
  const std::string height = facts.plan.has_ceiling ? " \u00d7 " + fixed(size.z(), 2) : "";
  html += card("Size", fixed(size.x(), 2) + " \u00d7 " + fixed(size.y(), 2) + height + " m");
  html += card("Floor area", fixed(facts.area, 2) + " m\u00b2");
  if (facts.volume > 0)
    html += card("Volume", fixed(facts.volume, 1) + " m\u00b3");
  return html + card("Rooms", std::to_string(facts.plan.rooms.size())) + "</dl>\n";
}

std::string roomTable(const FloorPlan& plan)
{
  std::string html =
      "<div class=\"wide\"><table><tr><th>Room<th>Area<th>Height<th>Doors<th>Windows<th>Middle x, y</tr>\n";
  for (std::size_t r = 0; r < plan.rooms.size(); ++r) {
    const PlanRoom& room = plan.rooms[r];
    html += "<tr><td>" + std::to_string(r + 1) + "<td>" + fixed(room.area, 2) + " m\u00b2<td>" +
            (room.ceiling > room.floor ? fixed(room.ceiling - room.floor, 2) + " m" : "not seen") + "<td>" +
            std::to_string(countOpenings(room, true)) + "<td>" + std::to_string(countOpenings(room, false)) + "<td>" +
            fixed(room.label.x(), 2) + ", " + fixed(room.label.y(), 2) + " m</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string planSection(const RoomFacts& facts)
{
  const std::string marks = facts.stations.empty() ? "" : " Crosses: where scans were taken.";
  return "<h2>Plan</h2>\n<div class=\"plan\">" + planSvg(facts.plan, facts.stations) + "</div>\n<p>Cut " +
         fixed(facts.plan.height - facts.plan.floor, 2) + " m above the floor. Blue: windows; green: doors." + marks +
         " The same as <a href=\"plan.svg\">drawing</a>, <a href=\"plan.dxf\">DXF for CAD</a> and <a "
         "href=\"plan.json\">table</a>.</p>\n" +
         roomTable(facts.plan);
}

std::string errorSection(const Report& report, const std::optional<RoomFacts>& facts)
{
  std::string html = "<h2>How exact it is</h2>\n<ul>\n";
  const std::string before = html;
  if (const auto rms = figure(report, "registration_rms"))
    html += "<li><b>" + fixed(1000 * *rms, 1) +
            " mm</b>: so far apart two scans lie (root mean square) where both saw the same surface. Distances between "
            "places that different scans saw are uncertain by about that much.</li>\n";
  if (const auto noise = figure(report, "noise"); noise && *noise > 0)
    html += "<li><b>" + fixed(1000 * *noise, 1) +
            " mm</b>: noise of a single measured point. The surface is a mean over many and is smoother.</li>\n";
  if (facts && facts->wall_deviation > 0)
    html +=
        "<li><b>" + fixed(1000 * facts->wall_deviation, 1) +
        " mm</b>: at least 95 % of the surface of each wall that the plan calls straight is nearer to its line.</li>\n";
  return html == before ? "" : html + "</ul>\n";
}

std::string unseenSection(const Report& report, const std::optional<RoomFacts>& facts)
{
  std::string html = "<h2>What was not seen</h2>\n<ul>\n";
  if (facts && facts->walls > 0)
    html += "<li>" + fixed(facts->unseen_walls, 1) + " m of " + fixed(facts->walls, 1) +
            " m of the rooms' outlines: no data there, the plan closes the gap.</li>\n";
  if (const auto edges = figure(report, "boundary_edges"); edges && *edges > 0)
    html += "<li>The surface has holes where no scan looked: " + fixed(*edges, 0) + " edges of faces are open.</li>\n";
  if (const auto coverage = figure(report, "coverage"); coverage && *coverage > 0)
    html += "<li>" + fixed(100 * (1 - *coverage), 1) +
            " % of the surface is in no picture; its colour is that of its surroundings.</li>\n";
  html += "<li>Glass, mirrors and dark, shining things send little light back to a scanner and may be "
          "missing.</li>\n</ul>\n";
  std::string notes;
  for (const StageRecord& stage : report.stages)
    for (const Json& warning : stage.figures.value("warnings", Json::array()))
      if (warning.is_string())
        notes += "<li>" + escapedHtml(warning.get<std::string>()) + "</li>\n";
  return notes.empty() ? html : html + "<p>The program noticed:</p>\n<ul class=\"notes\">\n" + notes + "</ul>\n";
}

std::string sizeText(std::uintmax_t bytes)
{
  return bytes >= 1000000 ? fixed(bytes / 1e6, 1) + " MB" : fixed(std::max(1.0, bytes / 1e3), 0) + " kB";
}

/// What a run wrote that was asked to end early; "" of a whole one.
std::string endSection(const Report& report, const ModelFiles& files)
{
  if (report.isWhole())
    return "";
  const auto end = std::find_if(std::begin(run_ends), std::end(run_ends),
                                [&](const RunEnd& known) { return report.stages.back().name == known.stage; });
  const std::string file = fs::path(files.*end->file).filename().string();
  return "<p>The run was asked to end with <a href=\"" + file + "\">" + file +
         "</a>; poses: <a href=\"poses.txt\">poses.txt</a>. <code>-resume</code> without <code>-until</code> goes "
         "on.</p>\n";
}

std::string fileSection(const ModelFiles& files)
{
  static const std::pair<const char*, const char*> known[] = {
      {"model.glb", "textured model, for most viewers and game engines"},
      {"model_full.glb", "textured model with all details"},
      {"tiles/tileset.json", "textured model in parts, for viewers of 3D Tiles"},
      {"model.obj", "textured model, with its .mtl and images beside it"},
      {"mesh.ply", "surface without texture"},
      {"plan.svg", "plan, for browsers and drawing programs"},
      {"plan.dxf", "plan, for CAD programs"},
      {"plan.json", "rooms, walls, doors and windows as a table"},
      {"poses.txt", "where the scans or photographs were taken"},
      {"registration.html", "how the scans fit together"},
      {"report.json", "figures of this page for programs"}};
  std::string html = "<h2>Files</h2>\n<div class=\"wide\"><table>\n";
  for (const auto& [name, what] : known)
    if (const fs::path path = fs::path(files.folder) / name; fs::is_regular_file(path))
      html += concat("<tr><td><a href=\"", name, "\">", name, "</a><td>", sizeText(fs::file_size(path)), "<td>", what,
                     "</tr>\n");
  return html + "</table></div>\n";
}

std::string stageTable(const Report& report)
{
  std::string html = "<table><tr><th>stage<th>time, s<th>CPU, s<th>peak memory, MB<th>figures</tr>\n";
  const ModelReport all = publicReport(report);
  for (const ModelStage& stage : all.stages) {
    html += "<tr><td>" + escapedHtml(stage.name) + (stage.resumed ? " (earlier run)" : "") + "<td>" +
            fixed(stage.seconds, 1) + "<td>" + fixed(stage.cpu_seconds, 1) + "<td>" + fixed(stage.peak_megabytes, 0) +
            "<td>";
    for (const auto& [name, value] : stage.figures)
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
  std::string html = "<h3>How far photographs are off from each other</h3><table><tr><th>photograph"
                     "<th>places<th>median, pixels<th>nine tenths below, pixels</tr>\n";
  for (const Json& fit : fits)
    html += "<tr><td>" + escapedHtml(fit.value("photograph", "")) + "<td>" + std::to_string(fit.value("places", 0)) +
            "<td>" + fixed(fit.value("median_pixels", 0.0), 2) + "<td>" +
            fixed(fit.value("nine_tenths_below_pixels", 0.0), 2) + "</tr>\n";
  return html + "</table>\n";
}

/// Inside the room, at the stations of the scanner, and where photographs were taken.
std::vector<ViewerPlace> placesOf(const Report& report, const ModelFiles& files, const RoomFacts& facts)
{
  std::vector<ViewerPlace> places;
  if (!report.pictures.empty() && report.pictures[0].angle > 0) {
    const ReportPicture& inside = report.pictures[0];
    places.push_back({"Inside", inside.eye, inside.look, inside.angle, "Views", {}, 0});
  }
  const Eigen::Isometry3d T_model_plan = facts.plan.T_plan_model.inverse();
  const Eigen::Vector2d middle = 0.5 * (facts.plan.low + facts.plan.high);
  for (const auto& [name, at] : facts.standpoints) {
    const Eigen::Vector3d ahead(middle.x() - at.x(), middle.y() - at.y(), 0);
    places.push_back({"Station " + name,
                      T_model_plan * at,
                      T_model_plan * (at + (ahead.norm() > 0.01 ? ahead : Eigen::Vector3d::UnitX()).eval()),
                      62,
                      "Stations",
                      {},
                      0});
  }
  for (const StageRecord& stage : report.stages)
    for (const Json& place : stage.figures.value("places", Json::array()))
      places.push_back({place.at("name"), vectorOf(place, "eye"), vectorOf(place, "look"), place.at("angle"),
                        "Photographs", readFile(files.folder + "/" + place.at("file").get<std::string>()),
                        place.at("aspect")});
  return places;
}

std::string viewer(const Report& report, const ModelFiles& files, const std::optional<RoomFacts>& facts)
{
  ViewerOptions options;
  options.up = report.up;
  options.places = placesOf(report, files, facts.value_or(RoomFacts()));
  if (facts) {
    const Eigen::Isometry3d T_model_plan = facts->plan.T_plan_model.inverse();
    options.floor = facts->plan.floor;
    for (const PlanRoom& room : facts->plan.rooms)
      for (const PlanWall& wall : room.walls)
        if (wall.seen && (wall.to - wall.from).norm() > 0.3)
          options.walls.push_back({T_model_plan * Eigen::Vector3d(wall.from.x(), wall.from.y(), facts->plan.floor),
                                   T_model_plan * Eigen::Vector3d(wall.to.x(), wall.to.y(), facts->plan.floor)});
  }
  return "<div class=\"viewer\">" + viewerElement(readFile(files.viewer_glb), options) + "</div>\n";
}

/// Of scans that were registered: where they are, and what those without a place need.
std::string registrationLink(const Report& report)
{
  for (const StageRecord& stage : report.stages)
    if (const std::string page = stage.figures.value("registration_page", ""); !page.empty()) {
      const int without = stage.figures.value("unplaced_scans", 0);
      return "<p><a href=\"" + page + "\">Floor plan of the scans</a>" +
             (without > 0
                  ? ": " + std::to_string(without) +
                        " are not in the model; the page shows where they may be and which hint takes each place"
                  : "") +
             ".</p>\n";
    }
  return "";
}

std::string pictureSection(const Report& report, const ModelFiles& files)
{
  constexpr int quality = 80; // of JPEG: a page of a few megabytes
  std::string html = "<h2>Pictures</h2>\n<div class=\"pictures\">\n";
  for (const ReportPicture& picture : report.pictures) {
    const auto bytes = encodeImage(halfSize(readImage(files.folder + "/" + picture.file)), ".jpg", quality);
    const std::string title = escapedHtml(picture.title);
    html += "<figure><a href=\"" + escapedHtml(picture.file) + "\"><img alt=\"" + title +
            "\" src=\"data:image/jpeg;base64," + base64({bytes.begin(), bytes.end()}) + "\"></a><figcaption>" + title +
            "</figcaption></figure>\n";
  }
  return html + "</div>\n";
}
} // namespace

std::string reportPage(const Report& report, const ModelFiles& files, const std::optional<RoomFacts>& facts)
{
  const std::string name = escapedHtml(fs::path(report.input).lexically_normal().filename().string());
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
                     "content=\"width=device-width, initial-scale=1\"><title>Model of " +
                     name + "</title>\n<style>\n" + page_css + "</style></head><body>\n<h1>Model of " + name +
                     "</h1>\n<p>Made from " + escapedHtml(report.kind) + ".</p>\n";
  if (facts)
    html += cards(*facts);
  html += endSection(report, files);
  if (report.isWhole())
    html += viewer(report, files, facts);
  html += registrationLink(report);
  if (facts)
    html += planSection(*facts);
  html += errorSection(report, facts);
  if (report.isWhole())
    html += unseenSection(report, facts) + fileSection(files) + pictureSection(report, files);
  html += "<details><summary>Times, memory and figures of each step</summary>\n<p>Input: " + escapedHtml(report.input) +
          ". Time of this run: " + fixed(report.seconds, 1) + " s.</p>\n<div class=\"wide\">" + stageTable(report) +
          fitTable(report) + "</div></details>\n";
  return html + "</body></html>\n";
}
} // namespace fresco::model
