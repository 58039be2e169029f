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
#include <fresco/core/require.h>
#include <limits>
namespace fresco::io {
namespace {
[[noreturn]] void failEarly(const PlyElement& element)
{
  throw std::runtime_error(concat("truncated: ", element.count, " rows of '", element.name, "' do not fit"));
}

/// Values one after the other from the data of a binary file.
template <bool Swap>
class BinarySource {
public:
  explicit BinarySource(std::string_view data) : at_(data.data()), end_(data.data() + data.size()) {}

  template <typename T>
  T next()
  {
    if (remaining() < sizeof(T))
      throw std::runtime_error("truncated");
    char bytes[sizeof(T)];
    std::copy(at_, at_ + sizeof(T), bytes);
    if constexpr (Swap)
      std::reverse(bytes, bytes + sizeof(T));
    at_ += sizeof(T);
    return loadScalar<T>(bytes);
  }
  /// Rows without lists are in the file what they are in memory. @return where `bytes` of them begin, or nullptr
  const std::uint8_t* takeRows(std::size_t bytes)
  {
    if (Swap || bytes > remaining())
      return nullptr;
    at_ += bytes;
    return reinterpret_cast<const std::uint8_t*>(at_ - bytes);
  }
  /// Appends the rows that follow and are a list of three, as long as they are. @return their number
  std::uint64_t copyTriangles(std::uint64_t most, FaceCollector& collector)
  {
    constexpr std::size_t row_bytes = 1 + 3 * sizeof(int);
    std::uint64_t rows = 0;
    for (; !Swap && rows < most && remaining() >= row_bytes && *at_ == 3; ++rows, at_ += row_bytes)
      collector.addTriangle(loadScalar<std::array<int, 3>>(at_ + 1));
    return rows;
  }
  std::size_t remaining() const { return end_ - at_; }
  static std::size_t leastBytes(const PlyElement& element) { return element.fixedSize(); }
  static std::size_t leastItemBytes(Scalar type) { return scalarSize(type); }

private:
  const char* at_;
  const char* end_;
};

/// Values one after the other from the data of an ASCII file.
class TextSource {
public:
  explicit TextSource(std::string_view data) : scanner_(data) {}

  template <typename T>
  T next()
  {
    return parseNumber<T>(scanner_.wordAcrossLines());
  }
  static const std::uint8_t* takeRows(std::size_t) { return nullptr; }
  static std::uint64_t copyTriangles(std::uint64_t, FaceCollector&) { return 0; }
  /// The last word of a file needs no separator.
  std::size_t remaining() const { return scanner_.remaining() + 1; }
  static std::size_t leastBytes(const PlyElement& element) { return 2 * element.properties.size(); }
  static std::size_t leastItemBytes(Scalar) { return 2; }

private:
  TextScanner scanner_;
};

/// Length of a list, checked against the rest of the file.
template <typename Source>
std::size_t nextLength(Source& source, const PlyProperty& list)
{
  return visitScalar(*list.count_type, [&](auto zero) -> std::size_t {
    const auto raw = source.template next<decltype(zero)>();
    const auto length = static_cast<std::int64_t>(raw);
    if (length < 0 || static_cast<std::uint64_t>(length) > source.remaining() / Source::leastItemBytes(list.type))
      throw std::runtime_error(concat("truncated: a list of ", length, " values does not fit"));
    return length;
  });
}

template <typename Source>
void skipValues(Source& source, Scalar type, std::size_t count)
{
  visitScalar(type, [&](auto zero) {
    for (std::size_t i = 0; i < count; ++i)
      source.template next<decltype(zero)>();
  });
}

template <typename Source>
void skipProperty(Source& source, const PlyProperty& property)
{
  skipValues(source, property.type, property.count_type ? nextLength(source, property) : 1);
}

template <typename Source>
void checkSize(const Source& source, const PlyElement& element)
{
  const std::size_t least = Source::leastBytes(element);
  if (least > 0 && element.count > source.remaining() / least)
    failEarly(element);
  if (element.name == "face" && element.count > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    throw std::runtime_error(concat("too many rows of '", element.name, "'"));
}

/// Columns of the properties that are no lists.
PointTable layoutOf(const PlyElement& element)
{
  PointTable table;
  for (const PlyProperty& property : element.properties)
    if (!property.count_type)
      table.addColumn(standardName(property.name), property.type);
  if (table.columns.empty())
    throw std::runtime_error("vertices without properties");
  return table;
}

template <typename Source>
PointTable readVertices(Source& source, const PlyElement& element)
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
        const auto value = source.template next<decltype(zero)>();
        std::memcpy(at, &value, sizeof(value));
        at += sizeof(value);
      });
    }
  if constexpr (std::is_same_v<Source, TextSource>)
    repackWholeNumbers(table);
  return table;
}

template <typename T, typename Source>
void readList(Source& source, const PlyProperty& list, std::vector<T>& items)
{
  items.resize(nextLength(source, list));
  visitScalar(list.type, [&](auto zero) {
    using Item = decltype(zero);
    if constexpr (std::is_floating_point_v<Item> && !std::is_floating_point_v<T>)
      throw std::runtime_error("vertex indices are no integers");
    else
      for (T& item : items)
        item = source.template next<Item>();
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

template <typename Source>
void readFaceProperty(Source& source, const PlyProperty& property, bool textured, TexturedRow& row)
{
  if (isIndexList(property))
    readList(source, property, row.corners);
  else if (textured && isTexcoordList(property))
    readList(source, property, row.texcoords);
  else if (textured && isTexnumber(property))
    visitScalar(property.type, [&](auto zero) {
      row.number = int(std::clamp<double>(source.template next<decltype(zero)>(), -1, std::numeric_limits<int>::max()));
    });
  else
    skipProperty(source, property);
}

/// @param textured content also gets texture coordinates
template <typename Source>
void readFaces(Source& source, const PlyElement& element, bool textured, FaceCollector& collector, PlyContent& content)
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

template <typename Source>
void skipElement(Source& source, const PlyElement& element)
{
  for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row)
    for (const PlyProperty& property : element.properties)
      skipProperty(source, property);
}

/// First row of PCL's element `camera`: position, axes and the size of an organised cloud.
template <typename Source>
void readCamera(Source& source, const PlyElement& element, PointTable& sensor)
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

template <typename Source>
PlyContent readElements(Source source, const PlyHeader& header, bool textured)
{
  PlyContent content;
  content.textures = header.textures;
  FaceCollector collector;
  PointTable camera;
  for (const PlyElement& element : header.elements) {
    checkSize(source, element);
    if (element.name == "vertex" && content.vertices.rows > 0)
      throw std::runtime_error("two elements 'vertex'");
    if (element.name == "vertex")
      content.vertices = readVertices(source, element);
    else if (element.name == "face" || element.name == "tristrips")
      readFaces(source, element, textured, collector, content);
    else if (element.name == "camera" && !element.hasList() && !element.properties.empty())
      readCamera(source, element, camera);
    else
      skipElement(source, element);
  }
  if (content.vertices.rows == 0)
    throw std::runtime_error("no vertices");
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
  const std::string_view data = content.substr(header.size);
  if (header.format == PlyFormat::ascii)
    return readElements(TextSource(data), header, textured);
  return header.format == PlyFormat::little_endian ? readElements(BinarySource<false>(data), header, textured)
                                                   : readElements(BinarySource<true>(data), header, textured);
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
