// SPDX-License-Identifier: BSD-3-Clause
#include "answer/odds.h"
#include "scan/lists.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/union_find.h>
namespace fresco::registration {
namespace {
// Of log-odds: constant, agree / (1 + agree), overlap^4, u = log(1 + 1000 times what contradicts beyond twice the usual); if joined,
// constant, u; then the largest claim that the examples allow. Printed by benchmark/experiments/odds_fit.py FLOOR..., see
// docs/measurements/registration_evidence.md#probability; not to be changed by hand.
constexpr double fitted[] = {-3.528, 7.09, -3.19, -1.061, 2.201, -3.712, 0.9901};

double logOdds(const CandidatePlace& place, bool joined, double usual_violation)
{
  const double unusual = std::max(0.0, place.contradict - 2.0 * usual_violation * place.agree);
  const double u = std::log1p(1000.0 * unusual);
  return fitted[0] + fitted[1] * place.agree / (1.0 + place.agree) + fitted[2] * std::pow(place.overlap, 4) +
         fitted[3] * u + (joined ? fitted[4] + fitted[5] * u : 0.0);
}
} // namespace

double largestClaim() { return fitted[6]; }

std::vector<double> oddsOf(const std::vector<CandidatePlace>& places, bool joined, double usual_violation)
{
  std::vector<double> odds;
  double sum = 1.0; // that none is right
  for (const CandidatePlace& place : places)
    sum += odds.emplace_back(std::exp(logOdds(place, joined, usual_violation)));
  for (double& value : odds)
    value = std::min(value / sum, largestClaim());
  return odds;
}

namespace {
bool isOfPart(const CandidatePlace& link, Index scan)
{
  return std::find(link.part.begin(), link.part.end(), scan) != link.part.end();
}

// Mean of accepted pairs: people, panes and errors of range contradict right places, too.
double usualViolation(const std::vector<PairResult>& pairs)
{
  double sum = 0.0, count = 0.0;
  for (const PairResult& pair : pairs)
    if (pair.accepted) {
      sum += pair.violation;
      count += 1.0;
    }
  return sum / std::max(count, 1.0);
}

// Accepted pairs that hold a group, of most overlap, without circles.
std::vector<PairResult> treeOf(const ScanCluster& group, std::vector<PairResult> pairs)
{
  removeIf(pairs, [&](const PairResult& pair) {
    return !pair.accepted || !contains(group, pair.a) || !contains(group, pair.b);
  });
  sortFalling(pairs, &PairResult::overlap);
  UnionFind held(group.scans.size());
  removeIf(pairs, [&](const PairResult& pair) {
    const Index a = held.root(positionOf(group, pair.a)), b = held.root(positionOf(group, pair.b));
    held.join(a, b);
    return a == b;
  });
  return pairs;
}

// Which scans are on the smaller one of the two sides that a pair of the tree holds together.
std::vector<bool> partOn(const PairResult& link, const ScanCluster& group, const std::vector<PairResult>& tree)
{
  UnionFind held(group.scans.size());
  for (const PairResult& pair : tree)
    if (&pair != &link)
      held.join(positionOf(group, pair.a), positionOf(group, pair.b));
  const Index with_a = held.root(positionOf(group, link.a));
  std::vector<bool> in_part;
  for (std::size_t k = 0; k < group.scans.size(); ++k)
    in_part.push_back(held.root(k) != with_a);
  if (2 * std::count(in_part.begin(), in_part.end(), true) > std::ptrdiff_t(in_part.size()))
    in_part.flip();
  return in_part;
}

// What free space says of all pairs of a group, each judged once: the links of a chain of n scans ask for n^3 / 6.
std::vector<std::vector<FreeSpaceEvidence>> evidenceOf(const ScanCluster& group, const FreeSpaceJudge& judge,
                                                       int threads)
{
  return mapTasks(group.scans.size(), threads, [&](Index k) {
    std::vector<FreeSpaceEvidence> row;
    for (Index i = 0; i < k; ++i)
      row.push_back(judge.judge(group.scans[i], group.scans[k], group.poses[i].inverse() * group.poses[k]));
    return row;
  });
}

CandidatePlace placeOf(const PairResult& link, const std::vector<bool>& in_part, const ScanCluster& group,
                       const std::vector<std::vector<FreeSpaceEvidence>>& pairs, double usual)
{
  FreeSpaceEvidence evidence;
  for (std::size_t i = 0; i < in_part.size(); ++i)
    for (std::size_t k = 0; k < in_part.size(); ++k)
      if (in_part[k] && !in_part[i])
        evidence += pairs[std::max(i, k)][std::min(i, k)];
  const bool turned = in_part[positionOf(group, link.a)];
  CandidatePlace place;
  place.scan = turned ? link.a : link.b;
  place.beside = turned ? link.b : link.a;
  place.T_beside_scan = turned ? link.T_a_b.inverse().eval() : link.T_a_b;
  place.overlap = link.overlap;
  place.violation = link.violation;
  place.agree = evidence.agree;
  place.contradict = evidence.clustered;
  place.contradicted = isContradicted(evidence);
  for (std::size_t k = 0; k < in_part.size(); ++k)
    if (in_part[k])
      place.part.push_back(group.scans[k]);
  const bool hinted = std::any_of(group.hinted.begin(), group.hinted.end(), [&](const HintedJoin& join) {
    return isOfPart(place, join.a) != isOfPart(place, join.b);
  });
  place.probability = oddsOf({place}, !hinted, usual)[0];
  return place;
}

std::vector<CandidatePlace> linksOf(const ScanCluster& group, const std::vector<PairResult>& pairs,
                                    const FreeSpaceJudge& judge, int threads, double usual)
{
  const std::vector<PairResult> tree = treeOf(group, pairs);
  const auto evidence = evidenceOf(group, judge, threads);
  std::vector<CandidatePlace> links;
  for (const PairResult& link : tree)
    links.push_back(placeOf(link, partOn(link, group, tree), group, evidence, usual));
  return links;
}

// Those of one group beside one other group exclude each other.
void describeCandidates(ScanRegistrationResult& result, double usual)
{
  const auto other = [&](const CandidatePlace& place) { return result.scans[place.beside].group; };
  for (CandidatePlace& place : result.candidates) {
    std::vector<CandidatePlace> rivals = {place};
    for (const CandidatePlace& rival : result.candidates)
      if (&rival != &place && rival.group == place.group && other(rival) == other(place))
        rivals.push_back(rival);
    place.probability = oddsOf(rivals, false, usual)[0];
  }
}
} // namespace

void describeOdds(const std::vector<ScanCluster>& groups, const FreeSpaceJudge& judge, int threads,
                  ScanRegistrationResult& result)
{
  const double usual = usualViolation(result.pairs);
  describeCandidates(result, usual);
  for (ScanResult& scan : result.scans)
    scan.probability = scan.group == 0 ? largestClaim() : 0.0;
  for (const CandidatePlace& place : result.candidates)
    if (result.scans[place.beside].group == 0)
      for (const Index i : groups[place.group].scans)
        result.scans[i].probability = std::max(result.scans[i].probability, place.probability);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (CandidatePlace& link : linksOf(groups[g], result.pairs, judge, threads, usual)) {
      link.group = g;
      for (const Index i : link.part)
        result.scans[i].probability = std::min(result.scans[i].probability, link.probability);
      result.links.push_back(link);
    }
}

namespace {
// Whether the joining steps brought a part where it is; then it becomes a cluster of its own.
bool cut(const CandidatePlace& link, std::vector<ScanCluster>& clusters)
{
  const Index at = clusterOf(clusters, link.scan);
  if (at != clusterOf(clusters, link.beside))
    return false;
  partCluster(clusters, at, link.part, {RefusalReason::unsure, link.beside, link.agree, link.contradict});
  return true;
}
} // namespace

bool loseUnsure(const ScanRegistrationResult& result, const ScanCluster& known, const ScanRegistrationOptions& options,
                std::vector<ScanCluster>& clusters)
{
  const double asked = std::min(options.confidence, largestClaim());
  bool lost = false;
  for (const CandidatePlace& link : result.links) {
    const bool started =
        std::any_of(known.scans.begin(), known.scans.end(), [&](Index scan) { return isOfPart(link, scan); });
    const bool said = std::any_of(options.hints.begin(), options.hints.end(), [&](const RegistrationHint& hint) {
      const bool with_b = hint.kind != HintKind::near && isOfPart(link, hint.b);
      return hint.kind != HintKind::apart && isOfPart(link, hint.a) != with_b;
    });
    if (link.group == 0 && link.probability < asked && !started && !said)
      lost = cut(link, clusters) || lost;
  }
  sortBySize(clusters, known.scans.empty() ? 0 : 1);
  return lost;
}
} // namespace fresco::registration
