// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/mesh/ply.h"
#include "io/points/text_numbers.h"
#include <algorithm>
namespace fresco::io {
namespace {
constexpr struct {
  const char *name, *other;
  Scalar type;
} types[] = {{"char", "int8", Scalar::int8},        {"uchar", "uint8", Scalar::uint8},
             {"short", "int16", Scalar::int16},     {"ushort", "uint16", Scalar::uint16},
             {"int", "int32", Scalar::int32},       {"uint", "uint32", Scalar::uint32},
             {"float", "float32", Scalar::float32}, {"double", "float64", Scalar::float64}};

Scalar parseType(std::string_view word)
{
  for (const auto& known : types)
    if (word == known.name || word == known.other)
      return known.type;
  throw std::runtime_error(concat("PLY header: unknown type '", word.substr(0, 40), "'"));
}

bool isInteger(Scalar type) { return type != Scalar::float32 && type != Scalar::float64; }

PlyFormat parseFormat(std::string_view word)
{
  if (word == "ascii")
    return PlyFormat::ascii;
  if (word == "binary_little_endian")
    return PlyFormat::little_endian;
  if (word == "binary_big_endian")
    return PlyFormat::big_endian;
  throw std::runtime_error(concat("PLY header: unknown format '", word.substr(0, 40), "'"));
}

PlyProperty parseProperty(TextScanner& scanner)
{
  PlyProperty property;
  std::string_view word = scanner.word();
  if (word == "list") {
    property.count_type = parseType(scanner.word());
    expect(isInteger(*property.count_type), "PLY header: length of a list is no integer");
    word = scanner.word();
  }
  property.type = parseType(word);
  property.name = scanner.word();
  expect(!property.name.empty(), "PLY header: property without a name");
  return property;
}

PlyElement parseElement(TextScanner& scanner)
{
  PlyElement element;
  element.name = scanner.word();
  element.count = parseNumber<std::uint64_t>(scanner.word());
  return element;
}

/// One line of the header. @return false at its end
bool parseLine(TextScanner& scanner, PlyHeader& header, bool& has_format)
{
  const std::string_view keyword = scanner.word();
  if (keyword == "end_header")
    return false;
  if (keyword == "format") {
    header.format = parseFormat(scanner.word());
    has_format = true;
  } else if (keyword == "element") {
    header.elements.push_back(parseElement(scanner));
  } else if (keyword == "property") {
    expect(!header.elements.empty(), "PLY header: property before any element");
    header.elements.back().properties.push_back(parseProperty(scanner));
  } else if (keyword == "comment") {
    if (scanner.word() == "TextureFile")
      header.textures.emplace_back(scanner.restOfLineInPlace());
  } else if (keyword != "obj_info" && !keyword.empty()) {
    remark(concat("PLY header: a line is left out: '", keyword.substr(0, 40), "'"));
  }
  return true;
}
} // namespace

const char* plyTypeName(Scalar type)
{
  for (const auto& known : types)
    if (known.type == type)
      return known.name;
  throw std::runtime_error("PLY has no 64-bit integers");
}

bool PlyElement::hasList() const
{
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.count_type.has_value(); });
}

std::size_t PlyElement::fixedSize() const
{
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += scalarSize(property.count_type.value_or(property.type));
  return bytes;
}

PlyHeader parsePlyHeader(std::string_view content)
{
  TextScanner scanner(content);
  expect(scanner.restOfLine() == "ply", "not a PLY file");
  PlyHeader header;
  bool has_format = false;
  while (parseLine(scanner, header, has_format)) {
    scanner.nextLine();
    expect(!scanner.done(), "PLY header ends early");
  }
  expect(has_format, "PLY header: no format");
  scanner.nextLine();
  header.size = content.size() - scanner.remaining();
  return header;
}
} // namespace fresco::io
