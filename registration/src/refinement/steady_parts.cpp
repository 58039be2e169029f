// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/steady_parts.h"
#include "refinement/free_motion.h"
#include <algorithm>
namespace fresco::registration {
namespace {
// Scans with matches across a cut; those of its body may move.
struct CutScans {
  ScanPointers scans;
  IsometryVector poses;
  std::vector<char> fixed;
  std::vector<std::pair<Index, Index>> excluded;
};

CutScans scansAt(const LooseCut& cut, const ScanPointers& members, const IsometryVector& poses,
                 const std::vector<std::pair<Index, Index>>& excluded)
{
  CutScans across;
  std::vector<Index> at(members.size(), -1);
  for (const Index i : cut.linked) {
    at[i] = across.scans.size();
    across.scans.push_back(members[i]);
    across.poses.push_back(poses[i]);
    across.fixed.push_back(!std::binary_search(cut.body.begin(), cut.body.end(), i));
  }
  for (const auto& [a, b] : excluded)
    if (at[a] >= 0 && at[b] >= 0)
      across.excluded.emplace_back(at[a], at[b]);
  return across;
}
} // namespace

std::optional<FreeMotion> findUnsteadyMotion(const ScanPointers& members, const IsometryVector& poses,
                                             const LooseCut& cut, JointOptions options)
{
  constexpr double loose_share = 0.1; // of information: with more, whole walls hold
  constexpr Index fewer_samples = 1500;
  const std::optional<WeakestMotion> weakest = findWeakestMotion(cut.information);
  if (!weakest || weakest->share > loose_share)
    return {};
  const CutScans across = scansAt(cut, members, poses, options.excluded);
  const float voxel = across.scans[0]->levels.back().voxel;
  options.fixed = across.fixed;
  options.excluded = across.excluded;
  options.anchors.clear();
  options.max_distance = near_voxels * voxel;
  options.samples = std::min(options.samples, fewer_samples);
  options.first_level = check_level;
  options.covariances = options.cuts = false;
  options.threads = 1;
  const IsometryVector refined = refineJointly(across.scans, across.poses, options, {}).poses;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  Index moving = 0;
  for (std::size_t i = 0; i < refined.size(); ++i)
    if (!across.fixed[i]) {
      moved += refined[i].translation() - across.poses[i].translation();
      ++moving;
    }
  FreeMotion motion;
  motion.translation = moved.normalized();
  return moved.norm() > voxel * moving ? std::optional(motion) : std::nullopt;
}
} // namespace fresco::registration
