// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/candidate_features.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
namespace fresco::filters {
using Eigen::ArrayXf;
using Eigen::Index;
using Eigen::Vector3f;

namespace {
constexpr Index nearest = 8, wide = 24; // neighbours across the beam
constexpr int ring_count = 4;
constexpr Index ring_sizes[] = {8, 16, 32};              // nearest neighbours counted apart, then all
constexpr float held = 2.5f, close = 1.2f, beyond = 4.f; // deviations of the noise

/// ln(n + 1/2)
float logCount(float count)
{
  static const std::array<float, 256> logs = [] {
    std::array<float, 256> values{};
    for (std::size_t n = 0; n < values.size(); ++n)
      values[n] = std::log(n + 0.5f);
    return values;
  }();
  const Index n = std::min(count, 255.f);
  return logs[n];
}
} // namespace

void NormalCandidateFeatures::set(const std::vector<CandidateNeighbor>& neighbors, const Vector3f& beam, float noise)
{
  constexpr float least_noise = 0.05f; // spacings: surfaces between beams are not flatter, however exact these are
  constexpr float fading = 16.f;       // squared spacings across the beam at which a neighbour places a plane by half
  sortIntoRings(neighbors);
  const Index n = neighbors.size();
  beam_ = beam;
  offsets_.resize(3, n);
  normals_.resize(3, n);
  at_crease_.resize(n);
  for (Index j = 0; j < n; ++j) {
    const CandidateNeighbor& neighbor = neighbors[order_[j].second];
    offsets_.col(j) = neighbor.offset;
    normals_.col(j) = neighbor.normal;
    at_crease_[j] = neighbor.at_crease;
  }
  const ArrayXf along = (beam.transpose() * offsets_.matrix()).transpose().array();
  across_ = (offsets_.square().colwise().sum().transpose() - along.square()).max(0.f);
  measureSpacing();
  across_ /= spacing_ * spacing_;
  markNearestAcross();
  placing_ = (1 + across_ / fading).inverse();
  noise_ = std::max(noise, least_noise * spacing_);
}

/// Those of each ring before those of the next, in no order within it.
void NormalCandidateFeatures::sortIntoRings(const std::vector<CandidateNeighbor>& neighbors)
{
  order_.clear();
  for (std::size_t j = 0; j < neighbors.size(); ++j)
    order_.emplace_back(neighbors[j].offset.squaredNorm(), j);
  auto end = order_.end();
  for (int ring = ring_count - 2; ring >= 0; --ring)
    if (order_.begin() + ring_sizes[ring] < end) {
      std::nth_element(order_.begin(), order_.begin() + ring_sizes[ring], end);
      end = order_.begin() + ring_sizes[ring];
    }
}

/// Harmonic mean of the distances of the nearest across the beam: some of them lie far across it.
void NormalCandidateFeatures::measureSpacing()
{
  float inverse = 0, found = 0;
  for (Index j = 0; j < std::min(nearest, across_.size()); ++j)
    if (across_[j] > 0) {
      inverse += 1 / std::sqrt(across_[j]);
      ++found;
    }
  spacing_ = inverse > 0 ? found / inverse : 1.f;
}

/// Marks those nearest across the beam.
void NormalCandidateFeatures::markNearestAcross()
{
  sorted_.assign(across_.data(), across_.data() + across_.size());
  auto end = sorted_.end();
  const auto mark = [&](Index most, ArrayXf& marked) {
    if (end - sorted_.begin() <= most) {
      marked.setOnes(across_.size());
      return;
    }
    const auto last = sorted_.begin() + (most - 1);
    std::nth_element(sorted_.begin(), last, end);
    marked = (across_ <= *last).cast<float>();
    end = last + 1;
  };
  mark(wide, wide_across_);
  mark(nearest, near_across_);
}

/// Height of the plane that most of the neighbours are on, starting at the point, in deviations.
float NormalCandidateFeatures::placeOfPlane() const
{
  constexpr int placings = 4; // of the plane
  float place = 0;
  for (int k = 0; k < placings; ++k) {
    const ArrayXf weights = ((height_ - place).abs() < held).cast<float>() * placing_;
    const float total = weights.sum();
    if (!(total > 0))
      break;
    place = (weights * height_).sum() / total;
  }
  return place;
}

NormalCandidateFeatures::Features NormalCandidateFeatures::of(const NormalCandidate& candidate)
{
  const float cosine = -candidate.direction.dot(beam_);
  thickness_ = noise_ * cosine;
  height_ = (candidate.direction.transpose() * offsets_.matrix()).transpose().array() / thickness_;
  const float place = placeOfPlane();
  height_ -= place;
  held_ = (height_.abs() < held).cast<float>();
  Features features;
  features[0] = candidate.to_own > 0.97f;
  features[1] = candidate.to_own;
  features[2] = std::clamp(place, -4.f, 4.f);
  features[3] = std::abs(features[2]);
  features[4] = std::log(candidate.share + 0.003f);
  features[5] = std::log(cosine);
  features[6] = std::log(thickness_ / spacing_ + 0.001f);
  static_assert(7 + 6 * ring_count + 6 + 7 == count);
  float* at = countRings(candidate.direction, features.data() + 7);
  at = measureSpread(candidate.direction, at);
  measureFit(candidate.direction, at);
  return features;
}

float* NormalCandidateFeatures::countRings(const Vector3f& direction, float* at)
{
  constexpr float alike = 0.9f; // cosine
  const ArrayXf inside = (height_.abs() < close).cast<float>();
  const ArrayXf same = ((direction.transpose() * normals_.matrix()).transpose().array() > alike).cast<float>() * held_;
  const ArrayXf other = (held_ - same) * (1 - at_crease_);
  const ArrayXf front = (height_ > beyond).cast<float>(), behind = (height_ < -beyond).cast<float>();
  for (int ring = 0; ring < ring_count; ++ring) {
    const Index end = ring < ring_count - 1 ? std::min(ring_sizes[ring], held_.size()) : held_.size();
    for (const ArrayXf* counted :
         std::initializer_list<const ArrayXf*>{&inside, &held_, &same, &other, &front, &behind})
      *at++ = logCount(counted->head(end).sum());
  }
  return at;
}

/// Of the neighbours held: the nearest across the beam, and deviations within the plane, in spacings.
float* NormalCandidateFeatures::measureSpread(const Vector3f& direction, float* at)
{
  float gap = across_.size() > 0 ? across_.maxCoeff() : 1.f;
  for (Index j = 0; j < across_.size(); ++j)
    if (held_[j] > 0)
      gap = std::min(gap, across_[j]);
  const Vector3f u = direction.unitOrthogonal(), v = direction.cross(u);
  const ArrayXf a = (u.transpose() * offsets_.matrix()).transpose().array() / spacing_;
  const ArrayXf b = (v.transpose() * offsets_.matrix()).transpose().array() / spacing_;
  const float total = std::max(1.f, held_.sum()), mean_a = (held_ * a).sum() / total,
              mean_b = (held_ * b).sum() / total;
  const float aa = (held_ * a.square()).sum() / total - mean_a * mean_a;
  const float bb = (held_ * b.square()).sum() / total - mean_b * mean_b;
  const float ab = (held_ * a * b).sum() / total - mean_a * mean_b;
  const float middle = (aa + bb) / 2, apart = std::hypot((aa - bb) / 2, ab);
  const float longer = std::sqrt(std::max(0.f, middle + apart)), shorter = std::sqrt(std::max(0.f, middle - apart));
  *at++ = std::log(gap + 0.1f);
  *at++ = std::log(longer + 0.1f);
  *at++ = std::log(shorter + 0.1f);
  *at++ = std::log(std::max(shorter * spacing_ / thickness_, 0.1f));
  *at++ = std::log(noise_ / spacing_);
  *at++ = std::log(across_.size() + 1.f);
  return at;
}

/// How far the neighbours are from the plane, and how far those that it holds agree with it.
void NormalCandidateFeatures::measureFit(const Vector3f& direction, float* at)
{
  const ArrayXf off = height_.abs().min(beyond);
  const float total = std::max(1.f, held_.sum());
  *at++ = logCount((held_ * near_across_).sum());
  *at++ = (off * near_across_).sum() / std::max(1.f, near_across_.sum());
  *at++ = (off * wide_across_).sum() / std::max(1.f, wide_across_.sum());
  *at++ = std::sqrt((held_ * height_.square()).sum() / total);
  *at++ = (held_ * (direction.transpose() * normals_.matrix()).transpose().array()).sum() / total;
  *at++ = (height_.max(-beyond).min(beyond) * wide_across_).sum() / std::max(1.f, wide_across_.sum());
  *at = at_crease_.size() > 0 ? at_crease_.mean() : 0.f;
}
} // namespace fresco::filters
