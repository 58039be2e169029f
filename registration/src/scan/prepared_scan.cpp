// SPDX-License-Identifier: BSD-3-Clause
#include "scan/prepared_scan.h"
#include "scan/viewpoint_search.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/registration/core/surface_points.h>
namespace fresco::registration {
namespace {
// Neighbours of points are searched in `level`, which brings a search of the caller if there is one.
void fillLevel(const RawScan& raw, int threads, ScanLevel& level)
{
  RawScan thinned = thin(raw, level.voxel);
  level.points = std::move(thinned.points);
  if (!level.search)
    level.tree = std::make_shared<PointTree>(level.points, threads);
  level.viewpoints = std::move(thinned.viewpoints);
  level.colors = std::move(thinned.colors);
  level.prepareSearch();
  estimateNormals(level, threads);
  level.samples = normalSpaceOrder(level);
}

} // namespace

void ScanLevel::prepareSearch() const
{
  if (search)
    search->setPoints(points);
}

Neighbor ScanLevel::nearest(const Eigen::Vector3f& query, float max_distance) const
{
  if (!search && grid) {
    const Neighbor near = grid->nearest(query, std::min(max_distance, grid->reach()));
    if (near.index >= 0 || max_distance <= grid->reach())
      return near;
  }
  if (!search)
    return tree->nearest(query, max_distance);
  std::vector<Neighbor> found;
  search->nearest(query, 1, found);
  const bool near = !found.empty() && found[0].squared_distance < max_distance * max_distance;
  return near ? found[0] : Neighbor{-1, 0.f};
}

Index countUsable(const std::vector<PreparedScan>& scans)
{
  return std::count_if(scans.begin(), scans.end(), [](const PreparedScan& scan) { return scan.problem.empty(); });
}

void prepareManySearches(ScanLevel& level)
{
  const bool fits = level.points.cwiseAbs().maxCoeff() < NearestGrid::most_cells * level.voxel;
  if (fits && !level.search)
    level.grid = std::make_shared<NearestGrid>(*level.tree, final_distance * level.voxel, level.voxel);
}

void prepareManySearches(PreparedScan& scan)
{
  if (!scan.problem.empty())
    return;
  for (int k = 0; k <= check_level; ++k) { // in the finest one few are searched
    ScanLevel& level = scan.levels[k];
    prepareManySearches(level);
    if (level.blocks.empty())
      level.blocks = PointBlocks(level.points);
  }
  scan.free_space.prepareManyJudgements();
}

void distrustViewpoint(PreparedScan& scan, const std::string& reason)
{
  scan.viewpoint_problem = reason;
  scan.oriented = false;
  scan.free_space = {};
  scan.aliases.clear();
  const Eigen::Vector3f middle = scan.levels.front().points.rowwise().mean();
  for (ScanLevel& level : scan.levels)
    for (Index i = 0; i < level.points.cols(); ++i)
      if (level.normals.col(i).dot(middle - level.points.col(i)) < 0.f)
        level.normals.col(i) *= -1.f;
}

PreparedScan prepareScan(const PointSet& scan, const Thinning& thinning, int threads,
                         const std::shared_ptr<NeighborSearch>& search)
{
  // Of the free space: from a wrong viewpoint, one direction meets many surfaces.
  constexpr double coherence_limit = 0.7;
  constexpr double wide_view = 0.75; // of all directions, from the points' middle: a room, not a part of one
  PreparedScan prepared;
  const WorkingCenter center = workingCenter(scan);
  prepared.center = center.place;
  prepared.viewpoint_given = center.given;
  prepared.size = scanSize(scan);
  RawScan raw = finitePoints(scan, prepared.center);
  if (raw.points.cols() < fewest_points) {
    prepared.problem = concat("only ", raw.points.cols(), " finite points");
    return prepared;
  }
  const auto look = [&] {
    prepared.free_space = ScanFreeSpace(raw.points, raw.viewpoints, 3.f * thinning.voxels[0]);
    return prepared.free_space.coherence() > coherence_limit;
  };
  prepared.oriented = look() && (center.given || center.assumed);
  if (!prepared.oriented && !center.given) {
    if (const auto place = findViewpoint(raw.points, prepared.size, threads)) {
      prepared.center += place->cast<double>();
      prepared.viewpoint_found = true;
      raw.points.colwise() -= *place;
      prepared.oriented = look();
    } else {
      prepared.blind = prepared.free_space.coverage() > wide_view;
    }
  }
  for (const float voxel : thinning.voxels) {
    ScanLevel& level = prepared.levels.emplace_back();
    level.voxel = voxel;
    level.search = search;
    fillLevel(raw, threads, level);
    raw = {level.points, level.viewpoints, level.colors};
  }
  prepared.levels.front().around.resize(Eigen::NoChange, 0); // only coarser levels are compared with free space
  std::reverse(prepared.levels.begin(), prepared.levels.end());
  if (static_cast<Index>(prepared.levels.back().samples.size()) < fewest_points)
    prepared.problem = concat("only ", prepared.levels.back().samples.size(), " points lie on surfaces");
  if (!prepared.oriented)
    distrustViewpoint(prepared, center.given     ? "its viewpoint is wrong: surfaces lie behind each other"
                                : center.assumed ? "no viewpoint is given, and its frame's origin is none"
                                                 : "no viewpoint is given, and its frame's origin is far away");
  return prepared;
}
} // namespace fresco::registration
