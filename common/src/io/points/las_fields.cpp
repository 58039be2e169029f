// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/las_fields.h"
namespace fresco::io {
namespace {
/// Types of extra bytes from 1 on.
constexpr Scalar extra_types[] = {Scalar::uint8, Scalar::int8,   Scalar::uint16, Scalar::int16,   Scalar::uint32,
                                  Scalar::int32, Scalar::uint64, Scalar::int64,  Scalar::float32, Scalar::float64};
constexpr unsigned type_count = std::size(extra_types);

bool hasColors(int format)
{
  return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}

LasField shared(const char* name, std::size_t offset, unsigned shift, unsigned bits)
{
  LasField field{name, Scalar::uint8, offset};
  field.shift = shift;
  field.bits = bits;
  return field;
}
} // namespace

std::size_t lasRecordBytes(int format)
{
  constexpr std::size_t bytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return bytes[format];
}

std::vector<LasField> lasFields(int format, const Eigen::Array3d& scale, const Eigen::Array3d& origin)
{
  std::vector<LasField> fields;
  for (std::size_t axis = 0; axis < 3; ++axis)
    fields.push_back(
        {xyz_names[axis], Scalar::int32, 4 * axis, Scalar::float64, 1, 0, 0, scale[Index(axis)], origin[Index(axis)]});
  fields.push_back({"intensity", Scalar::uint16, 12, Scalar::float32});
  const bool modern = format >= 6;
  std::size_t at = modern ? 22 : 20; // behind what all formats have
  if (format != 0 && format != 2) {
    fields.push_back({"gps_time", Scalar::float64, at, Scalar::float64});
    at += 8;
  }
  for (std::size_t k = 0; k < 3 && hasColors(format); ++k, at += 2)
    fields.push_back({color_names[k], Scalar::uint16, at, Scalar::uint8});
  if (format == 8 || format == 10)
    fields.push_back({"near_infrared", Scalar::uint16, at, Scalar::uint16});
  const unsigned bits = modern ? 4 : 3;
  fields.push_back(shared("return_number", 14, 0, bits));
  fields.push_back(shared("number_of_returns", 14, bits, bits));
  if (modern) {
    fields.push_back({"classification", Scalar::uint8, 16});
    fields.push_back(shared("classification_flags", 15, 0, 4));
  } else {
    fields.push_back(shared("classification", 15, 0, 5));
    fields.push_back(shared("classification_flags", 15, 5, 3));
  }
  fields.push_back({"user_data", Scalar::uint8, 17});
  LasField angle{"scan_angle", modern ? Scalar::int16 : Scalar::int8, modern ? 18U : 16U, Scalar::float32};
  angle.scale = modern ? 0.006 : 1; // degrees
  fields.push_back(angle);
  fields.push_back({"point_source_id", Scalar::uint16, modern ? 20U : 18U, Scalar::uint16});
  return fields;
}

LasField lasExtraField(const std::uint8_t* descriptor, std::size_t offset)
{
  constexpr unsigned no_data = 1, scaled = 8, moved = 16; // bits of the options
  const unsigned type = descriptor[2], options = descriptor[3];
  const auto* text = reinterpret_cast<const char*>(descriptor + 4);
  LasField field{standardName(std::string(text, ::strnlen(text, 32))), Scalar::uint8, offset};
  if (type == 0 || type > 3 * type_count) { // bytes of which nothing is said
    field.count = std::max(1U, options);
    return field;
  }
  field.stored = field.column = extra_types[(type - 1) % type_count];
  field.count = (type - 1) / type_count + 1; // two or three values: deprecated
  const auto value = [&](std::size_t at) { return loadScalar<double>(descriptor + at); };
  if ((options & scaled) != 0)
    field.scale = value(112);
  if ((options & moved) != 0)
    field.origin = value(136);
  if (field.scale != 1 || field.origin != 0)
    field.column = Scalar::float64;
  if ((options & no_data) != 0) {
    const bool is_float = field.stored == Scalar::float32 || field.stored == Scalar::float64;
    field.no_data = is_float ? value(40) : double(loadScalar<std::int64_t>(descriptor + 40));
    field.column = is_float ? field.column : Scalar::float64; // which has a NaN
  }
  return field;
}

std::string lasExtraDescriptor(const Column& column)
{
  std::string descriptor(las_descriptor_bytes, '\0');
  for (unsigned type = 1; type <= type_count; ++type)
    if (extra_types[type - 1] == column.type)
      descriptor[2] = char(type);
  descriptor.replace(4, std::min<std::size_t>(column.name.size(), 32), column.name.substr(0, 32));
  return descriptor;
}
} // namespace fresco::io
