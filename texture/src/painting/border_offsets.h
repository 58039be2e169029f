// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/patch_mesh.h"
#include "views/vertex_views.h"
#include <array>
#include <cstring>
#include <unordered_map>
namespace fresco::texture {
/// Offsets of seam levelling where tiles of a mesh meet: what one tile has found holds for those after it, so that both
/// give the surface between them the same colour.
class BorderOffsets {
public:
  /// Tiles whose offsets are still to be found. @param boxes of the surface of each, with some room
  void setOpen(std::vector<Eigen::AlignedBox3f> boxes) { open_ = std::move(boxes); }
  /// @param patches of the tile in work, the first ones, are its own; the others lie around it
  void setOwn(Index patches) { own_ = patches; }

  /// visit(vertex, number of the share, offset) for what is known of the shares
  template <typename Visit>
  void forKnown(const PatchMesh& patches, const VertexViews& shares, const Visit& visit) const
  {
    for (std::size_t v = 0; v < shares.size() && !known_.empty(); ++v)
      if (const auto at = known_.find(keyOf(patches.vertices.col(v))); at != known_.end())
        for (std::size_t s = 0; s < shares[v].size(); ++s)
          for (const auto& [view, offset] : at->second)
            if (view == shares[v][s].view)
              visit(v, s, offset);
  }

  /// Keeps offset(vertex, number of the share) of the own patches' vertices where tiles that are open want them.
  template <typename Offset>
  void add(const PatchMesh& patches, const VertexViews& shares, const Offset& offset)
  {
    for (Index i = 0; i < 3 * own_; ++i)
      if (const int v = patches.faces.data()[i]; isWanted(patches.vertices.col(v))) {
        auto& list = known_[keyOf(patches.vertices.col(v))];
        for (std::size_t s = 0; s < shares[v].size() && list.size() < shares[v].size(); ++s)
          list.emplace_back(shares[v][s].view, offset(v, s));
      }
  }

private:
  using Key = std::array<std::uint32_t, 3>; ///< bits of the coordinates: all tiles have the same ones

  static Key keyOf(const Eigen::Vector3f& vertex)
  {
    Key key;
    std::memcpy(key.data(), vertex.data(), sizeof key);
    return key;
  }

  struct Hash {
    std::size_t operator()(const Key& key) const
    {
      return (key[0] * 0x9e3779b97f4a7c15u) ^ (key[1] * 0xc2b2ae3d27d4eb4fu) ^ (key[2] * 0x165667b19e3779f9u);
    }
  };

  bool isWanted(const Eigen::Vector3f& vertex) const
  {
    for (const Eigen::AlignedBox3f& box : open_)
      if (box.contains(vertex))
        return true;
    return false;
  }

  std::unordered_map<Key, std::vector<std::pair<int, Eigen::Vector3f>>, Hash> known_;
  std::vector<Eigen::AlignedBox3f> open_;
  Index own_ = 0;
};
} // namespace fresco::texture
