// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tiles/mesh_tiles.h"
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/search/neighbors.h>
#include <memory>
#include <vector>
namespace fresco::texture {
/// Points brought to the surface that they were measured on.
struct SurfaceSamples {
  std::vector<Index> points;       ///< M, columns of the point set, ascending
  Points places, normals;          ///< 3xM, foot on the surface in mesh coordinates; unit normal of its face
  Eigen::VectorXf spacing;         ///< M, mesh units from one sample to the next on the same side of the surface
  std::vector<int> scan;           ///< M, column of `stations`
  Points stations;                 ///< 3xS, where scans were taken from, mesh coordinates; 3x1 where that is not known
  std::unique_ptr<PointTree> tree; ///< of the places

  Index size() const { return points.size(); }
};

/// Leaves out points that are not finite, behind the surface (by their normals or viewpoints), or farther from it than
/// noise explains.
/// @param tiles of the mesh, which take part one after the other
SurfaceSamples sampleSurface(const TriangleMesh& mesh, const MeshTiles& tiles, const PointSet& points, int threads);

/// Gaussian means over samples on the same side of the surface.
class SurfaceGaussian {
public:
  /// @param width deviation in spacings
  SurfaceGaussian(const SurfaceSamples& samples, double width) : samples_(samples), width_(width) {}

  /// Samples that count within a ball; none where all are too far away.
  void gather(const Eigen::Vector3f& middle, float radius, std::vector<int>& found) const;

  /// @param found  by gather() around the place
  /// @param values 3xM
  /// @return sum of weight * value, and the sum of weights, 0 where nothing is known
  Eigen::Vector4f at(const Eigen::Vector3f& place, const Eigen::Vector3f& normal, const std::vector<int>& found,
                     const Points& values) const;

  static constexpr float reach = 4.f;      ///< deviations: beyond, a sample does not count
  static constexpr float same_side = 0.5f; ///< cosine: normals of one surface scatter by less than 60 degrees

private:
  const SurfaceSamples& samples_;
  float width_;
};
} // namespace fresco::texture
