// SPDX-License-Identifier: BSD-3-Clause
#include "evidence/frame_evidence.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
ScanEvidence judge(const ScanPatches& patches, const std::vector<const PatchVotes*>& others)
{
  PatchVotes all(patches.size(), 0);
  for (const PatchVotes* votes : others)
    for (Index i = 0; i < patches.size(); ++i)
      all[i] |= (*votes)[i];
  ScanEvidence evidence;
  evidence.rooms.resize(patches.room_count);
  evidence.rooms[0].own = true;
  const auto counts = [&](Index i) { return (all[i] & (confirmed_vote | contradicted_vote)) == confirmed_vote; };
  for (Index i = 0; i < patches.size(); ++i) {
    RoomAgreement& room = evidence.rooms[patches.rooms[i]];
    room.compared += (all[i] & compared_vote) != 0 ? 1.0 : 0.0;
    for (const PatchVotes* votes : others)
      evidence.comparisons += ((*votes)[i] & compared_vote) != 0 ? 1.0 : 0.0;
    if (!counts(i))
      continue;
    room.confirmed[static_cast<int>(patches.kinds[i])] += 1.0;
    for (const PatchVotes* votes : others)
      room.witnesses += ((*votes)[i] & confirmed_vote) != 0 ? 1.0 : 0.0;
  }
  for (RoomAgreement& room : evidence.rooms) {
    double sum = 0.0;
    for (const double count : room.confirmed)
      sum += count;
    room.witnesses /= std::max(1.0, sum);
  }
  for (const Index size : contradictedGroups(patches, all))
    evidence.contradicted[std::min(group_bins - 1, static_cast<int>(std::log2(size)))] += 1.0;
  return evidence;
}

namespace {
bool isContradicted(const ScanEvidence& evidence) // by more than mixed pixels, which are alone
{
  return std::any_of(evidence.contradicted.begin() + 1, evidence.contradicted.end(), [](double n) { return n > 0.0; });
}

double unboundedAgreement(const EvidenceModel& model, const RoomAgreement& room)
{
  double value = 0.0;
  for (int kind = 0; kind < patch_kinds; ++kind)
    value += model.agree[kind] * room.confirmed[kind];
  return value;
}
} // namespace

double EvidenceModel::logOdds(const std::vector<ScanEvidence>& scans, double most) const
{
  double sum = prior * (scans.size() - 1.0), comparisons = 0.0;
  std::array<double, group_bins> contradicted{};
  for (const ScanEvidence& evidence : scans) {
    for (const RoomAgreement& room : evidence.rooms)
      sum += most * (1.0 - std::exp(-unboundedAgreement(*this, room) / most)) * room.witnesses / (1.0 + room.witnesses);
    for (int bin = 0; bin < group_bins; ++bin)
      contradicted[bin] += evidence.contradicted[bin];
    comparisons += evidence.comparisons;
  }
  for (int bin = 0; bin < group_bins; ++bin)
    sum -= contradict[bin] * std::max(0.0, contradicted[bin] - stray[bin] * comparisons);
  return sum;
}

double EvidenceModel::roomBound(const std::vector<std::array<ScanEvidence, 2>>& pairs) const
{
  constexpr double strong = 15.0; // log-odds without a bound, mean of both sides: nearly all of two rooms agrees
  constexpr double least = 0.1;   // log-odds
  double clean = 1.0, refuted = 1.0;
  for (const auto& [a, b] : pairs)
    if (unboundedAgreement(*this, a.rooms[0]) + unboundedAgreement(*this, b.rooms[0]) > 2.0 * strong)
      (isContradicted(a) || isContradicted(b) ? refuted : clean) += 1.0;
  return std::max(least, room_base + room_slope * std::log(refuted / clean));
}

const EvidenceModel& fittedModel()
{
  static const EvidenceModel model{{0.03977, 0.004253, 0.05622},
                                   0.1609,
                                   2.086,
                                   {0.0, 3.978, 6.794, 7.162, 7.497, 7.798, 8.098, 8.398, 8.698},
                                   {7.67e-05, 2.557e-05, 2.841e-06, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                                   -3.158};
  return model;
}
} // namespace fresco::registration
