// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/distributed/mesh_part.h>
#include <fresco/io/packing.h>
namespace fresco {
template <typename Archive>
void fields(Archive& archive, MeshPart::Run& run)
{
  archive(run.first, run.count);
}
} // namespace fresco
namespace fresco::io {
/// A rank's part as a mesh by itself.
struct SeparateMesh {
  TriangleMesh mesh;                   ///< own faces and the vertices that they use
  std::vector<MeshPart::Run> vertices; ///< which of the whole those are, in their order, some of them other ranks' own
};

/// By all ranks. Own vertices that no rank's face uses stay, so that the parts together have every vertex.
SeparateMesh separateMesh(const MeshPart& part, Exchange& ranks);
} // namespace fresco::io
