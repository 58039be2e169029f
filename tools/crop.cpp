// SPDX-License-Identifier: BSD-3-Clause
#include "support/plan_option.h"
#include "support/scan_option.h"
#include "support/tool.h"
#include <fresco/core/point_set.h>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/crop.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <pcl/common/io.h>
namespace {
using namespace fresco;

struct CropOptions {
  CropRegion region;
  RoomChoice room;
  PlanOptions plan;
  std::string polygon;
  GltfOptions gltf;

  void declare(Args& args)
  {
    args.numbers("box", "X0 Y0 Z0 X1 Y1 Z1", Range::any(),
                 "keep what lies in this box: two opposite corners, world coordinates",
                 [this](const std::vector<double>& given) {
                   const Eigen::Vector3d a(&given[0]), b(&given[3]);
                   if (!((a - b).array().abs() > 0).all())
                     throw UsageError("-box: a side of the box has no length");
                   const Eigen::Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b);
                   Eigen::Matrix2Xd base(2, 4);
                   base << low.x(), high.x(), high.x(), low.x(), low.y(), low.y(), high.y(), high.y();
                   region = {{base}, low.z(), high.z()};
                 });
    args.option(
        "polygon", polygon,
        "keep what lies in the polygons of this file, seen from above; .geojson, .json: x y in metres; .svg: one "
        "unit a metre, y pointing down. One polygon in another is a hole");
    args.option("above", region.low, Range::any(), "keep what lies above this height");
    args.option("below", region.high, Range::any(), "keep what lies below this height");
    args.option("room", room.number, Range::atLeast(1),
                "keep a room, by its number in the plan that fresco_plan draws");
    args.option("margin", room.margin, Range::atLeast(0),
                "with -room: what is kept behind the lines of its walls, metres");
    declarePlan(args, plan);
    args.option("quality", gltf.jpeg_quality, Range::within(1, 100).zero("PNG, without loss"),
                "JPEG quality of the texture's pictures");
  }
};

[[noreturn]] void refuseEmpty(const std::string& path)
{
  throw std::runtime_error(path + ": nothing of it lies inside; fresco_crop -h tells what is kept");
}

/// @param model a mesh or a cloud
template <typename Model>
CropRegion roomOf(const std::string& file, const Model& model, const CropOptions& options, bool quiet)
{
  try {
    return regionOfRoom(drawPlan(model, options.plan, printProgress(quiet)), options.room);
  } catch (const std::invalid_argument& error) { // of the model, at the height that was asked for
    throw std::runtime_error(file + ": " + error.what());
  }
}

void cropCloud(const std::vector<std::string>& files, const CropOptions& options, bool rooms, bool quiet)
{
  CloudFile file = readCloud(files[0]);
  const PointSet set = toPointSet(file);
  const CropRegion region = rooms ? roomOf(files[0], set, options, quiet) : options.region;
  pcl::Indices kept;
  for (Index i = 0; i < set.size(); ++i)
    if (isInside(region, set.origin + set.points.col(i).cast<double>()))
      kept.push_back(i);
  if (kept.empty())
    refuseEmpty(files[0]);
  pcl::PCLPointCloud2 cloud;
  pcl::copyPointCloud(file.cloud, kept, cloud);
  cloud.is_dense = 1;
  file.cloud = std::move(cloud);
  writeOutputs([&] { writeCloud(files[1], file); });
  inform(quiet, concat(kept.size(), " of ", set.size(), " points"));
}

void cropSurface(GltfModel model, const std::vector<std::string>& files, const CropOptions& options, bool rooms,
                 bool quiet)
{
  const Index before = model.model.mesh.faceCount();
  const CropRegion region = rooms ? roomOf(files[0], model.model.mesh, options, quiet) : options.region;
  model.model = cropModel(std::move(model.model), region);
  const Index faces = model.model.mesh.faceCount();
  if (faces == 0)
    refuseEmpty(files[0]);
  writeOutputs([&] { writeModel(files[1], std::move(model), options.gltf); });
  inform(quiet, concat(faces, " of ", before, " faces"));
}

/// @throws UsageError
void validate(const Args& args)
{
  const bool box = args.given("box"), room = args.given("room");
  const bool others = args.given("polygon") || args.given("above") || args.given("below");
  if (box + room + others > 1)
    throw UsageError("-box and -room go with none of -box, -room, -polygon, -above, -below");
  if (box + room + others == 0)
    throw UsageError("one of -box, -room, -polygon, -above, -below is needed");
}

void run(int argc, char** argv)
{
  CropOptions options;
  CommonOptions common;
  Args args("fresco_crop IN OUT -box X0 Y0 Z0 X1 Y1 Z1 | -polygon FILE | -above Z | -below Z | -room N [options]",
            "Cuts a part out of a cloud, a mesh or a textured model. Faces are cut at the border; textures, colours "
            "and fields "
            "stay.\nIN, OUT: clouds " +
                readableExtensions(FileKind::points) + "; meshes " + readableExtensions(FileKind::mesh) +
                "; textured\nmodels " + readableExtensions(FileKind::textured_mesh) + ".");
  options.declare(args);
  declareColumns(args);
  common.declare(args);
  args.note(
      "-polygon, -above and -below may stand together. Example: fresco_crop model.glb room.glb -polygon room.geojson "
      "-below 2.4");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  validate(args);
  requireDistinct({files[1]}, {files[0], options.polygon});
  std::optional<GltfModel> model = readModelIfAny(files[0]);
  const bool cloud = !model, rooms = args.given("room");
  if (!isWritable(files[1], cloud ? FileKind::points : FileKind::mesh) &&
      (cloud || !isWritable(files[1], FileKind::textured_mesh)))
    throw UsageError(
        files[1] + ": the output's extension must be " +
        (cloud ? writableExtensions(FileKind::points)
               : writableExtensions(FileKind::mesh) + ", or " + writableExtensions(FileKind::textured_mesh)));
  if (!options.polygon.empty())
    options.region.outlines = readOutlines(options.polygon);
  try {
    validateCropRegion(options.region);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(options.polygon.empty() ? error.what() : options.polygon + ": " + error.what());
  }
  options.plan.threads = common.threads;
  cloud ? cropCloud(files, options, rooms, common.quiet)
        : cropSurface(std::move(*model), files, options, rooms, common.quiet);
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_crop", [&] { run(argc, argv); });
}
