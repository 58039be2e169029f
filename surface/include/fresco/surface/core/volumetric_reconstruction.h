// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/exchange.h>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/core/point_stream.h>
#include <fresco/core/progress.h>
#include <fresco/surface/core/free_space_map.h>
#include <memory>
#include <vector>
namespace fresco {
/// Screened Poisson reconstruction over an adaptive octree: Kazhdan, Bolitho & Hoppe 2006, "Poisson Surface
/// Reconstruction"; Kazhdan & Hoppe 2013, "Screened Poisson Surface Reconstruction". The function chi is a sum of
/// B-splines of degree 1.
struct VolumetricOptions {
  int depth = 8;            ///< octree depth, 2..16; finest cell = cube side / 2^depth
  double cell_size = 0.0;   ///< side of the finest cell, unit of the points; it then sets the depth; 0 = from `depth`
  int min_depth = 5;        ///< the octree is complete down to this depth, 2..8
  float point_weight = 4.f; ///< alpha, the weight of chi = 0 at the points, >= 0; 0 = unscreened (2006)
  float scale = 1.1f;       ///< cube side / longest side of the bounding box, >= 1
  float samples_per_node = 1.f; ///< samples that a cell needs to sustain its depth, > 0; more = smoother
  bool confidence = false;      ///< samples weighted by PointSet::confidences, else by the length of their normals
  /// An octree depth: the surface is cut away where the data sustain less than it; >= 0, 0 = kept closed.
  float trim = 0.f;
  /// The same relative to the data, in octree levels, >= 0; 0 = kept closed. The surface is cut away where the data
  /// sustain less than D - trim_levels. D is the depth that the best-sampled quarter of the vertices reaches, but at
  /// most the finest depth. If `trim` is set, too, the deeper of the two limits holds.
  float trim_levels = 0.f;
  int iterations = 6; ///< smoothing sweeps per octree depth, 1..1000
  int threads = 0;    ///< 0 = all cores; the result does not depend on it
  /// No surface where beams passed: chi is kept positive there, farther than 1.5 cells from samples. In the frame of the
  /// points. Empty: beams are not asked.
  std::shared_ptr<const FreeSpaceMap> free_space;
};

/// Lengths are in the unit of the points.
struct VolumetricResult {
  /// Faces counter-clockwise seen from the free side (where the normals point to); the origin is that of the points.
  /// Closed and manifold unless trimmed. Colours where the points have them. Fields: "support" (octree depth that the
  /// data sustain at the vertex), "intensity" where the points have it.
  TriangleMesh mesh;
  int depth = 0;             ///< depth used
  double cell_size = 0.0;    ///< side of the finest cell
  double residual = 0.0;     ///< |A x - b| / |b| at the finest depth; from depth 9 on of an eighth of the unknowns
  double trim_depth = 0.0;   ///< depth below which the surface was cut away, 0 = nowhere
  Index used_points = 0;     ///< points that took part
  Index left_out_points = 0; ///< not finite, without normal or confidence, or far outliers
  Index cells = 0;           ///< cells of the octree, all depths
};

/// @throws std::invalid_argument if an option is out of range
FRESCO_EXPORT void validateVolumetricOptions(const VolumetricOptions& options);

/// @param points with normals that point to the free side
/// @throws std::invalid_argument if there are no normals, fewer than 4 usable points, all usable points coincide, or an
///         option is out of range
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT VolumetricResult reconstructVolumetric(const PointSet& points, const VolumetricOptions& options = {},
                                                     const Progress& progress = {});

/// The same; the points are freed as soon as they have been sampled, which lowers the peak of the memory used.
FRESCO_EXPORT VolumetricResult reconstructVolumetric(PointSet&& points, const VolumetricOptions& options = {},
                                                     const Progress& progress = {});

/// The same of more points than memory holds. They are read three times, or four times if there are far outliers, and
/// freed when they have been sampled. The result does not depend on their order and windows.
/// @throws as the other forms, and what reading throws
FRESCO_EXPORT VolumetricResult reconstructVolumetric(std::unique_ptr<PointStream> points,
                                                     const VolumetricOptions& options = {},
                                                     const Progress& progress = {});

/// A rank's part of a reconstruction that several ranks make together: the same bytes as one makes.
struct VolumetricPart {
  /// Consecutive vertices or faces of the whole mesh.
  struct Run {
    Index first, count;
  };
  VolumetricResult result;                ///< its mesh has the own vertices; faces hold numbers of the whole mesh
  std::vector<Run> vertices, faces;       ///< where the own ones belong, one run after the other, rising
  Index vertex_count = 0, face_count = 0; ///< of the whole mesh
};

/// All ranks call this, with the same options; several ranks cannot take free space. Octrees of depth 10 and more are
/// divided; rank 0 makes shallower ones. A surface that is trimmed comes to rank 0 as a whole, before it is trimmed; the
/// others have no part in the mesh.
/// @param points   of this rank, maybe none: any share of all points
/// @param exchange with the other ranks; outlives the call
/// @throws std::invalid_argument also if `min_depth` is below 5
FRESCO_EXPORT VolumetricPart reconstructVolumetricPart(std::unique_ptr<PointStream> points,
                                                       const VolumetricOptions& options, const Progress& progress,
                                                       Exchange& exchange);

/// What a reconstruction will take, judged from how many octree cells the points occupy.
struct VolumetricEstimate {
  std::size_t memory = 0; ///< bytes at most, beside the points themselves
  double seconds = 0;     ///< wall time, to a factor of about two: from how long counting took
};

/// Costs a fraction of the reconstruction: two passes over the points.
/// @throws as reconstructVolumetric()
FRESCO_EXPORT VolumetricEstimate estimateVolumetric(const PointStream& points, const VolumetricOptions& options = {});

/// Its memory only.
FRESCO_EXPORT std::size_t estimateMemory(const PointSet& points, const VolumetricOptions& options = {});
FRESCO_EXPORT std::size_t estimateMemory(const PointStream& points, const VolumetricOptions& options = {});
} // namespace fresco
