// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/rendering/requested_view.h>
#include <fresco/surface/core/mesh_distance.h>
#include <optional>
#include <sstream>
#include <variant>

namespace {
using namespace fresco;
using namespace fresco::rendering;

struct Request {
  std::string model, output, reference, room;
  std::vector<Shading> shadings{Shading::Gouraud};
  ViewRequest from;
  PictureOptions picture;
  CommonOptions common;
  ScanPath scan; ///< MODEL as a file of points
};

using Model = std::variant<TriangleMesh, TexturedMesh, PointSet>;

std::string joined(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::vector<Shading> parseShadings(const std::string& text)
{
  std::vector<Shading> shadings;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');)
    try {
      shadings.push_back(shadingByName(word));
    } catch (const std::invalid_argument&) {
      throw UsageError("-shading: '" + word + "' is none of " + joined(shadingNames()));
    }
  if (shadings.empty())
    throw UsageError("-shading: no name given");
  return shadings;
}

void declareView(Args& args, Request& request)
{
  args.option(
      "view", request.from.view,
      "where to look from: " + joined(viewNames()) +
          " (the whole model is in the picture), inside (a room, at eye height), above (a room, its ceiling and "
          "near walls left out)");
  args.option("room", request.room,
              "mesh of the room that -view inside or above is chosen for, so that pictures of several models are taken "
              "from one place (default: MODEL, which must have faces then)");
  const auto point = [&](const std::string& name, std::optional<Eigen::Vector3d>& value, const std::string& help) {
    args.numbers(name, "X Y Z", Range::any(), help,
                 [&value](const auto& given) { value = Eigen::Vector3d(given.data()); });
  };
  point("eye", request.from.eye, "position of the eye, unit of the model; replaces -view");
  point("look", request.from.look, "point in the middle of the picture, with -eye; default: middle of the model");
  point("up", request.from.up, "upright direction; default: 0 0 1, with -view inside and above found from the model");
  args.numbers("angle", "DEG", Range::within(1, 170),
               "vertical opening angle, degrees; default: 30, with -view inside 62",
               [&](const auto& given) { request.from.angle = given[0]; });
  args.flag("cull", request.picture.cull_back_faces,
            "leave out faces, and points with normals, seen from behind, and what hangs on walls of such faces (always "
            "with -view above)");
}

void declareLook(Args& args, Request& request)
{
  PictureOptions& picture = request.picture;
  args.values("shading", "NAME[,NAME...]",
              joined(shadingNames()) + " (default: gouraud); of several, each goes into its own file OUT_NAME",
              [&](const auto& words) { request.shadings = parseShadings(words[0]); });
  args.option("reference", request.reference, "mesh that error shading measures the distance to");
  args.option("limit", picture.error_limit, Range::above(0).zero("99 % of the vertices lie below"),
              "distance that error shading paints blue, unit of the model");
  args.option("unit", picture.unit, "unit of the model for the scale bar of error shading, for example m");
  args.size("size", picture.width, picture.height, Range::within(1, 65536), "pixels");
  const Range grey = Range::within(0, 255);
  args.values("background", "R G B", "colour behind the model; default: white (" + grey.text() + ")",
              [&picture, grey](const auto& words) {
                for (std::size_t c = 0; c < 3; ++c)
                  picture.background[c] = static_cast<std::uint8_t>(Args::integer("background", words[c], grey));
              });
  args.flag("transparent", picture.transparent, "no background: PNG with alpha");
  args.option("crease", picture.crease_angle, Range::within(0, 180),
              "edges that bend by more look sharp with gouraud, degrees");
  args.flag("no_colors", picture.no_colors, "leave out the colours of vertices and points: the shape alone");
  args.option("point_size", picture.point_size, Range::within(0, 1000).zero("by their number"),
              "size of points, pixels");
  args.option("oversampling", picture.oversampling, Range::within(1, 4),
              "pixels drawn per pixel along each side: finer, slower");
}

void checkRequest(const Request& request, const Args& args)
{
  if (args.given("view") && request.from.eye)
    throw UsageError("-view and -eye exclude each other");
  if (request.from.look && !request.from.eye)
    throw UsageError("-look needs -eye");
  const auto& names = viewNames();
  const bool indoor = request.from.view == "inside" || request.from.view == "above";
  if (!indoor && !request.room.empty())
    throw UsageError("-room needs -view inside or above");
  if (!indoor && std::find(names.begin(), names.end(), request.from.view) == names.end())
    throw UsageError("-view: '" + request.from.view + "' is none of " + joined(names) + ", inside, above");
  const bool error = std::count(request.shadings.begin(), request.shadings.end(), Shading::Error) > 0;
  if (error == request.reference.empty())
    throw UsageError(error ? "error shading needs -reference" : "-reference is for error shading only");
  const std::string end = extension(request.output);
  if (end != ".png" && end != ".jpg" && end != ".jpeg")
    throw UsageError("'" + request.output + "' ends neither in .png nor in .jpg");
  if (request.picture.transparent && end != ".png")
    throw UsageError("-transparent needs a .png");
}

Request parse(int argc, char** argv)
{
  Request request;
  Args args("fresco_snapshot MODEL OUT.png|OUT.jpg [options]",
            "Picture of a mesh (" + readableExtensions(FileKind::mesh) + "), a textured model (" +
                readableExtensions(FileKind::textured_mesh) + ")\nor a point cloud (" +
                readableExtensions(FileKind::points) + "). Needs no display.");
  declareLook(args, request);
  declareView(args, request);
  ScanOption scan;
  scan.declare(args);
  request.common.declare(args);
  args.note("Examples:");
  args.note("  fresco_snapshot model.obj room.png -shading texture -view inside -size 1920x1080");
  args.note("  fresco_snapshot result.ply out.png -shading normals,gouraud,error -reference truth.obj -unit mm");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  request.model = files[0];
  request.scan = scan.of(files[0]);
  request.output = files[1];
  request.picture.threads = request.common.threads;
  checkRequest(request, args);
  return request;
}

Model readModel(const Request& request)
{
  const std::string end = extension(request.model);
  const bool textured = std::count(request.shadings.begin(), request.shadings.end(), Shading::Texture) > 0;
  if (!isReadable(request.model, FileKind::mesh) && isReadable(request.model, FileKind::points))
    return readPoints(request.scan);
  if (end == ".glb" || (textured && (end == ".obj" || end == ".ply")))
    return readTexturedMesh(request.model);
  TriangleMesh mesh = readMesh(request.model);
  if (mesh.faceCount() == 0)
    return readPoints(request.model);
  return mesh;
}

const TriangleMesh* meshOf(const Model& model)
{
  if (const auto* textured = std::get_if<TexturedMesh>(&model))
    return &textured->mesh;
  return std::get_if<TriangleMesh>(&model);
}

Viewpoint chooseView(const Request& request, const Model& model, const PictureOptions& options)
{
  std::optional<TriangleMesh> room;
  if (!request.room.empty())
    room = readMesh(request.room);
  const bool indoor = request.from.view == "inside" || request.from.view == "above";
  require(request.from.eye || !indoor || room || meshOf(model), "-view ", request.from.view,
          " needs a mesh with faces; -room names one");
  return requestedView(request.from, {meshOf(model), std::get_if<PointSet>(&model)}, room ? &*room : nullptr, options);
}

Image draw(const Request& request, const Model& model, const PictureOptions& options)
{
  if (options.shading != Shading::Error)
    return std::visit([&](const auto& m) { return renderPicture(m, options); }, model);
  const TriangleMesh* mesh = meshOf(model);
  require(mesh && mesh->faceCount() > 0, "error shading needs a mesh with faces");
  const TriangleMesh reference = readMesh(request.reference);
  return renderErrorPicture(*mesh, vertexDistances(*mesh, reference, options.threads), options);
}

std::string outputName(const Request& request, Shading shading)
{
  if (request.shadings.size() == 1)
    return request.output;
  const std::filesystem::path path(request.output);
  const std::string name = shadingNames()[static_cast<std::size_t>(shading)];
  return (path.parent_path() / (path.stem().string() + "_" + name + path.extension().string())).string();
}

void run(int argc, char** argv)
{
  const Request request = parse(argc, argv);
  std::vector<std::string> outputs;
  for (const Shading shading : request.shadings)
    outputs.push_back(outputName(request, shading));
  std::vector<std::string> inputs = filesNamedBy(request.model);
  inputs.insert(inputs.end(), {request.model, request.reference, request.room});
  requireDistinct(outputs, inputs);
  const Progress progress = printProgress(request.common.quiet);
  report(progress, "read", 0.0);
  const Model model = readModel(request);
  std::vector<Image> pictures;
  try {
    PictureOptions options = request.picture;
    options.cull_back_faces |= request.from.view == "above";
    options.view = chooseView(request, model, options);
    for (const Shading shading : request.shadings) {
      report(progress, "draw " + shadingNames()[static_cast<std::size_t>(shading)],
             0.2 + 0.7 * pictures.size() / request.shadings.size());
      options.shading = shading;
      pictures.push_back(draw(request, model, options));
    }
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.model + ": " + error.what());
  }
  report(progress, "write", 0.9);
  writeOutputs([&] {
    for (std::size_t i = 0; i < pictures.size(); ++i)
      writeImage(outputs[i], pictures[i]);
  });
  report(progress, "done", 1.0);
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_snapshot", [&] { run(argc, argv); });
}
