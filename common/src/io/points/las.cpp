// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/las_fields.h"
#include "io/points/point_formats.h"
#include "io/points/row_file.h"
#include <Eigen/Core>
#include <algorithm>
#include <limits>
namespace fresco::io {
namespace {
/// Offsets in bytes follow the LAS 1.4 R15 specification, table 3.
struct LasHeader {
  std::uint64_t records = 0, data = 0,
                points = 0; ///< offsets of the first variable length record, of the first point; points
  std::uint32_t record_count = 0;
  std::size_t record = 0; ///< bytes of a point
  int format = 0;
  Eigen::Array3d scale, offset;
};

LasHeader readHeader(const RandomAccessFile& file)
{
  constexpr std::size_t oldest = 227, newest = 375;
  std::uint8_t bytes[newest] = {};
  expect(file.size() >= oldest, "not a LAS file: too short");
  file.read(0, bytes, std::min<std::uint64_t>(newest, file.size()));
  expect(std::memcmp(bytes, "LASF", 4) == 0, "not a LAS file: it does not begin with LASF");
  const int major = bytes[24], minor = bytes[25];
  expect(major == 1 && minor <= 4, "version ", major, '.', minor, " of LAS is not known");
  LasHeader header;
  constexpr int compressed = 0x80;
  expect((bytes[104] & compressed) == 0, "compressed (LAZ): name it .laz");
  header.format = bytes[104];
  header.record = loadScalar<std::uint16_t>(bytes + 105);
  expect(header.format <= 10 && header.record >= lasRecordBytes(header.format), "points of format ", header.format,
         " in ", header.record, " bytes");
  header.records = loadScalar<std::uint16_t>(bytes + 94);
  header.record_count = loadScalar<std::uint32_t>(bytes + 100);
  header.data = loadScalar<std::uint32_t>(bytes + 96);
  header.points = loadScalar<std::uint32_t>(bytes + 107);
  if (minor == 4 && file.size() >= newest && loadScalar<std::uint64_t>(bytes + 247) > 0)
    header.points = loadScalar<std::uint64_t>(bytes + 247);
  for (int axis = 0; axis < 3; ++axis) {
    header.scale[axis] = loadScalar<double>(bytes + 131 + 8 * axis);
    header.offset[axis] = loadScalar<double>(bytes + 155 + 8 * axis);
  }
  expect(header.scale.isFinite().all() && header.offset.isFinite().all(),
         "scale or offset of the coordinates is not finite");
  return header;
}

/// Descriptors of extra bytes, the record 4 of LASF_Spec; none where it is missing or damaged.
std::string extraDescriptors(const RandomAccessFile& file, const LasHeader& header)
{
  constexpr std::size_t head = 54;
  std::uint64_t at = header.records;
  for (std::uint32_t i = 0; i < header.record_count && at + head <= std::min(header.data, file.size()); ++i) {
    std::uint8_t bytes[head];
    file.read(at, bytes, head);
    const auto length = loadScalar<std::uint16_t>(bytes + 20);
    if (std::memcmp(bytes + 2, "LASF_Spec", 10) == 0 && loadScalar<std::uint16_t>(bytes + 18) == 4 &&
        length <= file.size() - at - head) {
      std::string text(length, '\0');
      file.read(at + head, text.data(), length);
      return text;
    }
    at += head + length;
  }
  return {};
}

/// Fields of the points of a file: those of the format, then extra bytes, which replace one of their name.
std::vector<LasField> fieldsOf(const RandomAccessFile& file, const LasHeader& header)
{
  std::vector<LasField> fields = lasFields(header.format, header.scale, header.offset);
  const std::string descriptors = extraDescriptors(file, header);
  std::size_t at = lasRecordBytes(header.format);
  for (std::size_t i = 0; i + las_descriptor_bytes <= descriptors.size(); i += las_descriptor_bytes) {
    LasField extra = lasExtraField(reinterpret_cast<const std::uint8_t*>(&descriptors[i]), at);
    const std::size_t bytes = extra.count * scalarSize(extra.stored);
    if (bytes > header.record - at)
      break;
    at += bytes;
    const auto same =
        std::find_if(fields.begin() + 3, fields.end(), [&](const auto& f) { return f.name == extra.name; });
    same == fields.end() ? fields.push_back(extra) : void(*same = extra);
  }
  if (at < header.record) {
    LasField rest{"extra_bytes", Scalar::uint8, at};
    rest.count = header.record - at;
    fields.push_back(rest);
  }
  return fields;
}

class LasReader : public ScanReader {
public:
  explicit LasReader(const std::string& path)
      : file_(path), header_(readHeader(file_)), fields_(fieldsOf(file_, header_))
  {
    const std::uint64_t left = file_.size() - std::min(header_.data, file_.size());
    expectRows(header_.points, header_.record, left);
    ScanInfo info;
    info.points = points();
    info.intensity_limits = Eigen::Array2d(0, std::numeric_limits<std::uint16_t>::max());
    scans_.push_back(info);
    full_color_ = fullColor(Scalar::uint16, largestColor());
    if (header_.format == 4 || header_.format == 5 || header_.format >= 9)
      remark("waveforms are left out");
  }

  PointTable open(Index) override
  {
    next_ = 0;
    PointTable layout;
    for (const LasField& field : fields_)
      layout.addColumn(field.name, field.column, field.count);
    columns_ = layout.columns;
    return layout;
  }

  Index read(PointTable& table, Index begin, Index end) override
  {
    const auto left = points() - next_;
    const Index count = std::min({end - begin, left, rows_per_window});
    readRecords(next_, count);
    for (std::size_t f = 0; f < fields_.size(); ++f)
      for (Index i = 0; i < count; ++i)
        store(fields_[f], record(i), table.cell(begin + i, columns_[f]));
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

  /// By a look at places all over the file.
  double largestColor()
  {
    constexpr Index places = 64, points_per_place = 1024;
    double largest = 0;
    const auto total = points();
    for (const LasField& field : fields_)
      for (Index place = 0; isColor(field) && place < places; ++place) {
        const Index first = total / places * place;
        const Index count = std::min(points_per_place, total - first);
        readRecords(first, count);
        for (Index i = 0; i < count; ++i)
          largest = std::max<double>(largest, loadScalar<std::uint16_t>(record(i) + field.offset));
      }
    return largest;
  }

  static bool isColor(const LasField& field)
  {
    return field.stored == Scalar::uint16 && std::count(color_names, color_names + 3, field.name) > 0;
  }

  void store(const LasField& field, const std::uint8_t* record, std::uint8_t* to) const
  {
    const std::uint8_t* from = record + field.offset;
    if (field.stored == field.column && field.bits == 0 && !field.no_data) {
      std::memcpy(to, from, field.count * scalarSize(field.stored));
      return;
    }
    for (std::size_t k = 0; k < field.count; ++k) {
      double value = visitScalar(
          field.stored, [&](auto zero) { return double(loadScalar<decltype(zero)>(from + k * sizeof(zero))); });
      if (field.bits > 0)
        value = unsigned(value) >> field.shift & ((1U << field.bits) - 1);
      value = field.no_data && value == *field.no_data ? std::numeric_limits<double>::quiet_NaN()
              : isColor(field)                         ? colorByte(value, full_color_)
                                                       : value * field.scale + field.origin;
      storeValue(field.column, value, to + k * scalarSize(field.column));
    }
  }

  RandomAccessFile file_;
  const LasHeader header_;
  const std::vector<LasField> fields_;
  std::vector<Column> columns_; ///< of the table that open() gave
  double full_color_ = 255;
  Index next_ = 0; ///< record
  std::vector<std::uint8_t> records_;
};
} // namespace

std::unique_ptr<ScanReader> openLas(const ScanPath& path) { return std::make_unique<LasReader>(path.file); }
} // namespace fresco::io
