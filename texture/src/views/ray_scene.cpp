// SPDX-License-Identifier: BSD-3-Clause
#include "views/ray_scene.h"
#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>
#include <limits>
#include <stdexcept>
namespace fresco::texture {
namespace {
constexpr int packet = 8;

void* newBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, Index count)
{
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, 12, static_cast<std::size_t>(count));
  if (!buffer)
    throw std::runtime_error("ray casting: out of memory");
  return buffer;
}

/// Rays through cells x .. x+7 of row y.
void aim(const Projector& view, const DepthMap& map, Eigen::Vector2i cell, RTCRayHit8& rays)
{
  const Eigen::Vector3f from = view.center();
  for (int i = 0; i < packet; ++i) {
    const Eigen::Vector3f d =
        view.ray({(std::min(cell.x() + i, map.width - 1) + 0.5) * map.step, (cell.y() + 0.5) * map.step});
    rays.ray.org_x[i] = from.x();
    rays.ray.org_y[i] = from.y();
    rays.ray.org_z[i] = from.z();
    rays.ray.dir_x[i] = d.x();
    rays.ray.dir_y[i] = d.y();
    rays.ray.dir_z[i] = d.z();
    rays.ray.tnear[i] = 0.f;
    rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
    rays.ray.time[i] = 0.f;
    rays.ray.mask[i] = ~0u;
    rays.ray.id[i] = rays.ray.flags[i] = 0;
    rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}
/// select() over the square of `radius` cells around each cell.
template <typename Select>
DepthMap selectWithin(const DepthMap& map, int radius, const Select& select)
{
  DepthMap rows = map, out;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      float& value = rows.depth[static_cast<std::size_t>(y) * map.width + x];
      for (int i = std::max(0, x - radius); i <= std::min(map.width - 1, x + radius); ++i)
        value = select(value, map.at(i, y));
    }
  out = rows;
  for (int y = 0; y < map.height; ++y)
    for (int j = std::max(0, y - radius); j <= std::min(map.height - 1, y + radius); ++j)
      for (int x = 0; x < map.width; ++x) {
        float& value = out.depth[static_cast<std::size_t>(y) * map.width + x];
        value = select(value, rows.at(x, j));
      }
  return out;
}
} // namespace

struct RayScene::Embree {
  RTCDevice device = rtcNewDevice(FRESCO_EMBREE_SETTINGS);
  RTCScene scene = device ? rtcNewScene(device) : nullptr;
  Embree()
  {
    if (!scene)
      throw std::runtime_error("ray casting: Embree does not start (not enough memory?)");
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Embree()
  {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const TriangleMesh& mesh) : embree_(std::make_unique<Embree>())
{
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices =
      static_cast<float*>(newBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertexCount()));
  std::copy_n(mesh.vertices.data(), mesh.vertices.size(), vertices);
  auto* faces = static_cast<unsigned*>(newBuffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.faceCount()));
  std::copy_n(mesh.faces.data(), mesh.faces.size(), faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree_->scene);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;

DepthMap RayScene::depthMap(const Projector& view, Index most_cells) const
{
  DepthMap map;
  const double pixels = static_cast<double>(view.camera().width) * view.camera().height;
  map.step = static_cast<float>(std::max(1.0, std::sqrt(pixels / static_cast<double>(most_cells))));
  map.width = static_cast<int>(std::ceil(view.camera().width / map.step));
  map.height = static_cast<int>(std::ceil(view.camera().height / map.step));
  map.depth.resize(static_cast<std::size_t>(map.width) * map.height);
  alignas(32) const int valid[packet] = {-1, -1, -1, -1, -1, -1, -1, -1};
  RTCRayHit8 rays;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; x += packet) {
      aim(view, map, {x, y}, rays);
      rtcIntersect8(valid, embree_->scene, &context, &rays);
      std::copy_n(rays.ray.tfar, std::min(packet, map.width - x),
                  map.depth.begin() + static_cast<std::ptrdiff_t>(y) * map.width + x);
    }
  return map;
}

RayHit RayScene::cast(const Eigen::Vector3f& from, const Eigen::Vector3f& direction) const
{
  RTCRayHit ray{};
  ray.ray.org_x = from.x();
  ray.ray.org_y = from.y();
  ray.ray.org_z = from.z();
  ray.ray.dir_x = direction.x();
  ray.ray.dir_y = direction.y();
  ray.ray.dir_z = direction.z();
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene, &context, &ray);
  return {ray.ray.tfar, ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : static_cast<int>(ray.hit.primID)};
}

DepthMap nearestWithin(const DepthMap& map, int radius)
{
  return selectWithin(map, radius, [](float a, float b) { return std::min(a, b); });
}

DepthMap farthestWithin(const DepthMap& map, int radius)
{
  return selectWithin(map, radius, [](float a, float b) { return std::max(a, b); });
}
} // namespace fresco::texture
