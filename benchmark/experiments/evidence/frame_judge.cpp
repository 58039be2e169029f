// SPDX-License-Identifier: BSD-3-Clause
#include "evidence/frame_judge.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <numeric>
#include <unordered_set>
namespace fresco::registration {
namespace {
constexpr double far_apart = 10.0; // sizes of a scan between scanners: what they share says little
}

FrameJudge::FrameJudge(const std::vector<PreparedScan>& scans, const ProposedPlaces& places, const EvidenceModel& model,
                       int threads)
    : scans_(scans), model_(model), threads_(threads), patches_(scans.size())
{
  for (const PreparedScan& scan : scans)
    if (scan.problem.empty()) {
      size_ = std::max(size_, scan.size);
      grain_ = std::max(grain_, 0.25 * scan.levels[check_level].voxel);
    }
  parallelFor(
      scans.size(), threads,
      [&](Index i) {
        if (scans[i].problem.empty())
          patches_[i] = makePatches(scans[i]);
      },
      1);
  std::vector<ScanCluster> frames;
  for (const ProposedPlace& place : places)
    frames.push_back(frameOf(place));
  remember(frames);
  std::vector<std::array<ScanEvidence, 2>> pairs;
  for (const ScanCluster& frame : frames)
    pairs.push_back({recall(frame, 0), recall(frame, 1)});
  room_bound_ = model.roomBound(pairs);
}

std::size_t FrameJudge::Hash::operator()(const View& view) const
{
  std::size_t hash = 14695981039346656037ull; // FNV-1a (Fowler, Noll, Vo)
  const auto add = [&](Index value) { hash = (hash ^ static_cast<std::size_t>(value)) * 1099511628211ull; };
  add(view.seer);
  add(view.seen);
  for (const int value : view.place)
    add(value);
  return hash;
}

FrameJudge::View FrameJudge::viewOf(const ScanCluster& frame, std::size_t seer, std::size_t seen) const
{
  const Eigen::Isometry3d T = frame.poses[seer].inverse() * frame.poses[seen];
  const Eigen::AngleAxisd turn(normalized(T.linear()));
  View view{frame.scans[seer], frame.scans[seen], {}};
  for (int k = 0; k < 3; ++k) {
    view.place[k] = std::lround(turn.angle() * turn.axis()[k] * size_ / grain_);
    view.place[3 + k] = std::lround(T.translation()[k] / grain_);
  }
  return view;
}

PatchVotes FrameJudge::find(const View& view) const
{
  Eigen::Vector3d turn, shift;
  for (int k = 0; k < 3; ++k) {
    turn[k] = view.place[k] * grain_ / size_;
    shift[k] = view.place[3 + k] * grain_;
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation(turn);
  T.translation() = shift;
  if (shift.norm() > far_apart * size_)
    return PatchVotes(patches_[view.seen].size(), 0);
  return votesOf(scans_[view.seer], patches_[view.seen], T);
}

void FrameJudge::remember(const std::vector<ScanCluster>& frames)
{
  std::unordered_set<View, Hash> wanted;
  std::vector<View> missing;
  for (const ScanCluster& frame : frames)
    for (std::size_t i = 0; i < frame.scans.size(); ++i)
      for (std::size_t k = 0; k < frame.scans.size(); ++k) {
        if (i == k)
          continue;
        const View view = viewOf(frame, i, k);
        if (votes_.count(view) == 0 && wanted.insert(view).second)
          missing.push_back(view);
      }
  std::vector<PatchVotes> found(missing.size());
  parallelFor(
      missing.size(), threads_, [&](Index k) { found[k] = find(missing[k]); }, 1);
  for (std::size_t k = 0; k < missing.size(); ++k)
    votes_.emplace(missing[k], std::move(found[k]));
}

ScanEvidence FrameJudge::recall(const ScanCluster& frame, std::size_t member) const
{
  std::vector<const PatchVotes*> others;
  for (std::size_t k = 0; k < frame.scans.size(); ++k)
    if (k != member)
      others.push_back(&votes_.at(viewOf(frame, k, member)));
  return judge(patches_[frame.scans[member]], others);
}

double FrameJudge::recallLogOdds(const ScanCluster& frame) const
{
  if (frame.scans.size() < 2)
    return 0.0;
  std::vector<ScanEvidence> evidence;
  for (std::size_t k = 0; k < frame.scans.size(); ++k)
    evidence.push_back(recall(frame, k));
  return model_.logOdds(evidence, room_bound_);
}

// Scans and where they lie to the first of them.
std::vector<int> FrameJudge::keyOf(const ScanCluster& frame) const
{
  std::vector<std::size_t> order(frame.scans.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return frame.scans[x] < frame.scans[y]; });
  std::vector<int> key;
  for (const std::size_t k : order) {
    const View view = viewOf(frame, order[0], k);
    key.push_back(view.seen);
    key.insert(key.end(), view.place.begin(), view.place.end());
  }
  return key;
}

std::vector<double> FrameJudge::logOdds(const std::vector<ScanCluster>& frames)
{
  std::vector<std::vector<int>> keys(frames.size());
  std::vector<ScanCluster> fresh;
  std::vector<std::vector<int>> fresh_keys;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    keys[k] = keyOf(frames[k]);
    if (odds_.emplace(keys[k], 0.0).second) {
      fresh.push_back(frames[k]);
      fresh_keys.push_back(keys[k]);
    }
  }
  remember(fresh);
  std::vector<double> found(fresh.size());
  parallelFor(
      fresh.size(), threads_, [&](Index k) { found[k] = recallLogOdds(fresh[k]); }, 1);
  for (std::size_t k = 0; k < fresh.size(); ++k)
    odds_[fresh_keys[k]] = found[k];
  std::vector<double> odds;
  for (const std::vector<int>& key : keys)
    odds.push_back(odds_.at(key));
  return odds;
}

ScanEvidence FrameJudge::evidenceOf(const ScanCluster& frame, std::size_t member)
{
  remember({frame});
  return recall(frame, member);
}
} // namespace fresco::registration
