// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer.h"
#include "viewer/viewer_sources.h"
#include <cstdint>
#include <fresco/core/require.h>
#include <fresco/io/json_text.h>
#include <nlohmann/json.hpp>
#include <regex>
namespace fresco::model {
namespace {
using Sorted = nlohmann::json; // by name

void validate(const std::string& glb, const ViewerOptions& options)
{
  require(glb.size() >= 20 && glb.compare(0, 4, "glTF") == 0, "viewer: this is no binary glTF");
  require(options.up.allFinite() && options.up.norm() > 0, "viewer: the upright direction is not finite or zero");
  for (const ViewerPlace& place : options.places) {
    require(place.eye.allFinite() && place.look.allFinite() && (place.look - place.eye).norm() > 0, "viewer: place ",
            place.name, ": not finite, or it looks nowhere");
    require(place.angle >= 1 && place.angle <= 170, "viewer: place ", place.name, ": angle ", place.angle,
            " is not in 1..170");
  }
}

Sorted coordinates(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// As JavaScript that may stand inside of a <script> element.
std::string optionsText(const ViewerOptions& options)
{
  Sorted places = Sorted::array();
  for (const ViewerPlace& place : options.places) {
    places.push_back({{"name", place.name},
                      {"group", place.group},
                      {"eye", coordinates(place.eye)},
                      {"look", coordinates(place.look)},
                      {"angle", place.angle}});
    if (!place.photograph.empty())
      places.back().update(
          {{"aspect", place.aspect}, {"photograph", "data:image/jpeg;base64," + base64(place.photograph)}});
  }
  Sorted walls = Sorted::array();
  for (const ViewerWall& wall : options.walls)
    walls.push_back({coordinates(wall.from), coordinates(wall.to)});
  Sorted all = {{"up", coordinates(options.up)}, {"places", places}, {"walls", walls}};
  if (options.floor)
    all["floor"] = *options.floor;
  return std::regex_replace(all.dump(-1, ' ', true, Sorted::error_handler_t::replace), std::regex("<"), "\\u003c");
}
} // namespace

std::string escapedHtml(const std::string& text)
{
  const nlohmann::json json = text;
  std::string out;
  for (const char c : nlohmann::json::parse(jsonText(json, -1)).get<std::string>()) // what is no UTF-8 is replaced
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

std::string base64(const std::string& bytes)
{
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::string viewerElement(const std::string& glb, const ViewerOptions& options)
{
  validate(glb, options);
  std::string html =
      concat("<style>\n", viewer_css, "</style>\n<div class=\"fresco-viewer\" id=\"fresco-viewer\"></div>\n");
  html += "<script type=\"application/octet-stream\" id=\"fresco-model\">";
  html += base64(glb);
  html += "</script>\n<script>\n";
  html += viewer_js;
  html += concat("{\n"
                 "const text = document.getElementById('fresco-model').textContent, bytes = new Uint8Array(",
                 glb.size(),
                 ");\n"
                 "for (let i = 0, at = 0; i < text.length; i += 65536)\n"
                 "  for (const c of atob(text.substr(i, 65536))) bytes[at++] = c.charCodeAt(0);\n"
                 "frescoViewer(document.getElementById('fresco-viewer'), bytes, ",
                 optionsText(options),
                 ");\n"
                 "}\n</script>\n");
  return html;
}

std::string viewerHtml(const std::string& glb, const ViewerOptions& options)
{
  return concat("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                "<meta name=\"viewport\" content=\"width=device-width\"><title>",
                escapedHtml(options.title),
                "</title>\n"
                "<style>html,body{margin:0;height:100%}</style></head><body>\n",
                viewerElement(glb, options), "</body></html>\n");
}
} // namespace fresco::model
