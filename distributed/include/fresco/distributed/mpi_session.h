// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/exchange.h>
#include <functional>
#include <memory>
#include <string>
namespace fresco {
/// MPI for the life of the object, the only one of its process; made and used by one thread. A program that was not started
/// by mpirun or srun is rank 0 of 1. Waiting costs hardly any processor time.
class MpiSession {
public:
  /// @throws std::runtime_error if MPI cannot be started or has been started already
  MpiSession();

  /// To be reached by all ranks at about the same time: MPI keeps the processor busy until then. A process that fails calls endJob() instead.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  Exchange& exchange();

  /// "rank 2 on HOST"; empty where there is one rank.
  std::string place() const;

  /// @param property what must be the same on all ranks
  /// @throws std::runtime_error on all ranks, naming the first rank that differs from rank 0:
  ///         "WHAT differs between rank 0 on A and rank 2 on B"
  void requireSame(const std::string& what, const std::string& property);

  /// Ends the processes of all ranks. Of ranks that fail at about the same time one speaks, the lowest.
  /// @param say prints why
  [[noreturn]] void endJob(int status, const std::function<void()>& say);

private:
  class State;
  std::unique_ptr<State> state_;
};
} // namespace fresco
