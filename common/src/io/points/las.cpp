// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/las.h"
#include "io/points/file_window.h"
#include <Eigen/Core>
#include <algorithm>
#include <fresco/core/require.h>
#include <limits>
#include <stdexcept>
namespace fresco::io {
namespace {
/// Offsets in bytes follow the LAS 1.4 R15 specification, table 3 (header) and 7 to 17 (records).
struct LasHeader {
  std::uint64_t data = 0, points = 0; ///< offset of the first record; records
  std::size_t record = 0;             ///< bytes
  int format = 0;
  Eigen::Array3d scale, offset;
};

template <typename T>
T loadAt(const std::uint8_t* bytes, std::size_t offset)
{
  return loadScalar<T>(bytes + offset);
}

constexpr std::size_t record_bytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// Where a format has its colours, 0 for none.
constexpr std::size_t color_offsets[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
constexpr std::size_t infrared_offsets[] = {0, 0, 0, 0, 0, 0, 0, 0, 36, 0, 36};

/// Where a format has the time, 0 for none.
constexpr std::size_t time_offsets[] = {0, 20, 0, 20, 20, 20, 22, 22, 22, 22, 22};

LasHeader readHeader(const RandomAccessFile& file)
{
  constexpr std::size_t oldest = 227, newest = 375;
  std::uint8_t bytes[newest] = {};
  if (file.size() < oldest)
    throw std::runtime_error("not a LAS file: too short");
  file.read(0, bytes, std::min<std::uint64_t>(newest, file.size()));
  if (std::memcmp(bytes, "LASF", 4) != 0)
    throw std::runtime_error("not a LAS file: it does not begin with LASF");
  const int major = bytes[24], minor = bytes[25];
  if (major != 1 || minor > 4)
    throw std::runtime_error(concat("version ", major, '.', minor, " of LAS is not known"));
  LasHeader header;
  constexpr int compressed = 0x80;
  if ((bytes[104] & compressed) != 0)
    throw std::runtime_error(laz_hint);
  header.format = bytes[104];
  header.record = loadAt<std::uint16_t>(bytes, 105);
  if (header.format > 10 || header.record < record_bytes[header.format])
    throw std::runtime_error(concat("points of format ", header.format, " in ", header.record, " bytes"));
  header.data = loadAt<std::uint32_t>(bytes, 96);
  header.points = loadAt<std::uint32_t>(bytes, 107);
  if (minor == 4 && file.size() >= newest && loadAt<std::uint64_t>(bytes, 247) > 0)
    header.points = loadAt<std::uint64_t>(bytes, 247);
  for (int axis = 0; axis < 3; ++axis) {
    header.scale[axis] = loadAt<double>(bytes, 131 + 8 * axis);
    header.offset[axis] = loadAt<double>(bytes, 155 + 8 * axis);
  }
  if (!header.scale.isFinite().all() || !header.offset.isFinite().all())
    throw std::runtime_error("scale or offset of the coordinates is not finite");
  return header;
}

/// Values one after the other into a row.
struct RowWriter {
  std::uint8_t* at;

  template <typename T>
  void put(T value)
  {
    std::memcpy(at, &value, sizeof(T));
    at += sizeof(T);
  }
};

class LasReader : public ScanReader {
public:
  explicit LasReader(const std::string& path) : file_(path), header_(readHeader(file_))
  {
    const std::uint64_t left = file_.size() - std::min(header_.data, file_.size());
    if (header_.points > left / header_.record)
      throw std::runtime_error(concat("truncated: ", header_.points, " points of ", header_.record,
                                      " bytes do not fit into ", left, " bytes"));
    ScanInfo info;
    info.points = points();
    info.intensity_limits = Eigen::Array2d(0, std::numeric_limits<std::uint16_t>::max());
    scans_.push_back(info);
    bytes_per_color_ = widestColor() > 255 ? 2 : 1;
  }

  PointTable open(Index) override
  {
    next_ = 0;
    PointTable layout;
    for (const char* name : xyz_names)
      layout.addColumn(name, Scalar::float64);
    layout.addColumn("intensity", Scalar::float32);
    for (const char* name : color_names)
      if (color_offsets[header_.format] > 0)
        layout.addColumn(name, Scalar::uint8);
    if (infrared_offsets[header_.format] > 0)
      layout.addColumn("near_infrared", Scalar::uint16);
    if (time_offsets[header_.format] > 0)
      layout.addColumn("gps_time", Scalar::float64);
    for (const char* name :
         {"return_number", "number_of_returns", "classification", "classification_flags", "user_data"})
      layout.addColumn(name, Scalar::uint8);
    layout.addColumn("scan_angle", Scalar::float32);
    layout.addColumn("point_source_id", Scalar::uint16);
    return layout;
  }

  Index read(PointTable& table, Index begin, Index end) override
  {
    const auto left = points() - next_;
    const Index count = std::min({end - begin, left, rows_per_window});
    readRecords(next_, count);
    for (Index i = 0; i < count; ++i)
      storeRecord(record(i), table.cell(begin + i, table.columns[0]));
    next_ += count;
    return count;
  }

private:
  Index points() const { return header_.points; }
  const std::uint8_t* record(Index i) const { return records_.data() + i * header_.record; }
  void readRecords(Index first, Index count)
  {
    records_.resize(count * header_.record);
    file_.read(header_.data + first * header_.record, records_.data(), records_.size());
  }

  /// Colours have 16 bits, but many writers fill only the lower 8: a look at places all over the file tells.
  std::uint16_t widestColor()
  {
    constexpr Index places = 64, points_per_place = 1024;
    std::uint16_t widest = 0;
    const auto total = points();
    for (Index place = 0; color_offsets[header_.format] > 0 && place < places; ++place) {
      const Index first = total / places * place;
      const Index count = std::min(points_per_place, total - first);
      readRecords(first, count);
      for (Index i = 0; i < count; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
          widest = std::max(widest, colorAt(record(i), channel));
    }
    return widest;
  }

  std::uint16_t colorAt(const std::uint8_t* record, std::size_t channel) const
  {
    return loadAt<std::uint16_t>(record, color_offsets[header_.format] + 2 * channel);
  }

  /// In the order of open().
  void storeRecord(const std::uint8_t* record, std::uint8_t* row) const
  {
    RowWriter out{row};
    for (int axis = 0; axis < 3; ++axis)
      out.put<double>(loadAt<std::int32_t>(record, 4 * axis) * header_.scale[axis] + header_.offset[axis]);
    out.put<float>(loadAt<std::uint16_t>(record, 12));
    for (std::size_t channel = 0; color_offsets[header_.format] > 0 && channel < 3; ++channel) {
      const unsigned color = colorAt(record, channel);
      out.put<std::uint8_t>(bytes_per_color_ == 2 ? color >> 8U : std::min(color, 255U));
    }
    if (const std::size_t at = infrared_offsets[header_.format]; at > 0)
      out.put<std::uint16_t>(loadAt<std::uint16_t>(record, at));
    if (const std::size_t at = time_offsets[header_.format]; at > 0)
      out.put<double>(loadAt<double>(record, at));
    header_.format < 6 ? putOldFlags(record, out) : putNewFlags(record, out);
  }

  /// Formats 0 to 5.
  static void putOldFlags(const std::uint8_t* record, RowWriter& out)
  {
    out.put<std::uint8_t>(record[14] & 7U);
    out.put<std::uint8_t>(record[14] >> 3U & 7U);
    out.put<std::uint8_t>(record[15] & 31U);
    out.put<std::uint8_t>(record[15] >> 5U);
    out.put<std::uint8_t>(record[17]);
    out.put<float>(loadAt<std::int8_t>(record, 16));
    out.put<std::uint16_t>(loadAt<std::uint16_t>(record, 18));
  }

  /// Formats 6 to 10.
  static void putNewFlags(const std::uint8_t* record, RowWriter& out)
  {
    constexpr float degrees_per_step = 0.006f;
    out.put<std::uint8_t>(record[14] & 15U);
    out.put<std::uint8_t>(record[14] >> 4U);
    out.put<std::uint8_t>(record[16]);
    out.put<std::uint8_t>(record[15] & 15U);
    out.put<std::uint8_t>(record[17]);
    out.put<float>(degrees_per_step * loadAt<std::int16_t>(record, 18));
    out.put<std::uint16_t>(loadAt<std::uint16_t>(record, 20));
  }

  RandomAccessFile file_;
  const LasHeader header_;
  int bytes_per_color_ = 2;
  Index next_ = 0; ///< record
  std::vector<std::uint8_t> records_;
};
} // namespace

std::unique_ptr<ScanReader> openLas(const std::string& path) { return std::make_unique<LasReader>(path); }
} // namespace fresco::io
