// SPDX-License-Identifier: BSD-3-Clause
#include "search/embree_scene.h"
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
namespace fresco::search {
namespace {
[[noreturn]] void failForMemory() { throw std::runtime_error("ray casting: Embree runs out of memory"); }

struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using Geometry = std::unique_ptr<RTCGeometryTy, GeometryRelease>;

/// Copies a matrix of three rows to a new buffer of the geometry.
template <typename Matrix>
const typename Matrix::Scalar* fillBuffer(const Geometry& geometry, RTCBufferType type, RTCFormat format,
                                          const Matrix& columns)
{
  using Scalar = typename Matrix::Scalar;
  void* buffer = rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, 3 * sizeof(Scalar), columns.cols());
  if (!buffer && columns.cols() > 0)
    failForMemory();
  std::copy_n(columns.data(), columns.size(), static_cast<Scalar*>(buffer));
  return static_cast<const Scalar*>(buffer);
}

RTCDevice newDevice(int threads)
{
  const char* settings = FRESCO_EMBREE_SETTINGS;
  const std::string own = "threads=" + std::to_string(threads);
  return rtcNewDevice(settings || threads == 0 ? settings : own.c_str());
}

bool countBytes(void* sum, ssize_t bytes, bool)
{
  *static_cast<std::atomic<std::ptrdiff_t>*>(sum) += bytes;
  return true;
}
} // namespace

EmbreeScene::EmbreeScene(const Points& vertices, const Faces& faces, RTCSceneFlags flags, int threads)
    : EmbreeScene(newDevice(threads)) // so that errors from here on end in the destructor, too
{
  if (!device_)
    failForMemory();
  rtcSetDeviceMemoryMonitorFunction(device_, countBytes, &bytes_);
  scene_ = rtcNewScene(device_);
  if (!scene_)
    failForMemory();
  rtcSetSceneFlags(scene_, flags);
  const Geometry geometry(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE));
  vertices_ = fillBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices);
  faces_ = fillBuffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, faces);
  face_count_ = faces.cols();
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_, geometry.get());
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) == RTC_ERROR_OUT_OF_MEMORY)
    failForMemory();
}

EmbreeScene::~EmbreeScene()
{
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}
} // namespace fresco::search
