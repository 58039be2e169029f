// SPDX-License-Identifier: BSD-3-Clause
#include "graph/pair_evidence.h"
#include <algorithm>
#include <fresco/core/statistics.h>
namespace fresco::registration {
bool isSound(const PairAlignment& pair, const VerifiedHypothesis& hypothesis)
{
  return &hypothesis == &pair.hypotheses.front() && hypothesis.check.overlap >= strong_overlap &&
         hypothesis.check.violation <= noise_violation;
}

double leastColor(const std::vector<PairAlignment>& pairs)
{
  constexpr double color_share = 0.5; // of what a quarter of the pairs has: lights and exposure change less
  std::vector<double> colors;
  for (const PairAlignment& pair : pairs)
    if (!pair.hypotheses.empty() && pair.hypotheses[0].check.color)
      colors.push_back(*pair.hypotheses[0].check.color);
  if (colors.empty())
    return -1.0;
  const double upper = rankedValue(colors, 3 * colors.size() / 4);
  return upper > good_color ? color_share * upper : -1.0;
}

double usualViolation(const std::vector<PairAlignment>& pairs)
{
  constexpr double violation_factor = 10.0; // of what the best quarter of the pairs has: another order of magnitude
  std::vector<double> violations;
  for (const PairAlignment& pair : pairs)
    if (!pair.hypotheses.empty() && !pair.ambiguous)
      violations.push_back(pair.hypotheses[0].check.violation);
  return violations.empty() ? 0.0 : violation_factor * rankedValue(violations, (violations.size() - 1) / 4);
}

double mostViolation(const std::vector<PairAlignment>& pairs, double limit)
{
  return std::min(limit, std::max(pane_violation, usualViolation(pairs)));
}

bool contradictsOneRoom(const PairCheck& check, double usual_violation)
{
  constexpr double one_room = 0.5;         // overlap
  constexpr double room_violation = 0.001; // a handful of points
  return check.overlap > one_room && check.violation > std::max(room_violation, usual_violation);
}
} // namespace fresco::registration
