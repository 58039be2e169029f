// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <atomic>
#include <embree3/rtcore.h>
#include <fresco/core/mesh.h>
namespace fresco::search {
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
  void commit(const Points& vertices, const Faces& faces, RTCSceneFlags flags);
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<std::ptrdiff_t> bytes_ = 0;
  Index face_count_ = 0;
  const int* faces_ = nullptr; ///< in Embree's memory, as is the next
  const float* vertices_ = nullptr;
};
} // namespace fresco::search
