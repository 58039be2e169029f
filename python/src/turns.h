// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <pybind11/pybind11.h>
namespace fresco::python {
/// A thread's time within our code with the GIL, or asking for it. When Python ends, it ends threads that ask for the GIL by unwinding
/// them, which aborts a process in C++: so it waits for the turns under way (at most 5 s), and no thread gets another.
class Turn {
public:
  /// Of a thread that holds the GIL. Does not return if Python ends.
  Turn();
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  class Asked;
  class Pause;
};

/// Of a thread without the GIL, which it takes: false if Python ends.
class Turn::Asked {
public:
  Asked();
  ~Asked();
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;
  explicit operator bool() const { return gil_.has_value(); }

private:
  std::optional<pybind11::gil_scoped_acquire> gil_;
};

/// Time without the GIL within a turn. Its end does not return if Python ends.
class Turn::Pause {
public:
  Pause();
  ~Pause();
  Pause(const Pause&) = delete;
  Pause& operator=(const Pause&) = delete;

private:
  std::optional<pybind11::gil_scoped_release> release_;
};

/// Has Python tell when it ends.
void watchEndOfPython();
} // namespace fresco::python
