// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <algorithm>
#include <array>
#include <cstring>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/formats.h>
#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <pcl/common/io.h>
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
  args.option("k", normals.k, Range::within(3, 1000), "neighbours of the plane fit, the point included");
  args.option("radius", normals.radius, Range::above(0),
              "instead of -k: neighbours within this distance, metres, but six of them");
  args.numbers(
      "viewpoint", "X Y Z", Range::any(),
      "where the scanner stood; default: fields vp_x vp_y vp_z, else the header of the file, else normals are made "
      "to agree with each other and to point out of closed objects",
      [this](const auto& given) { viewpoint = Eigen::Vector3d(given.data()); });
  args.flag("propagate", propagate, "as if no viewpoint were known");
  args.flag("flip", flip, "turn all normals round at the end");
  args.option("bilateral", smoothing.rounds, Range::atLeast(0), "rounds of bilateral smoothing of the normals");
  args.option("sigma_d", smoothing.sigma_d, Range::above(0).zero("from the local sampling"),
              "for -bilateral: deviation of the distance, metres");
  args.option("sigma_n", smoothing.sigma_n, Range::above(0).atMost(180),
              "for -bilateral: deviation of the angle between normals, degrees");
  args.option("move", smoothing.move_rounds, Range::atLeast(0),
              "then move points along their normals, this many rounds");
  args.flag("plain", plain,
            "plain plane fits: do not keep to one side of an edge, nor look for another one in -bilateral");
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
}

const pcl::PCLPointField* findField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  for (const auto& field : cloud.fields)
    if (field.name == name)
      return &field;
  return nullptr;
}

std::size_t sizeOf(const pcl::PCLPointField& field)
{
  return pcl::getFieldSize(field.datatype) * std::max<std::size_t>(1, field.count);
}

constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// Gives all points these fields, one behind the other. Their offsets say where they are now; `nowhere`: zero at first.
void arrange(pcl::PCLPointCloud2& cloud, std::vector<pcl::PCLPointField> fields)
{
  struct Piece {
    std::size_t from, to, size;
  };
  std::vector<Piece> pieces;
  std::size_t step = 0;
  for (auto& field : fields) {
    const std::size_t size = sizeOf(field), from = field.offset;
    const bool follows = !pieces.empty() && pieces.back().from + pieces.back().size == from &&
                         pieces.back().to + pieces.back().size == step;
    if (field.offset != nowhere && follows)
      pieces.back().size += size;
    else if (field.offset != nowhere)
      pieces.push_back({from, step, size});
    field.offset = static_cast<std::uint32_t>(step);
    step += size;
  }
  const std::size_t n = static_cast<std::size_t>(cloud.width) * cloud.height, before = cloud.point_step;
  std::vector<std::uint8_t> data(n * step);
  for (std::size_t i = 0; i < n; ++i)
    for (const Piece& piece : pieces)
      std::memcpy(data.data() + i * step + piece.to, cloud.data.data() + i * before + piece.from, piece.size);
  cloud.data.swap(data);
  cloud.fields.swap(fields);
  cloud.point_step = static_cast<std::uint32_t>(step);
  cloud.row_step = cloud.point_step * cloud.width;
}

/// Whether fields of the cloud hold these numbers, to the bit.
bool holds(const pcl::PCLPointCloud2& cloud, const std::array<std::string, 3>& names, const Points& values)
{
  if (values.cols() != static_cast<Index>(cloud.width) * static_cast<Index>(cloud.height))
    return false;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto* field = findField(cloud, names[axis]);
    if (!field || field->datatype != pcl::PCLPointField::FLOAT32 || sizeOf(*field) != sizeof(float))
      return false;
    for (Index i = 0; i < values.cols(); ++i)
      if (std::memcmp(cloud.data.data() + static_cast<std::size_t>(i) * cloud.point_step + field->offset,
                      &values(axis, i), sizeof(float)) != 0)
        return false;
  }
  return true;
}

const std::array<std::string, 3> coordinate_names = {"x", "y", "z"}, viewpoint_names = {"vp_x", "vp_y", "vp_z"};

/// A cloud without the coordinates and viewpoints that a set of its points holds as well: less memory on the way.
class BareCloud {
public:
  BareCloud(pcl::PCLPointCloud2& cloud, const PointSet& set) : cloud_(cloud), fields_(cloud.fields)
  {
    coordinates_ = set.origin.isZero(0) && holds(cloud, coordinate_names, set.points);
    viewpoints_ = holds(cloud, viewpoint_names, set.viewpoints);
    std::vector<pcl::PCLPointField> kept;
    for (const auto& field : fields_)
      if (!isLent(field.name))
        kept.push_back(field);
    arrange(cloud, kept);
  }
  /// Puts them back to their places, and adds those of the `names` that are not there, as float.
  pcl::PCLPointCloud2& complete(const std::vector<std::string>& names)
  {
    auto kept = cloud_.fields.begin();
    for (auto& field : fields_)
      field.offset = isLent(field.name) ? nowhere : kept++->offset;
    for (const std::string& name : names) {
      const auto same = [&](const pcl::PCLPointField& field) { return field.name == name; };
      if (std::any_of(fields_.begin(), fields_.end(), same))
        continue;
      fields_.emplace_back();
      fields_.back().name = name;
      fields_.back().offset = nowhere;
      fields_.back().datatype = pcl::PCLPointField::FLOAT32;
      fields_.back().count = 1;
    }
    arrange(cloud_, fields_);
    return cloud_;
  }
  bool withoutCoordinates() const { return coordinates_; }
  bool withoutViewpoints() const { return viewpoints_; }

private:
  bool isLent(const std::string& name) const
  {
    const auto among = [&](const auto& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
    return (coordinates_ && among(coordinate_names)) || (viewpoints_ && among(viewpoint_names));
  }
  pcl::PCLPointCloud2& cloud_;
  std::vector<pcl::PCLPointField> fields_;        ///< of the whole cloud
  bool coordinates_ = false, viewpoints_ = false; ///< whether they are left out
};

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
  if (finiteColumns(set.points).empty())
    throw std::runtime_error(name + ": no finite points");
  return set;
}

/// What the tool needs of the points.
PointSet withoutAttributes(PointSet set)
{
  PointSet bare;
  bare.points.swap(set.points);
  bare.viewpoints.swap(set.viewpoints);
  bare.origin = set.origin;
  return bare;
}

/// What was freed in small pieces goes back to the system, for what follows is large.
void returnFreedMemory()
{
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void writeResult(BareCloud& bare, const PointSet& set, const NormalField& field, const ToolOptions& options)
{
  std::vector<std::string> names = {"normal_x", "normal_y", "normal_z", "curvature"};
  if (options.confidence)
    names.push_back("confidence");
  pcl::PCLPointCloud2& cloud = bare.complete(names);
  const float sign = options.flip ? -1.f : 1.f;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<Index>(axis);
    writeField(cloud, names[axis], sign * field.normals.row(row));
    if (bare.withoutCoordinates() || options.smoothing.move_rounds > 0)
      writeField(cloud, coordinate_names[axis], set.points.row(row).cast<double>().array() + set.origin[row]);
    if (bare.withoutViewpoints())
      writeField(cloud, viewpoint_names[axis], set.viewpoints.row(row));
  }
  writeField(cloud, "curvature", field.curvatures);
  if (options.confidence)
    writeField(cloud, "confidence", field.confidences);
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_normals", [&] {
    ToolOptions options;
    CommonOptions common;
    Args args(
        "fresco_normals IN OUT [-k N or -radius M] [-viewpoint X Y Z] [-bilateral N] [-sigma_d M] [-sigma_n DEG] "
        "[options]",
        "Normals that point to where each point was seen from, then bilateral smoothing of the normal field.\nIN: " +
            readableExtensions(FileKind::points) + "; OUT: " + writableExtensions(FileKind::points) + ".");
    ScanOption scan;
    options.declare(args);
    scan.declare(args);
    common.declare(args);
    const auto files = args.parse(argc, argv, 2);
    requireDistinct({files[1]}, {files[0]});
    validate(args, options);
    const Progress progress = printProgress(common.quiet);
    CloudFile file = readCloud(scan.of(files[0]));
    PointSet set = withoutAttributes(loadPoints(file, files[0], args, options));
    BareCloud bare(file.cloud, set);
    options.normals.threads = options.smoothing.threads = common.threads;
    options.normals.edges = options.smoothing.edges = !options.plain;
    if (file.cloud.height > 1 && !options.no_grid)
      options.normals.image_width = file.cloud.width;
    {
      NormalField field = estimateNormals(set, options.normals, subProgress(progress, 0.0, 0.6));
      if (!options.confidence)
        field.confidences.resize(0);
      returnFreedMemory();
      BilateralResult smooth = smoothNormals(set, field.normals, options.smoothing, subProgress(progress, 0.6, 1.0));
      returnFreedMemory();
      field.normals.swap(smooth.normals);
      set.points.swap(smooth.points);
      writeResult(bare, set, field, options);
    }
    const std::string result = std::to_string(set.size()) + " points, normals " +
                               (set.viewpoints.cols() > 0 ? "towards the viewpoint" : "in agreement with each other");
    set = {}; // frees memory
    writeOutputs([&] { writeCloud(files[1], file); });
    inform(common.quiet, result);
  });
}
