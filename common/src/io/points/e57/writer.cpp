// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/paged_file.h"
#include "io/points/point_formats.h"
#include "io/points/row_file.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/pcl_cloud_table.h>
#include <fresco/io/scan_writer.h>
#include <limits>
namespace fresco::io::e57 {
namespace {
std::string tag(const std::string& name, const std::string& type, const std::string& content)
{
  return "<" + name + " type=\"" + type + "\">" + content + "</" + name + ">\n";
}

std::string real(const std::string& name, double value) { return tag(name, "Float", numberText(value)); }
std::string whole(const std::string& name, std::int64_t value) { return tag(name, "Integer", numberText(value)); }

/// "]]>" would end it.
std::string text(const std::string& name, std::string value)
{
  for (std::size_t at; (at = value.find("]]>")) != std::string::npos;)
    value.erase(at, 3);
  return tag(name, "String", "<![CDATA[" + value + "]]>");
}

std::string structure(const std::string& name, const std::string& content) { return tag(name, "Structure", content); }

std::string poseXml(const Eigen::Isometry3d& T)
{
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return structure("pose",
                   structure("rotation", real("w", q.w()) + real("x", q.x()) + real("y", q.y()) + real("z", q.z())) +
                       structure("translation", real("x", t.x()) + real("y", t.y()) + real("z", t.z())));
}

std::string guidOf(Index scan) { return textOf("fresco-scan-", scan + 1); }

/// Whole numbers of a type as E57 has them: 64 bits are taken for signed ones.
template <typename T>
using Limits = std::numeric_limits<std::conditional_t<std::is_same_v<T, std::uint64_t>, std::int64_t, T>>;

/// A field of the records and where its values come from.
struct Stream {
  std::string name;
  Column column; ///< with one value

  std::size_t bits() const { return 8 * column.bytes(); }
  std::string xml() const
  {
    return visitScalar(column.type, [&](auto zero) {
      using T = decltype(zero);
      if constexpr (std::is_floating_point_v<T>)
        return textOf("<", name, " type=\"Float\"", sizeof(T) == 4 ? " precision=\"single\"" : "", "/>\n");
      else
        return textOf("<", name, " type=\"Integer\" minimum=\"", std::int64_t(Limits<T>::min()), "\" maximum=\"",
                      std::int64_t(Limits<T>::max()), "\"/>\n");
    });
  }
};

/// The name of a column as E57 has it; an extension of ours for what it has no name for.
std::string fieldName(const std::string& column)
{
  static constexpr std::pair<const char*, const char*> names[] = {{"x", "cartesianX"},
                                                                  {"y", "cartesianY"},
                                                                  {"z", "cartesianZ"},
                                                                  {"red", "colorRed"},
                                                                  {"green", "colorGreen"},
                                                                  {"blue", "colorBlue"},
                                                                  {"normal_x", "nor:normalX"},
                                                                  {"normal_y", "nor:normalY"},
                                                                  {"normal_z", "nor:normalZ"},
                                                                  {"row", "rowIndex"},
                                                                  {"column", "columnIndex"},
                                                                  {"intensity", "intensity"},
                                                                  {"timeStamp", "timeStamp"},
                                                                  {"returnIndex", "returnIndex"},
                                                                  {"returnCount", "returnCount"},
                                                                  {"isColorInvalid", "isColorInvalid"}};
  for (const auto& [from, to] : names)
    if (column == from)
      return to;
  std::string name = "fresco:";
  for (const char c : column)
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

/// Rows and columns of an organised cloud as columns of their own, colours as bytes.
void prepare(PointTable& table)
{
  normalizeColors(table);
  unpackColors(table);
  if (table.height <= 1)
    return;
  PointTable wider;
  addColumns(table, wider, [](const Column&) { return true; });
  wider.addColumn(row_column, Scalar::uint32);
  wider.addColumn(column_column, Scalar::uint32);
  wider.allocate(table.rows);
  copyRows(table, wider);
  for (Index i = 0; i < table.rows; ++i) {
    const std::uint32_t place[] = {std::uint32_t(i / table.width), std::uint32_t(i % table.width)};
    std::memcpy(wider.cell(i, wider.columns[table.columns.size()]), place, sizeof(place));
  }
  table = std::move(wider);
}

std::vector<Stream> streamsOf(const PointTable& table)
{
  std::vector<Stream> streams;
  for (const Column& column : table.columns)
    for (const Column& value : singleValues({column}))
      streams.push_back({fieldName(column.name) + value.name.substr(column.name.size()), value});
  return streams;
}

/// Values of rows begin .. end - 1 as E57 packs them: their distance from the minimum.
std::string packed(const PointTable& table, const Stream& stream, Index begin, Index end)
{
  std::string bytes;
  forEachValue(
      table, stream.column, 0,
      [&](Index, auto value) {
        using T = decltype(value);
        if constexpr (std::is_integral_v<T>)
          value = T(std::uint64_t(value) - std::uint64_t(Limits<T>::min()));
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
      },
      begin, end);
  return bytes;
}

/// State of the positions of rows begin .. end - 1, two bits each: 0 = valid, 2 = not finite.
std::string packedStates(const std::vector<bool>& finite, Index begin, Index end)
{
  std::string bytes((end - begin + 3) / 4, '\0');
  for (Index i = begin; i < end; ++i)
    if (!finite[i])
      bytes[(i - begin) / 4] = char(bytes[(i - begin) / 4] | 2 << 2 * ((i - begin) % 4));
  return bytes;
}

std::string limitsXml(const PointTable& table)
{
  std::string xml;
  if (const Column* intensity = table.find("intensity")) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto look = [&](Index, auto value) {
      if (std::isfinite(double(value)))
        low = std::min(low, double(value)), high = std::max(high, double(value));
    };
    eachValue(table, *intensity, look);
    if (low < high)
      xml += structure("intensityLimits", real("intensityMinimum", low) + real("intensityMaximum", high));
  }
  if (table.find("red")) {
    std::string limits;
    for (const char* channel : {"colorRed", "colorGreen", "colorBlue"})
      limits += whole(std::string(channel) + "Minimum", 0) + whole(std::string(channel) + "Maximum", 255);
    xml += structure("colorLimits", limits);
  }
  return xml;
}

/// Sections one after the other behind the header, without checksums until they are written.
class Builder {
public:
  void add(const PlacedCloud& scan)
  {
    PointTable table = tableOfCloud(scan.cloud.cloud);
    if (table.height = scan.cloud.cloud.height, table.width = scan.cloud.cloud.width; table.columns.empty())
      for (const char* name : xyz_names)
        table.addColumn(name, Scalar::float32);
    require(findTriple(table, xyz_names).has_value(), "scan '", scan.name, "': no coordinates x y z");
    prepare(table);
    const std::vector<Stream> streams = streamsOf(table);
    const std::vector<bool> finite = finiteRows(table);
    const bool states = std::count(finite.begin(), finite.end(), false) > 0;
    std::string prototype;
    for (const Stream& stream : streams)
      prototype += stream.xml();
    if (states)
      prototype += "<cartesianInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/>\n";
    const std::uint64_t begin = addSection(table, streams, states ? &finite : nullptr);
    scans_ += "<vectorChild type=\"Structure\">" + text("guid", guidOf(scan_count_++)) + text("name", scan.name) +
              (scan.T_file_scan ? poseXml(*scan.T_file_scan) : "") + limitsXml(table) +
              textOf("<points type=\"CompressedVector\" fileOffset=\"", physical(begin), "\" recordCount=\"",
                     table.rows, "\">") +
              structure("prototype", prototype) +
              "<codecs type=\"Vector\" allowHeterogeneousChildren=\"1\"/></points></vectorChild>\n";
  }

  void add(const ScanPicture& picture)
  {
    using Projection = ScanImage::Projection;
    const ScanImage& said = picture.description;
    const char* const blob = said.encoding == ScanImage::Encoding::jpeg ? "jpegImage" : "pngImage";
    std::string xml = addBlob(blob, picture.bytes);
    if (!picture.mask.empty())
      xml += addBlob("imageMask", picture.mask);
    xml += whole("imageWidth", said.width) + whole("imageHeight", said.height);
    if (said.projection == Projection::pinhole)
      xml += real("focalLength", said.focal_length) + real("principalPointX", said.principal_x);
    if (said.projection == Projection::cylindrical)
      xml += real("radius", said.radius);
    if (said.projection == Projection::pinhole || said.projection == Projection::cylindrical)
      xml += real("principalPointY", said.principal_y);
    if (said.projection != Projection::none)
      xml += real("pixelWidth", said.pixel_width) + real("pixelHeight", said.pixel_height);
    const char* const kinds[] = {"visualReference", "pinhole", "spherical", "cylindrical"};
    pictures_ +=
        structure("vectorChild", text("guid", textOf("fresco-picture-", ++picture_count_)) + text("name", said.name) +
                                     (said.T_file_image ? poseXml(*said.T_file_image) : "") +
                                     (said.scan >= 0 ? text("associatedData3DGuid", guidOf(said.scan)) : "") +
                                     structure(std::string(kinds[int(said.projection)]) + "Representation", xml));
  }

  void write(const std::string& path)
  {
    const std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
        "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" "
        "xmlns:nor=\"http://www.libe57.org/E57_NOR_surface_normals.txt\" xmlns:fresco=\"urn:fresco:fields\">\n" +
        text("formatName", "ASTM E57 3D Imaging Data File") + text("guid", "fresco") + whole("versionMajor", 1) +
        whole("versionMinor", 0) + vector("data3D", scans_) + vector("images2D", pictures_) + "</e57Root>\n";
    const std::uint64_t begin = align();
    bytes_ += xml;
    const std::uint64_t pages = (bytes_.size() + page_payload - 1) / page_payload;
    bytes_.resize(pages * page_payload, '\0');
    bytes_.replace(0, header_bytes,
                   "ASTM-E57" + raw(std::uint32_t{1}) + raw(std::uint32_t{0}) + raw(pages * page_size) +
                       raw(physical(begin)) + raw(std::uint64_t{xml.size()}) + raw(std::uint64_t{page_size}));
    OutputFile file(path);
    for (std::uint64_t page = 0; page < pages; ++page) {
      const char* const from = bytes_.data() + page * page_payload;
      const std::uint32_t sum = crc32c(from, page_payload);
      const char checksum[] = {char(sum >> 24), char(sum >> 16), char(sum >> 8), char(sum)};
      file.write(from, page_payload);
      file.write(checksum, sizeof(checksum));
    }
    file.commit();
  }

private:
  static constexpr std::size_t header_bytes = 48;

  template <typename T>
  static std::string raw(T value)
  {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
  }
  static std::uint64_t physical(std::uint64_t logical)
  {
    return logical / page_payload * page_size + logical % page_payload;
  }
  static std::string vector(const std::string& name, const std::string& children)
  {
    return "<" + name + " type=\"Vector\" allowHeterogeneousChildren=\"1\">\n" + children + "</" + name + ">\n";
  }
  std::uint64_t align()
  {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    return bytes_.size();
  }

  std::string addBlob(const std::string& name, const std::string& content)
  {
    const std::uint64_t begin = align();
    bytes_ += raw(std::uint64_t{0}) + raw(std::uint64_t{(16 + content.size() + 3) / 4 * 4}) + content;
    align();
    return textOf("<", name, " type=\"Blob\" fileOffset=\"", physical(begin), "\" length=\"", content.size(), "\"/>\n");
  }

  /// Packets of as many whole groups of eight records as fit, so that each piece of a stream ends with a byte.
  /// @param finite null: all
  std::uint64_t addSection(const PointTable& table, const std::vector<Stream>& streams, const std::vector<bool>* finite)
  {
    const std::uint64_t begin = align();
    bytes_ += raw(std::uint64_t{1}) + raw(std::uint64_t{0}) + raw(physical(begin + 32)) + raw(std::uint64_t{0});
    std::size_t bits = finite ? 2 : 0;
    for (const Stream& stream : streams)
      bits += stream.bits();
    constexpr std::size_t payload = 60000; // a packet has 65536 bytes at most
    const std::size_t head = 6 + 2 * (streams.size() + 1);
    require(head + bits + 8 < payload, "too many fields for E57");
    const Index step = Index((payload - head) / bits * 8);
    for (Index row = 0; row < table.rows; row += step) {
      const Index end = std::min(table.rows, row + step);
      std::string lengths, pieces;
      const auto add = [&](const std::string& piece) {
        lengths += raw(std::uint16_t(piece.size()));
        pieces += piece;
      };
      for (const Stream& stream : streams)
        add(packed(table, stream, row, end));
      if (finite)
        add(packedStates(*finite, row, end));
      std::string packet = raw(std::uint16_t(streams.size() + (finite ? 1 : 0))) + lengths + pieces;
      packet.resize((packet.size() + 7) / 4 * 4 - 4, '\0');
      bytes_ += raw(std::uint8_t{1}) + raw(std::uint8_t{0}) + raw(std::uint16_t(packet.size() + 3)) + packet;
    }
    bytes_.replace(begin + 8, 8, raw(std::uint64_t{bytes_.size() - begin}));
    return begin;
  }

  std::string bytes_ = std::string(header_bytes, '\0');
  std::string scans_, pictures_;
  Index scan_count_ = 0, picture_count_ = 0;
};
} // namespace
} // namespace fresco::io::e57

void fresco::writeScans(const std::string& path, const std::vector<PlacedCloud>& scans,
                        const std::vector<ScanPicture>& pictures)
{
  io::e57::Builder builder;
  for (const PlacedCloud& scan : scans)
    builder.add(scan);
  for (const ScanPicture& picture : pictures)
    builder.add(picture);
  builder.write(path);
}

void fresco::io::writeE57Points(const std::string& path, const PointTable& points, bool)
{
  PlacedCloud scan{"scan 1", {}, {}};
  PointTable table = points;
  if (points.sensor) {
    scan.T_file_scan = Eigen::Isometry3d(Eigen::Translation3d(points.sensor->position));
    moveOrigin(table, points.sensor->position);
  }
  scan.cloud.cloud = cloudOfTable(std::move(table));
  writeScans(path, {scan});
}

std::vector<fresco::PlacedCloud> fresco::readPlacedClouds(const std::string& path)
{
  std::vector<PlacedCloud> clouds;
  const ScanPath any = scansOf({path})[0]; // with an index where that spares passes over the file
  const std::vector<ScanInfo> infos = readScanInfos(any);
  for (Index i = 0; i < Index(infos.size()); ++i) {
    PlacedCloud cloud{infos[i].name, {}, {}};
    if (infos[i].has_pose)
      cloud.T_file_scan = infos[i].T_file_scan;
    if (infos[i].points > 0)
      cloud.cloud = readCloud(ScanPath{path, i, any.index});
    clouds.push_back(std::move(cloud));
  }
  return clouds;
}

std::vector<fresco::ScanPicture> fresco::readScanPictures(const std::string& path)
{
  std::vector<ScanPicture> pictures;
  const std::vector<ScanImage> images = readScanImages(path);
  for (std::size_t i = 0; i < images.size(); ++i)
    try {
      pictures.push_back(
          {images[i], readScanImageBytes(path, i), images[i].has_mask ? readScanImageMask(path, i) : ""});
    } catch (const std::runtime_error& error) {
      io::remark(std::string("without a picture: ") + error.what());
    }
  return pictures;
}
