// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/core/require.h>
#include <fresco/core/types.h>
#include <utility>
#include <vector>
namespace fresco {
/// What the ranks (processes, or threads) of one job say to each other. This base is the only rank of all, and has
/// nobody to talk to.
///
/// All ranks call the members in the same order; but swap() is for pairs: it ends when all that is to be received is
/// there, and a message waits for its receiver. Messages between two ranks arrive in the order in which they were sent.
/// Members throw if another rank has failed.
class FRESCO_EXPORT Exchange {
public:
  using Bytes = std::vector<std::byte>;
  struct Send {
    int rank;
    const void* data;
    std::size_t bytes; ///< > 0
  };
  struct Receive {
    int rank;
    void* data;
    std::size_t bytes; ///< as the sender says
  };

  Exchange() = default;
  virtual ~Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  virtual int rank() const { return 0; } ///< 0 .. size() - 1
  virtual int size() const { return 1; }

  /// values[i] becomes its sum over all ranks: whole numbers add up to the same in any order.
  virtual void sum(std::int64_t* /*values*/, Index /*n*/) {}
  /// values[i] becomes the largest of all ranks.
  virtual void largest(double* /*values*/, Index /*n*/) {}
  /// Sum over all lower ranks.
  virtual std::int64_t sumBefore(std::int64_t /*own*/) { return 0; }
  /// What each rank has, by rank.
  virtual std::vector<Bytes> gatherAll(Bytes own)
  {
    std::vector<Bytes> all(1);
    all[0] = std::move(own);
    return all;
  }
  /// @param to what each rank shall get, by rank. @return what came from each, also from this rank itself, by rank
  virtual std::vector<Bytes> deliver(std::vector<Bytes> to) { return to; }
  /// Messages to and from other ranks.
  virtual void swap(const std::vector<Send>& send, const std::vector<Receive>& receive)
  {
    require(send.empty() && receive.empty(), "exchange: the only rank has nobody to talk to");
  }
};
} // namespace fresco
