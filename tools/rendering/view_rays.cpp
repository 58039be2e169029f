// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/view_rays.h"
#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>
#include <stdexcept>
namespace fresco::rendering {
struct ViewRays::Data {
  RTCDevice device = rtcNewDevice(FRESCO_EMBREE_SETTINGS);
  RTCScene scene = nullptr;
  ~Data()
  {
    if (scene)
      rtcReleaseScene(scene);
    if (device)
      rtcReleaseDevice(device);
  }
};

ViewRays::ViewRays(const TriangleMesh& mesh) : data_(std::make_unique<Data>())
{
  if (!data_->device)
    throw std::runtime_error("Embree does not start (not enough memory?)");
  data_->scene = rtcNewScene(data_->device);
  RTCGeometry geometry = rtcNewGeometry(data_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                  3 * sizeof(float), static_cast<std::size_t>(mesh.vertexCount())));
  auto* faces =
      static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                     3 * sizeof(unsigned), static_cast<std::size_t>(mesh.faceCount())));
  if ((mesh.vertexCount() > 0 && !vertices) || (mesh.faceCount() > 0 && !faces)) {
    rtcReleaseGeometry(geometry);
    throw std::runtime_error("not enough memory for rays in a mesh of that size");
  }
  std::copy_n(mesh.vertices.data(), mesh.vertices.size(), vertices);
  std::copy_n(mesh.faces.data(), mesh.faces.size(), faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(data_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(data_->scene);
}

ViewRays::~ViewRays() = default;

ViewHit ViewRays::trace(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double least) const
{
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(from.x());
  ray.ray.org_y = static_cast<float>(from.y());
  ray.ray.org_z = static_cast<float>(from.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tnear = static_cast<float>(least);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(data_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return {};
  const Eigen::Vector3d normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  return {ray.ray.tfar, normal.dot(direction) < 0};
}

ViewHit ViewRays::traceFront(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const
{
  constexpr int most_layers = 32;
  double least = 0;
  for (int layer = 0; layer < most_layers; ++layer) {
    const ViewHit hit = trace(from, direction, least);
    if (!hit.any() || hit.front)
      return hit;
    least = std::nextafter(static_cast<float>(hit.distance * (1 + 1e-6)), std::numeric_limits<float>::max());
  }
  return {};
}
} // namespace fresco::rendering
