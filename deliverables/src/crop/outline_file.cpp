// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/crop.h>
#include <fresco/io/file.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>
#include <stdexcept>
namespace fresco {
namespace {
using Outline = std::vector<Eigen::Vector2d>;

[[noreturn]] void fail(const std::string& reason) { throw std::runtime_error(reason); }

class GeoJson {
public:
  std::vector<Outline> read(const std::string& content)
  {
    visit(nlohmann::json::parse(content), 0);
    return std::move(outlines_);
  }

private:
  void visit(const nlohmann::json& object, int depth)
  {
    if (depth > 100) // of collections in collections
      fail("GeoJSON: nested too deep");
    const std::string type = object.at("type");
    if (type == "FeatureCollection")
      for (const auto& feature : object.at("features"))
        visit(feature, depth + 1);
    else if (type == "GeometryCollection")
      for (const auto& geometry : object.at("geometries"))
        visit(geometry, depth + 1);
    else if (type == "Feature" && !object.at("geometry").is_null())
      visit(object.at("geometry"), depth + 1);
    else if (type == "Polygon")
      addRings(object.at("coordinates"));
    else if (type == "MultiPolygon")
      for (const auto& polygon : object.at("coordinates"))
        addRings(polygon);
  }

  void addRings(const nlohmann::json& rings)
  {
    for (const auto& ring : rings) {
      outlines_.emplace_back();
      for (const auto& point : ring)
        outlines_.back().emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
    }
  }

  std::vector<Outline> outlines_;
};

double numberOf(std::istream& text)
{
  double value = 0;
  if (!(text >> value))
    fail("SVG: a number is missing");
  return value;
}

/// The points of a path of straight lines: M L H V Z and the same relative to the point before.
std::vector<Outline> pathOutlines(std::string text)
{
  for (std::size_t i = 0; i < text.size(); ++i) // numbers may follow each other without a space
    if (text[i] == ',' || (text[i] == '-' && i > 0 && (std::isdigit(text[i - 1]) || text[i - 1] == '.')))
      text[i] == ',' ? void(text[i] = ' ') : void(text.insert(i++, " "));
  std::vector<Outline> outlines;
  Eigen::Vector2d at(0, 0), start(0, 0);
  std::istringstream words(text);
  for (char command = 0, next = 0; words >> next;) {
    if (std::isalpha(next))
      command = next;
    else if (words.unget(); std::tolower(command) == 'z')
      command = 0;
    const Eigen::Vector2d base = std::islower(command) ? at : Eigen::Vector2d(0, 0);
    switch (std::tolower(command)) {
    case 'm':
    case 'l':
      at.x() = base.x() + numberOf(words);
      at.y() = base.y() + numberOf(words);
      break;
    case 'h':
      at.x() = base.x() + numberOf(words);
      break;
    case 'v':
      at.y() = base.y() + numberOf(words);
      break;
    case 'z':
      at = start;
      continue;
    default:
      fail("SVG: a path is not made of straight lines");
    }
    if (std::tolower(command) == 'm') {
      outlines.emplace_back();
      start = at;
      command = command == 'm' ? 'l' : 'L'; // further pairs are lines
    } else if (outlines.empty()) {
      fail("SVG: a path does not begin with M");
    }
    outlines.back().push_back(at);
  }
  return outlines;
}

class Svg {
public:
  std::vector<Outline> read(const std::string& content)
  {
    pugi::xml_document document;
    if (const auto result = document.load_buffer(content.data(), content.size()); !result)
      fail(concat("SVG: ", result.description()));
    for (const char* kind : {"polygon", "rect", "path"})
      for (const pugi::xpath_node& found : document.select_nodes(concat("//*[local-name()='", kind, "']").c_str()))
        add(found.node(), kind);
    for (Outline& outline : outlines_)
      for (Eigen::Vector2d& point : outline)
        point.y() = -point.y();
    return std::move(outlines_);
  }

private:
  void add(const pugi::xml_node& node, const std::string& kind)
  {
    for (pugi::xml_node at = node; at; at = at.parent())
      if (at.attribute("transform"))
        fail("SVG: what is drawn has a transform");
    if (kind == "rect") {
      const auto value = [&](const char* name) { return node.attribute(name).as_double(); };
      const double x = value("x"), y = value("y"), width = value("width"), height = value("height");
      outlines_.push_back({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}});
      return;
    }
    const std::string points =
        kind == "path" ? node.attribute("d").value() : concat("M ", node.attribute("points").value());
    for (Outline& outline : pathOutlines(points))
      outlines_.push_back(std::move(outline));
  }

  std::vector<Outline> outlines_;
};

Eigen::Matrix2Xd closed(Outline outline)
{
  if (outline.size() > 1 && outline.front() == outline.back())
    outline.pop_back();
  return Eigen::Map<const Eigen::Matrix2Xd>(outline.empty() ? nullptr : outline[0].data(), 2, outline.size());
}
} // namespace

std::vector<Eigen::Matrix2Xd> readOutlines(const std::string& path)
{
  const std::string content = readFile(path);
  std::vector<Eigen::Matrix2Xd> outlines;
  try {
    for (const Outline& outline : extension(path) == ".svg" ? Svg().read(content) : GeoJson().read(content))
      outlines.push_back(closed(outline));
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error(path + ": is not GeoJSON");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  if (outlines.empty())
    throw std::runtime_error(path + ": draws no polygon");
  return outlines;
}
} // namespace fresco
