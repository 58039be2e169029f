// SPDX-License-Identifier: BSD-3-Clause
#include "direction_worth.h"
#include "direction_weights.h"
namespace fresco {
namespace {
using namespace direction_weights;
static_assert(inputs == DirectionFigures::count && first == DirectionWorth::first_size, "weights of another network");
using First = Eigen::Array<float, first, 1>;

/// What the first layer gets from figures; those from outside what was seen in training count as its limits.
First firstLayer(const float* weights, const DirectionFigures::Figures& figures)
{
  using Limits = Eigen::Map<const DirectionFigures::Figures>;
  const DirectionFigures::Figures within = figures.cwiseMax(Limits(lowest)).cwiseMin(Limits(highest));
  return (Eigen::Map<const Eigen::Matrix<float, first, inputs>>(weights) * within).array();
}
} // namespace

DirectionWorth::DirectionWorth(const DirectionFigures::Figures& own)
    : from_own_(firstLayer(of_own, own) + Eigen::Map<const First>(first_bias))
{}

float DirectionWorth::of(const DirectionFigures::Figures& figures) const
{
  const Eigen::Matrix<float, first, 1> a = (firstLayer(of_direction, figures) + from_own_).max(0.f);
  const Eigen::Map<const Eigen::Matrix<float, second, first>> W(second_weights);
  const Eigen::Map<const Eigen::Matrix<float, second, 1>> bias(second_bias), last(last_weights);
  return (W * a + bias).cwiseMax(0.f).dot(last);
}
} // namespace fresco
