// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/placement.h"
#include "pair/pair_overlap.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::registration {
namespace {
JointOptions jointOptions(const ScanRegistrationOptions& options)
{
  JointOptions joint;
  joint.max_distance = options.max_distance;
  joint.min_overlap = 0.5 * options.min_overlap;
  joint.max_iterations = options.max_iterations;
  joint.threads = options.threads;
  return joint;
}

// Every pair of members that overlaps, checked at the refined poses.
std::vector<PairResult> checkPairs(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                                   const Placement& placement)
{
  const Index n = placement.members.size();
  std::vector<PairResult> all(n * n);
  parallelFor(
      n * n, options.threads,
      [&](Index k) {
        const Index a = k / n, b = k % n;
        if (a >= b)
          return;
        PairResult& pair = all[k];
        pair.a = placement.members[a];
        pair.b = placement.members[b];
        const PreparedScan &first = scans[pair.a], &second = scans[pair.b];
        const PairCheck check =
            checkPair(first, second, placement.poses[a].inverse() * placement.poses[b], check_level);
        pair.overlap = check.overlap;
        pair.violation = check.violation;
      },
      1);
  for (const JointPair& joint : placement.joint.pairs) {
    const Index a = std::min(joint.source, joint.target), b = std::max(joint.source, joint.target);
    PairResult& pair = all[a * n + b];
    pair.rms += joint.matches * joint.rms * joint.rms;
    pair.matches += joint.matches;
  }
  std::vector<PairResult> kept;
  for (PairResult& pair : all) {
    if (pair.a == pair.b || (pair.overlap < 0.5 * options.min_overlap && pair.violation <= options.max_violation))
      continue;
    pair.rms = std::sqrt(pair.rms / std::max<Index>(1, pair.matches));
    pair.accepted = pair.overlap >= options.min_overlap && pair.violation <= options.max_violation && pair.matches > 0;
    kept.push_back(pair);
  }
  return kept;
}

Index memberOf(const Placement& placement, Index scan)
{
  return std::find(placement.members.begin(), placement.members.end(), scan) - placement.members.begin();
}
} // namespace

void refinePlacement(const std::vector<PreparedScan>& scans, const ScanRegistrationOptions& options,
                     Placement& placement, const Progress& progress)
{
  constexpr int most_rounds = 4; // of leaving out contradicting pairs: bounds the time
  ScanPointers members;
  for (const Index i : placement.members)
    members.push_back(&scans[i]);
  JointOptions joint = jointOptions(options);
  joint.anchors = placement.anchors;
  const IsometryVector start = placement.poses;
  for (int round = 0; round < most_rounds; ++round) {
    placement.joint = refineJointly(members, start, joint, progress);
    placement.poses = placement.joint.poses;
    placement.pairs = checkPairs(scans, options, placement);
    const std::size_t before = joint.excluded.size();
    for (const PairResult& pair : placement.pairs)
      if (pair.matches > 0 && pair.violation > options.max_violation)
        joint.excluded.emplace_back(memberOf(placement, pair.a), memberOf(placement, pair.b));
    if (joint.excluded.size() == before)
      return;
  }
}
} // namespace fresco::registration
