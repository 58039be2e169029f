// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/mixed_pixel_score.h"
#include "mixed_pixels/mixed_pixel_weights.h"
#include "mixed_pixels/second_stage_weights.h"
#include "networks/mlp.h"
namespace fresco::filters {
namespace {
template <typename Weights>
float score(const NetworkInputs<Weights>& figures)
{
  return networkOutput<Weights>(firstSums<Weights>(Weights::of_figures, figures)) + Weights::last_bias[0];
}
} // namespace

float veilScore(const VeilFigures& figures) { return score<VeilWeights>(figures); }
float veilScore(const LikelyFigures& figures) { return score<LikelyWeights>(figures); }

std::vector<float> firstScores(const BeamScan& scan, const VeilOptions& options)
{
  std::vector<float> scores(scan.columns.size(), least_likely);
  forVeilCandidates(scan, options,
                    [&](Index i, const BeamSurroundings& around) { scores[i] = veilScore(veilFigures(around)); });
  return scores;
}
} // namespace fresco::filters
