// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/exchange.h>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <string>
#include <vector>
namespace fresco {
/// A rank's part of a mesh that several ranks hold together.
struct MeshPart {
  /// Consecutive in the whole.
  struct Run {
    Index first = 0, count = 0;
  };
  const TriangleMesh& mesh;               ///< own vertices with attributes, own faces of vertices of the whole
  std::vector<Run> vertices, faces;       ///< where those lie in the whole, in their order
  Index vertex_count = 0, face_count = 0; ///< of the whole
};

/// The file that writeMesh() writes of the whole, whole or absent. Each rank writes its part into it, so all of them must
/// see its folder.
/// @throws std::runtime_error "PATH: reason" if it is no .ply or cannot be written
FRESCO_EXPORT void writeMeshPart(const std::string& path, const MeshPart& part, Exchange& ranks);

/// Files of writeMeshParts() for OUT.ply: OUT_0000.ply ... by rank, then OUT.json.
FRESCO_EXPORT std::vector<std::string> meshPartFiles(const std::string& path, int ranks);

/// Each rank writes its part as a mesh by itself: its faces and the vertices they use. Ranks without any write none.
/// Rank 0 writes the index, which tells how the files make up the whole again: docs/distributed.md. All of them are
/// there in the end, or none.
/// @throws std::runtime_error as writeMeshPart()
FRESCO_EXPORT void writeMeshParts(const std::string& path, const MeshPart& part, Exchange& ranks);
} // namespace fresco
