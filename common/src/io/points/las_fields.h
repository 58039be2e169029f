// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <vector>
namespace fresco::io {
/// One value of a LAS record, as LAS 1.4 R15 has it (tables 7 to 17, and 24 for extra bytes), and its column.
struct LasField {
  std::string name;
  Scalar stored = Scalar::uint8;
  std::size_t offset = 0; ///< bytes in the record
  Scalar column = Scalar::uint8;
  std::size_t count = 1;
  unsigned shift = 0, bits = 0;       ///< of a byte that fields share; 0 bits: not shared
  double scale = 1, origin = 0;       ///< value = stored * scale + origin
  std::optional<double> no_data = {}; ///< stored value that stands for none
};

/// Bytes of a record of a point format 0..10, without extra bytes.
std::size_t lasRecordBytes(int format);

/// x y z, of that scale and origin, and all further fields of a point format but waveforms.
std::vector<LasField> lasFields(int format, const Eigen::Array3d& scale, const Eigen::Array3d& origin);

/// What a descriptor of extra bytes says. @param offset in the record
LasField lasExtraField(const std::uint8_t* descriptor, std::size_t offset);
/// The other way round.
std::string lasExtraDescriptor(const Column& column);
inline constexpr std::size_t las_descriptor_bytes = 192;
} // namespace fresco::io
