// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_parts/open_file.h"
#include <algorithm>
#include <fresco/distributed/mesh_part.h>
#include <fresco/io/file.h>
#include <fresco/io/packing.h>
#include <fresco/io/ply_rows.h>
#include <fresco/io/unfinished_files.h>
#include <optional>
namespace fresco {
namespace {
using namespace io;

/// A temporary file that rank 0 has made, opened by all.
class SharedFile {
public:
  SharedFile(const std::string& path, Exchange& ranks)
  {
    if (ranks.rank() == 0)
      own_.emplace(path);
    temporary_ = gatherValues(ranks, own_ ? own_->temporaryPath() : std::string())[0];
    if (!own_)
      addUnfinishedFile(temporary_); // rank 0 may be killed
    file_.emplace(path, temporary_);
  }
  ~SharedFile()
  {
    if (!own_)
      dropUnfinishedFile(temporary_);
  }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  void write(std::uint64_t offset, const void* data, std::size_t bytes) const { file_->write(offset, data, bytes); }

  /// By all ranks.
  void commit(Exchange& ranks)
  {
    file_->finish();
    awaitAll(ranks);
    if (own_)
      own_->commit();
    awaitAll(ranks);
  }

private:
  std::string temporary_;
  std::optional<OutputFile> own_;
  std::optional<OpenFile> file_;
};

/// What is alike on all ranks that have a vertex.
struct Layout {
  std::string header;
  std::size_t row = 0; ///< bytes of a vertex, 0 = this rank has none
};

template <typename Archive>
void fields(Archive& archive, Layout& layout)
{
  archive(layout.header, layout.row);
}

Layout layoutOf(const MeshPart& part)
{
  const PointTable table = plyRows(verticesToTable(part.mesh, 0, std::min<Index>(1, part.mesh.vertexCount())));
  return {plyHeader(table, part.vertex_count, part.face_count), table.data.size()};
}

/// write(own, whole, count) for pieces of the runs: the first own item, the first of the whole.
template <typename Write>
void forPieces(const std::vector<MeshPart::Run>& runs, const Write& write)
{
  constexpr Index at_most = Index{1} << 19;
  Index own = 0;
  for (const MeshPart::Run& run : runs)
    for (Index done = 0; done < run.count; done += at_most) {
      const Index count = std::min(at_most, run.count - done);
      write(own, run.first + done, count);
      own += count;
    }
}
} // namespace

void writeMeshPart(const std::string& path, const MeshPart& part, Exchange& ranks)
{
  if (extension(path) != ".ply")
    throw std::runtime_error(path + ": several ranks write .ply");
  const std::vector<Layout> layouts = gatherValues(ranks, layoutOf(part));
  auto layout = std::find_if(layouts.begin(), layouts.end(), [](const Layout& some) { return some.row > 0; });
  if (layout == layouts.end())
    layout = layouts.begin(); // a mesh without vertices
  SharedFile file(path, ranks);
  const std::uint64_t begin = layout->header.size(), faces = begin + layout->row * part.vertex_count;
  if (ranks.rank() == 0)
    file.write(0, layout->header.data(), begin);
  forPieces(part.vertices, [&](Index own, Index whole, Index count) {
    const PointTable table = plyRows(verticesToTable(part.mesh, own, own + count));
    file.write(begin + layout->row * whole, table.data.data(), table.data.size());
  });
  forPieces(part.faces, [&](Index own, Index whole, Index count) {
    const std::string rows = plyFaceRows(part.mesh.faces, own, own + count);
    file.write(faces + rows.size() / count * whole, rows.data(), rows.size());
  });
  file.commit(ranks);
}
} // namespace fresco
