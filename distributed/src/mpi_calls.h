// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <mpi.h>
#include <vector>
namespace fresco::distributed {
/// MPI counts with int.
constexpr std::size_t most_bytes_per_call = std::size_t{1} << 30;

/// @throws std::runtime_error with MPI's own words unless `code` is MPI_SUCCESS
void check(int code);

/// Requests under way, and the only place that waits for MPI. Its own functions that wait keep a processor busy, so these
/// requests are tested, and the thread sleeps in between: an eighth of the time waited so far, 1 ms at most.
class Requests {
public:
  /// To be filled by a call of MPI.
  MPI_Request* next() { return &all_.emplace_back(MPI_REQUEST_NULL); }

  /// @param seconds to wait at most, below 0 = for ever
  /// @return whether all are done
  bool wait(double seconds = -1);

private:
  std::vector<MPI_Request> all_;
};
} // namespace fresco::distributed
