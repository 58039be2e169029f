// SPDX-License-Identifier: BSD-3-Clause
#include "graph/viewpoint_check.h"
#include "graph/pair_evidence.h"
#include "scan/viewpoint_search.h"
#include <algorithm>
namespace fresco::registration {
namespace {
// What the pairs say of the free space of one scan.
struct ViewpointEvidence {
  double violations = 0.0; // sum over pairs of what the scan's free space says of the other
  Index pairs = 0;

  bool contradicts(double limit) const { return pairs >= fewest_pairs && violations > pairs * limit; }
};

std::vector<ViewpointEvidence> collectEvidence(Index scan_count, const std::vector<PairAlignment>& pairs)
{
  std::vector<ViewpointEvidence> evidence(scan_count);
  for (const PairAlignment& pair : pairs) {
    const VerifiedHypotheses& hypotheses = pair.rejected.empty() ? pair.hypotheses : pair.rejected;
    if (hypotheses.empty() || hypotheses[0].votes < many_votes)
      continue;
    evidence[pair.a].violations += hypotheses[0].check.violation_a;
    evidence[pair.b].violations += hypotheses[0].check.violation_b;
    ++evidence[pair.a].pairs;
    ++evidence[pair.b].pairs;
  }
  return evidence;
}

bool isNarrow(const PreparedScan& scan)
{
  return !scan.free_space.empty() && !sawAround(scan); // who saw more stood where it is said to have stood
}

// Whether it saw a place all around, and its frame's origin is taken for the scanner since nothing says so.
bool isAssumed(const PreparedScan& scan) { return scan.problem.empty() && !knowsViewpoint(scan) && sawAround(scan); }
} // namespace

ViewpointSign findViewpointSign(const PreparedScan& scan, int threads)
{
  constexpr double near = 0.25; // of the scan's size: right places are found to centimetres
  if (!isAssumed(scan))
    return ViewpointSign::none;
  const Points& points = scan.levels.back().points;
  if (isViewpoint(points, Eigen::Vector3f::Zero(), scan.size, threads))
    return ViewpointSign::center;
  const std::optional<Eigen::Vector3f> place = findViewpoint(points, scan.size, threads);
  if (!place)
    return ViewpointSign::none;
  return place->norm() < near * scan.size ? ViewpointSign::center : ViewpointSign::elsewhere;
}

void confirmViewpoints(std::vector<PreparedScan>& scans, const std::vector<ViewpointSign>& signs)
{
  const Index assumed = std::count_if(scans.begin(), scans.end(), isAssumed);
  const bool mostly = 2 * std::count(signs.begin(), signs.end(), ViewpointSign::center) > assumed;
  const Index n = scans.size();
  for (Index i = 0; i < n; ++i)
    if (isAssumed(scans[i]))
      scans[i].viewpoint_found = signs[i] == ViewpointSign::center || (mostly && signs[i] == ViewpointSign::none);
}

std::vector<char> wrongViewpoints(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                                  double max_violation)
{
  constexpr double narrow_share = 0.25; // of max_violation: mean violation from which a viewpoint is wrong, and
  constexpr double wide_share = 2.0;    // of a scanner of wide view, which must contradict nearly all it meets
  const Index n = scans.size();
  const std::vector<ViewpointEvidence> evidence = collectEvidence(n, pairs);
  std::vector<char> wrong(n, 0);
  Index known_wrong = 0;
  for (Index i = 0; i < n; ++i) {
    const bool without = scans[i].free_space.empty();
    const double share = isNarrow(scans[i]) ? narrow_share : wide_share;
    const bool sure = knowsViewpoint(scans[i]) && !isNarrow(scans[i]);
    wrong[i] = !without && !sure && evidence[i].contradicts(share * max_violation);
    known_wrong += wrong[i] || (scans[i].problem.empty() && without) ? 1 : 0;
  }
  // Where most are wrong, the rest comes from the same source.
  if (2 * known_wrong > n)
    for (Index i = 0; i < n; ++i)
      wrong[i] = wrong[i] || isNarrow(scans[i]);
  return wrong;
}
} // namespace fresco::registration
