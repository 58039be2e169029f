// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstring>
#include <fresco/core/array.h>
#include <fresco/core/exchange.h>
#include <type_traits>
namespace fresco::poisson {
using Bytes = Exchange::Bytes;

/// Appends plain values to a message.
template <typename T>
void append(Bytes& message, const T* values, std::size_t count)
{
  static_assert(std::is_trivially_destructible_v<T>);
  if (count == 0)
    return;
  const std::size_t at = message.size();
  message.resize(at + count * sizeof(T));
  std::memcpy(message.data() + at, static_cast<const void*>(values), count * sizeof(T));
}

template <typename T>
void append(Bytes& message, const T& value)
{
  append(message, &value, 1);
}

/// Appends the values of a message to an array.
template <typename T, typename Allocator>
void appendTo(std::vector<T, Allocator>& values, const Bytes& message)
{
  const std::size_t at = values.size(), count = message.size() / sizeof(T);
  values.resize(at + count);
  if (count > 0)
    std::memcpy(static_cast<void*>(values.data() + at), message.data(), count * sizeof(T));
}

template <typename T>
Array<T> valuesOf(const Bytes& message)
{
  Array<T> values;
  appendTo(values, message);
  return values;
}

/// What all ranks have, behind each other.
template <typename T>
Array<T> gatherAll(Exchange& exchange, const T* own, std::size_t count)
{
  Bytes message;
  append(message, own, count);
  Array<T> all;
  for (Bytes& part : exchange.gatherAll(std::move(message))) {
    appendTo(all, part);
    Bytes().swap(part);
  }
  return all;
}

/// `value` of rank 0.
template <typename T>
void broadcast(Exchange& exchange, T* values, std::size_t count)
{
  Bytes message;
  if (exchange.rank() == 0)
    append(message, values, count);
  const Bytes first = exchange.gatherAll(std::move(message))[0];
  if (count > 0)
    std::memcpy(static_cast<void*>(values), first.data(), count * sizeof(T));
}

inline std::int64_t sumOfAll(Exchange& exchange, std::int64_t own)
{
  exchange.sum(&own, 1);
  return own;
}
} // namespace fresco::poisson
