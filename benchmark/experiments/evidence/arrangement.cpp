// SPDX-License-Identifier: BSD-3-Clause
#include "evidence/arrangement.h"
#include <algorithm>
#include <fresco/registration/core/pose_graph.h>
#include <fresco/registration/core/sc2_pcr.h>
#include <numeric>
namespace fresco::registration {
namespace {
// Proposed places that two scans alone do not rule out.
ProposedPlaces withHope(FrameJudge& judge, const ProposedPlaces& places, double hopeless)
{
  std::vector<ScanCluster> pairs;
  for (const ProposedPlace& place : places)
    pairs.push_back(frameOf(place));
  const std::vector<double> odds = judge.logOdds(pairs);
  ProposedPlaces kept;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (odds[k] > hopeless)
      kept.push_back(places[k]);
  return kept;
}

/// A part of an arrangement, taken out, at another place.
struct Move {
  std::size_t frame = 0; ///< that it joins
  Eigen::Isometry3d T_frame_part = Eigen::Isometry3d::Identity();
};
using Moves = std::vector<Move, Eigen::aligned_allocator<Move>>;

class Search {
public:
  Search(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options)
      : judge_(judge), options_(options), places_(withHope(judge, places, options.hopeless))
  {}

  Arrangement joinAll();
  void exchange(Arrangement& arrangement);
  std::vector<std::vector<Index>> partsOf(const ScanCluster& frame);
  double bestOther(const Arrangement& arrangement, std::size_t frame, const std::vector<Index>& part,
                   Arrangement* best);

private:
  std::vector<Arrangement> successors(const std::vector<Arrangement>& beam);
  Moves movesTo(const std::vector<ScanCluster>& frames, const ScanCluster& part) const;
  bool isKnown(const Moves& moves, const Move& move, double size) const;
  void settle(ScanCluster& frame) const;
  double sizeOf(const ScanCluster& frame) const { return judge_.scans()[frame.scans[0]].size; }

  FrameJudge& judge_;
  const SearchOptions& options_;
  const ProposedPlaces places_;
};

bool Search::isKnown(const Moves& moves, const Move& move, double size) const
{
  return std::any_of(moves.begin(), moves.end(), [&](const Move& other) {
    return other.frame == move.frame && poseDistance(other.T_frame_part, move.T_frame_part, size) < options_.tolerance;
  });
}

// All places that are proposed for scans of a part in the frames, distinct.
Moves Search::movesTo(const std::vector<ScanCluster>& frames, const ScanCluster& part) const
{
  const std::vector<ClusterPlace> where = placesOf(frames, judge_.scans().size());
  std::vector<Index> position(judge_.scans().size(), -1);
  for (std::size_t k = 0; k < part.scans.size(); ++k)
    position[part.scans[k]] = k;
  Moves moves;
  for (const ProposedPlace& place : places_) {
    const bool a_moves = position[place.a] >= 0;
    if (a_moves == (position[place.b] >= 0))
      continue;
    const Index still = a_moves ? place.b : place.a, moved = a_moves ? place.a : place.b;
    const Eigen::Isometry3d T_still_moved = a_moves ? place.T_a_b.inverse() : place.T_a_b;
    const ClusterPlace& at = where[still];
    const ScanCluster& frame = frames[at.cluster];
    if (frame.scans.empty() || frame.scans[at.position] != still)
      continue;
    const Move move{static_cast<std::size_t>(at.cluster),
                    frame.poses[at.position] * T_still_moved * part.poses[position[moved]].inverse()};
    if (!isKnown(moves, move, sizeOf(part)))
      moves.push_back(move);
  }
  return moves;
}

// Lets all places count that are proposed near the poses of a frame.
void Search::settle(ScanCluster& frame) const
{
  constexpr double reach = 6.0; // tolerances between a place and the poses of the frame: beyond, it is another place
  PoseGraphOptions options;
  options.size = sizeOf(frame);
  options.tolerance = options_.tolerance;
  options.fixed.assign(frame.scans.size(), 0);
  options.fixed[0] = 1;
  std::vector<Index> position(judge_.scans().size(), -1);
  for (std::size_t k = 0; k < frame.scans.size(); ++k)
    position[frame.scans[k]] = k;
  PoseEdges edges;
  for (const ProposedPlace& place : places_) {
    const Index a = position[place.a], b = position[place.b];
    if (a >= 0 && b >= 0 &&
        poseDistance(frame.poses[a].inverse() * frame.poses[b], place.T_a_b, options.size) < reach * options.tolerance)
      edges.push_back({a, b, place.T_a_b});
  }
  frame.poses = optimizePoseGraph(frame.poses, edges, options);
}

// The best joins of each arrangement, distinct, the best first.
std::vector<Arrangement> Search::successors(const std::vector<Arrangement>& beam)
{
  struct Join {
    std::size_t from, frame, part;
    ScanCluster joined;
    double log_odds = 0.0;
  };
  std::vector<Join> joins;
  std::vector<ScanCluster> joined;
  for (std::size_t from = 0; from < beam.size(); ++from)
    for (std::size_t part = 1; part < beam[from].frames.size(); ++part) {
      const std::vector<ScanCluster>& frames = beam[from].frames;
      for (const Move& move : movesTo({frames.begin(), frames.begin() + part}, frames[part])) {
        joins.push_back({from, move.frame, part, frames[move.frame]});
        append(joins.back().joined, frames[part], move.T_frame_part);
        joined.push_back(joins.back().joined);
      }
    }
  const std::vector<double> odds = judge_.logOdds(joined);
  for (std::size_t k = 0; k < joins.size(); ++k) {
    const Arrangement& from = beam[joins[k].from];
    joins[k].log_odds = from.log_odds + odds[k] - judge_.logOdds(from.frames[joins[k].frame]) -
                        judge_.logOdds(from.frames[joins[k].part]);
  }
  std::stable_sort(joins.begin(), joins.end(), [](const Join& x, const Join& y) { return x.log_odds > y.log_odds; });
  std::vector<Arrangement> next;
  std::vector<double> from_odds;
  for (const Join& join : joins) {
    const Arrangement& from = beam[join.from];
    if (next.size() >= options_.beam || join.log_odds <= from.log_odds)
      break;
    // The same scans in as many frames with the same odds: the same joins in another order.
    const auto same = [&](double odds_of_other) { return std::abs(odds_of_other - join.log_odds) < 1e-3; };
    if (std::any_of(from_odds.begin(), from_odds.end(), same))
      continue;
    from_odds.push_back(join.log_odds);
    Arrangement arrangement = from;
    ScanCluster settled = join.joined;
    settle(settled);
    const bool better = judge_.logOdds(settled) > judge_.logOdds(join.joined);
    arrangement.log_odds = join.log_odds;
    if (better)
      arrangement.log_odds += judge_.logOdds(settled) - judge_.logOdds(join.joined);
    arrangement.frames[join.frame] = better ? settled : join.joined;
    arrangement.frames.erase(arrangement.frames.begin() + join.part);
    next.push_back(std::move(arrangement));
  }
  return next;
}

Arrangement Search::joinAll()
{
  Arrangement alone;
  for (std::size_t i = 0; i < judge_.scans().size(); ++i)
    if (judge_.scans()[i].problem.empty())
      alone.frames.push_back({{static_cast<Index>(i)}, {Eigen::Isometry3d::Identity()}});
  Arrangement best = alone;
  for (std::vector<Arrangement> beam{alone}; !beam.empty(); beam = successors(beam))
    for (const Arrangement& arrangement : beam)
      if (arrangement.log_odds > best.log_odds)
        best = arrangement;
  return best;
}

// Of all arrangements in which a part of a frame is apart from the rest, or elsewhere; against all scans alone.
double Search::bestOther(const Arrangement& arrangement, std::size_t frame, const std::vector<Index>& part,
                         Arrangement* best)
{
  auto [moved, rest] = divide(arrangement.frames[frame], part);
  std::vector<ScanCluster> frames = arrangement.frames;
  frames[frame] = rest;
  const double here = judge_.logOdds(arrangement.frames[frame]);
  const double apart = arrangement.log_odds - here + judge_.logOdds(moved) + judge_.logOdds(rest);
  const Moves moves = movesTo(frames, moved);
  std::vector<ScanCluster> joined;
  std::vector<std::size_t> into;
  for (const Move& move : moves) {
    const bool stays = move.frame == frame && poseDistance(move.T_frame_part, Eigen::Isometry3d::Identity(),
                                                           sizeOf(moved)) < 4.0 * options_.tolerance;
    if (stays)
      continue;
    joined.push_back(frames[move.frame]);
    append(joined.back(), moved, move.T_frame_part);
    into.push_back(move.frame);
  }
  const std::vector<double> odds = judge_.logOdds(joined);
  double most = apart;
  if (best) {
    best->frames = frames;
    best->frames.push_back(moved);
  }
  for (std::size_t k = 0; k < joined.size(); ++k) {
    const double other = apart - judge_.logOdds(moved) - judge_.logOdds(frames[into[k]]) + odds[k];
    if (other <= most)
      continue;
    most = other;
    if (best) {
      best->frames = frames;
      best->frames[into[k]] = joined[k];
    }
  }
  if (best) {
    best->log_odds = most;
    const auto gone = [](const ScanCluster& f) { return f.scans.empty(); };
    best->frames.erase(std::remove_if(best->frames.begin(), best->frames.end(), gone), best->frames.end());
  }
  return most;
}

// Every scan, and what holds together most: joined again where the scans lie, the best first. At most half of the frame.
std::vector<std::vector<Index>> Search::partsOf(const ScanCluster& frame)
{
  std::vector<ScanCluster> groups;
  std::vector<std::vector<Index>> parts;
  for (std::size_t k = 0; k < frame.scans.size(); ++k) {
    groups.push_back({{frame.scans[k]}, {frame.poses[k]}});
    parts.push_back({frame.scans[k]});
  }
  const std::size_t n = frame.scans.size();
  while (groups.size() > 2) {
    std::vector<ScanCluster> joined;
    std::vector<std::pair<std::size_t, std::size_t>> sides;
    for (std::size_t i = 0; i < groups.size(); ++i)
      for (std::size_t k = i + 1; k < groups.size(); ++k) {
        joined.push_back(groups[i]);
        append(joined.back(), groups[k], Eigen::Isometry3d::Identity());
        sides.emplace_back(i, k);
      }
    std::vector<double> gains = judge_.logOdds(joined);
    for (std::size_t k = 0; k < gains.size(); ++k)
      gains[k] -= judge_.logOdds(groups[sides[k].first]) + judge_.logOdds(groups[sides[k].second]);
    const std::size_t k = std::max_element(gains.begin(), gains.end()) - gains.begin();
    groups[sides[k].first] = joined[k];
    groups.erase(groups.begin() + sides[k].second);
    if (2 * joined[k].scans.size() <= n)
      parts.push_back(joined[k].scans);
    else
      parts.push_back(divide(frame, joined[k].scans).second.scans);
  }
  for (std::vector<Index>& part : parts)
    std::sort(part.begin(), part.end());
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}

void Search::exchange(Arrangement& arrangement)
{
  constexpr int most_moves = 50; // each raises the odds; bounds the time
  for (int move = 0; move < most_moves; ++move) {
    Arrangement best = arrangement;
    for (std::size_t f = 0; f < arrangement.frames.size(); ++f) {
      if (arrangement.frames[f].scans.size() < 2)
        continue;
      for (const std::vector<Index>& part : partsOf(arrangement.frames[f])) {
        Arrangement other;
        if (bestOther(arrangement, f, part, &other) > best.log_odds + 1e-6)
          best = other;
      }
    }
    if (best.log_odds <= arrangement.log_odds + 1e-6)
      break;
    arrangement = best;
  }
}
} // namespace

Arrangement findArrangement(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options)
{
  Search search(judge, places, options);
  Arrangement arrangement = search.joinAll();
  search.exchange(arrangement);
  sortBySize(arrangement.frames, 0);
  return arrangement;
}

std::vector<PartMargin> findMargins(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options,
                                    const Arrangement& arrangement)
{
  Search search(judge, places, options);
  std::vector<PartMargin> margins;
  for (std::size_t f = 0; f < arrangement.frames.size(); ++f)
    if (arrangement.frames[f].scans.size() > 1)
      for (const std::vector<Index>& part : search.partsOf(arrangement.frames[f]))
        margins.push_back({f, part, arrangement.log_odds - search.bestOther(arrangement, f, part, nullptr)});
  return margins;
}

Arrangement keepCertain(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options,
                        Arrangement arrangement, double least)
{
  std::vector<ScanCluster> aside; // nothing that is left may join them: they are no places elsewhere
  while (true) {
    const std::vector<PartMargin> margins = findMargins(judge, places, options, arrangement);
    const auto weakest = std::min_element(margins.begin(), margins.end(),
                                          [](const auto& x, const auto& y) { return x.margin < y.margin; });
    if (weakest == margins.end() || weakest->margin >= least)
      break;
    auto [part, rest] = divide(arrangement.frames[weakest->frame], weakest->scans);
    arrangement.frames[weakest->frame] = rest;
    aside.push_back(part);
    arrangement.log_odds = 0.0;
    for (const double odds : judge.logOdds(arrangement.frames))
      arrangement.log_odds += odds;
  }
  arrangement.frames.insert(arrangement.frames.end(), aside.begin(), aside.end());
  sortBySize(arrangement.frames, 0);
  return arrangement;
}
} // namespace fresco::registration
