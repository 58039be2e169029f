// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/filters/core/voxel_thinning.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/scan_writer.h>
#include <numeric>
#include <pcl/common/io.h>
using namespace fresco;

namespace {
struct FilterOptions {
  OutlierOptions outliers;
  ScatterOptions scatter;
  MixedPixelOptions mixed_pixels;
  float cell = 0; // metres
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();
  bool centroid = false, keep_organized = false, removed = false;
  void declare(Args& args);
};

void FilterOptions::declare(Args& args)
{
  const Range neighbors = Range::atLeast(1), sigma = Range::atLeast(0);
  args.values(
      "outliers", "K SIGMA",
      "remove points whose mean distance to their K neighbours exceeds the mean of all points by more than SIGMA "
      "standard deviations (K " +
          neighbors.text() + ", SIGMA " + sigma.text() + ")",
      [this, neighbors, sigma](const std::vector<std::string>& words) {
        outliers.k = Args::integer("outliers K", words[0], neighbors);
        outliers.sigma = static_cast<float>(Args::number("outliers SIGMA", words[1], sigma));
      });
  args.flag("relative", outliers.relative,
            "for -outliers: judge distances against those of the neighbours, so that sparse parts of a scan stay");
  args.option(
      "scattered", scatter.k, Range::atLeast(2),
      "remove points that fill a volume among those spaced as widely as they are, told by this many neighbours; "
      "16 is common. Sparse surfaces and wires stay");
  args.option("veil", mixed_pixels.angle, Range::above(0).below(90),
              "remove mixed pixels: the points in the air that a laser leaves at depth jumps. What a surface could "
              "join with most of the points next to it stays: the way to them leaves its beam at no less than this "
              "angle, degrees; 20 is common, more removes more");
  args.option("noise", mixed_pixels.noise, Range::above(0).zero("measured from the scan"),
              "for -veil: deviation of the ranges, metres");
  args.numbers("viewpoint", "X Y Z", Range::any(),
               "for -veil: where the scanner stood; default: fields vp_x vp_y vp_z, else the header of the file",
               [this](const auto& given) { viewpoint = Eigen::Vector3d(given.data()); });
  args.option("voxel", cell, Range::above(0),
              "keep one point per cube of this side, metres: the one nearest to the centroid");
  args.flag("centroid", centroid, "for -voxel: move the point kept to the centroid");
  args.flag("keep_organized", keep_organized, "removed points become NaN in their place");
  args.flag("removed", removed, "write the points that would be removed instead");
  args.note("The steps run in the order veil, scattered, outliers, voxel; only those given run. Points that are not "
            "finite are always\n"
            "removed. Every field of the points that stay is kept.\n"
            "Example: fresco_filter scan.pcd clean.pcd -veil 20 -outliers 16 2 -voxel 0.005");
}

/// The points of a cloud that are left, with their places in it.
struct Remaining {
  PointSet set;
  std::vector<Index> columns;

  void keep(const std::vector<Index>& indices)
  {
    set = selectPoints(set, indices);
    std::vector<Index> kept;
    for (const Index i : indices)
      kept.push_back(columns[i]);
    columns.swap(kept);
  }
};

/// Writes `value` into field `name`, of type float or double, of a point.
void setValue(pcl::PCLPointCloud2& cloud, Index point, const std::string& name, double value)
{
  for (const auto& field : cloud.fields)
    if (field.name == name) {
      auto* at = cloud.data.data() + static_cast<std::size_t>(point) * cloud.point_step + field.offset;
      const auto narrow = static_cast<float>(value);
      if (field.datatype == pcl::PCLPointField::FLOAT64)
        std::memcpy(at, &value, sizeof value);
      else if (field.datatype == pcl::PCLPointField::FLOAT32)
        std::memcpy(at, &narrow, sizeof narrow);
      else
        throw std::runtime_error("field " + name + " is neither float nor double");
    }
}

void setPosition(pcl::PCLPointCloud2& cloud, Index point, const Eigen::Vector3d& position)
{
  const char* const names[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis)
    setValue(cloud, point, names[axis], position[axis]);
}

/// Keeps the points named by `columns`, ascending.
void keepPoints(pcl::PCLPointCloud2& cloud, const std::vector<Index>& columns)
{
  pcl::PCLPointCloud2 kept;
  pcl::copyPointCloud(cloud, pcl::Indices(columns.begin(), columns.end()), kept);
  kept.is_dense = 1;
  cloud = std::move(kept);
}

void blankOthers(pcl::PCLPointCloud2& cloud, const std::vector<Index>& columns)
{
  std::size_t next = 0;
  const Index n = static_cast<Index>(cloud.width) * cloud.height;
  for (Index i = 0; i < n; ++i)
    if (next < columns.size() && columns[next] == i)
      ++next;
    else
      setPosition(cloud, i, Eigen::Vector3d::Constant(NAN));
  cloud.is_dense = static_cast<Index>(columns.size()) == n;
}

std::vector<Index> complement(const std::vector<Index>& columns, const std::vector<Index>& all)
{
  std::vector<Index> others;
  std::set_difference(all.begin(), all.end(), columns.begin(), columns.end(), std::back_inserter(others));
  return others;
}

void removeMixedPixels(Remaining& rest, const std::string& file, const Args& args, const FilterOptions& options)
{
  if (args.given("viewpoint"))
    rest.set.viewpoints = (options.viewpoint - rest.set.origin).cast<float>();
  if (rest.set.viewpoints.cols() == 0)
    throw std::runtime_error(file + ": the viewpoint is not known, give -viewpoint X Y Z");
  if (!rest.set.viewpoints.allFinite())
    throw std::runtime_error(file + ": a viewpoint is not finite");
  rest.keep(withoutMixedPixels(rest.set.points, rest.set.viewpoints, options.mixed_pixels));
}

void thin(Remaining& rest, pcl::PCLPointCloud2& cloud, const FilterOptions& options)
{
  const VoxelThinning thinning = thinByVoxel(rest.set.points, options.cell, options.mixed_pixels.threads);
  rest.keep(thinning.kept);
  if (options.centroid)
    for (Index i = 0; i < rest.set.size(); ++i)
      setPosition(cloud, rest.columns[i], rest.set.origin + thinning.centroids.col(i).cast<double>());
}

/// Runs the steps given; says on stderr what each leaves.
void filterCloud(CloudFile& file, const std::string& name, const Args& args, const FilterOptions& options, bool quiet)
{
  const Progress progress = printProgress(quiet);
  Remaining rest{toPointSet(file), {}};
  rest.columns.resize(rest.set.size());
  std::iota(rest.columns.begin(), rest.columns.end(), Index(0));
  std::vector<std::string> lines = {std::to_string(rest.set.size()) + " points"};
  rest.keep(finiteColumns(rest.set.points));
  if (rest.columns.empty())
    throw std::runtime_error(name + ": no finite points");
  const std::vector<Index> finite = rest.columns;
  const auto step = [&](const char* option, double fraction, const auto& run) {
    if (!args.given(option))
      return;
    report(progress, option, fraction);
    const std::size_t before = rest.columns.size();
    run();
    lines.push_back(std::string(option) + " removed " + std::to_string(before - rest.columns.size()));
  };
  step("veil", 0.2, [&] { removeMixedPixels(rest, name, args, options); });
  step("scattered", 0.4, [&] { rest.keep(withoutScatter(rest.set.points, options.scatter)); });
  step("outliers", 0.5, [&] { rest.keep(withoutOutliers(rest.set.points, options.outliers)); });
  step("voxel", 0.8, [&] { thin(rest, file.cloud, options); });
  std::vector<Index> columns = options.removed ? complement(rest.columns, finite) : rest.columns;
  if (columns.empty())
    throw std::runtime_error(name + ": no points are left");
  options.keep_organized ? blankOthers(file.cloud, columns) : keepPoints(file.cloud, columns);
  lines.push_back(std::to_string(columns.size()) + " points written");
  for (const auto& line : lines)
    inform(quiet, line);
}
/// Scan by scan, so that poses and pictures stay.
void filterScans(const std::vector<std::string>& files, const Args& args, const FilterOptions& options, bool quiet)
{
  std::vector<PlacedCloud> scans = readPlacedClouds(files[0]);
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (scans[i].cloud.cloud.width > 0) {
      const std::string name = ScanPath{files[0], Index(i)}.name();
      inform(quiet, name);
      filterCloud(scans[i].cloud, name, args, options, quiet);
    }
  const std::vector<ScanPicture> pictures = readScanPictures(files[0]);
  writeOutputs([&] { writeScans(files[1], scans, pictures); });
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_filter", [&] {
    FilterOptions options;
    CommonOptions common;
    Args args("fresco_filter IN OUT [-scattered K] [-outliers K SIGMA] [-veil DEG] [-voxel M] [options]",
              "Removes isolated points and mixed pixels of a scan, and thins it by voxel.\nIN: " +
                  readableExtensions(FileKind::points) + "; OUT: " + writableExtensions(FileKind::points) + ".");
    ScanOption scan;
    options.declare(args);
    scan.declare(args);
    common.declare(args);
    const auto files = args.parse(argc, argv, 2);
    requireDistinct({files[1]}, {files[0]});
    options.outliers.threads = options.scatter.threads = options.mixed_pixels.threads = common.threads;
    if (scan.number == 0 && extension(files[0]) == ".e57" && extension(files[1]) == ".e57")
      return filterScans(files, args, options, common.quiet);
    CloudFile file = readCloud(scan.of(files[0]));
    filterCloud(file, files[0], args, options, common.quiet);
    writeOutputs([&] { writeCloud(files[1], file); });
  });
}
