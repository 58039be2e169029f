// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/pcd.h"
#include "io/points/row_file.h"
#include "io/points/text_numbers.h"
#include "io/points/text_table.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <liblzf/lzf.h>
#include <limits>
#include <numeric>
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
  if (v.size() != 7)
    throw std::runtime_error("PCD header: VIEWPOINT needs 7 numbers");
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
  if (fields == 0 || header.sizes.size() != fields || header.types.size() != fields || header.counts.size() != fields)
    throw std::runtime_error("PCD header: FIELDS, SIZE, TYPE and COUNT do not agree");
  constexpr std::uint64_t most = std::numeric_limits<int>::max();
  if (header.width > most || header.height > most || (header.has_points && header.points > most))
    throw std::runtime_error("PCD header: too many points");
  if (!header.has_points)
    header.points = header.width * header.height;
  if (header.width == 0)
    std::tie(header.width, header.height) = std::pair(header.points, std::uint64_t{1});
  if (header.points != header.width * header.height)
    throw std::runtime_error(
        concat("PCD header: POINTS ", header.points, " is not WIDTH ", header.width, " x HEIGHT ", header.height));
  if (header.points == 0)
    throw std::runtime_error("no points");
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
    if (scanner.done())
      throw std::runtime_error("PCD header ends early");
  }
  header.storage = scanner.word();
  scanner.nextLine();
  header.data = content.substr(content.size() - scanner.remaining());
  finishHeader(header);
  return header;
}

Scalar scalarType(char type, std::size_t size)
{
  for (int i = 0; i <= int(Scalar::float64); ++i)
    if (typeLetter(Scalar(i)) == type && scalarSize(Scalar(i)) == size)
      return Scalar(i);
  throw std::runtime_error(concat("PCD header: no type '", type, "' of ", size, " bytes"));
}

struct StoredField {
  std::size_t bytes;          ///< per point
  std::optional<Column> kept; ///< nothing: padding
};

std::vector<StoredField> storedFields(const PcdHeader& header, PointTable& table)
{
  std::vector<StoredField> fields;
  for (std::size_t i = 0; i < header.names.size(); ++i) {
    const std::size_t count = std::max<std::size_t>(header.counts[i], 1);
    if (count > 1U << 20 || header.sizes[i] < 1 || header.sizes[i] > 8)
      throw std::runtime_error("PCD header: SIZE or COUNT is out of range");
    if (header.names[i] == "_") {
      fields.push_back({count * header.sizes[i], std::nullopt});
      continue;
    }
    const Scalar type = scalarType(header.types[i], header.sizes[i]);
    table.addColumn(count == 1 ? standardName(header.names[i]) : header.names[i], type, count);
    fields.push_back({table.columns.back().bytes(), table.columns.back()});
  }
  return fields;
}

std::size_t rowBytes(const std::vector<StoredField>& fields)
{
  return std::accumulate(fields.begin(), fields.end(), std::size_t{0},
                         [](std::size_t sum, const StoredField& field) { return sum + field.bytes; });
}

void checkRows(std::uint64_t points, std::size_t row_bytes, std::size_t available)
{
  if (points > available / row_bytes)
    throw std::runtime_error(
        concat("truncated: ", points, " points of ", row_bytes, " bytes do not fit into ", available, " bytes"));
}

void readBinary(const PcdHeader& header, const std::vector<StoredField>& fields, PointTable& table)
{
  const std::size_t row_bytes = rowBytes(fields);
  checkRows(header.points, row_bytes, header.data.size());
  table.allocate(static_cast<Index>(header.points));
  const char* at = header.data.data();
  if (row_bytes == table.stride) {
    std::memcpy(table.data.data(), at, table.data.size());
    return;
  }
  for (Index row = 0; row < table.rows; ++row)
    for (const StoredField& field : fields) {
      if (field.kept)
        std::memcpy(table.cell(row, *field.kept), at, field.bytes);
      at += field.bytes;
    }
}

/// Field after field: all values of the first, all values of the second ...
void readCompressed(const PcdHeader& header, const std::vector<StoredField>& fields, PointTable& table)
{
  if (header.data.size() < 8)
    throw std::runtime_error("truncated");
  const auto compressed = loadScalar<std::uint32_t>(header.data.data());
  const auto expanded = loadScalar<std::uint32_t>(header.data.data() + 4);
  if (compressed > header.data.size() - 8)
    throw std::runtime_error(concat("truncated: ", compressed, " compressed bytes do not fit"));
  const std::size_t row_bytes = rowBytes(fields);
  // 3 bytes of LZF stand for 264 bytes at most. The sizes are divided, since their product may not fit into 64 bits.
  if (expanded == 0 || expanded / 264 > compressed || expanded % row_bytes != 0 ||
      expanded / row_bytes != header.points)
    throw std::runtime_error("compressed data do not have the size that the header gives");
  std::vector<char> bytes(expanded);
  if (lzf_decompress(header.data.data() + 8, compressed, bytes.data(), expanded) != expanded)
    throw std::runtime_error("compressed data are damaged");
  table.allocate(static_cast<Index>(header.points));
  const char* at = bytes.data();
  for (const StoredField& field : fields)
    for (Index row = 0; row < table.rows; ++row, at += field.bytes)
      if (field.kept)
        std::memcpy(table.cell(row, *field.kept), at, field.bytes);
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

void readAscii(const PcdHeader& header, const std::vector<StoredField>& fields, PointTable& table)
{
  std::size_t words = 0;
  for (std::size_t i = 0; i < fields.size(); ++i)
    words += std::max<std::size_t>(header.counts[i], 1);
  checkRows(header.points, 2 * words, header.data.size() + 1);
  table.allocate(static_cast<Index>(header.points));
  TextScanner scanner(header.data);
  for (Index row = 0; row < table.rows; ++row)
    for (std::size_t i = 0; i < fields.size(); ++i)
      for (std::size_t k = 0; k < std::max<std::size_t>(header.counts[i], 1); ++k) {
        const std::string_view word = scanner.wordAcrossLines();
        if (fields[i].kept)
          parseCell(word, *fields[i].kept, table.cell(row, *fields[i].kept) + k * scalarSize(fields[i].kept->type));
      }
  repackWholeNumbers(table);
}
} // namespace

PointTable parsePcd(std::string_view content)
{
  const PcdHeader header = parseHeader(content);
  PointTable table;
  const std::vector<StoredField> fields = storedFields(header, table);
  if (table.columns.empty())
    throw std::runtime_error("PCD header: no field but padding");
  if (header.storage == "ascii")
    readAscii(header, fields, table);
  else if (header.storage == "binary")
    readBinary(header, fields, table);
  else if (header.storage == "binary_compressed")
    readCompressed(header, fields, table);
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
  const std::vector<StoredField> fields = storedFields(header, layout.table);
  if (layout.table.columns.empty())
    return {};
  layout.table.stride = 0; // as stored, with padding
  std::size_t column = 0;
  for (const StoredField& field : fields) {
    if (field.kept)
      layout.table.columns[column++].offset = layout.table.stride;
    layout.table.stride += field.bytes;
  }
  layout.table.sensor = header.sensor;
  layout.offset = header.data.data() - begin.data();
  layout.rows = header.points;
  return layout;
}
} // namespace fresco::io
