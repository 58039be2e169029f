// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/point_formats.h"
#include "io/points/row_file.h"
#include "io/points/text_numbers.h"
#include "io/points/text_table.h"
#include <algorithm>
#include <liblzf/lzf.h>
#include <limits>
namespace fresco::io {
namespace {
struct PcdHeader {
  std::vector<std::string> names;
  std::vector<std::size_t> sizes, counts;
  std::vector<char> types;
  std::uint64_t width = 0, height = 1, points = 0;
  bool has_points = false;
  std::optional<SensorPose> sensor;
  std::string_view storage;
  std::string_view data;
};

/// parse(word) of the rest of a line.
template <typename Parse>
auto parseWords(TextScanner& scanner, const Parse& parse)
{
  std::vector<decltype(parse(std::string_view()))> values;
  for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word())
    values.push_back(parse(word));
  return values;
}

SensorPose parseViewpoint(TextScanner& scanner)
{
  const std::vector<double> v = parseWords(scanner, parseNumber<double>);
  expect(v.size() == 7, "PCD header: VIEWPOINT needs 7 numbers");
  SensorPose pose;
  pose.position = {v[0], v[1], v[2]};
  pose.orientation = Eigen::Quaterniond(v[3], v[4], v[5], v[6]).cast<float>();
  return pose;
}

void parseEntry(std::string_view keyword, TextScanner& scanner, PcdHeader& header)
{
  if (keyword == "FIELDS" || keyword == "COLUMNS")
    header.names = parseWords(scanner, [](std::string_view word) { return std::string(word); });
  else if (keyword == "SIZE")
    header.sizes = parseWords(scanner, parseNumber<std::uint64_t>);
  else if (keyword == "TYPE")
    header.types = parseWords(scanner, [](std::string_view word) { return word.size() == 1 ? word[0] : '?'; });
  else if (keyword == "COUNT")
    header.counts = parseWords(scanner, parseNumber<std::uint64_t>);
  else if (keyword == "WIDTH")
    header.width = parseNumber<std::uint64_t>(scanner.word());
  else if (keyword == "HEIGHT")
    header.height = parseNumber<std::uint64_t>(scanner.word());
  else if (keyword == "VIEWPOINT")
    header.sensor = parseViewpoint(scanner);
  else if (keyword == "POINTS") {
    header.points = parseNumber<std::uint64_t>(scanner.word());
    header.has_points = true;
  } else if (keyword != "VERSION" && !keyword.empty() && keyword[0] != '#')
    throw std::runtime_error(concat("PCD header: unknown entry '", keyword.substr(0, 40), "'"));
}

void finishHeader(PcdHeader& header)
{
  const std::size_t fields = header.names.size();
  if (header.sizes.empty()) // version 0.5
    header.sizes.assign(fields, 4);
  if (header.types.empty())
    header.types.assign(fields, 'F');
  if (header.counts.empty())
    header.counts.assign(fields, 1);
  expect(fields > 0 && header.sizes.size() == fields && header.types.size() == fields && header.counts.size() == fields,
         "PCD header: FIELDS, SIZE, TYPE and COUNT do not agree");
  constexpr std::uint64_t most = std::numeric_limits<int>::max();
  expect(header.width <= most && header.height <= most && (!header.has_points || header.points <= most),
         "PCD header: too many points");
  if (!header.has_points)
    header.points = header.width * header.height;
  if (header.width == 0)
    std::tie(header.width, header.height) = std::pair(header.points, std::uint64_t{1});
  expect(header.points == header.width * header.height, "PCD header: POINTS ", header.points, " is not WIDTH ",
         header.width, " x HEIGHT ", header.height);
  expect(header.points > 0, "no points");
}

PcdHeader parseHeader(std::string_view content)
{
  TextScanner scanner(content);
  PcdHeader header;
  for (;; scanner.nextLine()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "DATA")
      break;
    parseEntry(keyword, scanner, header);
    expect(!scanner.done(), "PCD header ends early");
  }
  header.storage = scanner.word();
  scanner.nextLine();
  header.data = content.substr(content.size() - scanner.remaining());
  finishHeader(header);
  return header;
}

/// What PCD calls a type: 'F', 'I' or 'U'.
char typeLetter(Scalar type)
{
  return visitScalar(type, [](auto zero) {
    using T = decltype(zero);
    return std::is_floating_point_v<T> ? 'F' : std::is_signed_v<T> ? 'I' : 'U';
  });
}

Scalar scalarType(char type, std::size_t size)
{
  for (int i = 0; i <= int(Scalar::float64); ++i)
    if (typeLetter(Scalar(i)) == type && scalarSize(Scalar(i)) == size)
      return Scalar(i);
  throw std::runtime_error(concat("PCD header: no type '", type, "' of ", size, " bytes"));
}

constexpr const char* padding = "_";

bool isKept(const Column& column) { return column.name != padding; }

/// The columns of a row as they are stored, padding among them.
PointTable storedRows(const PcdHeader& header)
{
  PointTable stored, kept; // the second for names and types
  for (std::size_t i = 0; i < header.names.size(); ++i) {
    const std::size_t count = std::max<std::size_t>(header.counts[i], 1);
    expect(count <= 1U << 20 && header.sizes[i] >= 1 && header.sizes[i] <= 8,
           "PCD header: SIZE or COUNT is out of range");
    Column column{padding, Scalar::uint8, count * header.sizes[i]};
    if (header.names[i] != padding) {
      kept.addColumn(count == 1 ? standardName(header.names[i]) : header.names[i],
                     scalarType(header.types[i], header.sizes[i]), count);
      column = kept.columns.back();
    }
    column.offset = stored.stride;
    stored.columns.push_back(column);
    stored.stride += column.bytes();
  }
  expect(!kept.columns.empty(), "PCD header: no field but padding");
  return stored;
}

void readBinary(const PcdHeader& header, PointTable& stored, PointTable& table)
{
  expectRows(header.points, stored.stride, header.data.size());
  table.allocate(static_cast<Index>(header.points));
  stored.rows = table.rows;
  stored.view = reinterpret_cast<const std::uint8_t*>(header.data.data());
  if (stored.stride == table.stride)
    std::memcpy(table.data.data(), stored.view, table.data.size());
  else
    copyRows(stored, table);
}

/// Field after field: all values of the first, all values of the second ...
void readCompressed(const PcdHeader& header, const PointTable& stored, PointTable& table)
{
  expect(header.data.size() >= 8, "truncated");
  const auto compressed = loadScalar<std::uint32_t>(header.data.data());
  const auto expanded = loadScalar<std::uint32_t>(header.data.data() + 4);
  expect(compressed <= header.data.size() - 8, "truncated: ", compressed, " compressed bytes do not fit");
  // 3 bytes of LZF stand for 264 bytes at most. The sizes are divided, since their product may not fit into 64 bits.
  expect(expanded > 0 && expanded / 264 <= compressed && expanded % stored.stride == 0 &&
             expanded / stored.stride == header.points,
         "compressed data do not have the size that the header gives");
  std::vector<char> bytes(expanded);
  expect(lzf_decompress(header.data.data() + 8, compressed, bytes.data(), expanded) == expanded,
         "compressed data are damaged");
  table.allocate(static_cast<Index>(header.points));
  const char* at = bytes.data();
  for (const Column& field : stored.columns) {
    const Column* const kept = table.find(field.name);
    for (Index row = 0; row < table.rows; ++row, at += field.bytes())
      if (kept)
        std::memcpy(table.cell(row, *kept), at, field.bytes());
  }
}

void parseCell(std::string_view word, const Column& column, std::uint8_t* at)
{
  const bool packed = column.name == "rgb" || column.name == "rgba";
  visitScalar(column.type, [&](auto zero) {
    using T = decltype(zero);
    T value{};
    if constexpr (std::is_integral_v<T> && sizeof(T) == 4)
      value = packed ? static_cast<T>(parseNumber<std::int64_t>(word)) : parseNumber<T>(word); // signed or not
    else
      value = parseNumber<T>(word);
    std::memcpy(at, &value, sizeof(value));
  });
}

void readAscii(const PcdHeader& header, const PointTable& stored, PointTable& table)
{
  const auto wordsOf = [&](std::size_t field) { return std::max<std::size_t>(header.counts[field], 1); };
  std::vector<const Column*> kept; // nullptr: padding
  std::size_t words = 0;
  for (const Column& field : stored.columns) {
    words += wordsOf(kept.size());
    kept.push_back(table.find(field.name));
  }
  expectRows(header.points, 2 * words, header.data.size() + 1);
  table.allocate(static_cast<Index>(header.points));
  TextScanner scanner(header.data);
  for (Index row = 0; row < table.rows; ++row)
    for (std::size_t i = 0; i < kept.size(); ++i)
      for (std::size_t k = 0; k < wordsOf(i); ++k) {
        const std::string_view word = scanner.wordAcrossLines();
        if (kept[i])
          parseCell(word, *kept[i], table.cell(row, *kept[i]) + k * scalarSize(kept[i]->type));
      }
  repackWholeNumbers(table);
}

std::string headerText(const PointTable& table, bool compressed)
{
  std::string fields, sizes, types, counts, viewpoint;
  for (const Column& column : table.columns) {
    fields += " " + singleWord(column.name);
    sizes += textOf(' ', scalarSize(column.type));
    types += textOf(' ', typeLetter(column.type));
    counts += textOf(' ', column.count);
  }
  if (table.sensor) {
    const auto& [position, q] = *table.sensor;
    viewpoint = "\nVIEWPOINT";
    for (const double value : position)
      viewpoint += " " + numberText(value);
    for (const float value : {q.w(), q.x(), q.y(), q.z()})
      viewpoint += " " + numberText(value);
  }
  const bool organised = table.height > 0;
  return textOf("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS", fields, "\nSIZE", sizes, "\nTYPE",
                types, "\nCOUNT", counts, "\nWIDTH ", organised ? table.width : table.rows, "\nHEIGHT ",
                organised ? table.height : 1, viewpoint, "\nPOINTS ", table.rows, "\nDATA ",
                compressed ? "binary_compressed" : "binary", '\n');
}

/// Two sizes and the data, column after column. Empty if they do not become smaller or are too large for the format.
std::string compressColumns(const PointTable& table)
{
  if (table.data.size() > std::numeric_limits<int>::max())
    return {};
  std::vector<char> columns;
  columns.reserve(table.data.size());
  for (const Column& column : table.columns)
    for (Index row = 0; row < table.rows; ++row) {
      const char* cell = reinterpret_cast<const char*>(table.cell(row, column));
      columns.insert(columns.end(), cell, cell + column.bytes());
    }
  const auto expanded = static_cast<std::uint32_t>(columns.size());
  std::string packed(8 + columns.size(), '\0');
  const std::uint32_t size = lzf_compress(columns.data(), expanded, packed.data() + 8, expanded);
  if (size == 0)
    return {};
  std::memcpy(packed.data(), &size, 4);
  std::memcpy(packed.data() + 4, &expanded, 4);
  packed.resize(8 + size);
  return packed;
}
} // namespace

PointTable parsePcd(std::string_view content)
{
  const PcdHeader header = parseHeader(content);
  PointTable stored = storedRows(header), table;
  addColumns(stored, table, isKept);
  if (header.storage == "ascii")
    readAscii(header, stored, table);
  else if (header.storage == "binary")
    readBinary(header, stored, table);
  else if (header.storage == "binary_compressed")
    readCompressed(header, stored, table);
  else
    throw std::runtime_error(concat("PCD header: unknown DATA '", header.storage.substr(0, 40), "'"));
  table.sensor = header.sensor;
  if (header.height > 1)
    std::tie(table.width, table.height) =
        std::pair(static_cast<Index>(header.width), static_cast<Index>(header.height));
  return table;
}

std::optional<RowLayout> pcdRows(std::string_view begin)
{
  const PcdHeader header = parseHeader(begin);
  if (header.storage != "binary")
    return {};
  RowLayout layout;
  layout.table = storedRows(header);
  auto& columns = layout.table.columns;
  columns.erase(std::remove_if(columns.begin(), columns.end(), [](const Column& c) { return !isKept(c); }),
                columns.end());
  layout.table.sensor = header.sensor;
  layout.offset = header.data.data() - begin.data();
  layout.rows = header.points;
  return layout;
}

void writePcd(const std::string& path, const PointTable& table, bool compressed)
{
  const std::string packed = compressed ? compressColumns(table) : std::string();
  OutputFile file(path);
  file.write(headerText(table, !packed.empty()));
  if (packed.empty())
    file.write(table.data.data(), table.data.size());
  else
    file.write(packed);
  file.commit();
}
} // namespace fresco::io
