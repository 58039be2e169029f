// SPDX-License-Identifier: BSD-3-Clause
#include "evidence/patch_votes.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
// What the surface says that was measured where a patch is: nothing where none was.
PatchVote compare(const PreparedScan& seer, const Eigen::Vector3f& point, const Eigen::Vector3f& normal)
{
  constexpr float reach = 2.f;         // voxels of the coarser level: also where few rays went
  constexpr float thickness = 1.5f;    // voxels
  constexpr float least_cosine = 0.8f; // 37 degrees: normals of one surface at edges of cells
  const ScanLevel& level = seer.levels[check_level - 1];
  const Neighbor hit = level.nearest(point, reach * level.voxel);
  if (hit.index < 0 || level.normals.col(hit.index).isZero())
    return 0;
  const Eigen::Vector3f own = level.normals.col(hit.index);
  const float cosine = seer.oriented ? own.dot(normal) : std::abs(own.dot(normal));
  const float off = std::min(std::abs(own.dot(point - level.points.col(hit.index))),
                             std::abs(normal.dot(point - level.points.col(hit.index))));
  const bool same = cosine > least_cosine && off < thickness * seer.levels[check_level].voxel;
  return same ? confirmed_vote | compared_vote : compared_vote;
}
} // namespace

PatchVotes votesOf(const PreparedScan& seer, const ScanPatches& seen, const Eigen::Isometry3d& T_seer_seen)
{
  using Verdict = ScanFreeSpace::Verdict;
  const float voxel = seer.levels[check_level].voxel;
  const Eigen::Isometry3f T = T_seer_seen.cast<float>();
  std::vector<Verdict> verdicts(seen.size(), Verdict::agrees);
  if (!seer.free_space.empty())
    verdicts = seer.free_space.judge({seen.points, &seen.normals}, T, {1.5f * voxel, 0.02f, seer.spares_doubtful});
  PatchVotes votes(seen.size(), 0);
  for (Index i = 0; i < seen.size(); ++i) {
    if (verdicts[i] == Verdict::unknown)
      continue;
    votes[i] = compare(seer, T * seen.points.col(i), T.linear() * seen.normals.col(i));
    if (verdicts[i] == Verdict::violates && (votes[i] & confirmed_vote) == 0)
      votes[i] = contradicted_vote;
  }
  return votes;
}

std::vector<Index> contradictedGroups(const ScanPatches& patches, const PatchVotes& votes)
{
  const auto isContradicted = [&](Index i) { return (votes[i] & contradicted_vote) != 0; };
  std::vector<Index> sizes, open;
  std::vector<char> reached(patches.size(), 0);
  for (Index first = 0; first < patches.size(); ++first) {
    if (reached[first] != 0 || !isContradicted(first))
      continue;
    open.assign(1, first);
    reached[first] = 1;
    sizes.push_back(0);
    while (!open.empty()) {
      const Index i = open.back();
      open.pop_back();
      ++sizes.back();
      for (const std::int32_t next : patches.around.col(i))
        if (next >= 0 && reached[next] == 0 && isContradicted(next)) {
          reached[next] = 1;
          open.push_back(next);
        }
    }
  }
  return sizes;
}
} // namespace fresco::registration
