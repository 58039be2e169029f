// SPDX-License-Identifier: BSD-3-Clause
#include "graph/moved_people.h"
#include "graph/free_space_evidence.h"
#include "scan/lists.h"
#include "scan/people.h"
#include <algorithm>
namespace fresco::registration {
namespace {
// Of the pairs, whether nothing contradicts their best pose.
std::vector<char> findFree(const std::vector<PreparedScan>& scans, const std::vector<const PairAlignment*>& pairs,
                           int threads)
{
  const FreeSpaceJudge judge(scans);
  return mapTasks(pairs.size(), threads, [&](Index k) {
    return !isContradicted(judge.judge(pairs[k]->a, pairs[k]->b, pairs[k]->hypotheses[0].T_a_b));
  });
}

void swapPeople(std::vector<PreparedScan>& scans, std::vector<std::vector<char>>& people)
{
  for (std::size_t k = 0; k < scans.size(); ++k)
    if (!scans[k].levels.empty())
      scans[k].levels[check_level].maybe_person.swap(people[k]);
}
} // namespace

void spareDoubtful(std::vector<PreparedScan>& scans, const PlanFrames& frames, int threads)
{
  forEachTask(frames.size(), threads, [&](Index k) {
    scans[k].spares_doubtful = true;
    if (frames[k])
      scans[k].levels[check_level].maybe_person = findPeople(scans[k], *frames[k]);
  });
}

void spareNothing(std::vector<PreparedScan>& scans)
{
  std::vector<std::vector<char>> people(scans.size());
  swapPeople(scans, people);
  for (PreparedScan& scan : scans)
    scan.spares_doubtful = false;
}

bool peopleMoved(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs, int threads)
{
  constexpr double least_overlap = 0.35; // less, and the pose is hardly ever right
  // Floors of 8 to 16 scans with people have 0.1 and more, as a rule 0.4; of 55 without them one has a pair in 32.
  constexpr double least_share = 0.1;
  std::vector<const PairAlignment*> overlapping;
  for (const PairAlignment& pair : pairs)
    if (!pair.hypotheses.empty() && pair.hypotheses[0].check.overlap >= least_overlap)
      overlapping.push_back(&pair);
  const std::vector<char> free = findFree(scans, overlapping, threads);
  std::vector<std::vector<char>> people(scans.size());
  swapPeople(scans, people);
  const std::vector<char> free_with_people = findFree(scans, overlapping, threads);
  swapPeople(scans, people);
  Index all = 0, by_people = 0;
  for (std::size_t k = 0; k < overlapping.size(); ++k) {
    all += free[k] != 0 ? 1 : 0;
    by_people += free[k] != 0 && free_with_people[k] == 0 ? 1 : 0;
  }
  return by_people >= fewest_pairs && by_people >= least_share * all;
}
} // namespace fresco::registration
