// SPDX-License-Identifier: BSD-3-Clause
#include "direction_worth.h"
#include "direction_weights.h"
#include "rectifiers.h"
namespace fresco {
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
} // namespace fresco
