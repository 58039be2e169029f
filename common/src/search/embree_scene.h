// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <atomic>
#if FRESCO_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fresco/core/mesh.h>
namespace fresco::search {
/// What a call that traces rays takes besides them; Embree 3 and 4 differ in nothing else that is used here.
class RayQuery {
public:
  explicit RayQuery(bool coherent)
  {
#if FRESCO_EMBREE_VERSION >= 4
    rtcInitIntersectArguments(&nearest_);
    rtcInitOccludedArguments(&any_);
    nearest_.flags = any_.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
#else
    rtcInitIntersectContext(&context_);
    context_.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
  }

#if FRESCO_EMBREE_VERSION >= 4
  void trace(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &nearest_); }
  void trace(const int* valid, RTCScene scene, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &rays, &nearest_); }
  void trace(const int* valid, RTCScene scene, RTCRayHit16& rays) { rtcIntersect16(valid, scene, &rays, &nearest_); }
  void occlude(const int* valid, RTCScene scene, RTCRay16& rays) { rtcOccluded16(valid, scene, &rays, &any_); }

private:
  RTCIntersectArguments nearest_;
  RTCOccludedArguments any_;
#else
  void trace(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
  void trace(const int* valid, RTCScene scene, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context_, &rays); }
  void trace(const int* valid, RTCScene scene, RTCRayHit16& rays) { rtcIntersect16(valid, scene, &context_, &rays); }
  void occlude(const int* valid, RTCScene scene, RTCRay16& rays) { rtcOccluded16(valid, scene, &context_, &rays); }

private:
  RTCIntersectContext context_;
#endif
};

/// A copy of the triangles of a mesh in a scene of Embree of its own.
class EmbreeScene {
public:
  /// @param threads that build the scene, 0 = all cores
  /// @throws std::runtime_error if memory runs out
  EmbreeScene(const Points& vertices, const Faces& faces, RTCSceneFlags flags, int threads = 0);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return scene_; }
  Index faceCount() const { return face_count_; }
  const int* face(Index f) const { return faces_ + 3 * f; }      ///< its three vertices
  const float* vertex(int v) const { return vertices_ + 3 * v; } ///< x y z
  std::size_t memory() const { return bytes_; }                  ///< bytes held, those of the triangles included

private:
  explicit EmbreeScene(RTCDevice device) : device_(device) {}
  RTCDevice device_;
  RTCScene scene_ = nullptr;
  std::atomic<std::ptrdiff_t> bytes_ = 0;
  Index face_count_ = 0;
  const int* faces_ = nullptr; ///< in Embree's memory, as is the next
  const float* vertices_ = nullptr;
};
} // namespace fresco::search
