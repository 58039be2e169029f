// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/free_space_evidence.h"
#include <array>
#include <set>
namespace fresco::registration {
/// Probability of each of some places of one part, of which one at most is right, by what agrees there and what contradicts.
/// @param joined          whether the joining steps took it
/// @param usual_violation of pairs of these scans
std::vector<double> oddsOf(const std::vector<CandidatePlace>& places, bool joined, double usual_violation);

/// Above it nothing is claimed: more examples would be needed.
double largestClaim();

/// Probabilities of candidates, links and scans. A scan is as sure of its place as the weakest link between it and the largest part
/// of its group.
/// @param groups with their hints; what these hold was not taken by the joining steps
void describeOdds(const std::vector<ScanCluster>& groups, const FreeSpaceJudge& judge, int threads,
                  ScanRegistrationResult& result);

/// Changes what a registration starts from until all its places have the probability that the options ask for, above 0.
class OddsFollower {
public:
  /// @param known scans with a start pose, which keep their places
  /// @param options gets hints. Both have to outlive it
  OddsFollower(const ScanCluster& known, ScanRegistrationOptions& options)
      : known_(known), options_(options), given_(options.hints.size())
  {}

  /// Parts of the placed group that are less probable become clusters again; if there are none, the likeliest other place that is
  /// probable enough is taken by a hint.
  /// @param clusters that the result was made of
  /// @return whether anything changed
  bool follow(const ScanRegistrationResult& result, std::vector<ScanCluster>& clusters);

private:
  bool lose(const std::vector<CandidatePlace>& links, std::vector<ScanCluster>& clusters);
  bool gain(const std::vector<CandidatePlace>& places);
  const ScanCluster& known_;
  ScanRegistrationOptions& options_;
  const double asked_ = std::min(options_.confidence, largestClaim());
  std::ptrdiff_t given_;                 // hints of a person come first
  std::set<std::array<Index, 3>> tried_; // places that were taken, whether they were kept or not
};
} // namespace fresco::registration
