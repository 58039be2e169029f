// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <limits>
#include <memory>
namespace fresco {
struct Ray {
  Eigen::Vector3f origin, direction;                  ///< direction of any length but 0; distances are in units of it
  float far = std::numeric_limits<float>::infinity(); ///< where the ray ends
  float near = 0.f;                                   ///< where it begins
};

/// The nearest face along a ray.
struct RayHit {
  int face = -1; ///< column of TriangleMesh::faces; -1: nothing was hit
  float distance = std::numeric_limits<float>::infinity();
  float beta = 0.f, gamma = 0.f;                    ///< barycentric coordinates of the face's corners 1 and 2
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(); ///< of the face, not of unit length; it points to where the corners
                                                    ///< are counter-clockwise
};

template <std::size_t n>
using RayPacket = std::array<Ray, n>;
template <std::size_t n>
using HitPacket = std::array<RayHit, n>;

/// Whether the rays of a packet run side by side; a matter of speed only.
enum class RayOrder { coherent, incoherent };

/// Ray casting against the triangles of a mesh, in the frame of its vertices (without TriangleMesh::origin), in single
/// precision, by Embree: Wald et al. 2014, "Embree: a kernel framework for efficient CPU ray tracing". The mesh is
/// copied. May be used by many threads at once.
class FRESCO_EXPORT RayScene {
public:
  /// @param watertight no ray slips through between two faces that share an edge; a little slower
  /// @throws std::runtime_error if memory runs out
  explicit RayScene(const TriangleMesh& mesh, bool watertight = true);
  ~RayScene();
  RayScene(RayScene&&) noexcept;

  RayHit intersect(const Ray& ray) const;

  /// The same for `n` rays at once; n = 8 or 16.
  template <std::size_t n>
  HitPacket<n> intersect(const RayPacket<n>& rays, RayOrder order) const;

  /// @param count of the rays that matter
  /// @return bit i is set where something lies between the ends of ray i
  unsigned occluded(const RayPacket<16>& rays, int count = 16) const;

private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};
} // namespace fresco
