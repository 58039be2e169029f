// SPDX-License-Identifier: BSD-3-Clause
#include "plan.h"
#include "input/standpoint.h"
#include "photographs/structure_from_motion.h"
#include "stages/video.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fstream>
#include <set>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

double bytesOf(const std::string& file)
{
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return error ? 0 : double(size);
}

/// Points of a file as its header tells; else judged by its size.
double pointsOf(const ScanPath& path)
{
  const std::string& file = path.file;
  constexpr double bytes_a_point = 25; // of text, and of packed formats with colours
  if (holdsScans(file)) {
    double sum = 0;
    try {
      for (const ScanInfo& scan : readScanInfos(path))
        sum += double(scan.points);
    } catch (const std::runtime_error&) { // damaged: registration says so
    }
    return sum;
  }
  std::string head(4096, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), std::streamsize(head.size()));
  if (head.rfind("LASF", 0) == 0) {
    std::uint32_t few = 0;
    std::uint64_t many = 0;
    std::memcpy(&few, &head[107], sizeof few);
    std::memcpy(&many, &head[247], sizeof many); // of version 1.4, where `few` may be 0
    return few > 0 ? few : double(many);
  }
  double points = bytesOf(file) / bytes_a_point;
  for (const char* key : {"\nPOINTS ", "\nelement vertex "})
    if (const std::size_t at = head.find(key); at != std::string::npos)
      points = std::atof(head.c_str() + at + std::strlen(key));
  return holdsFaces(file) ? std::clamp(10 * points, 3e5, 4e6) : points; // spread over them: stages/cloud.cpp
}

/// Vertices of a surface of scans: what one of them sees, counted in coarse boxes, and n about n^(1/3) times as much, since they overlap.
double verticesOfScans(const Job& job)
{
  constexpr float box = 0.5f; // metres; walls of a room lie in about as many of them as they have area
  constexpr double usual_cell = 0.02;
  const std::vector<ScanPath>& scans = job.input.scans;
  std::set<std::array<int, 3>> boxes;
  Points points(3, 0);
  try {
    points = samplePoints(scans[scans.size() / 2]);
  } catch (const std::runtime_error&) { // damaged: registration says so
  }
  for (Index i = 0; i < points.cols(); ++i)
    boxes.insert({int(std::floor(points(0, i) / box)), int(std::floor(points(1, i) / box)),
                  int(std::floor(points(2, i) / box))});
  const double cell = job.options.cell > 0 ? job.options.cell : usual_cell;
  return double(boxes.size()) * box * box * std::cbrt(double(scans.size())) / (cell * cell);
}

/// Vertices by the kind of input.
double verticesOf(const Job& job, double points)
{
  constexpr double most = 3e6, a_frame = 1e3, points_a_vertex = 4;
  if (job.input.rgbd)
    return std::min(most, a_frame * double(job.input.rgbd->frames.size()));
  return std::min(most, job.input.is_cloud ? points / points_a_vertex : verticesOfScans(job));
}
/// Pixels of a photograph that is to be placed.
double pixelsOf(const ModelInput& input)
{
  try {
    const ImageSize size = input.unplaced.empty() ? ImageSize() : readImageSize(input.images + "/" + input.unplaced[0]);
    return double(size.width) * size.height;
  } catch (const std::runtime_error&) { // damaged: checkPhotographs() says so
    return 0;
  }
}

/// Seconds of one core in colmap.
struct Placing {
  double cpu = 0, most_cpu = 0;
};

/// By features, which pixels tell, and pairs: docs/measurements/model.md. How long photographs are tried before they have a
/// place depends on what they show: ten times as long where they hardly overlap.
Placing placingOf(double photographs, double pixels)
{
  constexpr double most_pixels = 3200 * 2400, most_features = 11000; // colmap scales to 3200, keeps 8192 places
  constexpr double features_a_pixel = 4.5e-3, of_pixel = 1.6e-6, of_matched = 1.1e-4, of_placed = 1.2e-4, hard = 10;
  const double used = std::min(pixels, most_pixels), features = std::min(features_a_pixel * used, most_features);
  const double cpu =
      photographs * of_pixel * used + of_matched * features * double(pairsToMatch(std::size_t(photographs)));
  const double placed = of_placed * features * photographs;
  return {cpu + placed, cpu + hard * placed};
}
} // namespace

ModelPlan estimate(const Job& job)
{
  const ModelInput& input = job.input;
  ModelPlan plan;
  plan.input = describe(input);
  plan.found = input.found;
  plan.warnings = input.warnings;
  double largest = 0, picture_bytes = 0;
  std::set<std::string> files;
  for (const ScanPath& scan : input.scans)
    if (files.insert(scan.file).second) {
      const double points = pointsOf(scan);
      plan.points += points;
      largest = std::max(largest, points);
    }
  for (const PictureFile& picture : input.pictures())
    picture_bytes += bytesOf(picture.file);
  const KeptFrames frames_kept = input.video.empty() || input.rgbd ? KeptFrames() : framesToKeep(input.video);
  const double kept = frames_kept.count, photographs = double(input.unplaced.size()) + kept;
  constexpr double found_a_photograph = 100, bytes_a_photograph = 2e5; // of a room; of a frame of a video
  picture_bytes += bytes_a_photograph * kept;
  const bool pictured = input.hasPictures() || kept > 0;
  if (input.scans.empty() && !input.rgbd)
    plan.points = input.sparse.empty() ? found_a_photograph * photographs : double(input.sparse.size());
  const double frames = input.rgbd ? double(input.rgbd->frames.size()) : 0;
  if (input.rgbd)
    plan.points = frames * input.rgbd->camera.width * input.rgbd->camera.height;
  // Seconds of one core and bytes, per item, of the runs in docs/measurements/model.md: true to a factor of two there.
  const double points = input.rgbd ? 0 : plan.points, vertices = verticesOf(job, points);
  const double scans = input.is_cloud || job.options.use_poses ? 0 : double(input.scans.size());
  const bool has_poses = input.rgbd && input.rgbd->has_poses;
  constexpr double most_painted = 2e7, most_averaged = 16; // points of a texture; a vertex
  double cpu = 9e-6 * points + 0.5 * scans * (scans - 1) + (has_poses ? 0.06 : 0.4) * frames + 1e-5 * vertices;
  double memory = 2e8 + (input.is_cloud ? 220 * points : 500 * largest), disk = 5e6 + 40 * points + 45 * vertices;
  if (!input.rgbd)
    cpu += 8e-5 * vertices + 1.4e-5 * std::min(points, most_averaged * vertices);
  double later = 2e8 + 800 * vertices;
  if (job.options.until.empty()) {
    cpu += 2 + 1.2e-5 * vertices;
    cpu += pictured ? 4e-6 * picture_bytes : 4e-5 * vertices + 6e-6 * std::min(points, most_painted);
    later += pictured ? 45 * std::min(picture_bytes, 1e8) : 250 * std::min(points, most_painted);
    disk += 300 * vertices + 6 * picture_bytes;
  }
  const auto seconds = [&](double of_one_core) {
    return of_one_core / std::max(1.0, 0.7 * threadCount(job.options.threads));
  };
  const Placing placing = job.options.until.empty() || input.scans.empty()
                              ? placingOf(photographs, kept > 0 ? frames_kept.pixels : pixelsOf(input))
                              : Placing();
  plan.seconds = seconds(cpu + placing.cpu);
  plan.most_seconds = seconds(cpu + placing.most_cpu);
  plan.memory = std::max(memory, later);
  plan.disk = disk;
  return plan;
}

void requireRoom(const ModelPlan& plan, const Job& job)
{
  constexpr double certain = 3; // what is judged too high by this factor would still fit
  const auto megabytes = [](double bytes) { return std::lround(bytes / 1e6); };
  if (const double there = double(machineMemory()); plan.memory > certain * there)
    throw std::runtime_error(concat(job.input.folder, ": about ", megabytes(plan.memory), " MB of memory for ",
                                    plan.input, ", ", megabytes(there),
                                    " MB are there: thin the points first (fresco_filter -voxel 0.01)"));
  std::error_code error;
  fs::path place = fs::absolute(job.files.folder);
  while (!fs::exists(place) && place.has_parent_path() && place != place.parent_path())
    place = place.parent_path();
  if (const fs::space_info space = fs::space(place, error); !error && plan.disk > certain * double(space.available))
    throw std::runtime_error(concat(job.files.folder, ": about ", megabytes(plan.disk), " MB will be written, ",
                                    megabytes(double(space.available)), " MB are free"));
}
} // namespace fresco::model

std::string fresco::planSummary(const ModelPlan& plan)
{
  const auto rounded = [](double value) { // two digits: more would pretend to know
    const double unit = value > 0 ? std::pow(10.0, std::floor(std::log10(value)) - 1) : 1;
    return std::llround(std::round(value / unit) * unit);
  };
  std::string text;
  for (const std::string& stage : plan.stages)
    text += (text.empty() ? "" : ", ") + stage;
  const bool in_seconds = plan.most_seconds < 90;
  const auto least = rounded(plan.seconds / (in_seconds ? 1 : 60)),
             most = rounded(plan.most_seconds / (in_seconds ? 1 : 60));
  const std::string time = concat(least, most > least ? concat(" to ", most) : "", in_seconds ? " s" : " min");
  return concat(text, "; ", rounded(plan.points), " raw points; about ", time, ", ", rounded(plan.memory / 1e6),
                " MB of memory, ", rounded(plan.disk / 1e6), " MB of disk");
}
