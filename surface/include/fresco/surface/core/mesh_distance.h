// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/progress.h>
#include <string>
namespace fresco {
/// Distance between two surfaces as in Cignoni, Rocchini & Scopigno 1998, "Metro: measuring error on simplified
/// surfaces": for points of one, the distance to the closest point of the other, both ways. Vertices that no face names
/// do not count.
struct MeshDistanceOptions {
  bool vertex_to_vertex = false; ///< measure vertices against the vertices of the other mesh, not against its surface
  int samples = 0;               ///< area-uniform surface samples per mesh that are measured beside the vertices, >= 0
  int normal_samples = 500000;   ///< samples per mesh for the normals where `samples` is 0; 0 = normals not measured
  std::uint64_t seed = 1;        ///< of the samples
  int threads = 0;               ///< 0 = all cores; the result does not depend on it
};

/// Over the points of one mesh, in the unit of the meshes.
struct DistanceStatistics {
  double max = 0, mean = 0, rms = 0;
  Index count = 0; ///< points measured; 0 = not measured
};

struct TwoSidedDistance {
  DistanceStatistics to_reference;   ///< points of the mesh against the reference
  DistanceStatistics from_reference; ///< points of the reference against the mesh
  DistanceStatistics symmetric;      ///< the larger of the two for max, mean and RMS; the sum of the counts
};

/// Angle between the normal of the face a sample lies on and that of the closest face of the other mesh, degrees,
/// 0..180. Normals follow from the corners, not from the file.
struct NormalDeviation {
  double mean = 0, median = 0, percentile95 = 0;
  double share_above_20 = 0; ///< of the samples deviate by more than 20 degrees, 0..1
  Index count = 0;           ///< samples measured; 0 = not measured
};

struct MeshDistanceResult {
  TwoSidedDistance vertices;        ///< over vertices
  TwoSidedDistance surface;         ///< over surface samples, to the surface; only with MeshDistanceOptions::samples
  Eigen::VectorXf vertex_distances; ///< V of the mesh: distance to the reference; NaN where no face names the vertex
  double reference_diagonal = 0;    ///< of the bounding box of the reference
  NormalDeviation normals_to_reference, normals_from_reference;
  bool inside_out = false; ///< most normals are opposite; the deviations are then those of the turned mesh
  MeshTopology mesh_topology, reference_topology; ///< zeros where a mesh has no faces
};

/// @param mesh, reference in one world frame; their origins may differ
/// @throws std::invalid_argument if one is not measurable (see requireMeasurable), the reference has no extent, or an
///         option is out of range
FRESCO_EXPORT MeshDistanceResult measureMeshDistance(const TriangleMesh& mesh, const TriangleMesh& reference,
                                                     const MeshDistanceOptions& options = {},
                                                     const Progress& progress = {});

/// MeshDistanceResult::vertex_distances alone.
/// @throws std::invalid_argument as measureMeshDistance()
FRESCO_EXPORT Eigen::VectorXf vertexDistances(const TriangleMesh& mesh, const TriangleMesh& reference, int threads = 0);

/// @param name        how errors call the mesh
/// @param need_faces  false for MeshDistanceOptions::vertex_to_vertex: points without faces will do
/// @throws std::invalid_argument "NAME: reason" if the mesh has no faces, no area, an index out of range, or a vertex
///         that counts is not finite
FRESCO_EXPORT void requireMeasurable(const TriangleMesh& mesh, const std::string& name, bool need_faces = true);
} // namespace fresco
