// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/mesh/ply.h"
#include "io/points/row_file.h"
#include "io/points/text_numbers.h"
#include "io/points/text_table.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/polygon_fans.h>
#include <fresco/core/poses.h>
#include <limits>
namespace fresco::io {
namespace {
/// Values one after the other from the data of a file.
class ValueReader {
public:
  ValueReader(std::string_view data, PlyFormat format) : scanner_(data), format_(format) {}

  bool isText() const { return format_ == PlyFormat::ascii; }

  template <typename T>
  T next()
  {
    if (isText())
      return parseNumber<T>(scanner_.wordAcrossLines());
    expect(remaining() >= sizeof(T), "truncated");
    const std::string_view stored = scanner_.bytes(sizeof(T));
    if (format_ == PlyFormat::little_endian)
      return loadScalar<T>(stored.data());
    char bytes[sizeof(T)];
    std::reverse_copy(stored.begin(), stored.end(), bytes);
    return loadScalar<T>(bytes);
  }
  /// Rows without lists are in some files what they are in memory. @return where `bytes` of them begin, or nullptr
  const std::uint8_t* takeRows(std::size_t bytes)
  {
    const bool alike = format_ == PlyFormat::little_endian && bytes <= remaining();
    return alike ? reinterpret_cast<const std::uint8_t*>(scanner_.bytes(bytes).data()) : nullptr;
  }
  /// Appends the rows that follow and are a list of three, as long as they are. @return their number
  std::uint64_t copyTriangles(std::uint64_t most, FaceCollector& collector)
  {
    constexpr std::size_t row_bytes = 1 + 3 * sizeof(int);
    const std::string_view left = scanner_.rest();
    std::uint64_t rows = 0;
    if (format_ == PlyFormat::little_endian)
      for (const char* at = left.data(); rows < most && left.size() / row_bytes > rows && *at == 3;
           at += row_bytes, ++rows)
        collector.addTriangle(loadScalar<std::array<int, 3>>(at + 1));
    scanner_.bytes(rows * row_bytes);
    return rows;
  }
  /// Bytes; the last word of a text needs no separator.
  std::size_t remaining() const { return scanner_.remaining() + (isText() ? 1 : 0); }
  std::size_t leastBytes(const PlyElement& element) const
  {
    return isText() ? 2 * element.properties.size() : element.fixedSize();
  }
  std::size_t leastItemBytes(Scalar type) const { return isText() ? 2 : scalarSize(type); }

private:
  TextScanner scanner_;
  const PlyFormat format_;
};

/// Length of a list, checked against the rest of the file.
std::size_t nextLength(ValueReader& source, const PlyProperty& list)
{
  return visitScalar(*list.count_type, [&](auto zero) -> std::size_t {
    const auto length = static_cast<std::int64_t>(source.next<decltype(zero)>());
    expect(length >= 0 && std::uint64_t(length) <= source.remaining() / source.leastItemBytes(list.type),
           "truncated: a list of ", length, " values does not fit");
    return length;
  });
}

void skipValues(ValueReader& source, Scalar type, std::size_t count)
{
  visitScalar(type, [&](auto zero) {
    for (std::size_t i = 0; i < count; ++i)
      source.next<decltype(zero)>();
  });
}

void skipProperty(ValueReader& source, const PlyProperty& property)
{
  skipValues(source, property.type, property.count_type ? nextLength(source, property) : 1);
}

void checkSize(const ValueReader& source, const PlyElement& element)
{
  const std::size_t least = source.leastBytes(element);
  expect(least == 0 || element.count <= source.remaining() / least, "truncated: ", element.count, " rows of '",
         element.name, "' do not fit");
  expect(element.name != "face" || element.count <= std::uint64_t(std::numeric_limits<int>::max()),
         "too many rows of '", element.name, "'");
}

/// Columns of the properties that are no lists.
PointTable layoutOf(const PlyElement& element)
{
  PointTable table;
  for (const PlyProperty& property : element.properties)
    if (!property.count_type)
      table.addColumn(standardName(property.name), property.type);
  expect(!table.columns.empty(), "vertices without properties");
  return table;
}

PointTable readVertices(ValueReader& source, const PlyElement& element)
{
  PointTable table = layoutOf(element);
  table.rows = element.count;
  if (!element.hasList())
    table.view = source.takeRows(element.count * table.stride);
  if (table.view)
    return table;
  table.allocate(table.rows);
  std::uint8_t* at = table.data.data();
  for (std::uint64_t row = 0; row < element.count; ++row)
    for (const PlyProperty& property : element.properties) {
      if (property.count_type) {
        skipProperty(source, property);
        continue;
      }
      visitScalar(property.type, [&](auto zero) {
        const auto value = source.next<decltype(zero)>();
        std::memcpy(at, &value, sizeof(value));
        at += sizeof(value);
      });
    }
  if (source.isText())
    repackWholeNumbers(table);
  return table;
}

template <typename T>
void readList(ValueReader& source, const PlyProperty& list, std::vector<T>& items)
{
  items.resize(nextLength(source, list));
  visitScalar(list.type, [&](auto zero) {
    using Item = decltype(zero);
    if constexpr (std::is_floating_point_v<Item> && !std::is_floating_point_v<T>)
      throw std::runtime_error("vertex indices are no integers");
    else
      for (T& item : items)
        item = source.next<Item>();
  });
}

bool isIndexList(const PlyProperty& property)
{
  return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool isPlainIndexList(const PlyProperty& property)
{
  return isIndexList(property) && property.count_type == Scalar::uint8 &&
         (property.type == Scalar::int32 || property.type == Scalar::uint32);
}

/// A row of faces with what textures it.
struct TexturedRow {
  std::vector<std::int64_t> corners;
  std::vector<float> texcoords;
  int number = 0;

  void addTo(PlyContent& content) const
  {
    const bool all = texcoords.size() == 2 * corners.size();
    triangulate(corners.size(), [&](std::size_t i, std::size_t k, std::size_t l) {
      content.texnumbers.push_back(number);
      for (const std::size_t corner : {i, k, l})
        for (const std::size_t at : {2 * corner, 2 * corner + 1})
          content.texcoords.push_back(all ? texcoords[at] : std::numeric_limits<float>::quiet_NaN());
    });
  }
};

bool isTexcoordList(const PlyProperty& property)
{
  return property.count_type && (property.name == "texcoord" || property.name == "texture_coordinates");
}

bool isTexnumber(const PlyProperty& property)
{
  return !property.count_type && (property.name == "texnumber" || property.name == "texture_id");
}

void readFaceProperty(ValueReader& source, const PlyProperty& property, bool textured, TexturedRow& row)
{
  if (isIndexList(property))
    readList(source, property, row.corners);
  else if (textured && isTexcoordList(property))
    readList(source, property, row.texcoords);
  else if (textured && isTexnumber(property)) // fmax() takes NaN for -1
    visitScalar(property.type, [&](auto zero) {
      row.number = int(std::fmin(std::fmax(source.next<decltype(zero)>(), -1), std::numeric_limits<int>::max()));
    });
  else
    skipProperty(source, property);
}

/// @param textured content also gets texture coordinates
void readFaces(ValueReader& source, const PlyElement& element, bool textured, FaceCollector& collector,
               PlyContent& content)
{
  const bool strips = element.name == "tristrips";
  const bool plain = !strips && !textured && element.properties.size() == 1 && isPlainIndexList(element.properties[0]);
  TexturedRow row;
  for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
    if (plain)
      i += source.copyTriangles(element.count - i, collector);
    if (i == element.count)
      break;
    row.corners.clear();
    row.texcoords.clear();
    for (const PlyProperty& property : element.properties)
      readFaceProperty(source, property, textured, row);
    if (strips)
      collector.addStrip(row.corners.data(), row.corners.size());
    else
      collector.addPolygon(row.corners.data(), row.corners.size());
    if (textured && !strips)
      row.addTo(content);
  }
}

/// Says which properties of a file have no place in a table or mesh.
void remarkOnOmissions(const PlyHeader& header)
{
  std::string names;
  for (const PlyElement& element : header.elements) {
    const bool vertices = element.name == "vertex", faces = element.name == "face" || element.name == "tristrips";
    if (element.count == 0 || element.name == "camera")
      continue;
    for (const PlyProperty& property : element.properties)
      if (vertices ? property.count_type.has_value()
                   : !faces || !(isIndexList(property) || isTexcoordList(property) || isTexnumber(property)))
        names += concat(names.empty() ? "" : ", ", property.name, " of ", element.name);
  }
  if (!names.empty())
    remark("left out: " + names);
}

void skipElement(ValueReader& source, const PlyElement& element)
{
  for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row)
    for (const PlyProperty& property : element.properties)
      skipProperty(source, property);
}

/// First row of PCL's element `camera`: position, axes and the size of an organised cloud.
void readCamera(ValueReader& source, const PlyElement& element, PointTable& sensor)
{
  const PointTable camera = readVertices(source, element);
  const auto value = [&](const std::string& name, double missing) {
    const Column* column = camera.find(name);
    const float given = column && camera.rows > 0 ? columnValues(camera, *column)[0] : std::nanf("");
    return std::isfinite(given) ? given : missing;
  };
  SensorPose pose;
  Eigen::Matrix3f axes;
  for (int row = 0; row < 3; ++row) {
    const std::string axis(1, static_cast<char>('x' + row));
    pose.position[row] = value("view_p" + axis, 0.0);
    for (int column = 0; column < 3; ++column)
      axes(row, column) =
          static_cast<float>(value(axis + "_axis" + static_cast<char>('x' + column), row == column ? 1.0 : 0.0));
  }
  if (isRotation(axes.cast<double>(), 1e-3))
    pose.orientation = Eigen::Quaternionf(axes);
  sensor.sensor = pose;
  sensor.width = static_cast<Index>(std::clamp(value("viewportx", 0), 0.0, 1e9));
  sensor.height = static_cast<Index>(std::clamp(value("viewporty", 0), 0.0, 1e9));
}

PlyContent readElements(ValueReader source, const PlyHeader& header, bool textured)
{
  PlyContent content;
  content.textures = header.textures;
  FaceCollector collector;
  PointTable camera;
  for (const PlyElement& element : header.elements) {
    checkSize(source, element);
    expect(element.name != "vertex" || content.vertices.rows == 0, "two elements 'vertex'");
    if (element.name == "vertex")
      content.vertices = readVertices(source, element);
    else if (element.name == "face" || element.name == "tristrips")
      readFaces(source, element, textured, collector, content);
    else if (element.name == "camera" && !element.hasList() && !element.properties.empty())
      readCamera(source, element, camera);
    else
      skipElement(source, element);
  }
  expect(content.vertices.rows > 0, "no vertices");
  content.faces = collector.faces(content.vertices.rows);
  content.vertices.sensor = camera.sensor;
  if (camera.width * camera.height == content.vertices.rows)
    std::tie(content.vertices.width, content.vertices.height) = std::pair(camera.width, camera.height);
  return content;
}

PlyContent parse(std::string_view content, bool textured)
{
  const PlyHeader header = parsePlyHeader(content);
  remarkOnOmissions(header);
  return readElements({content.substr(header.size), header.format}, header, textured);
}
} // namespace

PlyContent parsePly(std::string_view content) { return parse(content, false); }
PlyContent parseTexturedPly(std::string_view content) { return parse(content, true); }

std::optional<RowLayout> plyRows(std::string_view begin)
{
  const PlyHeader header = parsePlyHeader(begin);
  const bool one_cloud = std::count_if(header.elements.begin(), header.elements.end(),
                                       [](const PlyElement& element) { return element.name == "vertex"; }) == 1;
  if (header.format != PlyFormat::little_endian || !one_cloud)
    return {};
  RowLayout layout;
  layout.offset = header.size;
  bool found = false;
  for (const PlyElement& element : header.elements) {
    if (element.count > std::numeric_limits<std::uint32_t>::max() && element.name != "vertex")
      return {}; // of something else than points: damage, and the product might not fit
    if (element.hasList() && (element.count > 0 || element.name == "vertex"))
      return {};
    if (element.name == "vertex") {
      found = true;
      layout.table = layoutOf(element);
      layout.rows = element.count;
    } else if (element.count > 0)
      (found ? layout.bytes_after : layout.offset) += element.count * element.fixedSize();
  }
  return found ? std::optional(layout) : std::nullopt;
}
} // namespace fresco::io
