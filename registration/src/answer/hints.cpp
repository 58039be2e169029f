// SPDX-License-Identifier: BSD-3-Clause
#include "answer/hints.h"
#include "answer/more_pairs.h"
#include "answer/places.h"
#include "graph/place_check.h"
#include "scan/lists.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <fresco/io/listed.h>
namespace fresco::registration {
namespace {
// Usable scans that follow each other.
std::vector<RankedPair> neighbours(const std::vector<PreparedScan>& scans)
{
  std::vector<RankedPair> pairs;
  Index last = -1;
  const Index n = scans.size();
  for (Index k = 0; k < n; ++k)
    if (scans[k].problem.empty()) {
      if (last >= 0)
        pairs.push_back({last, k});
      last = k;
    }
  return pairs;
}

class HintFollower {
public:
  HintFollower(const AlignmentInput& input, const ScanRegistrationOptions& options, GlobalAlignment& alignment,
               std::vector<std::string>& said)
      : scans_(input.scans), known_(input.known), options_(options), clusters_(alignment.graph.clusters),
        places_(input.scans, alignment.pairs, alignment.graph.places, options), judge_(input.scans), said_(said)
  {}

  void run();

private:
  void say(const RegistrationHint& hint, const std::string& what)
  {
    if (hint.kind != HintKind::order) // most scans that follow each other hang together
      said_.push_back(hint.source + ": " + what);
  }
  std::string name(Index scan) const { return scanName(options_, scan); }
  Index clusterOf(Index scan) const { return registration::clusterOf(clusters_, scan); }
  const Eigen::Isometry3d& poseOf(Index scan) const { return poseIn(clusters_[clusterOf(scan)], scan); }
  Eigen::Isometry3d relative(Index a, Index b) const { return poseOf(a).inverse() * poseOf(b); }
  void follow(const RegistrationHint& hint);
  void keepApart(const RegistrationHint& hint);
  void split(const RegistrationHint& hint, RefusalReason reason);
  void take(const RegistrationHint& hint);
  void take(const RegistrationHint& hint, Places places);
  void join(const RegistrationHint& hint, const Place& place);
  void goNear(const RegistrationHint& hint);
  void followOrder(const RegistrationHint& hint);

  const std::vector<PreparedScan>& scans_;
  const ScanCluster& known_;
  const ScanRegistrationOptions& options_;
  std::vector<ScanCluster>& clusters_;
  const PlaceFinder places_;
  const FreeSpaceJudge judge_;
  std::vector<std::string>& said_;
};

// Cuts the cluster of two scans where their parts hang together least: a tree of the strongest overlaps grows until only the
// one would be left that joins both.
void HintFollower::split(const RegistrationHint& hint, RefusalReason reason)
{
  struct Overlap {
    double share;
    Index i, k;
  };
  const Index at = clusterOf(hint.a);
  const ScanCluster cluster = clusters_[at];
  const Index n = cluster.scans.size();
  std::vector<Overlap> overlaps;
  for (Index i = 0; i < n; ++i)
    for (Index k = i + 1; k < n; ++k)
      overlaps.push_back({0.0, i, k});
  forEachTask(overlaps.size(), options_.threads, [&](Index o) {
    auto& [share, i, k] = overlaps[o];
    share = checkRoughly(scans_[cluster.scans[i]], scans_[cluster.scans[k]],
                         cluster.poses[i].inverse() * cluster.poses[k], check_level)
                .overlap;
  });
  sortFalling(overlaps, &Overlap::share);
  const Index a = positionOf(cluster, hint.a), b = positionOf(cluster, hint.b);
  UnionFind parts(n);
  for (const Overlap& overlap : overlaps) {
    const auto holds = [&](Index scan) {
      return parts.root(overlap.i) == parts.root(scan) || parts.root(overlap.k) == parts.root(scan);
    };
    if (!holds(a) || !holds(b))
      parts.join(overlap.i, overlap.k);
  }
  std::vector<Index> with_b;
  for (Index i = 0; i < n; ++i)
    if (parts.root(i) == parts.root(b))
      with_b.push_back(cluster.scans[i]);
  auto [moved, stays] = divide(cluster, with_b);
  const bool known_a = contains(known_, hint.a), known_b = contains(known_, hint.b);
  if (known_a != known_b ? known_b : moved.scans.size() > stays.scans.size())
    std::swap(moved, stays);
  moved.refusal = {reason, contains(moved, hint.a) ? hint.b : hint.a};
  for (const HintedJoin& held : cluster.hinted)
    for (ScanCluster* part : {&stays, &moved})
      if (contains(*part, held.a) && contains(*part, held.b))
        part->hinted.push_back(held);
  clusters_[at] = stays;
  clusters_.insert(clusters_.begin() + at + 1, moved);
}

void HintFollower::keepApart(const RegistrationHint& hint)
{
  if (clusterOf(hint.a) != clusterOf(hint.b) || !places_.see(hint.a, hint.b, relative(hint.a, hint.b))) {
    say(hint, "they are apart already");
    return;
  }
  const PairCheck check = checkPair(scans_[hint.a], scans_[hint.b], relative(hint.a, hint.b), check_level);
  split(hint, RefusalReason::apart);
  const Index moved =
      clusters_[clusterOf(hint.a)].refusal.reason == RefusalReason::apart ? clusterOf(hint.a) : clusterOf(hint.b);
  std::vector<std::string> names;
  for (const Index scan : clusters_[moved].scans)
    names.push_back(name(scan));
  say(hint, concat("taken apart, though they overlap by ", std::round(100.0 * check.overlap), " % and ",
                   std::round(1e4 * check.violation) / 100.0, " % contradicts: ", listed(names, 5),
                   names.size() > 1 ? " lose their places" : " loses its place"));
}

void HintFollower::join(const RegistrationHint& hint, const Place& place)
{
  const Index a = clusterOf(place.a), b = clusterOf(place.b);
  const Eigen::Isometry3d T_a_b = poseOf(place.a) * place.fit.T * poseOf(place.b).inverse(); // clusters
  if (const RegistrationHint* apart = places_.forbids(clusters_[a], clusters_[b], T_a_b)) {
    say(hint, "not followed: " + apart->source + " keeps them apart there");
    return;
  }
  ScanCluster &first = clusters_[std::min(a, b)], &second = clusters_[std::max(a, b)];
  first.hinted.push_back({place.a, place.b, hint.source, second.scans});
  first.hinted.insert(first.hinted.end(), second.hinted.begin(), second.hinted.end());
  append(first, second, a < b ? T_a_b : T_a_b.inverse());
  clusters_.erase(clusters_.begin() + std::max(a, b));
}

// Of places in the data the one that nothing rivals.
void HintFollower::take(const RegistrationHint& hint, Places places)
{
  const std::size_t tried = places.size();
  places_.judge(clusters_, judge_, places);
  removeIf(places, &Place::contradicted);
  if (places.empty()) {
    say(hint, concat("not followed: ",
                     tried == 0 ? "no place was found where they see each other"
                                : concat("free space contradicts the ", tried, " places found"),
                     "; `relative` gives one"));
    return;
  }
  if (places.size() > 1 && rivals(places[1].fit, places[0].fit, judge_.unit())) {
    std::string choices;
    for (std::size_t k = 0; k < 2; ++k)
      choices += (k > 0 ? ", or " : "") + places_.line(places[k]);
    say(hint, "not followed: two places are about as good: " + choices);
    return;
  }
  join(hint, places[0]);
}

// relative, choose, link
void HintFollower::take(const RegistrationHint& hint)
{
  Places places = places_.ofPair(hint.a, hint.b);
  if (hint.kind == HintKind::choose && hint.number > static_cast<Index>(places.size())) {
    say(hint, concat("not followed: the two have ", places.size(), " places"));
    return;
  }
  if (hint.kind == HintKind::relative)
    places = {places_.given(hint)};
  else if (hint.kind == HintKind::choose)
    places = {places[hint.number - 1]};
  if (clusterOf(hint.a) == clusterOf(hint.b)) {
    const Eigen::Isometry3d T = relative(hint.a, hint.b);
    const bool agrees = hint.kind == HintKind::link || hint.kind == HintKind::order
                            ? places_.see(hint.a, hint.b, T)
                            : poseDistance(T, places[0].fit.T, scans_[hint.b].size) <= options_.max_distance;
    if (agrees)
      return say(hint, "it is so already");
    if (hint.kind == HintKind::link || hint.kind == HintKind::order)
      return say(hint,
                 "not followed: they hang together where they do not see each other; `relative` or `choose` moves "
                 "one");
    split(hint, RefusalReason::claimed);
    say(hint, "they hung together otherwise, and are taken apart");
  }
  if (hint.kind == HintKind::link || hint.kind == HintKind::order)
    take(hint, places);
  else
    join(hint, places[0]);
}

void HintFollower::goNear(const RegistrationHint& hint)
{
  const auto isNear = [&](const Eigen::Isometry3d& T) { // of the working frame's origin, about where the scanner is
    Eigen::Vector3d off = T.translation() - hint.place;
    if (hint.any_height)
      off.z() = 0.0;
    return off.norm() <= hint.radius;
  };
  if (clusterOf(hint.a) == 0)
    return say(hint, isNear(poseOf(hint.a)) ? "it is so already" : "not followed: it is placed elsewhere");
  const ScanCluster& moving = clusters_[clusterOf(hint.a)];
  Places near;
  for (const Place& place : places_.ofClusters(clusters_[0], moving))
    if (isNear(poseOf(place.a) * place.fit.T * poseOf(place.b).inverse() * poseOf(hint.a)))
      near.push_back(place);
  take(hint, near);
}

void HintFollower::followOrder(const RegistrationHint& hint)
{
  const std::size_t before = clusters_.size();
  for (const RankedPair& pair : neighbours(scans_)) {
    RegistrationHint step = hint;
    step.a = pair.a;
    step.b = pair.b;
    take(step);
  }
  said_.push_back(concat(hint.source, ": ", before - clusters_.size(), " joins of scans that follow each other"));
}

void HintFollower::follow(const RegistrationHint& hint)
{
  for (const Index scan : {hint.a, hint.b})
    if (hint.kind != HintKind::order && !scans_[scan].problem.empty())
      return say(hint, "not followed: " + name(scan) + ": " + scans_[scan].problem);
  switch (hint.kind) {
  case HintKind::apart:
    return keepApart(hint);
  case HintKind::near:
    return goNear(hint);
  case HintKind::order:
    return followOrder(hint);
  default:
    return take(hint);
  }
}

void HintFollower::run()
{
  // What says most comes first.
  for (const HintKind kind :
       {HintKind::apart, HintKind::relative, HintKind::choose, HintKind::link, HintKind::near, HintKind::order})
    for (const RegistrationHint& hint : options_.hints)
      if (hint.kind == kind)
        follow(hint);
  sortBySize(clusters_, 1);
}

// Pairs of scans of two clusters that hints speak of and that have not been aligned.
std::vector<RankedPair> untriedPairs(const AlignmentInput& input, const std::vector<RegistrationHint>& hints,
                                     const GlobalAlignment& alignment)
{
  const std::vector<ClusterPlace> places = placesOf(alignment.graph.clusters, input.scans.size());
  std::vector<RankedPair> pairs;
  const auto ask = [&](Index a, Index b) {
    if (a > b)
      std::swap(a, b);
    const auto is_it = [&](const auto& pair) { return pair.a == a && pair.b == b; };
    const std::vector<PairAlignment>& tried = alignment.pairs;
    if (input.scans[a].problem.empty() && input.scans[b].problem.empty() && places[a].cluster != places[b].cluster &&
        std::none_of(tried.begin(), tried.end(), is_it) && std::none_of(pairs.begin(), pairs.end(), is_it))
      pairs.push_back({a, b});
  };
  for (const RegistrationHint& hint : hints)
    if (hint.kind == HintKind::link || hint.kind == HintKind::choose)
      ask(hint.a, hint.b);
    else if (hint.kind == HintKind::order)
      for (const RankedPair& pair : neighbours(input.scans))
        ask(pair.a, pair.b);
  return pairs;
}
} // namespace

void followHints(const AlignmentInput& input, const ScanRegistrationOptions& options, GlobalAlignment& alignment,
                 std::vector<std::string>& said)
{
  const std::vector<RankedPair> pairs = untriedPairs(input, options.hints, alignment);
  if (!pairs.empty())
    alignMore(input, options, pairs, alignment.pairs);
  HintFollower(input, options, alignment, said).run();
}
} // namespace fresco::registration
