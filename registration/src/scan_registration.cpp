// SPDX-License-Identifier: BSD-3-Clause
#include "answer/hints.h"
#include "answer/more_pairs.h"
#include "answer/odds.h"
#include "answer/pair_memory.h"
#include "global_alignment.h"
#include "graph/equal_rooms.h"
#include "graph/scan_exchange.h"
#include "registration_result.h"
#include "scan/scan_survey.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/registration/core/scan_registration.h>
#include <numeric>
namespace fresco {
using namespace registration;
namespace {
void validate(const ScanSource& scans, const std::vector<Pose>& start, const ScanRegistrationOptions& options)
{
  require(scans.count > 0, "registration: no scans");
  const Index count = scans.count, starts = start.size(), names = options.names.size();
  require(start.empty() || starts == count, "registration: ", count, " scans, ", starts, " start poses");
  require(options.voxel >= 0.f && std::isfinite(options.voxel), "registration: voxel ", options.voxel,
          " is negative or NaN");
  require(options.max_distance >= 0.f && std::isfinite(options.max_distance), "registration: max_distance ",
          options.max_distance, " is negative or NaN");
  require(options.min_overlap > 0.f && options.min_overlap <= 1.f, "registration: min_overlap ", options.min_overlap,
          " is not in 0..1");
  require(options.max_violation >= 0.f && options.max_violation <= 1.f, "registration: max_violation ",
          options.max_violation, " is not in 0..1");
  require(options.confidence == 0.0 || (options.confidence >= 0.5 && options.confidence < 1.0),
          "registration: confidence ", options.confidence, " is not 0 and not in 0.5..1");
  require(options.max_iterations >= 1, "registration: max_iterations ", options.max_iterations, " is below 1");
  require(options.names.empty() || names == count, "registration: ", count, " scans, ", names, " names");
  const bool any_start = std::any_of(start.begin(), start.end(), [](const Pose& pose) { return pose.has_value(); });
  require(!options.fixed || any_start, "registration: no scan has a start pose that could be fixed");
  for (const Pose& pose : start)
    require(!pose || pose->allFinite(), "registration: a start pose is not finite");
}

Eigen::Isometry3d workingToScan(const PreparedScan& scan)
{
  return Eigen::Isometry3d(Eigen::Translation3d(scan.center));
}

struct ScanSet {
  const ScanSource& scans;
  const ScanSurvey& survey;
  Exchange& ranks;
};

// All but those that cannot be read and duplicates.
std::vector<PreparedScan> prepareAll(const ScanSet& set, const ScanRegistrationOptions& options,
                                     const Thinning& thinning, const Progress& progress)
{
  const auto& [scans, survey, ranks] = set;
  std::vector<PreparedScan> prepared(scans.count);
  for (Index i = 0; i < scans.count; ++i) {
    report(progress, "prepare", 1.0 * i / scans.count);
    prepared[i].problem = survey.scans[i].problem;
    prepared[i].duplicate_of = survey.duplicates[i];
    if (survey.duplicates[i] >= 0)
      prepared[i].problem = "the same points as " + scanName(options, survey.duplicates[i]);
    if (prepared[i].problem.empty() && isOwn(ranks, i))
      prepared[i] = prepareScan(scans.read(i), thinning, options.threads);
  }
  shareScans(ranks, prepared, options.threads);
  return prepared;
}

ScanCluster startCluster(const std::vector<PreparedScan>& scans, const std::vector<Pose>& start)
{
  ScanCluster cluster;
  const Index n = start.size();
  for (Index i = 0; i < n; ++i)
    if (scans[i].problem.empty() && start[i]) {
      Eigen::Isometry3d pose(*start[i]);
      pose.linear() = normalized(pose.linear());
      cluster.scans.push_back(i);
      cluster.poses.push_back(pose * workingToScan(scans[i]));
    }
  return cluster;
}

// Start poses where all scans have one, else what global alignment finds.
GlobalAlignment searchClusters(const AlignmentInput& input, const ScanRegistrationOptions& options,
                               const Progress& progress)
{
  const Index usable = countUsable(input.scans);
  const Index started = input.known.scans.size();
  if (started < usable)
    return alignGlobally(input, options, progress);
  GlobalAlignment alignment;
  if (usable > 0)
    alignment.graph.clusters.push_back(input.known);
  return alignment;
}

// The same, or what an earlier registration found.
GlobalAlignment findClusters(const AlignmentInput& input, const ScanRegistrationOptions& options,
                             const std::string& key, PairMemory* memory, const Progress& progress)
{
  if (memory == nullptr)
    return searchClusters(input, options, progress);
  if (const auto earlier = unpackAlignment(memory->bytes, key)) {
    memory->used = true;
    restoreScans(input, *earlier, options.threads);
    return *earlier;
  }
  GlobalAlignment alignment = searchClusters(input, options, progress);
  *memory = {packAlignment(alignment, key), false};
  return alignment;
}

// Brings the first cluster into the frame of its first scan, which stays that of the world whatever hints add.
// @return that scan
Index fixWorld(const std::vector<PreparedScan>& scans, ScanCluster& cluster)
{
  const auto first = std::min_element(cluster.scans.begin(), cluster.scans.end());
  const Eigen::Isometry3d T_world_cluster =
      workingToScan(scans[*first]) * cluster.poses[first - cluster.scans.begin()].inverse();
  for (Eigen::Isometry3d& pose : cluster.poses)
    pose = T_world_cluster * pose;
  return *first;
}

// Members in rising order; without start poses, the frame of the first scan becomes that of the cluster.
// @param world_scan see fixWorld(); -1 = none
Placement toPlacement(const ScanCluster& cluster, const RegistrationState& state, Index world_scan)
{
  const auto hasStart = [&](Index i) { return !state.start.empty() && state.start[i].has_value(); };
  const bool started = std::any_of(cluster.scans.begin(), cluster.scans.end(), hasStart);
  std::vector<std::size_t> order(cluster.scans.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t x, std::size_t y) { return cluster.scans[x] < cluster.scans[y]; });
  const Index first = cluster.scans[order[0]];
  const Eigen::Isometry3d T_first_frame = workingToScan(state.scans[first]) * cluster.poses[order[0]].inverse();
  Placement placement;
  placement.refusal = cluster.refusal;
  placement.hinted = cluster.hinted;
  for (const std::size_t k : order) {
    if (hasStart(cluster.scans[k]))
      placement.anchors.push_back(placement.members.size());
    if (state.options.fixed && started)
      placement.fixed.push_back(hasStart(cluster.scans[k]));
    if (cluster.scans[k] == world_scan)
      placement.holder = placement.members.size();
    placement.members.push_back(cluster.scans[k]);
    placement.poses.push_back(started || world_scan >= 0 ? cluster.poses[k] : T_first_frame * cluster.poses[k]);
  }
  return placement;
}

// What comes of clusters and hints.
ScanRegistrationResult refineAll(const AlignmentInput& input, const std::vector<Pose>& start,
                                 const ScanRegistrationOptions& options, GlobalAlignment alignment,
                                 const Progress& progress)
{
  Index world_scan = -1;
  std::vector<std::string> said;
  std::vector<ScanCluster>& clusters = alignment.graph.clusters;
  if (!options.hints.empty() && !clusters.empty()) {
    if (input.known.scans.empty())
      world_scan = fixWorld(input.scans, clusters[0]);
    followHints(input, options, alignment, said);
  }
  RegistrationState state{input.scans, start, options, {}, std::move(alignment.pairs), alignment.graph.places, said};
  const double step = 1.0 / clusters.size();
  for (const ScanCluster& cluster : clusters) {
    const double done = state.placements.size() * step;
    state.placements.push_back(toPlacement(cluster, state, state.placements.empty() ? world_scan : -1));
    refinePlacement(input.scans, options, state.placements.back(), subProgress(progress, done, done + step));
  }
  return describeRegistration(state);
}

ScanRegistrationResult findPoses(const ScanSource& scans, const std::vector<Pose>& start,
                                 const ScanRegistrationOptions& given, const Progress& progress)
{
  Exchange alone;
  Exchange& ranks = scans.ranks ? *scans.ranks : alone;
  ScanSurvey survey = surveyScans(scans, ranks, given);
  survey.duplicates = findDuplicates(survey, start);
  const double size = commonSize(survey, given);
  ScanRegistrationOptions options = given;
  if (!(options.voxel > 0.f))
    options.voxel = size > 0.0 ? chooseVoxel(survey, size) : 1.f;
  if (!(options.max_distance > 0.f))
    options.max_distance = reach_voxels * options.voxel;
  const Thinning thinning(options.voxel, size, survey.narrowness);
  std::vector<PreparedScan> prepared =
      prepareAll({scans, survey, ranks}, options, thinning, subProgress(progress, 0.0, 0.3));

  const ScanCluster known = startCluster(prepared, start);
  const AlignmentInput input{prepared, known, ranks};
  GlobalAlignment alignment =
      findClusters(input, options, memoryKey(survey, start, options), scans.memory, subProgress(progress, 0.3, 0.6));
  partEqualRooms({prepared, alignment.pairs, graphOptions(options)}, known, alignment.graph.clusters);
  const Progress refining = subProgress(progress, 0.6, 1.0);
  for (;;) {
    ScanRegistrationResult result = refineAll(input, start, options, alignment, refining);
    if (!loseUnsure(result, known, options, alignment.graph.clusters))
      return result;
  }
}
} // namespace

std::string scanName(const ScanRegistrationOptions& options, Index scan)
{
  return options.names.empty() ? concat("scan ", scan) : options.names[scan];
}

ScanRegistrationResult registerScans(const std::vector<PointSet>& scans, const std::vector<Pose>& start,
                                     const ScanRegistrationOptions& options, const Progress& progress)
{
  return registerScans(ScanSource(scans.size(), [&](Index i) { return scans[i]; }), start, options, progress);
}

ScanRegistrationResult registerScans(const ScanSource& scans, const std::vector<Pose>& start,
                                     const ScanRegistrationOptions& options, const Progress& progress)
{
  validate(scans, start, options);
  ScanRegistrationResult result = findPoses(scans, start, options, progress);
  returnFreedMemory(); // of many prepared scans, before callers merge them all
  return result;
}
} // namespace fresco
