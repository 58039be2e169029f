// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <utility>
#include <vector>
namespace fresco::filters {
/// A neighbour of a point.
struct CandidateNeighbor {
  Eigen::Vector3f offset; ///< from the point
  Eigen::Vector3f normal; ///< unit
  bool at_crease;         ///< its own neighbours have different normals
};

/// A candidate for the normal of a point.
struct NormalCandidate {
  Eigen::Vector3f direction; ///< unit, facing the viewer
  float share;               ///< of the weight of all normals around, 0..1
  float to_own;              ///< cosine to the normal the point has
};

/// Features that tell how well candidates fit a point beside a crease, from its neighbours and the noise of the beams.
/// They change neither with the frame nor with the unit of length.
class NormalCandidateFeatures {
public:
  static constexpr int count = 44;
  using Features = Eigen::Matrix<float, count, 1>;

  /// @param neighbors without the point itself
  /// @param beam unit, towards the point
  /// @param noise deviation along the beam, length, > 0
  void set(const std::vector<CandidateNeighbor>& neighbors, const Eigen::Vector3f& beam, float noise);
  Features of(const NormalCandidate& candidate);

private:
  void sortIntoRings(const std::vector<CandidateNeighbor>& neighbors);
  void measureSpacing();
  void markNearestAcross();
  float placeOfPlane() const;
  float* countRings(const Eigen::Vector3f& direction, float* at); ///< @return behind the last one
  float* measureSpread(const Eigen::Vector3f& direction, float* at);
  void measureFit(const Eigen::Vector3f& direction, float* at);

  Eigen::Vector3f beam_;
  float noise_ = 0, spacing_ = 1;            ///< of the beams, lengths
  Eigen::Array3Xf offsets_, normals_;        ///< of the neighbours, ring by ring
  Eigen::ArrayXf at_crease_, across_;        ///< 0 or 1; squared distance across the beam in spacings
  Eigen::ArrayXf near_across_, wide_across_; ///< 1 for those nearest across the beam, else 0
  Eigen::ArrayXf placing_;                   ///< weights where the height of a plane is sought
  Eigen::ArrayXf height_, held_;             ///< above the plane in deviations of the noise; 0 or 1
  float thickness_ = 0;                      ///< deviation of the noise across the plane, length
  std::vector<std::pair<float, int>> order_; ///< squared distance, neighbour
  std::vector<float> sorted_;
};
} // namespace fresco::filters
