// SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <chrono>
#include <cmath>
#include <fresco/core/parallel.h>
#include <gtest/gtest.h>
#include <thread>
namespace {
using fresco::Index;

TEST(Parallel, EveryIndexOnceForAnyThreadCount)
{
  for (const Index n : {0, 1, 2, 511, 512, 513, 100000})
    for (const int threads : {0, 1, 3, 8}) {
      std::vector<int> hits(n, 0);
      fresco::parallelFor(n, threads, [&](Index i) { ++hits[i]; });
      EXPECT_EQ(std::count(hits.begin(), hits.end(), 1), n) << threads;
    }
}

TEST(Parallel, SumHasTheSameBitsForAnyThreadCount)
{
  const auto term = [](Index i) {
    return std::sin(static_cast<double>(i)) * 1e-3 + 1.0 / (1.0 + static_cast<double>(i));
  };
  const double one = fresco::parallelSum(1000003, 1, 0.0, term);
  for (const int threads : {2, 3, 7, 0})
    EXPECT_EQ(fresco::parallelSum(1000003, threads, 0.0, term), one) << threads;
}

TEST(Parallel, ReduceJoinsInOrder)
{
  const auto map = [](Index begin, Index end) {
    std::string text;
    for (Index i = begin; i < end; ++i)
      text += static_cast<char>('a' + i % 26);
    return text;
  };
  const auto join = [](std::string all, const std::string& part) { return all + part; };
  EXPECT_EQ(fresco::parallelReduce(5000, 4, std::string(), map, join), map(0, 5000));
}

TEST(Parallel, ExceptionOfABodyReachesTheCaller)
{
  const auto run = [](int threads) {
    fresco::parallelFor(10000, threads, [](Index i) {
      if (i == 7777)
        throw std::runtime_error("body");
    });
  };
  EXPECT_THROW(run(1), std::runtime_error);
  EXPECT_THROW(run(4), std::runtime_error);
}

TEST(Parallel, LoopInsideALoop)
{
  std::vector<double> sums(64);
  fresco::parallelFor(64, 4, [&](Index i) {
    sums[i] = fresco::parallelSum(1000, 4, 0.0, [&](Index j) { return static_cast<double>(i * j); });
  });
  for (std::size_t i = 0; i < sums.size(); ++i)
    EXPECT_EQ(sums[i], static_cast<double>(i) * 499500.0);
}

TEST(Parallel, MoreThreadsThanCoresAreUsed)
{
  const int wanted = static_cast<int>(std::thread::hardware_concurrency()) >= 8 ? 3 : 2;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20); // for a machine that is busy otherwise
  std::atomic<int> inside{0}, most{0};
  fresco::parallelFor(
      16, 8,
      [&](Index) {
        const int now = ++inside;
        for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
        }
        while (most < wanted && std::chrono::steady_clock::now() < end)
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --inside;
      },
      1);
  EXPECT_GE(most, wanted);
}

TEST(Parallel, LoopsOfSeveralThreadsAtOnce)
{
  std::vector<Index> sums(6);
  std::vector<std::thread> callers;
  for (Index caller = 0; caller < 6; ++caller)
    callers.emplace_back([&sums, caller] {
      for (int round = 0; round < 200; ++round) {
        const auto own = [caller](Index i) { return i * caller; };
        sums[caller] += fresco::parallelSum(1000, 3, Index(0), own);
      }
    });
  for (std::thread& caller : callers)
    caller.join();
  for (Index caller = 0; caller < 6; ++caller)
    EXPECT_EQ(sums[caller], 200 * 499500 * caller);
}

TEST(Parallel, NegativeThreadCountThrows)
{
  EXPECT_THROW(fresco::parallelFor(4, -1, [](Index) {}), std::invalid_argument);
  EXPECT_GE(fresco::threadCount(0), 1);
  EXPECT_EQ(fresco::threadCount(5), 5);
}
} // namespace
