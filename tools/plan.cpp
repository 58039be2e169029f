// SPDX-License-Identifier: BSD-3-Clause
#include "support/plan_option.h"
#include "support/scan_option.h"
#include "support/tool.h"
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/plan_drawing.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/point_io.h>
#include <variant>
namespace {
using namespace fresco;
using Model = std::variant<TexturedMesh, PointSet>;

struct Request {
  PlanOptions plan;
  std::string axis; ///< of a series of sections; "" = none
  double step = 0, pixel = 0.005;
  bool ortho = false;
  CommonOptions common;
};

void declare(Args& args, Request& request)
{
  declarePlan(args, request.plan);
  const Range step = Range::above(0);
  args.values(
      "sections", "AXIS STEP",
      "also parallel sections of a mesh, each STEP metres along AXIS (x, y or z), as OUT_x+1.50.svg ... (STEP " +
          step.text() + ")",
      [&request, step](const auto& words) {
        request.axis = words[0];
        request.step = Args::number("sections STEP", words[1], step);
        if (words[0] != "x" && words[0] != "y" && words[0] != "z")
          throw UsageError("-sections: axis '" + words[0] + "' is none of x, y, z");
      });
  args.flag("ortho", request.ortho,
            "also what lies below the cut, seen from above, true to scale: OUT_ortho.png with OUT_ortho.pgw");
  args.option("pixel", request.pixel, Range::above(0), "of pictures, metres");
}

Model readInput(const ScanPath& path)
{
  if (std::optional<GltfModel> read = readModelIfAny(path.file))
    return std::move(read->model);
  return readPoints(path);
}

/// OUT_ADDED.END, in the place of OUT.svg.
std::string beside(const std::string& output, const std::string& added)
{
  const std::filesystem::path path(output);
  return (path.parent_path() / (path.stem().string() + added)).string();
}

void writePicture(const std::string& path, const ScaledPicture& picture)
{
  writeImage(path, picture.image);
  writeFile(std::filesystem::path(path).replace_extension(".pgw").string(), worldFile(picture));
}

void writeDrawing(const std::string& path, const FloorPlan& plan, double pixel)
{
  const std::string end = extension(path);
  if (end == ".png")
    writePicture(path, planPicture(plan, pixel));
  else
    writeFile(path, end == ".svg" ? planSvg(plan) : planDxf(plan));
}

/// A section as a sheet: its first coordinate is the horizontal one, or x of a horizontal section.
FloorPlan sheetOf(const std::vector<Eigen::Matrix3Xd>& lines, int axis)
{
  FloorPlan sheet;
  sheet.low.setConstant(INFINITY);
  sheet.high = -sheet.low;
  for (const Eigen::Matrix3Xd& line : lines) {
    Polyline flat(2, line.cols());
    flat << line.row(axis == 0 ? 1 : 0), line.row(axis == 2 ? 1 : 2);
    sheet.low = sheet.low.cwiseMin(flat.rowwise().minCoeff());
    sheet.high = sheet.high.cwiseMax(flat.rowwise().maxCoeff());
    sheet.section.push_back(flat);
  }
  return sheet;
}

void writeSections(const Request& request, const Model& model, const std::string& output)
{
  constexpr int most = 1000;
  const auto* textured = std::get_if<TexturedMesh>(&model);
  require(textured, "-sections needs a mesh with faces; fresco_reconstruct makes one of a cloud");
  const TriangleMesh& mesh = textured->mesh;
  const int axis = request.axis[0] - 'x';
  const double low = mesh.vertices.row(axis).minCoeff() + mesh.origin[axis];
  const double high = mesh.vertices.row(axis).maxCoeff() + mesh.origin[axis];
  const double first = std::ceil(low / request.step);
  require((high - low) / request.step < most, "-sections: more than ", most, " sections between ", low, " and ", high,
          " m");
  for (double k = first; k * request.step < high; ++k) {
    const FloorPlan sheet = sheetOf(cutMesh(mesh, Eigen::Vector3d::Unit(axis), k * request.step), axis);
    if (!sheet.empty())
      writeDrawing(beside(output, format("_%s%+.2f", request.axis.c_str(), k * request.step) + extension(output)),
                   sheet, request.pixel);
  }
}

void tell(const FloorPlan& plan, bool quiet)
{
  double area = 0, worst = 0;
  int walls = 0, straight = 0;
  for (const PlanRoom& room : plan.rooms) {
    area += room.area;
    for (const PlanWall& wall : room.walls)
      if (wall.seen) {
        ++walls;
        straight += wall.straight ? 1 : 0;
        worst = wall.straight ? std::max(worst, wall.worst) : worst;
      }
  }
  inform(quiet, concat(plan.rooms.size(), plan.rooms.size() == 1 ? " room, " : " rooms, ") +
                    format("%.2f m2; cut at %.2f m, floor %.2f m, ", area, plan.height, plan.floor) +
                    (plan.has_ceiling ? format("ceiling %.2f m", plan.ceiling) : std::string("no ceiling")));
  inform(quiet,
         format("%d of %d walls are straight: 95 %% of their data within %.1f mm", straight, walls, 1000 * worst));
}

void writeAll(const Request& request, const std::string& output, const Model& model, const FloorPlan& plan)
{
  writeOutputs([&] {
    writeDrawing(output, plan, request.pixel);
    writeFile(beside(output, ".json"), planJson(plan));
    writeFile(beside(output, ".csv"), planCsv(plan));
    if (request.ortho)
      writePicture(beside(output, "_ortho.png"),
                   std::visit([&](const auto& m) { return orthophoto(m, plan, request.pixel); }, model));
    if (!request.axis.empty())
      writeSections(request, model, output);
  });
}

void run(int argc, char** argv)
{
  Request request;
  Args args("fresco_plan MODEL_OR_CLOUD OUT.svg|OUT.dxf|OUT.png [options]",
            "Floor plan of a mesh, a textured model or a cloud, in metres: section, straight walls, doors and windows, "
            "rooms.\n"
            "Beside OUT: OUT.json and OUT.csv, the rooms with area and height; beside a .png its world file .pgw.");
  declare(args, request);
  ScanOption scan;
  scan.declare(args);
  request.common.declare(args);
  args.note(
      "Examples:\n  fresco_plan model/mesh.ply plan.dxf\n  fresco_plan model.obj plan.svg -ortho -sections x 0.5");
  const auto files = args.parse(argc, argv, 2);
  const std::string& output = files[1];
  if (const std::string end = extension(output); end != ".svg" && end != ".dxf" && end != ".png")
    throw UsageError("'" + output + "' ends in none of .svg, .dxf, .png");
  requireDistinct({output, beside(output, ".json"), beside(output, ".csv"), beside(output, "_ortho.png")}, {files[0]});
  request.plan.threads = request.common.threads;
  const Model model = readInput(scan.of(files[0]));
  const Progress progress = printProgress(request.common.quiet);
  FloorPlan plan;
  try {
    if (const auto* cloud = std::get_if<PointSet>(&model))
      plan = drawPlan(*cloud, request.plan, progress);
    else
      plan = drawPlan(std::get<TexturedMesh>(model).mesh, request.plan, progress);
    writeAll(request, output, model, plan);
  } catch (const std::invalid_argument& error) { // of the model, at the height, with the pixel that was asked for
    throw std::runtime_error(files[0] + ": " + error.what());
  }
  tell(plan, request.common.quiet);
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_plan", [&] { run(argc, argv); });
}
