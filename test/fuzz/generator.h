// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
namespace fresco::fuzz {
/// A file in its parts: lines of a header, sections, blocks of data. What keeps them together (lengths, offsets) is
/// added by packed(), so that a file with a broken part gets as far as that part.
struct GeneratedFile {
  enum class Kind {
    plain,
    glb, ///< the last part is the buffer, the others are the JSON
    e57  ///< header and sections, then the lines of the XML
  };
  std::vector<std::string> parts;
  Kind kind = Kind::plain;

  std::string packed() const;
};

/// A random valid input of a target; no parts if the target has no generator.
GeneratedFile generated(const std::string& target, std::uint32_t seed);

/// One thing of the file is broken: a part is lost, doubled or in another place, a number is another, a word stands where
/// another should, bytes are overwritten, or the end is missing.
std::string broken(GeneratedFile file, std::uint32_t seed);

/// The same of any input: its lines are its parts.
std::string broken(std::string_view input, std::uint32_t seed);
} // namespace fresco::fuzz
