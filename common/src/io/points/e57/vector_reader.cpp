// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/vector_reader.h"
#include "io/files/expect.h"
#include <algorithm>
#include <fresco/core/point_table.h>
namespace fresco::io::e57 {
namespace {
constexpr std::size_t header_bytes = 32; // of a section
enum PacketType : std::uint8_t { index_packet = 0, data_packet = 1, empty_packet = 2 };

/// Bytes that must be readable behind the last one of a packed stream.
constexpr std::size_t unpack_slack = 16;

/// Whole numbers one after the other in a little-endian stream, the lowest bit first.
void unpackIntegers(const std::uint8_t* stream, std::size_t first_bit, const Field& field,
                    std::vector<std::int64_t>& numbers)
{
  const int bits = field.bits();
  const std::uint64_t offset = field.minimum, mask = bits == 0 ? 0 : ~std::uint64_t{0} >> (64 - bits);
  std::size_t bit = first_bit;
  for (std::int64_t& number : numbers) {
    const std::uint8_t* const at = stream + bit / 8;
    const unsigned shift = bit % 8;
    auto word = loadScalar<std::uint64_t>(at) >> shift;
    if (shift + bits > 64) // the rest lies in a ninth byte
      word |= std::uint64_t{at[8]} << (64 - shift);
    number = (word & mask) + offset; // modulo 2^64
    bit += bits;
  }
}

std::uint64_t bitsPerRecord(const std::vector<Field>& fields)
{
  std::uint64_t bits = 0;
  for (const Field& field : fields)
    bits += field.type == Field::Type::string ? 8 : field.bits();
  return bits;
}

/// Bytes of the string that begins at `at`: its length stands in 7 bits, or in 63 where the lowest bit is set.
/// @return bytes with the length; 0 if more than `available`
std::size_t stringBytes(const std::uint8_t* at, std::size_t available)
{
  if (available == 0)
    return 0;
  std::uint64_t length = at[0] >> 1U, prefix = 1;
  if ((at[0] & 1U) != 0) {
    if (available < 8)
      return 0;
    length = loadScalar<std::uint64_t>(at) >> 1U;
    prefix = 8;
  }
  return length > available - prefix ? 0 : length + prefix;
}

template <typename T>
void copyReals(const std::uint8_t* from, std::vector<double>& reals)
{
  for (double& value : reals) {
    value = loadScalar<T>(from);
    from += sizeof(T);
  }
}
} // namespace

void VectorReader::Stream::append(const std::uint8_t* more, std::size_t count)
{
  bytes.resize(size + count + unpack_slack);
  std::copy_n(more, count, bytes.data() + size);
  size += count;
}

void VectorReader::Stream::dropDecoded()
{
  const std::size_t whole = bit / 8;
  bytes.erase(bytes.begin(), bytes.begin() + whole);
  size -= whole;
  bit -= 8 * whole;
}

VectorReader::VectorReader(PagedFile& file, const CompressedVector& records)
    : file_(file), records_(records), left_(records.count), streams_(records.fields.size())
{
  if (left_ == 0)
    return;
  const std::uint64_t begin = file.logical(records.physical_offset);
  std::uint8_t header[header_bytes];
  file.read(begin, header, header_bytes);
  const auto length = loadScalar<std::uint64_t>(header + 8);
  expect(header[0] == 1, "damaged: no compressed vector at offset ", records.physical_offset);
  expect(length >= header_bytes && length <= file.size() - begin, "truncated: the section at offset ",
         records.physical_offset, " has ", length, " bytes, ", file.size() - begin, " are left in the file");
  packet_ = file.logical(loadScalar<std::uint64_t>(header + 16));
  end_ = begin + length;
  const std::uint64_t bits = std::max(bitsPerRecord(records.fields), least_bits_per_record);
  expect(left_ / 8 <= length / bits + 1, "truncated: ", left_, " points of ", bits, " bits do not fit into ", length,
         " bytes");
  for (std::size_t f = 0; f < streams_.size(); ++f) {
    streams_[f].append(nullptr, 0);
    if (records.fields[f].type == Field::Type::scaled_integer) {
      streams_[f].scale = records.fields[f].scale;
      streams_[f].offset = records.fields[f].offset;
    }
  }
}

bool VectorReader::holds(std::size_t field, std::size_t records) const
{
  const Stream& stream = streams_[field];
  if (records_.fields[field].type != Field::Type::string)
    return 8 * stream.size - stream.bit >= records * records_.fields[field].bits();
  std::size_t at = stream.bit / 8;
  for (std::size_t i = 0; i < records; ++i) {
    const std::size_t bytes = stringBytes(stream.bytes.data() + at, stream.size - at);
    if (bytes == 0)
      return false;
    at += bytes;
  }
  return true;
}

void VectorReader::readPacket()
{
  expect(packet_ < end_ && end_ - packet_ >= 4, "truncated: the points end early, ", left_, " of ", records_.count,
         " are missing");
  std::uint8_t head[4];
  file_.read(packet_, head, sizeof(head));
  const std::size_t length = std::size_t{loadScalar<std::uint16_t>(head + 2)} + 1;
  expect(head[0] <= empty_packet && length % 4 == 0 && length <= end_ - packet_, "damaged: a packet of type ",
         int{head[0]}, " and ", length, " bytes");
  if (head[0] == data_packet) {
    buffer_.resize(length);
    file_.read(packet_, buffer_.data(), length);
    distribute(length);
  }
  packet_ += length;
}

/// Hands the pieces of a data packet to their streams.
void VectorReader::distribute(std::size_t length)
{
  const std::size_t count = length < 6 ? 0 : loadScalar<std::uint16_t>(buffer_.data() + 4);
  expect(count == streams_.size(), "damaged: a packet of ", count, " streams, expected ", streams_.size());
  std::size_t at = 6 + 2 * count;
  for (std::size_t f = 0; f < count; ++f) {
    const std::size_t bytes = 6 + 2 * f + 2 <= length ? loadScalar<std::uint16_t>(buffer_.data() + 6 + 2 * f) : length;
    expect(at <= length && bytes <= length - at, "damaged: a packet is shorter than its streams");
    streams_[f].append(buffer_.data() + at, bytes);
    at += bytes;
  }
}

void VectorReader::decodeStrings(Stream& stream, std::size_t count) const
{
  for (std::size_t i = 0; i < count; ++i)
    stream.bit += 8 * stringBytes(stream.bytes.data() + stream.bit / 8, stream.size - stream.bit / 8);
  std::fill(stream.reals.begin(), stream.reals.end(), 0.0);
}

void VectorReader::decode(std::size_t f, std::size_t count)
{
  const Field& field = records_.fields[f];
  Stream& stream = streams_[f];
  if (field.isInteger()) {
    stream.integers.resize(count);
    unpackIntegers(stream.bytes.data(), stream.bit, field, stream.integers);
  } else {
    stream.reals.resize(count);
    const std::uint8_t* from = stream.bytes.data() + stream.bit / 8;
    if (field.type == Field::Type::single_float)
      copyReals<float>(from, stream.reals);
    else if (field.type == Field::Type::double_float)
      copyReals<double>(from, stream.reals);
    else
      decodeStrings(stream, count);
  }
  stream.bit += count * field.bits();
  stream.dropDecoded();
}

std::size_t VectorReader::next(std::size_t most)
{
  const std::size_t count = std::min<std::uint64_t>(most, left_);
  if (count == 0)
    return 0;
  for (std::size_t f = 0; f < streams_.size(); ++f)
    while (!holds(f, count))
      readPacket();
  for (std::size_t f = 0; f < streams_.size(); ++f)
    decode(f, count);
  left_ -= count;
  return count;
}

void VectorReader::requireEnd()
{
  constexpr std::size_t head = 4; // bytes of a packet
  while (packet_ + head <= end_)
    readPacket();
  for (std::size_t f = 0; f < streams_.size(); ++f)
    expect(8 * streams_[f].size - streams_[f].bit < 8, "damaged: there is more of field ", records_.fields[f].name,
           " than its ", records_.count, " records");
}
} // namespace fresco::io::e57
