// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <fresco/io/packing.h>
#include <gtest/gtest.h>
#include <limits>
namespace fresco::test {
inline Exchange::Bytes message(int from, int to, std::size_t size)
{
  Exchange::Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::byte>(from * 31 + to * 7 + static_cast<int>(i % 251));
  return bytes;
}

inline void expectSums(Exchange& ranks)
{
  const int rank = ranks.rank(), size = ranks.size();
  constexpr std::int64_t large = (std::int64_t{1} << 60) + 1; // a double would lose the 1
  std::vector<std::int64_t> values{rank, 1, rank == size - 1 ? large : 0, -rank};
  ranks.sum(values.data(), 4);
  EXPECT_EQ(values, (std::vector<std::int64_t>{size * (size - 1) / 2, size, large, -size * (size - 1) / 2}));
  EXPECT_EQ(ranks.sumBefore(2 * rank + 1), rank * rank);
  std::vector<double> reals{1.0 * rank, -std::numeric_limits<double>::infinity(), 0.1 - rank};
  ranks.largest(reals.data(), 3);
  EXPECT_EQ(reals, (std::vector<double>{size - 1.0, -std::numeric_limits<double>::infinity(), 0.1}));
  ranks.sum(nullptr, 0);
}

/// Parts of all sizes, none among them, and from and to this rank itself.
inline void expectDeliveries(Exchange& ranks)
{
  const int rank = ranks.rank(), size = ranks.size();
  const auto bytes = [&](int from, int to) {
    return std::size_t{1000} * static_cast<std::size_t>((from + 2 * to) % 4);
  };
  const auto gathered = ranks.gatherAll(message(rank, 0, bytes(rank, 0)));
  ASSERT_EQ(gathered.size(), static_cast<std::size_t>(size));
  std::vector<Exchange::Bytes> to;
  for (int other = 0; other < size; ++other) {
    EXPECT_EQ(gathered[other], message(other, 0, bytes(other, 0))) << other;
    to.push_back(message(rank, other, bytes(rank, other)));
  }
  const auto from = ranks.deliver(std::move(to));
  ASSERT_EQ(from.size(), static_cast<std::size_t>(size));
  for (int other = 0; other < size; ++other)
    EXPECT_EQ(from[other], message(other, rank, bytes(other, rank))) << other;
}

/// Along the ranks, one after the other; then around in a ring, two messages of one size to each neighbour.
inline void expectSwaps(Exchange& ranks)
{
  const int rank = ranks.rank(), size = ranks.size();
  std::int64_t passed = 0;
  if (rank > 0)
    ranks.swap({}, {{rank - 1, &passed, sizeof(passed)}});
  passed += rank;
  if (rank + 1 < size)
    ranks.swap({{rank + 1, &passed, sizeof(passed)}}, {});
  EXPECT_EQ(passed, rank * (rank + 1) / 2);
  if (size == 1)
    return;
  const int next = (rank + 1) % size, before = (rank + size - 1) % size;
  constexpr std::size_t bytes = 300000; // more than goes out at once
  const Exchange::Bytes first = message(rank, 1, bytes), second = message(rank, 2, bytes);
  Exchange::Bytes received_first(bytes), received_second(bytes);
  ranks.swap({{next, first.data(), bytes}, {next, second.data(), bytes}},
             {{before, received_first.data(), bytes}, {before, received_second.data(), bytes}});
  EXPECT_EQ(received_first, message(before, 1, bytes));
  EXPECT_EQ(received_second, message(before, 2, bytes));
}

/// What packing.h promises on top.
inline void expectSharedItems(Exchange& ranks)
{
  const auto item = [](Index i) { return std::pair(std::string(static_cast<std::size_t>(i), 'x'), 0.5 * i); };
  std::vector<std::pair<std::string, double>> items(7);
  for (Index i = 0; i < 7; ++i)
    if (isOwn(ranks, i))
      items[i] = item(i);
  shareItems(ranks, items);
  for (Index i = 0; i < 7; ++i)
    EXPECT_EQ(items[i], item(i)) << i;
}

/// What holds for every kind of Exchange; to be called by all ranks.
inline void expectExchangeLaws(Exchange& ranks)
{
  for (int round = 0; round < 20; ++round) { // later messages do not overtake earlier ones
    expectSums(ranks);
    expectDeliveries(ranks);
    expectSwaps(ranks);
    expectSharedItems(ranks);
  }
}
} // namespace fresco::test
