// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include "poisson/octree/sample_ranges.h"
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/array.h>
#include <fresco/core/point_set.h>
#include <fresco/core/point_stream.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco::poisson {
/// The cube that the octree divides.
struct Cube {
  Eigen::Vector3d corner = Eigen::Vector3d::Zero(); ///< lower corner, in the frame of the points
  double side = 1.0;
  int depth = 0;

  double cell() const { return std::ldexp(side, -depth); }
};

/// Mean of the points within one finest cell.
struct Sample {
  Eigen::Vector3f position; ///< in cells of the finest depth, from the cube's corner
  float area; ///< surface that it stands for, in faces of a finest cell; its weight (1 = a point) until known
  Eigen::Vector3f normal; ///< unit
  float depth;            ///< octree depth that the data sustain here
  float noise;            ///< standard deviation of the position across the surface, in finest cells
};

/// Colour 0..255 (three numbers) and intensity.
using Attributes = Eigen::Vector4f;

struct Samples {
  Cube cube;
  Array<std::uint64_t> codes;   ///< Morton codes of the finest cells, strictly rising
  Array<Sample> samples;        ///< by code
  Array<Attributes> attributes; ///< by code; empty if the points have neither colour nor intensity
  Index used_points = 0, left_out_points = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); ///< of the points
  bool has_colors = false, has_intensities = false;
};

/// Points that are all there already.
class WholeSet : public PointStream {
public:
  explicit WholeSet(const PointSet& set) : set_(set) {}
  void read(const std::function<void(const PointSet&)>& receive) const override { receive(set_); }

private:
  const PointSet& set_;
};

/// Leaves out unusable points and far outliers, fits the cube, sorts along the Z-order curve and joins the points of a
/// cell.
/// @throws std::invalid_argument as reconstructVolumetric()
Samples gatherSamples(const PointSet& points, const VolumetricOptions& options);
/// The same of a stream, which is read three times, or four times if there are far outliers.
Samples gatherSamples(const PointStream& points, const VolumetricOptions& options);

/// Samples joined within the cells of a coarser depth.
struct CoarseSample {
  Eigen::Vector3f position; ///< in cells of the finest depth
  float area;
  float noise; ///< as Sample::noise
  float depth; ///< as Sample::depth
};

/// Samples joined in the cells of one depth.
struct SampleLevel {
  Array<std::uint64_t> codes; ///< of cells of `depth`
  Array<CoarseSample> samples;
  /// By sample, of those that were joined in it: mean normal, and mean of n . (p - mean p) in cells of the finest depth;
  /// empty at the finest depth and where nobody asks.
  Array<Eigen::Vector4f> fluxes;
  Array<float> expected; ///< of chi by sample, at the finest depth
  int depth = 0;
};

SampleLevel finestLevel(const Samples& samples, int threads);
Array<Eigen::Vector3f> normalsOf(const Samples& samples, int threads);
/// @param normals of the samples of the finest depth: their fluxes are wanted
SampleLevel coarsen(const SampleLevel& fine, int threads, const Array<Eigen::Vector3f>* normals = nullptr);

/// Samples of each brick of `level` among sorted codes of a depth no coarser than the level's.
SampleRanges sampleRanges(const BrickLevel& level, const Array<std::uint64_t>& codes, int depth, int threads);
} // namespace fresco::poisson
