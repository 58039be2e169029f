// SPDX-License-Identifier: BSD-3-Clause
#include "answer/pair_memory.h"
#include "graph/scan_exchange.h"
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/io/byte_hash.h>
namespace fresco::registration {
namespace {
constexpr char version[] = "fresco pairs 4"; // to be changed with what is packed, and with what decides

std::string heading(const std::string& key, const std::string& content)
{
  return concat(version, "\n", key, "\n", hashBytes(content.data(), content.size()), "\n");
}
} // namespace

template <typename Archive>
void fields(Archive& archive, GlobalAlignment& alignment)
{
  archive(alignment.graph, alignment.pairs, alignment.signs, alignment.distrusted, alignment.aliases,
          alignment.people_moved);
}

std::string memoryKey(const ScanSurvey& survey, const std::vector<Pose>& start, const ScanRegistrationOptions& options)
{
  Packer packer;
  for (ScanSketch scan : survey.scans)
    packer(scan.hash, scan.look, scan.size, scan.problem);
  for (Pose pose : start)
    packer(pose);
  float voxel = options.voxel, min_overlap = options.min_overlap, max_violation = options.max_violation;
  bool upright = options.upright;
  packer(voxel, min_overlap, max_violation, upright);
  const Exchange::Bytes bytes = packer.take();
  return concat(survey.scans.size(), " ", hashBytes(bytes.data(), bytes.size()));
}

std::string packAlignment(GlobalAlignment alignment, const std::string& key)
{
  Packer packer;
  packer(alignment);
  const Exchange::Bytes bytes = packer.take();
  std::string content(bytes.size(), '\0');
  std::memcpy(content.data(), bytes.data(), bytes.size());
  return heading(key, content) + content;
}

std::optional<GlobalAlignment> unpackAlignment(const std::string& bytes, const std::string& key)
{
  std::size_t begin = 0;
  for (int line = 0; line < 3 && begin != std::string::npos; ++line)
    begin = bytes.find('\n', begin + (line > 0 ? 1 : 0));
  if (begin == std::string::npos)
    return std::nullopt;
  const std::string content = bytes.substr(begin + 1);
  if (bytes.substr(0, begin + 1) != heading(key, content))
    return std::nullopt;
  Exchange::Bytes packed(content.size());
  std::memcpy(packed.data(), content.data(), content.size());
  Unpacker unpacker(packed);
  GlobalAlignment alignment;
  unpacker(alignment);
  return alignment;
}
} // namespace fresco::registration
