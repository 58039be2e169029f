// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>
/// Writes E57 files (ASTM E2807) of all that the reader promises to read. Shares no code with it, so that one checks the
/// other. A file is made in memory.
namespace fresco::test::e57 {
/// A field of the records and its values: `stored` for whole numbers, `reals` for floats, `texts` for strings.
struct Field {
  std::string name;
  std::string type = "Float"; ///< or Integer, ScaledInteger, String
  bool single = false;        ///< precision of a Float
  std::int64_t minimum = 0, maximum = 0;
  double scale = 1, offset = 0;
  std::vector<std::int64_t> stored = {};
  std::vector<double> reals = {};
  std::vector<std::string> texts = {};
};

struct Scan {
  std::string name;
  std::vector<Field> fields;
  std::size_t count = 0;
  std::string more = {}; ///< further XML: pose, limits
};

struct Image {
  std::string representation; ///< XML; PICTURE and MASK are replaced by fileOffset and length
  std::string picture, mask;
  std::string more = {}; ///< further XML: pose, name
};

template <typename T>
std::string raw(T value)
{
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

inline std::string exact(double value)
{
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

/// CRC32C bit by bit.
inline std::uint32_t checksum(std::string_view bytes)
{
  std::uint32_t crc = ~std::uint32_t{0};
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0x82F63B78U : crc >> 1;
  }
  return ~crc;
}

inline std::uint64_t physical(std::uint64_t logical) { return logical / 1020 * 1024 + logical % 1020; }

/// Bits one after the other, the lowest first.
inline std::string packed(const Field& field)
{
  const auto range = static_cast<std::uint64_t>(field.maximum) - static_cast<std::uint64_t>(field.minimum);
  int bits = 0;
  while (bits < 64 && range >> bits > 0)
    ++bits;
  std::vector<bool> stream;
  for (const std::int64_t value : field.stored) {
    const auto above = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(field.minimum);
    for (int bit = 0; bit < bits; ++bit)
      stream.push_back((above >> bit & 1U) != 0);
  }
  std::string bytes((stream.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < stream.size(); ++i)
    if (stream[i])
      bytes[i / 8] = static_cast<char>(bytes[i / 8] | 1 << i % 8);
  return bytes;
}

inline std::string streamOf(const Field& field)
{
  std::string bytes;
  if (field.type == "String")
    for (const std::string& text : field.texts)
      bytes += (text.size() < 128 ? std::string(1, static_cast<char>(text.size() << 1U))
                                  : raw(std::uint64_t{text.size()} << 1U | 1U)) +
               text;
  else if (field.type != "Float")
    bytes = packed(field);
  else
    for (const double value : field.reals)
      bytes += field.single ? raw(static_cast<float>(value)) : raw(value);
  return bytes;
}

/// Packets whose pieces have odd sizes, another for each stream, with an index and an empty packet between.
inline std::string packetsOf(const std::vector<Field>& fields)
{
  std::vector<std::string> streams;
  for (const Field& field : fields)
    streams.push_back(streamOf(field));
  std::string packets;
  std::vector<std::size_t> done(streams.size(), 0);
  std::size_t left = 0;
  for (const std::string& stream : streams)
    left += stream.size();
  for (std::size_t turn = 1; left > 0; ++turn) {
    std::string lengths, pieces;
    for (std::size_t f = 0; f < streams.size(); ++f) {
      const std::string piece = streams[f].substr(done[f], (turn * 37 + f * 101) % 700);
      done[f] += piece.size();
      left -= piece.size();
      lengths += raw(static_cast<std::uint16_t>(piece.size()));
      pieces += piece;
    }
    std::string packet = raw(static_cast<std::uint16_t>(streams.size())) + lengths + pieces;
    packet.resize((packet.size() + 7) / 4 * 4 - 4, '\0'); // four bytes of header come before it
    packets +=
        raw(std::uint8_t{1}) + raw(std::uint8_t{0}) + raw(static_cast<std::uint16_t>(packet.size() + 3)) + packet;
    if (turn % 3 == 0)
      packets += std::string("\2\0\7\0\0\0\0\0", 8) + std::string("\0\0\17\0\0\0\0\0\0\0\0\0\0\0\0\0", 16);
  }
  return packets;
}

inline std::string prototypeOf(const Field& field)
{
  std::string xml = "<" + field.name + " type=\"" + field.type + "\"";
  if (field.type == "Float")
    xml += field.single ? " precision=\"single\"" : "";
  else if (field.type != "String")
    xml += " minimum=\"" + std::to_string(field.minimum) + "\" maximum=\"" + std::to_string(field.maximum) + "\"";
  if (field.type == "ScaledInteger")
    xml += " scale=\"" + exact(field.scale) + "\" offset=\"" + exact(field.offset) + "\"";
  return xml + "/>\n";
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// Sections one after the other behind the header; checksums come last.
class File {
public:
  std::string add(const Scan& scan)
  {
    const std::uint64_t begin = align();
    const std::string packets = packetsOf(scan.fields);
    bytes_ += raw(std::uint64_t{1}) + raw(std::uint64_t{32 + packets.size()}) + raw(physical(begin + 32)) +
              raw(std::uint64_t{0}) + packets;
    std::string xml = "<vectorChild type=\"Structure\"><guid type=\"String\"><![CDATA[guid of " + scan.name +
                      "]]></guid><name type=\"String\"><![CDATA[" + scan.name + "]]></name>" + scan.more +
                      "<points type=\"CompressedVector\" fileOffset=\"" + std::to_string(physical(begin)) +
                      "\" recordCount=\"" + std::to_string(scan.count) + "\"><prototype type=\"Structure\">\n";
    for (const Field& field : scan.fields)
      xml += prototypeOf(field);
    return xml + "</prototype><codecs type=\"Vector\"></codecs></points></vectorChild>\n";
  }

  std::string add(const Image& image)
  {
    std::string xml = replaced(image.representation, "PICTURE", addBlob(image.picture));
    if (!image.mask.empty())
      xml = replaced(xml, "MASK", addBlob(image.mask));
    return "<vectorChild type=\"Structure\">" + image.more + xml + "</vectorChild>\n";
  }

  /// The whole file.
  std::string finish(const std::string& xml)
  {
    const std::uint64_t begin = align(), xml_at = physical(begin);
    bytes_ += xml;
    const std::size_t pages = (bytes_.size() + 1019) / 1020;
    bytes_.resize(pages * 1020, ' ');
    bytes_.replace(0, 48,
                   "ASTM-E57" + raw(std::uint32_t{1}) + raw(std::uint32_t{0}) + raw(std::uint64_t{pages * 1024}) +
                       raw(xml_at) + raw(std::uint64_t{xml.size()}) + raw(std::uint64_t{1024}));
    return withChecksums(bytes_);
  }

  static std::string withChecksums(const std::string& logical)
  {
    std::string file;
    for (std::size_t at = 0; at < logical.size(); at += 1020) {
      const std::string page = logical.substr(at, 1020);
      const std::uint32_t sum = checksum(page);
      file += page;
      for (int shift = 24; shift >= 0; shift -= 8)
        file += static_cast<char>(sum >> shift & 0xFFU);
    }
    return file;
  }

private:
  std::uint64_t align()
  {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    return bytes_.size();
  }
  std::string addBlob(const std::string& content)
  {
    const std::uint64_t begin = align();
    bytes_ += raw(std::uint64_t{0}) + raw(std::uint64_t{16 + content.size()}) + content;
    return "fileOffset=\"" + std::to_string(physical(begin)) + "\" length=\"" + std::to_string(content.size()) + "\"";
  }
  std::string bytes_ = std::string(48, '\0');
};

inline std::string fileOf(const std::vector<Scan>& scans, const std::vector<Image>& images = {})
{
  File file;
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
                    "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" "
                    "xmlns:nor=\"http://www.libe57.org/E57_NOR_surface_normals.txt\">\n<data3D type=\"Vector\">\n";
  for (const Scan& scan : scans)
    xml += file.add(scan);
  xml += "</data3D><images2D type=\"Vector\">\n";
  for (const Image& image : images)
    xml += file.add(image);
  return file.finish(xml + "</images2D></e57Root>\n");
}

/// The same file with `what` in its XML replaced by `by`, no longer than it, checksums right. "" if it is not there.
inline std::string edited(const std::string& file, const std::string& what, std::string by)
{
  std::string logical;
  for (std::size_t at = 0; at < file.size(); at += 1024)
    logical += file.substr(at, 1020);
  const std::size_t at = logical.find(what);
  if (at == std::string::npos || what.size() < by.size())
    return {};
  by.resize(what.size(), ' ');
  return File::withChecksums(logical.replace(at, what.size(), by));
}

inline std::string element(const std::string& name, double value)
{
  return "<" + name + " type=\"Float\">" + exact(value) + "</" + name + ">";
}

inline std::string element(const std::string& name, int value)
{
  return "<" + name + " type=\"Integer\">" + std::to_string(value) + "</" + name + ">";
}

inline std::string poseXml(const Eigen::Isometry3d& T)
{
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return "<pose type=\"Structure\"><rotation type=\"Structure\">" + element("w", q.w()) + element("x", q.x()) +
         element("y", q.y()) + element("z", q.z()) + "</rotation><translation type=\"Structure\">" +
         element("x", t.x()) + element("y", t.y()) + element("z", t.z()) + "</translation></pose>";
}

inline std::string poseXml(double qw, double qz, double x, double y, double z)
{
  return poseXml(Eigen::Translation3d(x, y, z) * Eigen::Isometry3d(Eigen::Quaterniond(qw, 0, 0, qz)));
}
} // namespace fresco::test::e57
