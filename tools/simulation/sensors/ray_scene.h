// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "simulation/scene/scene.h"
#include <array>
#include <memory>
namespace fresco::simulation {
struct Ray {
  Eigen::Vector3f origin, direction; ///< direction of any length; distances are in units of it
  float far = 1e30f;                 ///< where the ray ends
};

/// Nearest face along a ray.
struct VirtualHit {
  int face = -1;                                 ///< -1: nothing was hit
  float distance = 0.f, beta = 0.f, gamma = 0.f; ///< weights of the face's corners 1 and 2
};

constexpr int packet_size = 16;
using RayPacket = std::array<Ray, packet_size>;
using HitPacket = std::array<VirtualHit, packet_size>;

/// Ray casting against the triangles of a mesh; may be used by many threads at once. The mesh is copied.
class VirtualRays {
public:
  explicit VirtualRays(const TriangleMesh& mesh);
  ~VirtualRays();
  VirtualRays(VirtualRays&&) noexcept;
  VirtualRays(const VirtualRays&) = delete;
  VirtualRays& operator=(const VirtualRays&) = delete;

  VirtualHit intersect(const Ray& ray) const;
  /// @param coherent whether the rays run side by side; a matter of speed
  HitPacket intersectPacket(const RayPacket& rays, bool coherent) const;
  /// @return bit i is set where something lies between the ends of ray i
  unsigned occludedPacket(const RayPacket& rays, int count = packet_size) const;

private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};
} // namespace fresco::simulation
