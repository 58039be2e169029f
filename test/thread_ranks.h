// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <fresco/core/exchange.h>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>
namespace fresco::test {
/// Ranks that are threads of this process.
class ThreadRanks {
public:
  /// rank(exchange) on each of n threads. Throws what the first of them threw.
  static void run(int n, const std::function<void(Exchange&)>& rank)
  {
    ThreadRanks ranks(n);
    std::vector<std::thread> threads;
    threads.reserve(n);
    for (int r = 0; r < n; ++r)
      threads.emplace_back([&, r] {
        Rank exchange(ranks, r);
        try {
          rank(exchange);
        } catch (...) {
          ranks.fail(std::current_exception());
        }
      });
    for (std::thread& thread : threads)
      thread.join();
    if (ranks.error_)
      std::rethrow_exception(ranks.error_);
    for (const auto& box : ranks.boxes_)
      if (!box.empty())
        throw std::logic_error("a message was not received");
  }

private:
  using Bytes = Exchange::Bytes;

  explicit ThreadRanks(int n) : n_(n), boxes_(std::size_t(n) * n) {}

  void put(int from, int to, Bytes message)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    boxes_[from * n_ + to].push_back(std::move(message));
    changed_.notify_all();
  }

  Bytes take(int from, int to)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    std::deque<Bytes>& box = boxes_[from * n_ + to];
    changed_.wait(lock, [&] { return !box.empty() || error_; });
    if (box.empty())
      throw std::runtime_error("another rank failed");
    Bytes message = std::move(box.front());
    box.pop_front();
    return message;
  }

  void fail(const std::exception_ptr& error)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!error_)
      error_ = error;
    changed_.notify_all();
  }

  class Rank : public Exchange {
  public:
    Rank(ThreadRanks& ranks, int rank) : ranks_(ranks), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return ranks_.n_; }

    void sum(std::int64_t* values, Index n) override
    {
      std::vector<std::int64_t> total(n, 0);
      for (const Bytes& part : gatherAll(bytesOf(values, n)))
        for (Index i = 0; i < n; ++i)
          total[i] += valueAt<std::int64_t>(part, i);
      std::copy(total.begin(), total.end(), values);
    }

    void largest(double* values, Index n) override
    {
      for (const Bytes& part : gatherAll(bytesOf(values, n)))
        for (Index i = 0; i < n; ++i)
          values[i] = std::max(values[i], valueAt<double>(part, i));
    }

    std::int64_t sumBefore(std::int64_t own) override
    {
      const std::vector<Bytes> all = gatherAll(bytesOf(&own, 1));
      std::int64_t before = 0;
      for (int r = 0; r < rank_; ++r)
        before += valueAt<std::int64_t>(all[r], 0);
      return before;
    }

    std::vector<Bytes> gatherAll(Bytes own) override { return deliver(std::vector<Bytes>(size(), own)); }

    std::vector<Bytes> deliver(std::vector<Bytes> to) override
    {
      for (int r = 0; r < size(); ++r)
        ranks_.put(rank_, r, std::move(to[r]));
      std::vector<Bytes> from;
      for (int r = 0; r < size(); ++r)
        from.push_back(ranks_.take(r, rank_));
      return from;
    }

    void swap(const std::vector<Send>& send, const std::vector<Receive>& receive) override
    {
      for (const Send& s : send)
        ranks_.put(rank_, s.rank, bytesOf(static_cast<const std::byte*>(s.data), s.bytes));
      for (const Receive& r : receive) {
        const Bytes message = ranks_.take(r.rank, rank_);
        if (message.size() != r.bytes)
          throw std::logic_error("a message has another length than expected");
        std::memcpy(r.data, message.data(), r.bytes);
      }
    }

  private:
    template <typename T>
    static Bytes bytesOf(const T* values, std::size_t n)
    {
      Bytes bytes(n * sizeof(T));
      if (n > 0)
        std::memcpy(bytes.data(), values, bytes.size());
      return bytes;
    }
    template <typename T>
    static T valueAt(const Bytes& bytes, Index i)
    {
      T value;
      std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
      return value;
    }

    ThreadRanks& ranks_;
    int rank_;
  };

  int n_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::deque<Bytes>> boxes_;
  std::exception_ptr error_;
};
} // namespace fresco::test
