// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/sensors/ray_scene.h"
#include <embree3/rtcore.h>
#include <fresco/core/require.h>
namespace fresco::simulation {
struct VirtualRays::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Handles()
  {
    if (scene)
      rtcReleaseScene(scene);
    if (device)
      rtcReleaseDevice(device);
  }
};

VirtualRays::VirtualRays(const TriangleMesh& mesh) : handles_(std::make_unique<Handles>())
{
  handles_->device = rtcNewDevice(FRESCO_EMBREE_SETTINGS);
  if (!handles_->device)
    throw std::runtime_error("ray casting: Embree gives no device");
  handles_->scene = rtcNewScene(handles_->device);
  rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                  3 * sizeof(float), static_cast<std::size_t>(mesh.vertexCount())));
  auto* faces =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                     3 * sizeof(unsigned), static_cast<std::size_t>(mesh.faceCount())));
  if (!vertices || !faces) {
    rtcReleaseGeometry(geometry);
    throw std::runtime_error("ray casting: out of memory");
  }
  Eigen::Map<Points>(vertices, 3, mesh.vertexCount()) = mesh.vertices;
  Eigen::Map<Eigen::Matrix<unsigned, 3, Eigen::Dynamic>>(faces, 3, mesh.faceCount()) = mesh.faces.cast<unsigned>();
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(handles_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(handles_->scene);
}

VirtualRays::~VirtualRays() = default;
VirtualRays::VirtualRays(VirtualRays&&) noexcept = default;

VirtualHit VirtualRays::intersect(const Ray& ray) const
{
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = ray.origin.x(), query.ray.org_y = ray.origin.y(), query.ray.org_z = ray.origin.z();
  query.ray.dir_x = ray.direction.x(), query.ray.dir_y = ray.direction.y(), query.ray.dir_z = ray.direction.z();
  query.ray.tfar = ray.far;
  query.ray.mask = ~0u;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(handles_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return {};
  return {static_cast<int>(query.hit.primID), query.ray.tfar, query.hit.u, query.hit.v};
}

namespace {
void fill(RTCRay16& to, const RayPacket& rays, int count)
{
  for (int i = 0; i < packet_size; ++i) {
    const Ray& ray = rays[i < count ? i : 0];
    to.org_x[i] = ray.origin.x(), to.org_y[i] = ray.origin.y(), to.org_z[i] = ray.origin.z();
    to.dir_x[i] = ray.direction.x(), to.dir_y[i] = ray.direction.y(), to.dir_z[i] = ray.direction.z();
    to.tnear[i] = 0.f, to.tfar[i] = ray.far, to.time[i] = 0.f;
    to.mask[i] = ~0u, to.id[i] = static_cast<unsigned>(i), to.flags[i] = 0;
  }
}

struct alignas(64) Lanes {
  int valid[packet_size];
  explicit Lanes(int count)
  {
    for (int i = 0; i < packet_size; ++i)
      valid[i] = i < count ? -1 : 0;
  }
};
} // namespace

HitPacket VirtualRays::intersectPacket(const RayPacket& rays, bool coherent) const
{
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  const Lanes lanes(packet_size);
  alignas(64) RTCRayHit16 query;
  fill(query.ray, rays, packet_size);
  for (int i = 0; i < packet_size; ++i)
    query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect16(lanes.valid, handles_->scene, &context, &query);
  HitPacket hits;
  for (int i = 0; i < packet_size; ++i)
    if (query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID)
      hits[i] = {static_cast<int>(query.hit.primID[i]), query.ray.tfar[i], query.hit.u[i], query.hit.v[i]};
  return hits;
}

unsigned VirtualRays::occludedPacket(const RayPacket& rays, int count) const
{
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const Lanes lanes(count);
  alignas(64) RTCRay16 query;
  fill(query, rays, count);
  rtcOccluded16(lanes.valid, handles_->scene, &context, &query);
  unsigned blocked = 0;
  for (int i = 0; i < count; ++i)
    if (query.tfar[i] < 0.f)
      blocked |= 1u << i;
  return blocked;
}
} // namespace fresco::simulation
