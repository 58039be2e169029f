// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <functional>
#include <stdexcept>
#include <string_view>
namespace fresco {
/// Called between steps with the name of the step that begins and the share of the whole job done, 0..1.
/// Returns false to stop the job. Empty: nobody listens.
using Progress = std::function<bool(std::string_view step, double fraction)>;

/// The caller asked to stop through `Progress`.
struct FRESCO_EXPORT Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

/// @throws Cancelled if the listener asks to stop
inline void report(const Progress& progress, std::string_view step, double fraction)
{
  if (progress && !progress(step, fraction))
    throw Cancelled();
}

/// `progress` for a part of a job: 0..1 of the part is mapped to begin..end of the whole.
inline Progress subProgress(const Progress& progress, double begin, double end)
{
  if (!progress)
    return {};
  return [progress, begin, end](std::string_view step, double fraction) {
    return progress(step, begin + (end - begin) * fraction);
  };
}
} // namespace fresco
