// SPDX-License-Identifier: BSD-3-Clause
#include "search/embree_scene.h"
#include <fresco/search/ray_scene.h>
#include <type_traits>
namespace fresco {
struct RayScene::Embree : search::EmbreeScene {
  using EmbreeScene::EmbreeScene;
};

namespace {
/// Embree ends the program over other rays; they hit nothing.
bool isTraceable(const Ray& ray)
{
  constexpr float most = 1e18f; // Embree's own limit is 1.84e18
  return (ray.origin.array().abs() <= most).all() && (ray.direction.array().abs() <= most).all() && ray.near <= ray.far;
}

/// In the lanes of rays that are not to be traced: where packets are split for narrower processors, Embree traces them all.
const Ray& harmlessRay()
{
  static const Ray ray{{0.f, 0.f, 0.f}, {0.f, 0.f, 1.f}};
  return ray;
}

/// Lane i of Embree's rays, which keep each number of all rays together.
template <typename Lanes>
void setRay(Lanes& lanes, std::size_t i, const Ray& ray)
{
  lanes.org_x[i] = ray.origin.x(), lanes.org_y[i] = ray.origin.y(), lanes.org_z[i] = ray.origin.z();
  lanes.dir_x[i] = ray.direction.x(), lanes.dir_y[i] = ray.direction.y(), lanes.dir_z[i] = ray.direction.z();
  lanes.tnear[i] = ray.near, lanes.tfar[i] = ray.far, lanes.time[i] = 0.f;
  lanes.mask[i] = ~0u, lanes.id[i] = 0, lanes.flags[i] = 0;
}
} // namespace

RayScene::RayScene(const TriangleMesh& mesh, bool watertight)
    : embree_(
          std::make_unique<Embree>(mesh.vertices, mesh.faces, watertight ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE))
{}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

RayHit RayScene::intersect(const Ray& ray) const
{
  if (!isTraceable(ray))
    return {};
  RTCRayHit query{};
  query.ray.org_x = ray.origin.x(), query.ray.org_y = ray.origin.y(), query.ray.org_z = ray.origin.z();
  query.ray.dir_x = ray.direction.x(), query.ray.dir_y = ray.direction.y(), query.ray.dir_z = ray.direction.z();
  query.ray.tnear = ray.near, query.ray.tfar = ray.far;
  query.ray.mask = ~0u;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  search::RayQuery(false).trace(embree_->scene(), query);
  const RTCHit& hit = query.hit;
  if (hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return {};
  return {static_cast<int>(hit.primID), query.ray.tfar, hit.u, hit.v, {hit.Ng_x, hit.Ng_y, hit.Ng_z}};
}

template <std::size_t n>
HitPacket<n> RayScene::intersect(const RayPacket<n>& rays, RayOrder order) const
{
  alignas(64) int valid[n];
  std::conditional_t<n == 8, RTCRayHit8, RTCRayHit16> query;
  for (std::size_t i = 0; i < n; ++i) {
    valid[i] = isTraceable(rays[i]) ? -1 : 0;
    setRay(query.ray, i, valid[i] != 0 ? rays[i] : harmlessRay());
    query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  search::RayQuery(order == RayOrder::coherent).trace(valid, embree_->scene(), query);
  const auto& hit = query.hit;
  HitPacket<n> hits;
  for (std::size_t i = 0; i < n; ++i)
    if (valid[i] != 0 && hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
      hits[i] = {static_cast<int>(hit.primID[i]),
                 query.ray.tfar[i],
                 hit.u[i],
                 hit.v[i],
                 {hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]}};
  return hits;
}

template FRESCO_EXPORT HitPacket<8> RayScene::intersect(const RayPacket<8>&, RayOrder) const;
template FRESCO_EXPORT HitPacket<16> RayScene::intersect(const RayPacket<16>&, RayOrder) const;

unsigned RayScene::occluded(const RayPacket<16>& rays, int count) const
{
  alignas(64) int valid[16];
  RTCRay16 query;
  for (int i = 0; i < 16; ++i) {
    valid[i] = i < count && isTraceable(rays[i]) ? -1 : 0;
    setRay(query, i, valid[i] != 0 ? rays[i] : harmlessRay());
  }
  search::RayQuery(true).occlude(valid, embree_->scene(), query);
  unsigned blocked = 0;
  for (int i = 0; i < count; ++i)
    if (valid[i] != 0 && query.tfar[i] < 0.f)
      blocked |= 1u << i;
  return blocked;
}
} // namespace fresco
