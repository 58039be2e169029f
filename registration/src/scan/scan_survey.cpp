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

ScanSketch sketchOf(const ScanSource& scans, Index i, const ScanRegistrationOptions& options)
{
  ScanSketch sketch;
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

template <typename Archive>
void fields(Archive& archive, ScanSketch& sketch)
{
  archive(sketch.problem, sketch.size, sketch.narrowness, sketch.voxel, sketch.hash, sketch.look, sketch.has_points);
}

ScanSurvey surveyScans(const ScanSource& scans, Exchange& ranks, const ScanRegistrationOptions& options)
{
  ScanSurvey survey;
  survey.scans.resize(scans.count);
  for (Index i = 0; i < scans.count; ++i)
    if (isOwn(ranks, i))
      survey.scans[i] = sketchOf(scans, i, options);
  shareItems(ranks, survey.scans);
  Index counted = 0;
  for (const ScanSketch& sketch : survey.scans) {
    survey.narrowness += sketch.narrowness;
    counted += sketch.has_points ? 1 : 0;
  }
  survey.narrowness /= std::max<Index>(1, counted);
  return survey;
}

std::vector<Index> findDuplicates(const ScanSurvey& survey, const std::vector<Pose>& start)
{
  const Index n = survey.scans.size();
  const auto hash = [&](Index i) { return survey.scans[i].hash; };
  const auto started = [&](Index i) { return !start.empty() && start[i].has_value(); };
  std::vector<Index> duplicates(n, -1);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < n && !started(i); ++k)
      if (k != i && hash(i) != 0 && hash(k) == hash(i) && (k < i || started(k)) &&
          (duplicates[i] < 0 || (started(k) && !started(duplicates[i]))))
        duplicates[i] = k;
  return duplicates;
}

double commonSize(const ScanSurvey& survey, const ScanRegistrationOptions& options)
{
  constexpr double size_ratio = 100.0; // between scans of one job: above, one of them is in millimetres
  std::vector<double> known;
  for (const ScanSketch& scan : survey.scans)
    if (scan.size > 0.0)
      known.push_back(scan.size);
  if (known.empty())
    return 0.0;
  const double middle = rankedValue(known, (known.size() - 1) / 2);
  for (std::size_t i = 0; i < survey.scans.size(); ++i) {
    const double size = survey.scans[i].size;
    require(!(size > 0.0) || (size < size_ratio * middle && middle < size_ratio * size), scanName(options, i),
            ": reaches ", size, " from its viewpoint, the others ", middle, ": are they in the same unit?");
  }
  return middle;
}

float chooseVoxel(const ScanSurvey& survey, double size)
{
  std::vector<double> voxels;
  for (const ScanSketch& scan : survey.scans)
    if (scan.voxel > 0.0)
      voxels.push_back(std::max(scan.voxel, size / voxels_per_size));
  return median(voxels);
}
} // namespace fresco::registration
