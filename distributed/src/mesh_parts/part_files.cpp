// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_parts/open_file.h"
#include "mesh_parts/separate_mesh.h"
#include <cstdio>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/json_text.h>
#include <fresco/io/packing.h>
#include <fresco/io/ply_rows.h>
#include <fresco/io/unfinished_files.h>
#include <nlohmann/json.hpp>
#include <optional>
namespace fresco {
namespace {
using namespace io;
using Json = nlohmann::ordered_json;
using Runs = std::vector<MeshPart::Run>;

/// What the index tells of a file.
struct Entry {
  std::string file; ///< empty: the rank has none
  Index vertices = 0, faces = 0;
  std::array<double, 3> lowest = {}, highest = {};
  Runs vertex_runs, face_runs;
};

template <typename Archive>
void fields(Archive& archive, Entry& entry)
{
  archive(entry.file, entry.vertices, entry.faces, entry.lowest, entry.highest, entry.vertex_runs, entry.face_runs);
}

Entry entryOf(const std::string& path, const SeparateMesh& own, const Runs& faces)
{
  Entry entry;
  const TriangleMesh& mesh = own.mesh;
  if (mesh.vertexCount() == 0)
    return entry;
  entry.file = std::filesystem::path(path).filename().string();
  entry.vertices = mesh.vertexCount();
  entry.faces = mesh.faceCount();
  Eigen::Map<Eigen::Vector3d>(entry.lowest.data()) = mesh.origin + mesh.vertices.rowwise().minCoeff().cast<double>();
  Eigen::Map<Eigen::Vector3d>(entry.highest.data()) = mesh.origin + mesh.vertices.rowwise().maxCoeff().cast<double>();
  entry.vertex_runs = own.vertices;
  entry.face_runs = faces;
  return entry;
}

Json listOf(const Runs& runs)
{
  Json list = Json::array();
  for (const MeshPart::Run& run : runs)
    list.push_back({run.first, run.count});
  return list;
}

std::string indexOf(const MeshPart& whole, const std::vector<Entry>& entries)
{
  Json parts = Json::array();
  for (const Entry& entry : entries)
    if (!entry.file.empty())
      parts.push_back({{"file", entry.file},
                       {"vertices", entry.vertices},
                       {"faces", entry.faces},
                       {"lowest", entry.lowest},
                       {"highest", entry.highest},
                       {"vertex_runs", listOf(entry.vertex_runs)},
                       {"face_runs", listOf(entry.face_runs)}});
  const std::size_t count = parts.size();
  return jsonText(Json{{"format", "fresco mesh parts 1"},
                       {"vertices", whole.vertex_count},
                       {"faces", whole.face_count},
                       {"part_count", count},
                       {"parts", std::move(parts)}},
                  1);
}

/// A file of this rank, or none. The other ranks remove it, too, should this one be killed.
class OwnFile {
public:
  /// By all ranks. @param path empty: none
  OwnFile(const std::string& path, Exchange& ranks)
  {
    awaitAll(ranks); // so that all know the files soon after they are made
    if (!path.empty())
      output_.emplace(path);
    others_ = gatherValues(ranks, output_ ? output_->temporaryPath() : std::string());
    others_[ranks.rank()].clear();
    for (const std::string& other : others_)
      if (!other.empty())
        addUnfinishedFile(other);
    if (output_)
      file_.emplace(path, output_->temporaryPath());
  }
  ~OwnFile()
  {
    for (const std::string& other : others_)
      if (!other.empty())
        dropUnfinishedFile(other);
  }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  void append(std::string_view text)
  {
    file_->write(size_, text.data(), text.size());
    size_ += text.size();
  }
  void finish() const
  {
    if (file_)
      file_->finish();
  }
  void commit()
  {
    if (output_)
      output_->commit();
  }

private:
  std::optional<OutputFile> output_;
  std::optional<OpenFile> file_;
  std::vector<std::string> others_;
  std::uint64_t size_ = 0;
};

void writeWhole(const TriangleMesh& mesh, OwnFile& file)
{
  constexpr Index at_most = Index{1} << 19;
  for (Index begin = 0; begin < mesh.vertexCount(); begin += at_most) {
    const PointTable table = plyRows(verticesToTable(mesh, begin, std::min(begin + at_most, mesh.vertexCount())));
    if (begin == 0)
      file.append(plyHeader(table, mesh.vertexCount(), mesh.faceCount()));
    file.append({reinterpret_cast<const char*>(table.data.data()), table.data.size()});
  }
  for (Index begin = 0; begin < mesh.faceCount(); begin += at_most)
    file.append(plyFaceRows(mesh.faces, begin, std::min(begin + at_most, mesh.faceCount())));
}
} // namespace

std::vector<std::string> meshPartFiles(const std::string& path, int ranks)
{
  const std::string stem = std::filesystem::path(path).replace_extension().string();
  std::vector<std::string> names;
  for (int r = 0; r < ranks; ++r) {
    char number[16];
    std::snprintf(number, sizeof(number), "_%04d", r);
    names.push_back(stem + number + ".ply");
  }
  names.push_back(stem + ".json");
  return names;
}

void writeMeshParts(const std::string& path, const MeshPart& part, Exchange& ranks)
{
  if (extension(path) != ".ply")
    throw std::runtime_error(path + ": several ranks write .ply");
  const std::vector<std::string> names = meshPartFiles(path, ranks.size());
  const bool is_first = ranks.rank() == 0;
  const SeparateMesh own = separateMesh(part, ranks);
  const Entry entry = entryOf(names[ranks.rank()], own, part.faces);
  OwnFile file(entry.file.empty() ? std::string() : names[ranks.rank()], ranks);
  OwnFile index(is_first ? names.back() : std::string(), ranks);
  writeWhole(own.mesh, file);
  file.finish();
  const std::vector<Entry> entries = gatherValues(ranks, entry);
  if (is_first)
    index.append(indexOf(part, entries));
  index.finish();
  awaitAll(ranks);
  file.commit();
  awaitAll(ranks);
  index.commit();
  awaitAll(ranks);
}
} // namespace fresco
