// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_survey.h"
#include "scan/thinning.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/io/byte_hash.h>
#include <fresco/io/packing.h>
namespace fresco::registration {
namespace {
template <typename Values>
std::uint64_t hashOf(const Values& values, std::uint64_t before = 0)
{
  return hashBytes(values.data(), values.size() * sizeof(*values.data()), before);
}

// Messages of readers begin with the name of the file.
std::string withoutName(const std::string& message, const std::string& name)
{
  return message.rfind(name + ": ", 0) == 0 ? message.substr(name.size() + 2) : message;
}

// What is known of one scan.
struct Sketch {
  std::string problem;
  double size = 0.0, narrowness = 0.0, voxel = 0.0;
  std::uint64_t hash = 0, look = 0;
  bool has_points = false;
};

template <typename Archive>
void fields(Archive& archive, Sketch& sketch)
{
  archive(sketch.problem, sketch.size, sketch.narrowness, sketch.voxel, sketch.hash, sketch.look, sketch.has_points);
}

Sketch sketchOf(const ScanSource& scans, Index i, const ScanRegistrationOptions& options)
{
  Sketch sketch;
  PointSet scan;
  try {
    scan = scans.read(i);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::runtime_error& error) {
    sketch.problem = "left out: " + withoutName(error.what(), scanName(options, i));
  }
  validatePointSet(scan);
  sketch.size = scanSize(scan);
  sketch.narrowness = narrowness(scan);
  sketch.has_points = scan.size() > 0;
  if (sketch.size > 0.0)
    sketch.voxel = fittingVoxel(scan, sketch.size / voxels_per_size);
  if (sketch.has_points)
    sketch.hash = hashOf(scan.origin.cast<float>().eval(), hashOf(scan.points));
  sketch.look = hashOf(scan.normals, hashOf(scan.colors, hashOf(scan.viewpoints))); // what else is looked at
  return sketch;
}
} // namespace

ScanSurvey surveyScans(const ScanSource& scans, Exchange& ranks, const ScanRegistrationOptions& options)
{
  std::vector<Sketch> sketches(scans.count);
  for (Index i = 0; i < scans.count; ++i)
    if (isOwn(ranks, i))
      sketches[i] = sketchOf(scans, i, options);
  shareItems(ranks, sketches);
  ScanSurvey survey;
  Index counted = 0;
  for (const Sketch& sketch : sketches) {
    survey.problems.push_back(sketch.problem);
    survey.sizes.push_back(sketch.size);
    survey.voxels.push_back(sketch.voxel);
    survey.hashes.push_back(sketch.hash);
    survey.looks.push_back(sketch.look);
    survey.narrowness += sketch.narrowness;
    counted += sketch.has_points ? 1 : 0;
  }
  survey.narrowness /= std::max<Index>(1, counted);
  return survey;
}

std::vector<Index> findDuplicates(const ScanSurvey& survey, const std::vector<Pose>& start)
{
  const Index n = survey.hashes.size();
  const auto started = [&](Index i) { return !start.empty() && start[i].has_value(); };
  std::vector<Index> duplicates(n, -1);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < n && !started(i); ++k)
      if (k != i && survey.hashes[i] != 0 && survey.hashes[k] == survey.hashes[i] && (k < i || started(k)) &&
          (duplicates[i] < 0 || (started(k) && !started(duplicates[i]))))
        duplicates[i] = k;
  return duplicates;
}

double commonSize(const std::vector<double>& sizes, const ScanRegistrationOptions& options)
{
  constexpr double size_ratio = 100.0; // between scans of one job: above, one of them is in millimetres
  std::vector<double> known;
  std::copy_if(sizes.begin(), sizes.end(), std::back_inserter(known), [](double size) { return size > 0.0; });
  if (known.empty())
    return 0.0;
  const double middle = rankedValue(known, (known.size() - 1) / 2);
  const Index n = sizes.size();
  for (Index i = 0; i < n; ++i)
    require(!(sizes[i] > 0.0) || (sizes[i] < size_ratio * middle && middle < size_ratio * sizes[i]),
            scanName(options, i), ": reaches ", sizes[i], " from its viewpoint, the others ", middle,
            ": are they in the same unit?");
  return middle;
}

float chooseVoxel(const ScanSurvey& survey, double size)
{
  std::vector<double> voxels;
  for (const double voxel : survey.voxels)
    if (voxel > 0.0)
      voxels.push_back(std::max(voxel, size / voxels_per_size));
  return median(voxels);
}
} // namespace fresco::registration
