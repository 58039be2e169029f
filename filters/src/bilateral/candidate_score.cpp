// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/candidate_score.h"
#include "networks/mlp.h"
namespace fresco::filters {
namespace {
enum { of_candidate, of_own_normal }; // matrices of the first layer

const auto& network()
{
  static const Mlp<NormalCandidateFeatures::count, CandidateScore::first_size, 16> loaded(
      Weights(candidateScoreData()), {"of_candidate", "of_own_normal"});
  return loaded;
}
} // namespace

CandidateScore::CandidateScore(const NormalCandidateFeatures::Features& own)
    : from_own_(network().firstSums(of_own_normal, own))
{}

float CandidateScore::of(const NormalCandidateFeatures::Features& features) const
{
  return network().output(network().firstSums(of_candidate, features) + from_own_);
}
} // namespace fresco::filters
