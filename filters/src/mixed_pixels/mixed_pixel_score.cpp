// SPDX-License-Identifier: BSD-3-Clause
#include "mixed_pixels/mixed_pixel_score.h"
#include "networks/mlp.h"
namespace fresco::filters {
namespace {
template <int inputs, int first, int second>
struct Classifier : Mlp<inputs, first, second> {
  explicit Classifier(const Weights& weights)
      : Mlp<inputs, first, second>(weights, {"first_weights"}), last_bias(*weights.values("last_bias", {1, 1}))
  {}
  float score(const Eigen::Matrix<float, inputs, 1>& features) const
  {
    return this->output(this->firstSums(0, features)) + last_bias;
  }
  float last_bias;
};
} // namespace

float mixedPixelScore(const MixedPixelFeatures& features)
{
  static const Classifier<mixed_pixel_features::count, 64, 24> network{Weights(mixedPixelData())};
  return network.score(features);
}

float mixedPixelScore(const SecondStageFeatures& features)
{
  static const Classifier<mixed_pixel_features::second_stage_count, 96, 32> network{Weights(secondStageData())};
  return network.score(features);
}

std::vector<float> firstStageScores(const BeamScan& scan, const MixedPixelOptions& options)
{
  std::vector<float> scores(scan.columns.size(), least_second_stage);
  forMixedPixelCandidates(scan, options, [&](Index i, const BeamSurroundings& around) {
    scores[i] = mixedPixelScore(mixedPixelFeatures(around));
  });
  return scores;
}
} // namespace fresco::filters
