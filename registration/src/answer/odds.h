// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/free_space_evidence.h"
namespace fresco::registration {
/// Probability of each of some places of one part, of which one at most is right, by what agrees there and what contradicts.
/// @param joined          whether the joining steps took it
/// @param usual_violation of pairs of these scans: points that contradict, of those that could
std::vector<double> oddsOf(const std::vector<CandidatePlace>& places, bool joined, double usual_violation);

/// Above it nothing is claimed: more examples would be needed.
double largestClaim();

/// Probabilities of candidates, links and scans. A scan is as sure of its place as the weakest link between it and the largest part
/// of its group.
/// @param groups with their hints; what these hold was not taken by the joining steps
void describeOdds(const std::vector<ScanCluster>& groups, const FreeSpaceJudge& judge, int threads,
                  ScanRegistrationResult& result);

/// Makes parts of the placed group that are less probable than the options ask for clusters of their own: but for scans with a start
/// pose, and for what a hint says.
/// @param clusters that the result was made of
/// @return whether there were any
bool loseUnsure(const ScanRegistrationResult& result, const ScanCluster& known, const ScanRegistrationOptions& options,
                std::vector<ScanCluster>& clusters);
} // namespace fresco::registration
