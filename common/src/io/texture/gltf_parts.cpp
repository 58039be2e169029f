// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/gltf_parts.h"
#include <cmath>
namespace fresco::io {
namespace {
/// Linear light of an sRGB byte as 16 bit (IEC 61966-2-1).
std::uint16_t linearLight(std::uint8_t value)
{
  const double s = value / 255.0;
  const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  return std::lround(65535.0 * linear);
}
} // namespace

GltfPartBuilder::GltfPartBuilder(const TexturedMesh& model, const Groups& faces, int atlas)
    : model_(model), faces_(faces), textured_(atlas >= 0), at_(faces.begin[atlas + 1]), end_(faces.begin[atlas + 2])
{
  for (int value = 0; value < 256; ++value)
    linear_[value] = linearLight(value);
}

GltfPart GltfPartBuilder::next(std::size_t most)
{
  part_ = {};
  first_.clear();
  for (; at_ < end_ && places_.size() + 3 <= most; ++at_)
    for (int k = 0, face = faces_.list[at_]; k < 3; ++k)
      part_.indices.push_back(place(model_.mesh.faces(k, face), textured_ ? model_.texcoord_faces(k, face) : -1));
  places_.clear();
  return std::move(part_);
}

std::uint32_t GltfPartBuilder::place(int vertex, int texcoord)
{
  int& first = first_.emplace(vertex, -1).first->second;
  for (int at = first; at >= 0; at = places_[at].next)
    if (places_[at].texcoord == texcoord)
      return at;
  places_.push_back({vertex, texcoord, first});
  first = places_.size() - 1;
  append(vertex, texcoord);
  return first;
}

void GltfPartBuilder::append(int vertex, int texcoord)
{
  const TriangleMesh& mesh = model_.mesh;
  part_.positions.emplace_back(mesh.vertices.col(vertex));
  if (mesh.normals.cols() > 0)
    part_.normals.emplace_back(mesh.normals.col(vertex).normalized());
  if (textured_) {
    part_.texcoords.emplace_back(model_.texcoords(0, texcoord), 1.f - model_.texcoords(1, texcoord));
    if (tangents_)
      part_.tangents.emplace_back(tangents_->col(texcoord));
  } else if (mesh.colors.cols() > 0) {
    part_.colors.emplace_back(linear_[mesh.colors(0, vertex)], linear_[mesh.colors(1, vertex)],
                              linear_[mesh.colors(2, vertex)], std::uint16_t{65535});
  }
}
} // namespace fresco::io
