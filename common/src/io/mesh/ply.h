// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
namespace fresco::io {
enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::float32;    ///< of the value or of the items of a list
  std::optional<Scalar> count_type; ///< of the length of a list; nothing: a single value
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool hasList() const;
  std::size_t fixedSize() const; ///< bytes of a row in a binary file, lists taken as empty
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures; ///< image files that comments name, by texture number
  std::size_t size = 0;              ///< bytes up to the first data
};

/// @throws std::runtime_error for 64-bit integers, which PLY does not have
const char* plyTypeName(Scalar type);

/// @throws std::runtime_error if malformed
PlyHeader parsePlyHeader(std::string_view content);

/// Vertices may view the content of the file.
struct PlyContent : MeshTable {
  // With texture only: comments TextureFile as MeshLab, OpenMVS and Metashape write them.
  std::vector<std::string> textures;
  std::vector<float> texcoords; ///< u v of each corner of `faces`, NaN where there is none
  std::vector<int> texnumbers;  ///< of each face
};

/// What is left out is remarked.
/// @throws std::runtime_error if malformed or truncated, without vertices, or if a face names a vertex that is not there
PlyContent parsePly(std::string_view content);
FRESCO_EXPORT PlyContent parseTexturedPly(std::string_view content);

/// Binary little-endian. A sensor pose becomes the element `camera` that PCL reads.
/// @param faces 0 columns: no element `face`
void writePly(const std::string& path, PointTable vertices, const Faces& faces);

/// The same, with part(begin, end) = rows begin .. end - 1: the whole table is never in memory.
void writePly(const std::string& path, Index rows, const std::function<PointTable(Index, Index)>& part,
              const Faces& faces);
} // namespace fresco::io
