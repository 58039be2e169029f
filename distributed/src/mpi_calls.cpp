// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_calls.h"
#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
namespace fresco::distributed {
void check(int code)
{
  if (code == MPI_SUCCESS)
    return;
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw std::runtime_error("MPI: " + std::string(text, static_cast<std::size_t>(length)));
}

bool Requests::wait(double seconds)
{
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  constexpr auto awake = 50us; // messages between neighbours take less
  const auto start = Clock::now();
  for (int done = 0;;) {
    check(MPI_Testall(static_cast<int>(all_.size()), all_.data(), &done, MPI_STATUSES_IGNORE));
    const auto waited = Clock::now() - start;
    if (done || (seconds >= 0 && std::chrono::duration<double>(waited).count() > seconds))
      return done != 0;
    if (waited > awake)
      std::this_thread::sleep_for(std::min<Clock::duration>(1ms, waited / 8));
  }
}
} // namespace fresco::distributed
