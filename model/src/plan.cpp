// SPDX-License-Identifier: BSD-3-Clause
#include "plan.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
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
double pointsOf(const std::string& file)
{
  constexpr double bytes_a_point = 25; // of text, and of packed formats with colours
  if (holdsScans(file)) {
    double sum = 0;
    for (const ScanInfo& scan : readScanInfos(file))
      sum += double(scan.points);
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
  for (const char* key : {"\nPOINTS ", "\nelement vertex "})
    if (const std::size_t at = head.find(key); at != std::string::npos)
      return std::atof(head.c_str() + at + std::strlen(key));
  return bytesOf(file) / bytes_a_point;
}
} // namespace

ModelPlan estimate(const Job& job)
{
  // Seconds of one core and bytes, per item: docs/measurements/model.md. True to a factor of about three.
  constexpr double per_point = 12e-6, per_vertex = 2e-4, per_picture_byte = 1.5e-6, per_frame = 0.4, pictures = 15;
  constexpr double stored_point = 36, worked_point = 220, worked_vertex = 2500, program = 3e8;
  const ModelInput& input = job.input;
  ModelPlan plan;
  plan.input = describe(input);
  plan.found = input.found;
  plan.warnings = input.warnings;
  double largest = 0, picture_bytes = 0;
  std::set<std::string> files;
  for (const ScanPath& scan : input.scans)
    if (files.insert(scan.file).second) {
      const double points = pointsOf(scan.file);
      plan.points += points;
      largest = std::max(largest, points);
    }
  for (const PictureFile& picture : input.pictures())
    picture_bytes += bytesOf(picture.file);
  if (input.is_cloud)
    largest = plan.points;
  const double frames = input.rgbd ? double(input.rgbd->frames.size()) : 0;
  if (input.rgbd)
    plan.points = frames * input.rgbd->camera.width * input.rgbd->camera.height;
  const double vertices = std::min(input.rgbd ? 1e3 * frames : plan.points / 3, 3e6);
  const double pairs =
      input.is_cloud || job.options.use_poses ? 0 : 0.5 * double(input.scans.size() * input.scans.size());
  const double photographs = double(input.unplaced.size());
  const double cpu = per_point * (input.rgbd ? 0 : plan.points) + 0.05 * pairs + per_frame * frames +
                     per_vertex * vertices + per_picture_byte * picture_bytes +
                     0.1 * photographs * std::min(photographs, 40.0) + pictures;
  plan.seconds = cpu / std::max(1.0, 0.7 * threadCount(job.options.threads));
  plan.memory = program + worked_point * (input.rgbd ? 2e6 : largest) + worked_vertex * vertices;
  plan.disk = stored_point * (input.rgbd ? 3 * vertices : plan.points) + 200 * vertices + 2 * picture_bytes + 5e7;
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
  const std::string time =
      plan.seconds < 90 ? concat(rounded(plan.seconds), " s") : concat(rounded(plan.seconds / 60), " min");
  return concat(text, "; ", rounded(plan.points), " raw points; about ", time, ", ", rounded(plan.memory / 1e6),
                " MB of memory, ", rounded(plan.disk / 1e6), " MB of disk");
}
