// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/candidate_score.h"
#include "networks/mlp.h"
namespace fresco::filters {
namespace {
constexpr int inputs = NormalCandidateFeatures::count, first = CandidateScore::first_size, second = 16;

struct Network : Mlp<inputs, first, second> {
  explicit Network(const Weights& weights)
      : Mlp(weights), of_candidate(weights.values("of_candidate", {inputs, first})),
        of_own_normal(weights.values("of_own_normal", {inputs, first}))
  {}
  const float *of_candidate, *of_own_normal; ///< matrices of the first layer
};

const Network& network()
{
  static const Network loaded{Weights(candidateScoreData())};
  return loaded;
}
} // namespace

CandidateScore::CandidateScore(const NormalCandidateFeatures::Features& own)
    : from_own_(network().firstSums(network().of_own_normal, own))
{}

float CandidateScore::of(const NormalCandidateFeatures::Features& features) const
{
  return network().output(network().firstSums(network().of_candidate, features) + from_own_);
}
} // namespace fresco::filters
