// SPDX-License-Identifier: BSD-3-Clause
#include "answer/odds.h"
#include "scan/lists.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/core/union_find.h>
namespace fresco::registration {
namespace {
// Of log-odds: constant, if joined, agree / (1 + agree), log(1 + contradict / u), log(1 + violation / u), overlap^4, u = 0.001 + what
// is usual; then the largest claim that the examples allow. Printed by benchmark/experiments/odds_fit.py FLOOR..., see
// docs/measurements/registration_evidence.md#probability; not to be changed by hand.
constexpr double fitted[] = {-3.382, 2.416, 7.753, -2.352, -0.8561, -3.834, 0.9915};

double logOdds(const CandidatePlace& place, bool joined, double usual_violation)
{
  const double unit = 0.001 + usual_violation;
  return fitted[0] + (joined ? fitted[1] : 0.0) + fitted[2] * place.agree / (1.0 + place.agree) +
         fitted[3] * std::log1p(place.contradict / unit) + fitted[4] * std::log1p(place.violation / unit) +
         fitted[5] * std::pow(place.overlap, 4);
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
// Median of accepted pairs: people, panes and errors of range contradict right places, too.
double medianViolation(const std::vector<PairResult>& pairs)
{
  std::vector<double> found;
  for (const PairResult& pair : pairs)
    if (pair.accepted)
      found.push_back(pair.violation);
  return found.empty() ? 0.0 : median(found);
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

// The smaller one of what a pair of the tree holds together.
ScanCluster partOn(const PairResult& link, const ScanCluster& group, const std::vector<PairResult>& tree)
{
  UnionFind held(group.scans.size());
  for (const PairResult& pair : tree)
    if (&pair != &link)
      held.join(positionOf(group, pair.a), positionOf(group, pair.b));
  ScanCluster sides[2];
  for (const bool second : {false, true})
    for (std::size_t k = 0; k < group.scans.size(); ++k)
      if (held.root(k) == held.root(positionOf(group, second ? link.b : link.a)))
        append(sides[second], {{group.scans[k]}, {group.poses[k]}}, Eigen::Isometry3d::Identity());
  return sides[sides[1].scans.size() <= sides[0].scans.size()];
}

CandidatePlace placeOf(const PairResult& link, const ScanCluster& part, const ScanCluster& group,
                       const FreeSpaceJudge& judge, double usual)
{
  const FreeSpaceEvidence evidence = judge.judge(divide(group, part.scans).second, part, Eigen::Isometry3d::Identity());
  CandidatePlace place;
  const bool turned = contains(part, link.a);
  place.scan = turned ? link.a : link.b;
  place.beside = turned ? link.b : link.a;
  place.T_beside_scan = turned ? link.T_a_b.inverse().eval() : link.T_a_b;
  place.overlap = link.overlap;
  place.violation = link.violation;
  place.agree = evidence.agree;
  place.contradict = evidence.clustered;
  place.contradicted = isContradicted(evidence);
  place.part = part.scans;
  const bool hinted = std::any_of(group.hinted.begin(), group.hinted.end(), [&](const HintedJoin& join) {
    return contains(part, join.a) != contains(part, join.b);
  });
  place.probability = oddsOf({place}, !hinted, usual)[0];
  return place;
}

std::vector<CandidatePlace> linksOf(const ScanCluster& group, const std::vector<PairResult>& pairs,
                                    const FreeSpaceJudge& judge, int threads, double usual)
{
  const std::vector<PairResult> tree = treeOf(group, pairs);
  return mapTasks(tree.size(), threads,
                  [&](Index k) { return placeOf(tree[k], partOn(tree[k], group, tree), group, judge, usual); });
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
  const double usual = medianViolation(result.pairs);
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
  auto [part, rest] = divide(clusters[at], link.part);
  part.refusal = {RefusalReason::unsure, link.beside, link.agree, link.contradict};
  rest.refusal = clusters[at].refusal;
  clusters[at] = rest;
  clusters.push_back(part);
  return true;
}

RegistrationHint hintOf(const CandidatePlace& place)
{
  RegistrationHint hint;
  hint.kind = place.number > 0 ? HintKind::choose : HintKind::relative;
  hint.a = place.beside;
  hint.b = place.scan;
  hint.number = place.number;
  hint.T_a_b = place.T_beside_scan;
  hint.source = concat("probability ", std::round(1000.0 * place.probability) / 1000.0);
  return hint;
}
} // namespace

bool OddsFollower::lose(const std::vector<CandidatePlace>& links, std::vector<ScanCluster>& clusters)
{
  bool lost = false;
  for (const CandidatePlace& link : links) {
    const auto in = [&](Index scan) { return std::find(link.part.begin(), link.part.end(), scan) != link.part.end(); };
    if (link.group > 0 || link.probability >= asked_ || std::any_of(known_.scans.begin(), known_.scans.end(), in))
      continue;
    const auto own = options_.hints.begin() + given_;
    const auto holding =
        std::find_if(own, options_.hints.end(), [&](const auto& hint) { return in(hint.a) != in(hint.b); });
    if (holding != options_.hints.end()) { // it looked better before all scans were refined
      options_.hints.erase(holding);
      lost = true;
    } else {
      lost = cut(link, clusters) || lost;
    }
  }
  sortBySize(clusters, known_.scans.empty() ? 0 : 1);
  return lost;
}

bool OddsFollower::gain(const std::vector<CandidatePlace>& places)
{
  const CandidatePlace* best = nullptr;
  for (const CandidatePlace& place : places)
    if (!place.contradicted && (best ? place.probability > best->probability : place.probability >= asked_) &&
        tried_.count({place.beside, place.scan, place.number}) == 0)
      best = &place;
  if (best == nullptr)
    return false;
  tried_.insert({best->beside, best->scan, best->number});
  options_.hints.push_back(hintOf(*best));
  return true;
}

bool OddsFollower::follow(const ScanRegistrationResult& result, std::vector<ScanCluster>& clusters)
{
  return lose(result.links, clusters) || gain(result.candidates);
}
} // namespace fresco::registration
