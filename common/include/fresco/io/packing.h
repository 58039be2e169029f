// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstring>
#include <fresco/core/exchange.h>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>
namespace fresco {
/// What both directions share. @tparam Archive has block(data, bytes)
template <typename Archive>
class ArchiveBase {
public:
  template <typename... Values>
  void operator()(Values&... values)
  {
    (add(values), ...);
  }

protected:
  template <typename Value>
  void add(Value& value)
  {
    Archive& archive = static_cast<Archive&>(*this);
    if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>)
      archive.block(&value, sizeof(value));
    else
      fields(archive, value);
  }
};

/// Values as bytes, for messages between ranks on machines of one kind. A struct needs a function
/// `template <typename Archive> void fields(Archive& archive, Struct& s) { archive(s.first, s.second); }` beside it, which
/// serves both directions.
class Packer : public ArchiveBase<Packer> {
public:
  /// Of a container that is to be filled alike.
  std::size_t count(std::size_t size)
  {
    add(size);
    return size;
  }

  void block(const void* data, std::size_t bytes)
  {
    const auto* begin = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), begin, begin + bytes);
  }

  Exchange::Bytes take() { return std::move(bytes_); }

private:
  Exchange::Bytes bytes_;
};

/// The way back. @throws std::runtime_error if the bytes end too early
class Unpacker : public ArchiveBase<Unpacker> {
public:
  explicit Unpacker(const Exchange::Bytes& bytes) : bytes_(bytes) {}

  std::size_t count(std::size_t)
  {
    std::size_t size = 0;
    add(size);
    return size;
  }

  void block(void* data, std::size_t bytes)
  {
    if (bytes > bytes_.size() - at_)
      throw std::runtime_error("a message of another rank is too short");
    if (bytes > 0)
      std::memcpy(data, bytes_.data() + at_, bytes);
    at_ += bytes;
  }

private:
  const Exchange::Bytes& bytes_;
  std::size_t at_ = 0;
};

template <typename Archive>
void fields(Archive& archive, std::string& text)
{
  text.resize(archive.count(text.size()));
  archive.block(text.data(), text.size());
}

template <typename Archive, typename Value, typename Allocator>
void fields(Archive& archive, std::vector<Value, Allocator>& values)
{
  values.resize(archive.count(values.size()));
  for (Value& value : values)
    archive(value);
}

template <typename Archive, typename Value, std::size_t size>
void fields(Archive& archive, std::array<Value, size>& values)
{
  for (Value& value : values)
    archive(value);
}

template <typename Archive, typename First, typename Second>
void fields(Archive& archive, std::pair<First, Second>& pair)
{
  archive(pair.first, pair.second);
}

template <typename Archive, typename Value>
void fields(Archive& archive, std::optional<Value>& value)
{
  if (archive.count(value ? 1 : 0) == 0)
    return;
  if (!value)
    value.emplace();
  archive(*value);
}

template <typename Archive, typename Derived>
void fields(Archive& archive, Eigen::PlainObjectBase<Derived>& matrix)
{
  const std::size_t rows = archive.count(matrix.rows()), cols = archive.count(matrix.cols());
  matrix.resize(static_cast<Index>(rows), static_cast<Index>(cols));
  archive.block(matrix.data(), rows * cols * sizeof(typename Derived::Scalar));
}

template <typename Archive, typename Scalar, int dimension, int mode>
void fields(Archive& archive, Eigen::Transform<Scalar, dimension, mode>& transform)
{
  archive(transform.matrix());
}

/// What each rank has, by rank.
template <typename Value>
std::vector<Value> gatherValues(Exchange& ranks, Value own)
{
  Packer packer;
  packer(own);
  std::vector<Value> values;
  for (const Exchange::Bytes& bytes : ranks.gatherAll(packer.take())) {
    Unpacker unpacker(bytes);
    unpacker(values.emplace_back());
  }
  return values;
}

/// Returns when all ranks have called it.
inline void awaitAll(Exchange& ranks)
{
  std::int64_t nothing = 0;
  ranks.sum(&nothing, 1);
}

/// Items of a list that all ranks work through together: each has every size()-th.
inline bool isOwn(const Exchange& ranks, Index item) { return item % ranks.size() == ranks.rank(); }

/// Own items go to all ranks, those of the others come in.
template <typename Value>
void shareItems(Exchange& ranks, std::vector<Value>& items)
{
  if (ranks.size() == 1)
    return;
  Packer packer;
  const std::size_t step = ranks.size();
  for (std::size_t i = ranks.rank(); i < items.size(); i += step)
    packer(items[i]);
  const std::vector<Exchange::Bytes> parts = ranks.gatherAll(packer.take());
  for (std::size_t rank = 0; rank < step; ++rank) {
    Unpacker unpacker(parts[rank]);
    for (std::size_t i = rank; i < items.size() && !isOwn(ranks, i); i += step)
      unpacker(items[i]);
  }
}
} // namespace fresco
