// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/e57/paged_file.h"
#include <array>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
#include <optional>
#include <string>
#include <vector>
namespace fresco::io::e57 {
/// One value of every record of a compressed vector.
struct Field {
  enum class Type { integer, scaled_integer, single_float, double_float, string };
  std::string name; ///< without the prefix of an extension
  bool own = false; ///< of fresco's extension: a column of that name
  Type type = Type::double_float;
  std::int64_t minimum = 0, maximum = 0; ///< of what is stored, for integers
  double scale = 1, offset = 0;          ///< value = stored * scale + offset, for scaled integers

  bool isInteger() const { return type == Type::integer || type == Type::scaled_integer; }
  int bits() const; ///< of a record; 0 for strings
};

/// Records in a section of the file.
struct CompressedVector {
  std::uint64_t physical_offset = 0;
  std::uint64_t count = 0; ///< records
  std::vector<Field> fields;

  std::optional<std::size_t> find(std::string_view name) const; ///< index of the field
};

struct Limits {
  double minimum = 0, maximum = 0;
};

/// One child of data3D.
struct Scan {
  ScanInfo info; ///< points = records
  std::string guid;
  CompressedVector records;
  std::array<std::optional<Limits>, 3> color; ///< red, green, blue; nothing: as the type of the field says
};

/// Bytes in a section of the file.
struct Blob {
  std::uint64_t physical_offset = 0, length = 0;
};

struct Image {
  ScanImage description;
  Blob picture;
  std::optional<Blob> mask;
};

/// What the XML section says.
struct Content {
  std::vector<Scan> scans; ///< one that cannot be read has no points
  std::vector<Image> images;
  std::vector<std::string> errors; ///< scans and pictures that cannot be read, and pages with a wrong checksum
  bool is_doubtful = false;        ///< such pages: scans count if their points fit what is said of them, bit by bit
};

/// @throws std::runtime_error if there is no such section, or it is no XML
Content parseContent(PagedFile& file);
} // namespace fresco::io::e57
