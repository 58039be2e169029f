// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <cstring>
#include <fresco/common/cloud_file.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/oriented_normals.h>
using namespace fresco;

namespace {
struct ToolOptions {
  NormalOptions normals;
  BilateralOptions smoothing;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  bool plain = false, propagate = false, flip = false, confidence = false, no_grid = false;
  ToolOptions() { smoothing.rounds = 0; }
  void declare(Args& args);
};

void ToolOptions::declare(Args& args)
{
  args.option("k", normals.k, "neighbours of the plane fit, the point included, at least 3");
  args.option("radius", normals.radius, "instead of -k: neighbours within this distance, metres, but at least 6");
  args.values(
      "viewpoint", "X Y Z",
      "where the scanner stood; default: fields vp_x vp_y vp_z, else the header of the file, else normals are made "
      "to agree with each other and to point out of closed objects",
      [this](const std::vector<std::string>& words) {
        for (int axis = 0; axis < 3; ++axis)
          viewpoint[axis] = Args::number("viewpoint", words[axis]);
      });
  args.flag("propagate", propagate, "as if no viewpoint were known");
  args.flag("flip", flip, "turn all normals round at the end");
  args.option("bilateral", smoothing.rounds, "rounds of bilateral smoothing of the normals; 0 = none");
  args.option("sigma_d", smoothing.sigma_d,
              "for -bilateral: deviation of the distance, metres; 0 = from the local sampling");
  args.option("sigma_n", smoothing.sigma_n, "for -bilateral: deviation of the angle between normals, degrees, 0..180");
  args.option("move", smoothing.move_rounds, "then move points along their normals, this many rounds");
  args.flag("plain", plain, "plain plane fits: do not keep to one side of an edge");
  args.flag("no_grid", no_grid, "organised clouds: search neighbours in space, not around the pixel");
  args.flag("confidence", confidence,
            "also write the field confidence, 0..1: falls with incidence and missing neighbours");
  args.note("Writes the fields normal_x normal_y normal_z curvature and keeps all others. Points that are not finite "
            "and points\n"
            "whose normal cannot be told get NaN.\n"
            "Example: fresco_normals scan.pcd oriented.pcd -k 20 -bilateral 3 -sigma_n 15");
}

void validate(const Args& args, const ToolOptions& options)
{
  if (args.given("k") && args.given("radius"))
    throw UsageError("-k and -radius exclude each other");
  if (args.given("viewpoint") && options.propagate)
    throw UsageError("-viewpoint and -propagate exclude each other");
  if (options.normals.k < 3)
    throw UsageError("-k: " + std::to_string(options.normals.k) + " is below 3");
  if (args.given("radius") && !(options.normals.radius > 0))
    throw UsageError("-radius: " + std::to_string(options.normals.radius) + " is not above 0");
  if (options.smoothing.rounds < 0 || options.smoothing.move_rounds < 0)
    throw UsageError("-bilateral, -move: a number of rounds is negative");
  if (!(options.smoothing.sigma_d >= 0))
    throw UsageError("-sigma_d: " + std::to_string(options.smoothing.sigma_d) + " is negative");
  if (!(options.smoothing.sigma_n > 0 && options.smoothing.sigma_n <= 180))
    throw UsageError("-sigma_n: " + std::to_string(options.smoothing.sigma_n) + " is not in 0..180 degrees");
}

const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  for (const auto& field : cloud.fields)
    if (field.name == name)
      return &field;
  return nullptr;
}

/// Adds the fields that are not there, as float, to all points.
void addFields(pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names)
{
  const std::size_t n = static_cast<std::size_t>(cloud.width) * cloud.height, before = cloud.point_step;
  for (const std::string& name : names) {
    if (findField(cloud, name))
      continue;
    pcl::PCLPointField field;
    field.name = name;
    field.offset = cloud.point_step;
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    cloud.point_step += sizeof(float);
    cloud.fields.push_back(field);
  }
  if (cloud.point_step == before)
    return;
  std::vector<std::uint8_t> data(n * cloud.point_step);
  for (std::size_t i = 0; i < n; ++i)
    std::memcpy(data.data() + i * cloud.point_step, cloud.data.data() + i * before, before);
  cloud.data.swap(data);
  cloud.row_step = cloud.point_step * cloud.width;
}

/// Writes one value per point into field `name`, which is there.
template <typename Values>
void writeField(pcl::PCLPointCloud2& cloud, const std::string& name, const Values& values)
{
  const pcl::PCLPointField field = *findField(cloud, name);
  if (field.datatype != pcl::PCLPointField::FLOAT32 && field.datatype != pcl::PCLPointField::FLOAT64)
    throw std::runtime_error("field " + name + " is neither float nor double");
  for (Index i = 0; i < values.size(); ++i) {
    auto* at = cloud.data.data() + static_cast<std::size_t>(i) * cloud.point_step + field.offset;
    const double wide = values[i];
    const auto narrow = static_cast<float>(wide);
    if (field.datatype == pcl::PCLPointField::FLOAT64)
      std::memcpy(at, &wide, sizeof wide);
    else
      std::memcpy(at, &narrow, sizeof narrow);
  }
}

PointSet loadPoints(const CloudFile& file, const std::string& name, const Args& args, const ToolOptions& options)
{
  PointSet set = toPointSet(file);
  if (args.given("viewpoint"))
    set.viewpoints = (options.viewpoint - set.origin).cast<float>();
  else if (options.propagate)
    set.viewpoints.resize(3, 0);
  if (set.viewpoints.cols() == 1 && !set.viewpoints.allFinite())
    throw std::runtime_error(name + ": its viewpoint is not finite, give -viewpoint X Y Z or -propagate");
  for (Index i = 0; i < set.size(); ++i)
    if (set.points.col(i).allFinite())
      return set;
  throw std::runtime_error(name + ": no finite points");
}

void writeResult(CloudFile& file, const PointSet& set, const NormalField& field, const ToolOptions& options)
{
  std::vector<std::string> names = {"normal_x", "normal_y", "normal_z", "curvature"};
  if (options.confidence)
    names.push_back("confidence");
  addFields(file.cloud, names);
  const float sign = options.flip ? -1.f : 1.f;
  for (int axis = 0; axis < 3; ++axis)
    writeField(file.cloud, names[static_cast<std::size_t>(axis)], sign * field.normals.row(axis));
  writeField(file.cloud, "curvature", field.curvatures);
  if (options.confidence)
    writeField(file.cloud, "confidence", field.confidences);
  if (options.smoothing.move_rounds > 0)
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::ArrayXd world = set.points.row(axis).transpose().cast<double>().array() + set.origin[axis];
      writeField(file.cloud, std::string(1, "xyz"[axis]), world);
    }
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_normals", [&] {
    ToolOptions options;
    CommonOptions common;
    Args args("fresco_normals IN OUT [-k N or -radius M] [-viewpoint X Y Z] [-bilateral N] [-sigma_d M] [-sigma_n DEG] "
              "[options]",
              "Normals that point to where each point was seen from, then bilateral smoothing of the normal field.\n"
              "IN: PCD, PLY, VTK, OBJ, XYZ; OUT: PCD, PLY, XYZ.");
    options.declare(args);
    common.declare(args);
    const auto files = args.parse(argc, argv, 2);
    validate(args, options);
    const Progress progress = printProgress(common.quiet);
    CloudFile file = readCloud(files[0]);
    PointSet set = loadPoints(file, files[0], args, options);
    options.normals.threads = options.smoothing.threads = common.threads;
    options.normals.edges = !options.plain;
    if (file.cloud.height > 1 && !options.no_grid)
      options.normals.image_width = file.cloud.width;
    {
      NormalField field = estimateNormals(set, options.normals, subProgress(progress, 0.0, 0.6));
      BilateralResult smooth =
          smoothNormals(set.points, field.normals, options.smoothing, subProgress(progress, 0.6, 1.0));
      field.normals.swap(smooth.normals);
      set.points.swap(smooth.points);
      writeResult(file, set, field, options);
    }
    const std::string result = std::to_string(set.size()) + " points, normals " +
                               (set.viewpoints.cols() > 0 ? "towards the viewpoint" : "in agreement with each other");
    set = {}; // frees memory
    writeOutputs([&] { writeCloud(files[1], file); });
    inform(common.quiet, result);
  });
}
