// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/candidate_score.h"
#include "bilateral/candidate_weights.h"
#include "networks/mlp.h"
namespace fresco::filters {
static_assert(DirectionWeights::inputs == DirectionFigures::count &&
                  DirectionWeights::first == DirectionWorth::first_size,
              "weights of another network");

DirectionWorth::DirectionWorth(const DirectionFigures::Figures& own)
    : from_own_(firstSums<DirectionWeights>(DirectionWeights::of_own, own))
{}

float DirectionWorth::of(const DirectionFigures::Figures& figures) const
{
  return networkOutput<DirectionWeights>(firstSums<DirectionWeights>(DirectionWeights::of_direction, figures) +
                                         from_own_);
}
} // namespace fresco::filters
