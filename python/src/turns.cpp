// SPDX-License-Identifier: BSD-3-Clause
#include "turns.h"
#include <atomic>
#include <chrono>
#include <thread>
#include <unistd.h>
namespace fresco::python {
namespace {
// Atomic, since a lock might be held by another thread when a process forks.
std::atomic<int> turns{0};
std::atomic<bool> over{false};
std::thread::id last; ///< of the thread that ends Python, which may go on

bool begin()
{
  ++turns;
  if (!over || std::this_thread::get_id() == last)
    return true;
  --turns;
  return false;
}

[[noreturn]] void awaitEndOfProcess()
{
  for (;;)
    ::pause();
}

void endTurns()
{
  using namespace std::chrono;
  last = std::this_thread::get_id();
  over = true;
  const pybind11::gil_scoped_release release;
  const auto begun = steady_clock::now();
  while (turns > 0 && steady_clock::now() - begun < seconds(5)) // what waits for longer is not about to ask
    std::this_thread::sleep_for(milliseconds(1));
}
} // namespace

Turn::Turn()
{
  if (begin())
    return;
  PyEval_SaveThread();
  awaitEndOfProcess();
}

Turn::~Turn() { --turns; }

Turn::Asked::Asked()
{
  if (begin())
    gil_.emplace();
}

Turn::Asked::~Asked()
{
  if (!gil_)
    return;
  gil_.reset();
  --turns;
}

Turn::Pause::Pause()
{
  release_.emplace();
  --turns;
}

Turn::Pause::~Pause()
{
  if (!begin())
    awaitEndOfProcess();
  release_.reset();
}

void watchEndOfPython() { pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(endTurns)); }
} // namespace fresco::python
